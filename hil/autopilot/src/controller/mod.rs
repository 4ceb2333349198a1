//! The Crazyflie's cascade of PID controllers, from a position to four motor commands.
//!
//! position → velocity → tilt and thrust (100 Hz) → body rates → motor mix (500 Hz). Degrees and the legacy sign of
//! pitch inside, as in the firmware whose gains these are (crazyflie-firmware `position_controller_pid`,
//! `attitude_pid_controller`, `power_distribution_quadrotor`, `platform_defaults_cf21bl`).

mod attitude;
mod mixer;
mod parameters;
mod pid;
mod position;
#[cfg(test)]
mod tests;

pub use mixer::MotorCommands;
pub use parameters::{Axes, ControllerParameters, IDLE_THRUST, PidGains};

use nalgebra::Vector3;

use crate::ekf::Estimate;
use attitude::AttitudeController;
use position::PositionController;

/// What the drone shall do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SetPoint {
    /// Motors stand still.
    MotorsOff,
    /// Hold a position and a heading. Take-off and landing move the height of this set-point.
    Hold {
        /// Position in the world, m.
        position_m: Vector3<f32>,
        /// Heading, rad, counter-clockwise.
        yaw_rad: f32,
    },
}

/// Tilt and thrust asked for by the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Command {
    /// Roll, degrees, left side up.
    roll_deg: f32,
    /// Pitch, degrees, nose up.
    pitch_deg: f32,
    /// Mean motor command.
    thrust: f32,
}

/// Milliseconds between runs of the position and velocity loops.
const POSITION_PERIOD_MS: u64 = 10;
/// Milliseconds between runs of the attitude and rate loops.
const ATTITUDE_PERIOD_MS: u64 = 2;

/// The cascade with its memory.
#[derive(Debug, Clone)]
pub struct Controller {
    parameters: ControllerParameters,
    position: PositionController,
    attitude: AttitudeController,
    command: Option<Command>,
    motors: MotorCommands,
}

impl Controller {
    /// A controller with empty integrals and still motors.
    #[must_use]
    pub fn new(parameters: &ControllerParameters) -> Self {
        Self {
            parameters: *parameters,
            position: PositionController::new(parameters),
            attitude: AttitudeController::new(parameters),
            command: None,
            motors: MotorCommands::STOPPED,
        }
    }

    /// One millisecond: runs the loops that are due at `now_ms` and gives the motor commands that hold until the
    /// next. `gyro_deg_s` is the newest angular rate, body frame.
    ///
    /// Motors off clears every integral, as the firmware does when a set-point's mode changes.
    pub fn tick(
        &mut self,
        now_ms: u64,
        estimate: &Estimate,
        gyro_deg_s: &Vector3<f32>,
        set_point: &SetPoint,
    ) -> MotorCommands {
        let SetPoint::Hold {
            position_m,
            yaw_rad,
        } = set_point
        else {
            if self.command.is_some() {
                *self = Self::new(&self.parameters);
            }
            return self.motors;
        };
        if now_ms.is_multiple_of(POSITION_PERIOD_MS) {
            self.command = Some(self.position.update(estimate, position_m));
        }
        if let Some(command) = self.command
            && now_ms.is_multiple_of(ATTITUDE_PERIOD_MS)
        {
            let angles = estimate.legacy_euler();
            let yaw_deg = yaw_rad.to_degrees();
            let torque = self.attitude.update(&command, yaw_deg, &angles, gyro_deg_s);
            self.motors = mixer::mix(command.thrust, &torque);
        }
        self.motors
    }
}
