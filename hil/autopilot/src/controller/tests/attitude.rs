//! Claims about the attitude and rate loops.

use nalgebra::Vector3;

use crate::controller::attitude::{AttitudeController, Torque};
use crate::controller::{Command, ControllerParameters};
use crate::ekf::LegacyEuler;

/// Period of both loops, s.
const DT_S: f32 = 0.002;

const LEVEL: LegacyEuler = LegacyEuler {
    roll_deg: 0.0,
    pitch_deg: 0.0,
    yaw_deg: 0.0,
};

fn lean(roll_deg: f32, pitch_deg: f32) -> Command {
    Command {
        roll_deg,
        pitch_deg,
        thrust: 30_000.0,
    }
}

fn loops() -> AttitudeController {
    AttitudeController::new(&ControllerParameters::default())
}

/// The last answer of as many steps under the same conditions.
fn after(steps: usize, command: &Command, yaw_deg: f32, gyro_deg_s: &Vector3<f32>) -> Torque {
    let mut loops = loops();
    for _ in 1..steps {
        loops.update(command, yaw_deg, &LEVEL, gyro_deg_s);
    }
    loops.update(command, yaw_deg, &LEVEL, gyro_deg_s)
}

fn assert_close(found: f32, expected: f32, tolerance: f32) {
    assert!(
        (found - expected).abs() < tolerance,
        "{found} against {expected}"
    );
}

#[test]
fn a_degree_of_tilt_asks_for_six_degrees_a_second() {
    let rate = 6.0 + 3.0 * DT_S;
    let torque = 200.0 * rate + 400.0 * rate * DT_S;
    let rolled = after(1, &lean(1.0, 0.0), 0.0, &Vector3::zeros());
    assert_close(rolled.roll, torque, 0.01);
    let pitched = after(1, &lean(0.0, 1.0), 0.0, &Vector3::zeros());
    assert_close(pitched.pitch, torque, 0.01);
    assert_eq!((rolled.pitch, rolled.yaw, pitched.roll), (0.0, 0.0, 0.0));
}

#[test]
fn a_degree_of_heading_asks_for_six_degrees_a_second_more_gently() {
    let rate = 6.0 + 1.0 * DT_S;
    let torque = 120.0 * rate + 16.7 * rate * DT_S;
    let turned = after(1, &lean(0.0, 0.0), 1.0, &Vector3::zeros());
    assert_close(turned.yaw, torque, 0.01);
}

#[test]
fn tilt_integrals_stop_at_their_limits() {
    // Ten degrees for long: 20 deg s of it count, which makes 6 * 10 + 3 * 20 = 120 deg/s. Turning at that rate all
    // the while has been 60 deg too much, of which 33.3 count.
    for (command, gyro) in [
        (lean(10.0, 0.0), Vector3::new(120.0, 0.0, 0.0)),
        (lean(0.0, 10.0), Vector3::new(0.0, -120.0, 0.0)),
    ] {
        let torque = after(2500, &command, 0.0, &gyro);
        assert_close(torque.roll + torque.pitch, -400.0 * 33.3, 1.0);
    }
}

#[test]
fn heading_integrals_stop_at_their_limits() {
    // 360 deg s make 6 * 10 + 1 * 360 = 420 deg/s; 166.7 deg of the excess count.
    let torque = after(
        20_000,
        &lean(0.0, 0.0),
        10.0,
        &Vector3::new(0.0, 0.0, 420.0),
    );
    assert_close(torque.yaw, -16.7 * 166.7, 1.0);
}

#[test]
fn a_growing_rate_is_resisted_by_its_derivative() {
    // 100 deg/s² for 0.2 s about each axis: 200 of the rate, 400 of its integral, 2.5 of its slope; 120, 16.7 and
    // none about the vertical. Nose up is negative about y.
    let mut loops = loops();
    let steps = 101_u16;
    let torque = (0..steps).fold(None, |_, step| {
        let rate = 100.0 * DT_S * f32::from(step);
        let gyro = Vector3::new(rate, -rate, rate);
        Some(loops.update(&lean(0.0, 0.0), 0.0, &LEVEL, &gyro))
    });
    let torque = torque.expect("many steps");
    let integral = 100.0 * DT_S * DT_S * (100.0 * 101.0 / 2.0);
    let tilt = -(200.0 * 20.0 + 400.0 * integral + 2.5 * 100.0);
    assert_close(torque.roll, tilt, 1.0);
    assert_close(torque.pitch, tilt, 1.0);
    assert_close(torque.yaw, -(120.0 * 20.0 + 16.7 * integral), 1.0);
}

#[test]
fn a_turning_body_is_slowed_by_the_derivative_of_its_heading() {
    // The heading is met at every step, so of the attitude loop only 0.35 of 10 deg/s is left. For 0.2 s nothing turns:
    // 120 of the rate that is asked for, and 16.7 of its integral. Once it is flown, the integral is left.
    let mut loops = loops();
    let mut turn = |step: u16, rate_deg_s| {
        let yaw_deg = 10.0 * DT_S * f32::from(step);
        let angles = LegacyEuler { yaw_deg, ..LEVEL };
        let gyro = Vector3::new(0.0, 0.0, rate_deg_s);
        loops.update(&lean(0.0, 0.0), yaw_deg, &angles, &gyro).yaw
    };
    let still = (0..100).fold(0.0, |_, step| turn(step, 0.0));
    let turning = turn(100, -3.5);
    let integral = 16.7 * 3.5 * 0.2;
    assert_close(still, -120.0 * 3.5 - integral, 2.0);
    assert_close(turning, -integral, 2.0);
}

#[test]
fn headings_are_reached_the_short_way_and_turn_on_over_the_seam() {
    let mut loops = loops();
    let behind_left = LegacyEuler {
        yaw_deg: 170.0,
        ..LEVEL
    };
    let torque = loops.update(&lean(0.0, 0.0), -170.0, &behind_left, &Vector3::zeros());
    let rate = 20.0 * (6.0 + DT_S);
    assert_close(torque.yaw, 120.0 * rate + 16.7 * rate * DT_S, 0.1);
    // A body that turns across the seam has not jumped by a whole turn.
    let behind_right = LegacyEuler {
        yaw_deg: -179.98,
        ..LEVEL
    };
    let seam = LegacyEuler {
        yaw_deg: 180.0,
        ..LEVEL
    };
    let mut turning = self::loops();
    turning.update(&lean(0.0, 0.0), 180.0, &seam, &Vector3::zeros());
    let torque = turning.update(&lean(0.0, 0.0), -179.98, &behind_right, &Vector3::zeros());
    assert!(
        torque.yaw.abs() < 120.0 * 0.35 * 10.0 + 1.0,
        "{}",
        torque.yaw
    );
}

#[test]
fn torques_fit_sixteen_bits() {
    let torque = after(1, &lean(170.0, -170.0), 170.0, &Vector3::zeros());
    assert_eq!(torque.roll, 32_767.0);
    assert_eq!(torque.pitch, -32_767.0);
    assert_eq!(torque.yaw, 32_767.0);
}
