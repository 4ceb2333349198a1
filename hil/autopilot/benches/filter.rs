//! What a millisecond of the filter costs. It must stay under 5 µs, or a thousand flights take too long.

use autopilot::ekf::{
    Ekf, Flow, ImuSample, Measurement, Parameters, Pose, Position, Range, YawError,
};
use criterion::{BatchSize, Criterion};
use nalgebra::{UnitQuaternion, Vector3};
use std::hint::black_box;

const IMU: ImuSample = ImuSample {
    gyro_deg_s: Vector3::new(3.0, -2.0, 1.0),
    acc_g: Vector3::new(0.02, -0.01, 1.0),
};
const FLOW: Measurement = Measurement::Flow(Flow {
    counts: [5.0, -1.0],
    dt_s: 0.01,
    sd_counts: 2.0,
});
const RANGE: Measurement = Measurement::Range(Range {
    distance_m: 0.5,
    sd_m: 0.0025,
});

/// The filter after a second of flight with flow and range, about to make the pass of tick 1000, a predicting one.
fn settled() -> Ekf {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    for now_ms in 0..1000 {
        enqueue(&mut ekf, &IMU.measurements());
        if now_ms % 10 == 5 {
            enqueue(&mut ekf, &[FLOW, RANGE]);
        }
        ekf.tick(now_ms, true);
    }
    ekf
}

fn enqueue(ekf: &mut Ekf, measurements: &[Measurement]) {
    for measurement in measurements {
        // Four of twenty places.
        let _ = ekf.enqueue(*measurement);
    }
}

/// One pass with an IMU sample and these measurements; the filter it starts from is copied outside the clock.
fn pass(
    criterion: &mut Criterion,
    name: &str,
    start: &Ekf,
    now_ms: u64,
    measurements: &[Measurement],
) {
    criterion.bench_function(name, |bencher| {
        bencher.iter_batched(
            || start.clone(),
            |mut ekf| {
                enqueue(&mut ekf, &IMU.measurements());
                enqueue(&mut ekf, black_box(measurements));
                ekf.tick(black_box(now_ms), true);
                ekf
            },
            BatchSize::SmallInput,
        );
    });
}

/// The filter one tick later, where no prediction is due.
fn between() -> Ekf {
    let mut ekf = settled();
    ekf.tick(1000, true);
    ekf
}

fn passes(criterion: &mut Criterion) {
    let (settled, between) = (settled(), between());
    let fix = Measurement::Position(Position {
        position_m: Vector3::new(0.2, -0.1, 0.5),
        sd_m: 0.001,
    });
    let turn = Measurement::YawError(YawError {
        error_rad: 0.1,
        sd_rad: 0.002,
    });
    let pose = Measurement::Pose(Pose {
        position_m: Vector3::new(0.2, -0.1, 0.5),
        attitude: UnitQuaternion::from_euler_angles(0.01, -0.02, 0.05),
        sd_position_m: 0.01,
        sd_attitude_rad: 4.5e-3,
    });
    pass(criterion, "predicting", &settled, 1000, &[]);
    pass(criterion, "not predicting", &between, 1001, &[]);
    pass(criterion, "with flow", &between, 1001, &[FLOW]);
    pass(criterion, "with range", &between, 1001, &[RANGE]);
    pass(criterion, "with a correction", &between, 1001, &[fix, turn]);
    pass(criterion, "with a pose", &between, 1001, &[pose]);
    // All that can fall together in a tick.
    pass(
        criterion,
        "predicting, flow and range",
        &settled,
        1000,
        &[FLOW, RANGE],
    );
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    passes(&mut criterion);
    criterion.final_summary();
}
