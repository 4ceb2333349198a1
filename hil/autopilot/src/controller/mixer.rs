//! Thrust and torque to four motors (`power_distribution_quadrotor`).

use super::IDLE_THRUST;
use super::attitude::Torque;

/// Commands of the four motors, 0 to 65535, as shares of full thrust: front right, back right, back left, front
/// left. Front right and back left push the body clockwise, the others counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotorCommands(pub [u16; 4]);

impl MotorCommands {
    /// All motors off.
    pub const STOPPED: Self = Self([0; 4]);

    /// The largest of the four.
    #[must_use]
    pub fn largest(&self) -> u16 {
        self.0.into_iter().fold(0, u16::max)
    }
}

/// Spreads thrust and torque. If a motor would have to exceed its maximum, all give way by the excess: attitude goes
/// before height. None falls below idle.
pub fn mix(thrust: f32, torque: &Torque) -> MotorCommands {
    let roll = 0.5 * torque.roll;
    let pitch = 0.5 * torque.pitch;
    let yaw = torque.yaw;
    let wanted = [
        thrust - roll + pitch - yaw,
        thrust - roll - pitch + yaw,
        thrust + roll - pitch - yaw,
        thrust + roll + pitch + yaw,
    ];
    let full = f32::from(u16::MAX);
    let excess = (wanted.into_iter().fold(0.0, f32::max) - full).max(0.0);
    MotorCommands(wanted.map(|w| (w - excess).clamp(f32::from(IDLE_THRUST), full) as u16))
}
