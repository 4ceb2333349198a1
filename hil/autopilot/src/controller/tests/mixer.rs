//! Claims about the motor mix.

use crate::controller::attitude::Torque;
use crate::controller::mixer::mix;
use crate::controller::{IDLE_THRUST, MotorCommands};

#[test]
fn each_torque_goes_to_the_motors_that_make_it() {
    let torque = |roll, pitch, yaw| Torque { roll, pitch, yaw };
    // Half of roll and pitch on each side, all of yaw: front right, back right, back left, front left.
    for (torque, expected) in [
        (torque(2000.0, 0.0, 0.0), [29_000, 29_000, 31_000, 31_000]),
        (torque(0.0, 1000.0, 0.0), [30_500, 29_500, 29_500, 30_500]),
        (torque(0.0, 0.0, 300.0), [29_700, 30_300, 29_700, 30_300]),
        (
            torque(2000.0, 1000.0, 300.0),
            [29_200, 28_800, 30_200, 31_800],
        ),
    ] {
        assert_eq!(mix(30_000.0, &torque), MotorCommands(expected));
    }
}

#[test]
fn a_full_motor_makes_all_give_way_and_none_falls_below_idle() {
    let torque = Torque {
        roll: 30_000.0,
        pitch: 0.0,
        yaw: 0.0,
    };
    assert_eq!(
        mix(60_000.0, &torque),
        MotorCommands([35_535, 35_535, 65_535, 65_535])
    );
    assert_eq!(
        mix(20_000.0, &torque),
        MotorCommands([IDLE_THRUST, IDLE_THRUST, 35_000, 35_000])
    );
}
