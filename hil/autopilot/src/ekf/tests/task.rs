//! The 1 ms pass: order, queue, gaps, resets.

use nalgebra::Vector3;

use super::{AT_REST, rest};
use crate::ekf::{
    AbsoluteHeight, Ekf, Flow, ImuSample, Measurement, Parameters, Position, QUEUE_LENGTH,
    QueueFull, Range, YawError,
};

fn fix(x: f32, sd_m: f32) -> Measurement {
    Measurement::Position(Position {
        position_m: Vector3::new(x, 0.0, 0.0),
        sd_m,
    })
}

#[test]
fn the_queue_takes_twenty_measurements_and_loses_the_next() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    for _ in 0..QUEUE_LENGTH / 2 {
        for measurement in AT_REST.measurements() {
            assert_eq!(ekf.enqueue(measurement), Ok(()));
        }
    }
    assert_eq!(QUEUE_LENGTH, 20);
    assert_eq!(ekf.enqueue(fix(1.0, 0.1)), Err(QueueFull));
    ekf.tick(0, false);
    assert_eq!(
        ekf.enqueue(fix(1.0, 0.1)),
        Ok(()),
        "a tick empties the queue"
    );
}

#[test]
fn the_first_noise_step_cuts_the_position_variance_to_its_bound() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    ekf.tick(0, false);
    let variances = ekf.estimate().variances;
    assert_eq!((variances[0], variances[1]), (100.0, 100.0));
    assert!((variances[2] - 1.0).abs() < 1e-6);
}

#[test]
fn an_imu_sample_acts_at_the_next_prediction() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    let pushed = ImuSample {
        acc_g: Vector3::new(0.1, 0.0, 1.0),
        ..AT_REST
    };
    for now_ms in 0..10 {
        for measurement in pushed.measurements() {
            ekf.enqueue(measurement).expect("an empty queue");
        }
        ekf.tick(now_ms, false);
        assert_eq!(
            ekf.estimate().velocity_m_s,
            Vector3::zeros(),
            "tick {now_ms}"
        );
    }
    ekf.tick(10, false);
    let gained = ekf.estimate().velocity_m_s.x;
    assert!((gained - 0.1 * 9.81 * 0.01).abs() < 1e-6);
}

#[test]
fn a_gap_in_the_imu_repeats_the_last_average() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    let pushed = ImuSample {
        acc_g: Vector3::new(0.1, 0.0, 1.0),
        ..AT_REST
    };
    for measurement in pushed.measurements() {
        ekf.enqueue(measurement).expect("an empty queue");
    }
    for now_ms in 0..=30 {
        ekf.tick(now_ms, false);
    }
    let gained = ekf.estimate().velocity_m_s.x;
    assert!((gained - 0.1 * 9.81 * 0.03).abs() < 1e-5, "{gained}");
}

#[test]
fn without_flow_and_range_a_hover_stays_put_and_grows_unsure() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    rest(&mut ekf, 0, 1000, true);
    let flow = Measurement::Flow(Flow {
        counts: [0.0, 0.0],
        dt_s: 0.01,
        sd_counts: 2.0,
    });
    let range = Measurement::Range(Range {
        distance_m: 0.5,
        sd_m: 0.0025,
    });
    for now_ms in 1000..1200 {
        if now_ms % 10 == 0 {
            ekf.enqueue(range).expect("room");
            ekf.enqueue(flow).expect("room");
        }
        rest(&mut ekf, now_ms, 1, true);
    }
    let before = ekf.estimate();
    rest(&mut ekf, 1200, 1000, true);
    let after = ekf.estimate();
    assert!((before.position_m.z - 0.5).abs() < 0.01);
    assert!((after.position_m - before.position_m).norm() < 0.02);
    assert!(after.variances[3] > before.variances[3] + 2e-4);
    assert!(after.variances[2] > before.variances[2]);
}

#[test]
fn a_hard_fix_and_yaw_error_are_taken_whole_after_a_reset() {
    // First fix since the reset with sd 0.001 m and 0.002 rad: position 100 %, yaw 98 %.
    let mut ekf = Ekf::new(Parameters::default(), 0);
    rest(&mut ekf, 0, 500, true);
    ekf.enqueue(fix(0.2, 0.001)).expect("room");
    let error = YawError {
        error_rad: 0.1,
        sd_rad: 0.002,
    };
    ekf.enqueue(Measurement::YawError(error)).expect("room");
    rest(&mut ekf, 500, 1, true);
    let estimate = ekf.estimate();
    assert!((estimate.position_m.x - 0.2).abs() < 1e-4);
    let share = -estimate.yaw_rad() / 0.1;
    assert!((0.955..0.985).contains(&share), "yaw taken by {share}");
}

#[test]
fn an_absolute_height_reaches_the_state_through_the_queue() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    let height = AbsoluteHeight {
        height_m: 0.7,
        sd_m: 0.001,
    };
    ekf.enqueue(Measurement::AbsoluteHeight(height))
        .expect("room");
    ekf.tick(0, false);
    assert!((ekf.estimate().position_m.z - 0.7).abs() < 1e-4);
}

#[test]
fn the_supervisor_resets_the_filter_one_tick_after_it_leaves_its_bounds() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    ekf.enqueue(fix(100.5, 0.001)).expect("room");
    ekf.tick(0, true);
    assert!(ekf.estimate().position_m.x > 100.0);
    assert_eq!(ekf.resets(), 0);
    ekf.tick(1, true);
    assert_eq!(ekf.estimate().position_m, Vector3::zeros());
    assert_eq!(ekf.resets(), 1);
    ekf.tick(2, true);
    assert_eq!(ekf.resets(), 1);
}

#[test]
fn a_supervisor_with_wider_bounds_leaves_the_filter_alone() {
    let parameters = Parameters {
        max_position_m: 500.0,
        ..Parameters::default()
    };
    for (place_m, resets) in [(499.5, 0), (500.5, 1)] {
        let mut ekf = Ekf::new(parameters, 0);
        ekf.enqueue(fix(place_m, 0.001)).expect("room");
        ekf.tick(0, true);
        ekf.tick(1, true);
        assert_eq!(ekf.resets(), resets, "{place_m} m");
    }
}

#[test]
fn a_velocity_beyond_ten_metres_per_second_resets_the_filter() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    let shoved = ImuSample {
        acc_g: Vector3::new(0.0, 0.0, 20.0),
        ..AT_REST
    };
    let mut fastest = 0.0_f32;
    for now_ms in 0..100 {
        for measurement in shoved.measurements() {
            ekf.enqueue(measurement).expect("an empty queue");
        }
        ekf.tick(now_ms, true);
        fastest = fastest.max(ekf.estimate().velocity_m_s.z);
    }
    assert!(fastest > 10.0 && fastest < 12.0, "{fastest}");
    assert_eq!(ekf.resets(), 1);
}

#[test]
fn a_reset_faces_the_initial_yaw() {
    let parameters = Parameters {
        initial_yaw_rad: 0.5,
        ..Parameters::default()
    };
    let mut ekf = Ekf::new(parameters, 0);
    let turn = YawError {
        error_rad: 0.3,
        sd_rad: 0.001,
    };
    ekf.enqueue(Measurement::YawError(turn)).expect("room");
    rest(&mut ekf, 0, 5, false);
    assert!(ekf.estimate().yaw_rad() < 0.25);
    ekf.request_reset();
    rest(&mut ekf, 5, 2000, false);
    assert_eq!(ekf.resets(), 1);
    assert!((ekf.estimate().yaw_rad() - 0.5).abs() < 1e-5);
}

#[test]
fn a_reset_between_predictions_forgets_the_averages_and_shortens_the_next_step() {
    let mut ekf = Ekf::new(Parameters::default(), 0);
    let pushed = ImuSample {
        acc_g: Vector3::new(0.1, 0.0, 1.0),
        ..AT_REST
    };
    let push = |ekf: &mut Ekf, now_ms| {
        for measurement in pushed.measurements() {
            ekf.enqueue(measurement).expect("an empty queue");
        }
        ekf.tick(now_ms, false);
    };
    for now_ms in 0..14 {
        push(&mut ekf, now_ms);
    }
    ekf.request_reset();
    for now_ms in 14..20 {
        push(&mut ekf, now_ms);
    }
    ekf.tick(20, false);
    let gained = ekf.estimate().velocity_m_s.x;
    assert!((gained - 0.1 * 9.81 * 0.006).abs() < 1e-6, "{gained}");
}

#[test]
fn on_the_ground_an_accelerometer_offset_runs_away_for_want_of_flow() {
    // 20 and 30 mg for 2 s: 0.71 m/s and 0.71 m off, although nothing moves. In flight the same offset does nothing.
    let offset = ImuSample {
        acc_g: Vector3::new(0.02, -0.03, 1.0),
        ..AT_REST
    };
    let [on_the_ground, in_flight] = [false, true].map(|flying| {
        let mut ekf = Ekf::new(Parameters::default(), 0);
        for now_ms in 0..=2010 {
            for measurement in offset.measurements() {
                ekf.enqueue(measurement).expect("an empty queue");
            }
            ekf.tick(now_ms, flying);
        }
        ekf.estimate()
    });
    let acceleration = Vector3::new(0.02, -0.03, 0.0) * 9.81;
    assert!((on_the_ground.velocity_m_s - acceleration * 2.0).norm() < 0.01);
    assert!((on_the_ground.position_m - acceleration * 2.0).norm() < 0.01);
    assert!(in_flight.velocity_m_s.norm() < 1e-5);
}
