//! What a homing correction does to the estimate in flight.

use autopilot::ekf::{Measurement, Position, YawError};
use fake_sensors::motion::SensorModel;
use hil::drift::OpenLoop;
use nalgebra::Vector3;

/// What one homing correction did to the estimate: the shares of position and yaw that were taken, and the sudden
/// change of the velocity in the world, m/s.
struct Taken {
    position: f32,
    yaw: f32,
    kick_m_s: f32,
}

/// Sends a correction by (+0.20, -0.10) m and 0.10 rad and lets the filter take it.
fn correct(flight: &mut OpenLoop, sd_m: f32, sd_rad: f32) -> Taken {
    let shift = Vector3::new(0.2, -0.1, 0.0);
    let before = flight.ekf.estimate();
    let fix = Position {
        position_m: before.position_m + shift,
        sd_m,
    };
    let turn = YawError {
        error_rad: 0.1,
        sd_rad,
    };
    for measurement in [Measurement::Position(fix), Measurement::YawError(turn)] {
        flight.ekf.enqueue(measurement).expect("room for six");
    }
    flight.step();
    let after = flight.ekf.estimate();
    let moved = after.position_m - before.position_m;
    Taken {
        position: moved.dot(&shift) / shift.norm_squared(),
        yaw: (before.yaw_rad() - after.yaw_rad()) / 0.1,
        kick_m_s: (after.velocity_m_s - before.velocity_m_s).norm(),
    }
}

/// The first correction 4 s into the leg, the second `gap_ms` later.
fn correct_twice(sd_m: f32, sd_rad: f32, gap_ms: u64) -> [Taken; 2] {
    const FIRST_MS: u64 = 10_005;
    let mut flight = OpenLoop::new(&SensorModel::default(), 1);
    flight.run_until(FIRST_MS);
    let first = correct(&mut flight, sd_m, sd_rad);
    flight.run_until(FIRST_MS + gap_ms);
    [first, correct(&mut flight, sd_m, sd_rad)]
}

#[test]
fn hard_corrections_are_taken_whole_unless_they_follow_at_once() {
    // As measured on the firmware's filter: yaw 98 % at first and 5 s later, 78 % after 1 s; two within 0.1 s kick
    // the velocity by more than 1 m/s.
    let [first, later] = correct_twice(0.001, 0.002, 5000);
    for taken in [first, later] {
        assert!((taken.position - 1.0).abs() < 0.01, "{}", taken.position);
        assert!((taken.yaw - 0.98).abs() < 0.01, "{}", taken.yaw);
        assert!(taken.kick_m_s < 0.1, "{}", taken.kick_m_s);
    }
    let [_, soon] = correct_twice(0.001, 0.002, 1000);
    assert!((soon.yaw - 0.78).abs() < 0.05, "{}", soon.yaw);
    assert!((soon.kick_m_s - 0.31).abs() < 0.1, "{}", soon.kick_m_s);
    let [_, at_once] = correct_twice(0.001, 0.002, 100);
    assert!(at_once.position < 0.95, "{}", at_once.position);
    assert!((at_once.yaw - 0.56).abs() < 0.05, "{}", at_once.yaw);
    assert!(at_once.kick_m_s > 1.0, "{}", at_once.kick_m_s);
}

#[test]
fn soft_corrections_average_and_hardly_touch_the_heading() {
    // As measured on the firmware's filter: the first whole, the next by about a half, yaw by a few per cent.
    for (sd_m, sd_rad) in [(0.1, 0.2), (0.5, 0.17)] {
        let [first, later] = correct_twice(sd_m, sd_rad, 5000);
        assert!(first.position > 0.99, "{}", first.position);
        assert!((later.position - 0.52).abs() < 0.05, "{}", later.position);
        assert!(first.yaw < 0.02 && later.yaw < 0.05);
        assert!(first.kick_m_s < 0.01 && later.kick_m_s < 0.01);
    }
}
