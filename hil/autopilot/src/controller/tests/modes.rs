//! Claims about set-points that change their mode.

use nalgebra::Vector3;

use super::{STILL, hold, level};
use crate::controller::{Controller, ControllerParameters, MotorCommands, SetPoint};

fn go_to(x: f32, y: f32, z: f32) -> SetPoint {
    SetPoint::GoTo {
        position_m: Vector3::new(x, y, z),
    }
}

/// A controller whose integrals a second half a metre too low has wound up, and what it asks for then.
fn wound_up(set_point: &SetPoint) -> (Controller, MotorCommands) {
    let mut controller = Controller::new(&ControllerParameters::default());
    let motors = (0..1000).fold(MotorCommands::STOPPED, |_, now_ms| {
        controller.tick(now_ms, &level(), &STILL, set_point)
    });
    (controller, motors)
}

fn fresh(set_point: &SetPoint) -> MotorCommands {
    Controller::new(&ControllerParameters::default()).tick(0, &level(), &STILL, set_point)
}

#[test]
fn motors_off_stops_them_and_forgets_the_integrals() {
    let mut controller = Controller::new(&ControllerParameters::default());
    let below = hold(0.0, 0.0, 1.0, 0.0);
    for now_ms in 0..1000 {
        controller.tick(now_ms, &level(), &STILL, &below);
    }
    let wound_up = controller.tick(1000, &level(), &STILL, &below);
    assert_eq!(
        controller.tick(1001, &level(), &STILL, &SetPoint::MotorsOff),
        MotorCommands::STOPPED
    );
    let fresh = controller.tick(1010, &level(), &STILL, &below);
    assert!(fresh.largest() < wound_up.largest());
}

#[test]
fn a_changed_mode_empties_the_integrals_and_a_changed_value_does_not() {
    let below = hold(0.0, 0.0, 1.0, 0.0);
    let (mut changed, before) = wound_up(&below);
    let mut unchanged = changed.clone();
    assert!(before.largest() > fresh(&below).largest() + 3000);
    let afresh = changed.tick(1000, &level(), &STILL, &go_to(0.0, 0.0, 1.0));
    assert_eq!(afresh, fresh(&below));
    let lower = hold(0.0, 0.0, 0.99, 0.0);
    let on = unchanged.tick(1000, &level(), &STILL, &lower);
    assert!(on.largest() > fresh(&lower).largest() + 3000);
}

#[test]
fn thrust_stays_and_the_tilt_is_kept_between_a_changed_mode_and_the_next_position_loop() {
    let below = hold(0.02, 0.0, 0.55, 0.0);
    let (mut controller, before) = wound_up(&below);
    let mean = |motors: MotorCommands| motors.0.map(u32::from).iter().sum::<u32>() / 4;
    let after = controller.tick(1002, &level(), &STILL, &go_to(0.02, 0.0, 0.55));
    // Level is what the drone is: no torque, all motors at the thrust asked for before.
    assert_eq!(after.0, [after.0[0]; 4]);
    assert!(mean(after).abs_diff(mean(before)) <= 1);
}

#[test]
fn a_set_point_without_a_heading_keeps_the_last_one() {
    let (mut controller, _) = wound_up(&hold(0.0, 0.0, 0.5, 0.5));
    let [m1, m2, m3, m4] = controller
        .tick(1000, &level(), &STILL, &go_to(0.0, 0.0, 0.5))
        .0;
    assert_eq!([m1, m2], [m3, m4]);
    // As the first answer to a heading half a radian to the left.
    assert_eq!([m1, m2, m3, m4], fresh(&hold(0.0, 0.0, 0.5, 0.5)).0);
}
