//! Claims about the sensors from their definition.

mod errors;

use nalgebra::{UnitQuaternion, Vector3};

use super::{
    FlowDeck, FlowModel, Imu, ImuModel, MotionReadings, MotionSensors, MotionTruth, RangeModel,
    RangeSensor, SensorModel, StatedSd,
};

/// Level, half a metre up, at rest.
fn hover() -> MotionTruth {
    MotionTruth {
        position_m: Vector3::new(0.0, 0.0, 0.5),
        velocity_m_s: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        angular_rate_rad_s: Vector3::zeros(),
        specific_force_m_s2: Vector3::new(0.0, 0.0, 9.81),
    }
}

fn run(model: &SensorModel, seed: u64, truth: &MotionTruth, ticks: usize) -> Vec<MotionReadings> {
    let mut sensors = MotionSensors::new(model, seed);
    (0..ticks).map(|_| sensors.tick(truth)).collect()
}

fn total_counts(readings: &[MotionReadings]) -> [i32; 2] {
    readings
        .iter()
        .filter_map(|r| r.flow)
        .fold([0, 0], |sum, flow| {
            [0, 1].map(|axis| sum[axis] + i32::from(flow.counts[axis]))
        })
}

#[test]
fn an_ideal_imu_reads_rates_in_degrees_and_forces_in_g() {
    let mut imu = Imu::new(&SensorModel::ideal().imu, 1);
    let truth = MotionTruth {
        angular_rate_rad_s: Vector3::new(0.0, 0.0, core::f64::consts::PI),
        ..hover()
    };
    let reading = imu.tick(&truth);
    assert!((reading.gyro_deg_s - Vector3::new(0.0, 0.0, 180.0)).norm() < 1e-4);
    assert!((reading.acc_g - Vector3::new(0.0, 0.0, 1.0)).norm() < 1e-6);
}

#[test]
fn the_imu_saturates_at_its_range() {
    let mut imu = Imu::new(&SensorModel::ideal().imu, 1);
    let truth = MotionTruth {
        angular_rate_rad_s: Vector3::new(100.0, 0.0, 0.0),
        specific_force_m_s2: Vector3::new(0.0, 0.0, -1000.0),
        ..hover()
    };
    let reading = imu.tick(&truth);
    assert!((reading.gyro_deg_s.x - 2000.0).abs() < 1e-3);
    assert!((reading.acc_g.z + 24.0).abs() < 1e-5);
}

#[test]
fn biases_differ_between_seeds_with_the_models_spread() {
    let quiet = ImuModel {
        gyro_noise_deg_s: 0.0,
        acc_noise_g: 0.0,
        ..ImuModel::default()
    };
    let squares: [f64; 2] = (0..400).fold([0.0; 2], |sum, seed| {
        let reading = Imu::new(&quiet, seed).tick(&hover());
        [
            sum[0] + f64::from(reading.gyro_deg_s.x).powi(2),
            sum[1] + f64::from(reading.acc_g.y).powi(2),
        ]
    });
    let [gyro, acc] = squares.map(|sum| (sum / 400.0).sqrt());
    // Four standard errors of a deviation over 400 draws: 14 %.
    assert!((gyro / 0.1 - 1.0).abs() < 0.14, "gyro {gyro}");
    assert!((acc / 0.02 - 1.0).abs() < 0.14, "acc {acc}");
}

#[test]
fn flow_counts_488_per_radian_and_loses_none() {
    // 0.5 m/s at 0.5 m for 1.05 s: 1.05 rad. The last interval and one remainder may be pending.
    let truth = MotionTruth {
        velocity_m_s: Vector3::new(0.5, -0.25, 0.0),
        ..hover()
    };
    let [x, y] = total_counts(&run(&SensorModel::ideal(), 3, &truth, 1050));
    assert!(
        (-7.0..=0.0).contains(&(f64::from(x) - 488.32 * 1.05)),
        "{x}"
    );
    assert!((0.0..=4.0).contains(&(f64::from(y) + 244.16 * 1.05)), "{y}");
}

#[test]
fn flow_of_a_turning_drone_has_the_signs_the_filter_expects() {
    let truth = MotionTruth {
        angular_rate_rad_s: Vector3::new(0.3, 0.2, 5.0),
        ..hover()
    };
    let [x, y] = total_counts(&run(&SensorModel::ideal(), 3, &truth, 1000));
    assert!((-98..=-94).contains(&x), "pitching: {x}");
    assert!((142..=147).contains(&y), "rolling: {y}");
}

#[test]
fn flow_comes_every_ten_to_eleven_milliseconds() {
    let readings = run(&SensorModel::default(), 5, &hover(), 10_000);
    let intervals: Vec<f32> = readings
        .iter()
        .filter_map(|r| r.flow)
        .map(|f| f.dt_s)
        .collect();
    assert!(
        (920..=980).contains(&intervals.len()),
        "{}",
        intervals.len()
    );
    assert!(intervals.iter().all(|dt| (0.0099..0.0111).contains(dt)));
}

#[test]
fn flow_is_dropped_from_a_hundred_counts_on_either_axis_or_too_low() {
    // 10 or 11 ms at 0.5 m: 9.0 m/s are 88 to 97 counts, 10.5 m/s 103 and more.
    let moving = |x, y| MotionTruth {
        velocity_m_s: Vector3::new(x, y, 0.0),
        ..hover()
    };
    let low = MotionTruth {
        position_m: Vector3::new(0.0, 0.0, 0.02),
        ..hover()
    };
    for (truth, dropped) in [
        (moving(9.0, -9.0), false),
        (moving(10.5, 0.0), true),
        (moving(0.0, -10.5), true),
        (low, true),
    ] {
        let readings = run(&SensorModel::ideal(), 3, &truth, 200);
        assert_eq!(
            readings.iter().all(|r| r.flow.is_none()),
            dropped,
            "{truth:?}"
        );
    }
}

#[test]
fn the_driver_states_two_counts_or_a_deviation_that_grows_with_the_shutter() {
    let stated = |stated_sd| {
        let model = SensorModel {
            flow: FlowModel {
                stated_sd,
                ..SensorModel::ideal().flow
            },
            ..SensorModel::ideal()
        };
        let readings = run(&model, 3, &hover(), 20);
        readings
            .iter()
            .find_map(|r| r.flow)
            .expect("a reading")
            .sd_counts
    };
    assert_eq!(stated(StatedSd::Fixed), 2.0);
    assert!((stated(StatedSd::Adaptive { shutter: 0 }) - 0.4335).abs() < 1e-6);
    assert!((stated(StatedSd::Adaptive { shutter: 2000 }) - 2.0303).abs() < 1e-4);
}

#[test]
fn flow_noise_adds_up_to_two_counts_per_reading() {
    // Truncation hides some noise in one reading, but its remainder is carried: over n readings the sum spreads by
    // 2 sqrt(n), here over 100 readings and 200 seeds.
    let model = SensorModel {
        flow: FlowModel {
            noise_counts: 2.0,
            ..SensorModel::ideal().flow
        },
        ..SensorModel::ideal()
    };
    let square = (0..200)
        .map(|seed| {
            let mut deck = FlowDeck::new(&model.flow, seed);
            let readings = std::iter::repeat_with(|| deck.tick(&hover())).flatten();
            let sum: i32 = readings.take(100).map(|r| i32::from(r.counts[0])).sum();
            f64::from(sum * sum)
        })
        .sum::<f64>()
        / 200.0;
    // Four standard errors of a variance over 200 draws: 40 %.
    assert!((square / 400.0 - 1.0).abs() < 0.4, "{square}");
}

#[test]
fn a_turned_deck_sees_forward_motion_sideways() {
    // With a deck turned by a, motion along x shows as -sin a along the deck's y.
    let model = SensorModel {
        flow: FlowModel {
            mounting_yaw_sd_rad: 0.2,
            ..SensorModel::ideal().flow
        },
        ..SensorModel::ideal()
    };
    let truth = MotionTruth {
        velocity_m_s: Vector3::new(0.5, 0.0, 0.0),
        ..hover()
    };
    let [x, y] = total_counts(&run(&model, 9, &truth, 10_000)).map(f64::from);
    assert!(y.abs() > 20.0, "this seed's deck is not turned enough: {y}");
    assert!((x * x + y * y).sqrt() > 0.99 * 4883.0);
}

#[test]
fn range_comes_every_thirty_milliseconds_in_whole_millimetres() {
    let readings = run(&SensorModel::default(), 5, &hover(), 3000);
    let ranges: Vec<f32> = readings
        .iter()
        .filter_map(|r| r.range)
        .map(|range| range.distance_m)
        .collect();
    assert_eq!(ranges.len(), 100);
    for range in ranges {
        let millimetres = f64::from(range) * 1000.0;
        assert!((millimetres - millimetres.round()).abs() < 1e-3);
        assert!((range - 0.5).abs() < 0.06);
    }
}

#[test]
fn range_states_the_drivers_deviation_and_ends_at_five_metres() {
    let at = |height: f64| {
        let truth = MotionTruth {
            position_m: Vector3::new(0.0, 0.0, height),
            ..hover()
        };
        let mut sensor = RangeSensor::new(
            &RangeModel {
                noise_m: 0.0,
                offset_sd_m: 0.0,
            },
            1,
        );
        (0..30).find_map(|_| sensor.tick(&truth))
    };
    for (height, sd_m, tolerance) in [
        (0.5, 0.002_51, 1e-5),
        (2.0, 0.003_1, 5e-5),
        (2.5, 0.005, 1e-6),
        (4.0, 0.202_5, 1e-4),
    ] {
        let reading = at(height).expect("the ground is in range");
        assert!((reading.sd_m - sd_m).abs() < tolerance, "at {height} m");
    }
    assert_eq!(at(5.1), None);
}

#[test]
fn a_tilt_lengthens_the_range_only_beyond_the_cone() {
    for (tilt_deg, expected) in [(5.0_f64, 0.5), (27.5, 0.5 / 20_f64.to_radians().cos())] {
        let truth = MotionTruth {
            attitude: UnitQuaternion::from_euler_angles(tilt_deg.to_radians(), 0.0, 0.0),
            ..hover()
        };
        let readings = run(&SensorModel::ideal(), 1, &truth, 30);
        let range = readings[29].range.expect("a reading after 30 ms");
        assert!((f64::from(range.distance_m) - expected).abs() <= 0.0005);
    }
}

#[test]
fn a_seed_repeats_every_bit_and_another_differs() {
    let model = SensorModel::default();
    let first = run(&model, 11, &hover(), 500);
    assert_eq!(first, run(&model, 11, &hover(), 500));
    assert_ne!(first, run(&model, 12, &hover(), 500));
}

#[test]
fn noise_of_one_sensor_does_not_depend_on_another() {
    let silent_imu = SensorModel {
        imu: SensorModel::ideal().imu,
        ..SensorModel::default()
    };
    let flows = |model| -> Vec<_> {
        run(model, 11, &hover(), 500)
            .into_iter()
            .map(|r| (r.flow, r.range))
            .collect()
    };
    assert_eq!(flows(&silent_imu), flows(&SensorModel::default()));
}
