//! Each error of the sensors has the size its model says: statistics over many seeds.

use core::f64::consts::TAU;

use nalgebra::Vector3;

use super::{hover, total_counts};
use crate::motion::{
    FlowModel, Imu, ImuModel, MotionReadings, MotionSensors, MotionTruth, RangeModel, ScaleSwing,
    SensorModel,
};

const IDEAL: SensorModel = SensorModel::ideal();
const SEEDS: u64 = 300;
/// Four standard errors of a standard deviation over so many draws, as a share of it.
const CHANCE: f64 = 0.17;

fn with_imu(imu: ImuModel) -> SensorModel {
    SensorModel { imu, ..IDEAL }
}

fn with_flow(flow: FlowModel) -> SensorModel {
    SensorModel { flow, ..IDEAL }
}

fn with_range(range: RangeModel) -> SensorModel {
    SensorModel { range, ..IDEAL }
}

/// Root mean square over the seeds of what `error` makes of the readings of a second.
fn spread(
    model: &SensorModel,
    truth: &MotionTruth,
    error: impl Fn(&[MotionReadings]) -> f64,
) -> f64 {
    let squares = (0..SEEDS).map(|seed| error(&super::run(model, seed, truth, 1000)).powi(2));
    (squares.sum::<f64>() / SEEDS as f64).sqrt()
}

#[track_caller]
fn assert_size(found: f64, expected: f64) {
    assert!(
        (found / expected - 1.0).abs() < CHANCE,
        "{found}, not {expected}"
    );
}

fn ranges(readings: &[MotionReadings]) -> Vec<f64> {
    let ranges = readings.iter().filter_map(|r| r.range);
    ranges.map(|range| f64::from(range.distance_m)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_imu_passes_half_the_power_at_its_cut_offs() {
    let amplitude = |hz: f64, of: fn(&MotionReadings) -> f32| {
        let mut sensors = MotionSensors::new(&IDEAL, 1);
        let readings = (0..2000).map(|ms| {
            let sine = libm::sin(TAU * hz * f64::from(ms) / 1000.0);
            sensors.tick(&MotionTruth {
                angular_rate_rad_s: Vector3::repeat(sine.to_radians()),
                specific_force_m_s2: Vector3::repeat(9.81 * sine),
                ..hover()
            })
        });
        readings
            .skip(1000)
            .map(|r| f64::from(of(&r)).abs())
            .fold(0.0, f64::max)
    };
    let half_power = 0.5_f64.sqrt();
    let gyro = amplitude(80.0, |r| r.imu.gyro_deg_s.y);
    assert!((gyro - half_power).abs() < 0.01, "{gyro}");
    let acc = amplitude(30.0, |r| r.imu.acc_g.y);
    assert!((acc - half_power).abs() < 0.01, "{acc}");
}

#[test]
fn white_noise_of_the_imu_is_what_its_filters_leave() {
    // A second-order Butterworth filter passes white noise like a sharp one that is wider by π / (2 √2).
    let left = |cutoff_hz: f64| (1.111 * cutoff_hz / 500.0).sqrt();
    let model = with_imu(ImuModel {
        gyro_noise_deg_s: 2.0,
        acc_noise_g: 0.05,
        ..IDEAL.imu
    });
    let gyro = spread(&model, &hover(), |r| r[999].imu.gyro_deg_s.x.into());
    assert_size(gyro, 2.0 * left(80.0));
    let acc = spread(&model, &hover(), |r| r[999].imu.acc_g.x.into());
    assert_size(acc, 0.05 * left(30.0));
}

#[test]
fn the_gyroscopes_bias_walks_with_the_root_of_time() {
    let model = ImuModel {
        gyro_walk_deg_s_per_sqrt_s: 0.005,
        ..IDEAL.imu
    };
    let squares = (0..SEEDS).map(|seed| {
        let mut imu = Imu::new(&model, seed);
        let last = (0..4000).map(|_| imu.tick(&hover())).last();
        f64::from(last.expect("4000 samples").gyro_deg_s.z).powi(2)
    });
    let walked = (squares.sum::<f64>() / SEEDS as f64).sqrt();
    assert_size(walked, 0.005 * 2.0);
}

#[test]
fn the_gyroscopes_scale_is_off_by_a_hundredth() {
    let turning = MotionTruth {
        angular_rate_rad_s: Vector3::new(0.0, 0.0, 100_f64.to_radians()),
        ..hover()
    };
    let model = with_imu(ImuModel {
        gyro_scale_sd: 0.01,
        ..IDEAL.imu
    });
    let off = spread(&model, &turning, |r| {
        f64::from(r[999].imu.gyro_deg_s.z) - 100.0
    });
    assert_size(off, 1.0);
}

#[test]
fn flow_is_off_by_its_scale_along_and_by_its_mounting_across() {
    let forward = MotionTruth {
        velocity_m_s: Vector3::new(0.5, 0.0, 0.0),
        ..hover()
    };
    let scaled = with_flow(FlowModel {
        scale_sd: 0.05,
        ..IDEAL.flow
    });
    // Nearly a radian in a second; the last interval may be missing.
    let off = spread(&scaled, &forward, |r| {
        f64::from(total_counts(r)[0]) / 486.0 - 1.0
    });
    assert_size(off, 0.05);
    let turned = with_flow(FlowModel {
        mounting_yaw_sd_rad: 1_f64.to_radians(),
        ..IDEAL.flow
    });
    let off = spread(&turned, &forward, |r| f64::from(total_counts(r)[1]) / 486.0);
    assert_size(off, 1_f64.to_radians());
}

#[test]
fn flows_scale_swings_by_its_amplitude_and_is_right_over_a_whole_period() {
    let forward = MotionTruth {
        velocity_m_s: Vector3::new(0.5, 0.0, 0.0),
        ..hover()
    };
    let swinging = with_flow(FlowModel {
        scale_swing: Some(ScaleSwing {
            amplitude: 0.1,
            period_s: 10.0,
        }),
        ..IDEAL.flow
    });
    let off = spread(&swinging, &forward, |r| {
        f64::from(total_counts(r)[0]) / 486.0 - 1.0
    });
    // Root mean square of a sine, of which a second is a tenth.
    assert_size(off, 0.1 * 0.5_f64.sqrt());
    let period = super::run(&swinging, 1, &forward, 10_000);
    let counts = f64::from(total_counts(&period)[0]);
    // Ten radians at 488.3 counts each.
    assert!((counts / 4_883.0 - 1.0).abs() < 0.005, "{counts}");
}

#[test]
fn range_is_off_by_a_constant_and_noisy_about_it() {
    let shifted = with_range(RangeModel {
        offset_sd_m: 0.01,
        ..IDEAL.range
    });
    assert_size(spread(&shifted, &hover(), |r| mean(&ranges(r)) - 0.5), 0.01);
    let noisy = with_range(RangeModel {
        noise_m: 0.003,
        ..IDEAL.range
    });
    assert_size(spread(&noisy, &hover(), |r| ranges(r)[0] - 0.5), 0.003);
    // Over the 33 readings of a second the noise averages out, the offset does not.
    assert_size(
        spread(&noisy, &hover(), |r| mean(&ranges(r)) - 0.5),
        0.003 / 33_f64.sqrt(),
    );
}
