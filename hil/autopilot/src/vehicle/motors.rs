//! Four motors with a lag.

use nalgebra::Vector3;

use super::{STEP_S, VehicleParameters};
use crate::controller::MotorCommands;

/// The motors' thrusts, in the order of [`MotorCommands`].
#[derive(Debug, Clone)]
pub struct Motors {
    thrust_n: [f64; 4],
    newtons_per_count: f64,
    /// Share of the way to the commanded thrust covered in one step.
    approach: f64,
    offset_m: f64,
    torque_per_thrust_m: f64,
}

impl Motors {
    pub fn new(parameters: &VehicleParameters) -> Self {
        Self {
            thrust_n: [0.0; 4],
            newtons_per_count: parameters.full_thrust_n / f64::from(u16::MAX),
            approach: 1.0 - libm::exp(-STEP_S / parameters.motor_time_constant_s),
            offset_m: parameters.motor_offset_m,
            torque_per_thrust_m: parameters.torque_per_thrust_m,
        }
    }

    pub fn step(&mut self, commands: &MotorCommands) {
        for (thrust, command) in self.thrust_n.iter_mut().zip(commands.0) {
            *thrust += (f64::from(command) * self.newtons_per_count - *thrust) * self.approach;
        }
    }

    pub fn total_thrust_n(&self) -> f64 {
        self.thrust_n.iter().sum()
    }

    /// Torque on the body, body frame, N m.
    pub fn torque_nm(&self) -> Vector3<f64> {
        let [front_right, back_right, back_left, front_left] = self.thrust_n;
        Vector3::new(
            (back_left + front_left - front_right - back_right) * self.offset_m,
            (back_right + back_left - front_right - front_left) * self.offset_m,
            (back_right + front_left - front_right - back_left) * self.torque_per_thrust_m,
        )
    }
}
