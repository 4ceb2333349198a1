//! Claims about the position and velocity loops.

use nalgebra::Vector3;

use super::level;
use crate::controller::position::PositionController;
use crate::controller::{Command, ControllerParameters};
use crate::ekf::Estimate;

fn at(position_m: Vector3<f32>, velocity_m_s: Vector3<f32>) -> Estimate {
    Estimate {
        position_m,
        velocity_m_s,
        ..level()
    }
}

fn loops() -> PositionController {
    PositionController::new(&ControllerParameters::default())
}

/// The first answer to an error of position and a velocity.
fn answer(error_m: Vector3<f32>, velocity_m_s: Vector3<f32>) -> Command {
    loops().update(&at(Vector3::zeros(), velocity_m_s), &error_m)
}

fn assert_close(found: f32, expected: f32) {
    assert!(
        (found - expected).abs() < 1e-4 * expected.abs().max(1.0),
        "{found} against {expected}"
    );
}

#[test]
fn ten_centimetres_ask_for_five_degrees() {
    // 2.0 /s makes 0.2 m/s, 25 deg per m/s makes 5 deg, the first 10 ms of the integral 0.002 deg.
    let error = 0.1;
    let tilt = 25.0 * 2.0 * error + 1.0 * 2.0 * error * 0.01;
    assert_close(
        answer(Vector3::x() * error, Vector3::zeros()).pitch_deg,
        -tilt,
    );
    assert_close(
        answer(Vector3::y() * error, Vector3::zeros()).roll_deg,
        -tilt,
    );
}

#[test]
fn a_drift_of_ten_centimetres_a_second_asks_for_two_and_a_half_degrees_against_it() {
    let tilt = 25.0 * 0.1 + 1.0 * 0.1 * 0.01;
    assert_close(answer(Vector3::zeros(), Vector3::x() * 0.1).pitch_deg, tilt);
    assert_close(answer(Vector3::zeros(), Vector3::y() * 0.1).roll_deg, tilt);
}

#[test]
fn far_targets_are_approached_at_the_speed_limit() {
    for direction in [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y()] {
        let cruising = answer(direction * 10.0, direction * 1.1);
        assert!(cruising.roll_deg.abs() < 1e-3 && cruising.pitch_deg.abs() < 1e-3);
        let slower = answer(direction * 10.0, direction);
        assert_close(
            slower.roll_deg.abs() + slower.pitch_deg.abs(),
            25.0 * 0.1 + 0.001,
        );
    }
    for direction in [Vector3::z(), -Vector3::z()] {
        assert_close(answer(direction * 10.0, direction * 1.1).thrust, 30_000.0);
    }
}

#[test]
fn no_more_than_twenty_degrees_are_asked_for() {
    // From rest the speed limit asks for 27.5; the loop's own limit of 22 and the 20 after it leave 20.
    let ahead = answer(Vector3::new(10.0, 10.0, 0.0), Vector3::zeros());
    assert_eq!((ahead.roll_deg, ahead.pitch_deg), (-20.0, -20.0));
    let behind = answer(Vector3::new(-10.0, -10.0, 0.0), Vector3::zeros());
    assert_eq!((behind.roll_deg, behind.pitch_deg), (20.0, 20.0));
}

#[test]
fn the_velocity_loop_integrates_a_degree_per_metre() {
    let mut loops = loops();
    let pushed = at(Vector3::zeros(), Vector3::x() * 0.2);
    let command = (0..500).fold(loops.update(&pushed, &Vector3::zeros()), |_, _| {
        loops.update(&pushed, &Vector3::zeros())
    });
    // 5.01 s at 0.2 m/s.
    assert_close(command.pitch_deg, 25.0 * 0.2 + 1.0 * 0.2 * 5.01);
}

#[test]
fn the_position_loop_integrates_height_alone() {
    let mut loops = loops();
    let error = 0.1;
    // As fast as the proportional parts ask for: what is asked for beyond comes from an integral.
    let approaching = at(Vector3::zeros(), Vector3::repeat(2.0 * error));
    let target = Vector3::repeat(error);
    let command = (0..200).fold(loops.update(&approaching, &target), |_, _| {
        loops.update(&approaching, &target)
    });
    assert!(command.roll_deg.abs() < 1e-3 && command.pitch_deg.abs() < 1e-3);
    // 201 steps: the integral has grown to 0.1 m times 2.01 s, its own sum of 1 + 2 + ... + 201 steps.
    let speed = |steps: f32| 0.5 * error * 0.01 * steps;
    let sum = 0.5 * error * 0.01 * 0.01 * (201.0 * 202.0 / 2.0);
    assert_close(
        command.thrust,
        30_000.0 + 1000.0 * (25.0 * speed(201.0) + 15.0 * sum),
    );
}

#[test]
fn a_clamped_output_does_not_stop_the_integral() {
    // Ten metres too low for four seconds: 0.5 times 40 m s outlasts the arrival for as long again.
    let mut loops = loops();
    let climbing = at(Vector3::zeros(), Vector3::z() * 1.1);
    for _ in 0..400 {
        loops.update(&climbing, &(Vector3::z() * 10.0));
    }
    let arrived = loops.update(&climbing, &Vector3::zeros());
    assert_close(arrived.thrust, 30_000.0);
}

#[test]
fn thrust_stays_between_its_least_and_its_greatest() {
    // A wish of 1.1 m/s down from rest takes 27.5 thousand off the base.
    assert_eq!(
        answer(Vector3::z() * -10.0, Vector3::zeros()).thrust,
        20_000.0
    );
    // The loop gives 32.767 thousand at most.
    let falling = answer(Vector3::z() * 10.0, Vector3::z() * -3.0);
    assert_close(falling.thrust, 30_000.0 + 32_767.0);
    // On a Crazyflie 2 with a base of 36000 that is more than there is.
    let crazyflie_2 = ControllerParameters {
        base_thrust: 36_000.0,
        ..ControllerParameters::default()
    };
    let falling = at(Vector3::zeros(), Vector3::z() * -3.0);
    let command = PositionController::new(&crazyflie_2).update(&falling, &(Vector3::z() * 10.0));
    assert_eq!(command.thrust, 65_535.0);
}
