//! What a millisecond of the filter costs. It must stay under 5 µs, or a thousand flights take too long.

use autopilot::ekf::{
    Ekf, Flow, ImuSample, Measurement, Parameters, Pose, Position, Range, YawError,
};
use divan::{Bencher, black_box};
use nalgebra::{UnitQuaternion, Vector3};

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
fn pass(bencher: Bencher<'_, '_>, start: &Ekf, now_ms: u64, measurements: &[Measurement]) {
    bencher
        .with_inputs(|| start.clone())
        .bench_local_values(|mut ekf| {
            enqueue(&mut ekf, &IMU.measurements());
            enqueue(&mut ekf, black_box(measurements));
            ekf.tick(black_box(now_ms), true);
            ekf
        });
}

/// The filter one tick later, where no prediction is due.
fn between() -> Ekf {
    let mut ekf = settled();
    ekf.tick(1000, true);
    ekf
}

#[divan::bench]
fn predicting(bencher: Bencher<'_, '_>) {
    pass(bencher, &settled(), 1000, &[]);
}

#[divan::bench]
fn not_predicting(bencher: Bencher<'_, '_>) {
    pass(bencher, &between(), 1001, &[]);
}

#[divan::bench]
fn with_flow(bencher: Bencher<'_, '_>) {
    pass(bencher, &between(), 1001, &[FLOW]);
}

#[divan::bench]
fn with_range(bencher: Bencher<'_, '_>) {
    pass(bencher, &between(), 1001, &[RANGE]);
}

#[divan::bench]
fn with_correction(bencher: Bencher<'_, '_>) {
    let fix = Measurement::Position(Position {
        position_m: Vector3::new(0.2, -0.1, 0.5),
        sd_m: 0.001,
    });
    let turn = Measurement::YawError(YawError {
        error_rad: 0.1,
        sd_rad: 0.002,
    });
    pass(bencher, &between(), 1001, &[fix, turn]);
}

#[divan::bench]
fn with_pose(bencher: Bencher<'_, '_>) {
    let pose = Measurement::Pose(Pose {
        position_m: Vector3::new(0.2, -0.1, 0.5),
        attitude: UnitQuaternion::from_euler_angles(0.01, -0.02, 0.05),
        sd_position_m: 0.01,
        sd_attitude_rad: 4.5e-3,
    });
    pass(bencher, &between(), 1001, &[pose]);
}

/// A tick of all that can fall together.
#[divan::bench]
fn predicting_with_flow_and_range(bencher: Bencher<'_, '_>) {
    pass(bencher, &settled(), 1000, &[FLOW, RANGE]);
}

fn main() {
    divan::main();
}
