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
    /// Hold a position and a heading, as the high-level commander asks. Take-off and landing move the height of this
    /// set-point.
    Hold {
        /// Position in the world, m.
        position_m: Vector3<f32>,
        /// Heading, rad, counter-clockwise.
        yaw_rad: f32,
    },
    /// Hold a position and keep the heading held last: a low-level set-point whose yaw mode is "disable".
    GoTo {
        /// Position in the world, m.
        position_m: Vector3<f32>,
    },
}

impl SetPoint {
    /// Whether two set-points differ in a mode field, whatever their values.
    fn differs_in_mode(&self, other: &Self) -> bool {
        core::mem::discriminant(self) != core::mem::discriminant(other)
    }
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
    set_point: SetPoint,
    /// Heading that a set-point without one keeps, degrees.
    yaw_deg: f32,
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
            set_point: SetPoint::MotorsOff,
            yaw_deg: 0.0,
            command: None,
            motors: MotorCommands::STOPPED,
        }
    }

    /// One millisecond: runs the loops that are due at `now_ms` and gives the motor commands that hold until the
    /// next. `gyro_deg_s` is the newest angular rate, body frame.
    pub fn tick(
        &mut self,
        now_ms: u64,
        estimate: &Estimate,
        gyro_deg_s: &Vector3<f32>,
        set_point: &SetPoint,
    ) -> MotorCommands {
        if set_point.differs_in_mode(&self.set_point) {
            self.start_afresh(estimate);
        }
        self.set_point = *set_point;
        let position_m = match set_point {
            SetPoint::MotorsOff => {
                self.command = None;
                self.motors = MotorCommands::STOPPED;
                return self.motors;
            }
            SetPoint::Hold {
                position_m,
                yaw_rad,
            } => {
                self.yaw_deg = yaw_rad.to_degrees();
                position_m
            }
            SetPoint::GoTo { position_m } => position_m,
        };
        if now_ms.is_multiple_of(POSITION_PERIOD_MS) {
            self.command = Some(self.position.update(estimate, position_m));
        }
        if let Some(command) = self.command
            && now_ms.is_multiple_of(ATTITUDE_PERIOD_MS)
        {
            let angles = estimate.legacy_euler();
            let torque = self
                .attitude
                .update(&command, self.yaw_deg, &angles, gyro_deg_s);
            self.motors = mixer::mix(command.thrust, &torque);
        }
        self.motors
    }

    /// Empties every loop's memory, as the firmware does when a mode field of the set-point changes: the tilt that is
    /// flown becomes the tilt asked for until the position loop runs; thrust and heading stay.
    fn start_afresh(&mut self, estimate: &Estimate) {
        self.position = PositionController::new(&self.parameters);
        self.attitude = AttitudeController::new(&self.parameters);
        if let Some(command) = &mut self.command {
            let angles = estimate.legacy_euler();
            command.roll_deg = angles.roll_deg;
            command.pitch_deg = angles.pitch_deg;
        }
    }
}
