//! Attitude and rate loops.

use nalgebra::Vector3;

use super::pid::Pid;
use super::{ATTITUDE_PERIOD_MS, Axes, Command, ControllerParameters};
use crate::ekf::LegacyEuler;

/// Torques about the three axes, in command counts, saturated like the firmware's 16-bit integers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Torque {
    /// Left side up.
    pub roll: f32,
    /// Nose up.
    pub pitch: f32,
    /// Counter-clockwise.
    pub yaw: f32,
}

/// The two inner loops.
#[derive(Debug, Clone)]
pub struct AttitudeController {
    attitude: [Pid; 3],
    rate: [Pid; 3],
}

impl AttitudeController {
    pub fn new(parameters: &ControllerParameters) -> Self {
        let dt_s = ATTITUDE_PERIOD_MS as f32 * 0.001;
        let loops =
            |axes: &Axes| [axes.tilt, axes.tilt, axes.yaw].map(|gains| Pid::new(&gains, dt_s));
        let [roll, pitch, yaw] = loops(&parameters.attitude);
        Self {
            attitude: [roll, pitch, yaw.around_the_circle()],
            rate: loops(&parameters.rate),
        }
    }

    /// One step towards the commanded tilt and the heading `yaw_deg`.
    pub fn update(
        &mut self,
        command: &Command,
        yaw_deg: f32,
        angles: &LegacyEuler,
        gyro_deg_s: &Vector3<f32>,
    ) -> Torque {
        let wanted = [command.roll_deg, command.pitch_deg, yaw_deg];
        let here = [angles.roll_deg, angles.pitch_deg, angles.yaw_deg];
        // Nose up is a negative rotation about the y axis.
        let turning = [gyro_deg_s.x, -gyro_deg_s.y, gyro_deg_s.z];
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis| {
            let rate = self.attitude[axis].update(wanted[axis], here[axis]);
            let torque = self.rate[axis].update(rate, turning[axis]);
            // Symmetric: the firmware negates them as 16-bit integers.
            torque.clamp(-f32::from(i16::MAX), f32::from(i16::MAX))
        });
        Torque { roll, pitch, yaw }
    }
}
