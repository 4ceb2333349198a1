//! What the filter tells the rest of the autopilot.

use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::state::State;

/// The filter's estimate after a tick (`kalmanCoreExternalizeState`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Position in the world, m.
    pub position_m: Vector3<f32>,
    /// Velocity in the world, m/s.
    pub velocity_m_s: Vector3<f32>,
    /// Velocity in the body frame, m/s: the filter's own state.
    pub velocity_body_m_s: Vector3<f32>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f32>,
    /// Variances of position (m²), body velocity (m²/s²) and attitude about the body axes (rad²).
    pub variances: SVector<f32, 9>,
}

impl Estimate {
    pub(super) fn of(state: &State) -> Self {
        Self {
            position_m: state.position,
            velocity_m_s: state.rotation * state.velocity,
            velocity_body_m_s: state.velocity,
            attitude: state.attitude,
            variances: state.covariance.diagonal(),
        }
    }

    /// Heading, rad, counter-clockwise from the world's x axis, in (-π, π].
    #[must_use]
    pub fn yaw_rad(&self) -> f32 {
        let (w, x, y, z) = parts(&self.attitude);
        libm::atan2f(2.0 * (x * y + w * z), w * w + x * x - y * y - z * z)
    }

    /// The angles as the Crazyflie's controllers and logs state them.
    #[must_use]
    pub fn legacy_euler(&self) -> LegacyEuler {
        let (w, x, y, z) = parts(&self.attitude);
        let sin_pitch = (-2.0 * (x * z - w * y)).clamp(-1.0, 1.0);
        let roll = libm::atan2f(2.0 * (y * z + w * x), w * w - x * x - y * y + z * z);
        LegacyEuler {
            roll_deg: roll.to_degrees(),
            pitch_deg: -libm::asinf(sin_pitch).to_degrees(),
            yaw_deg: self.yaw_rad().to_degrees(),
        }
    }
}

/// Angles of the sequence yaw, pitch, roll, with the sign of pitch turned over: nose up is positive, as on the first
/// Crazyflies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegacyEuler {
    /// About the body's x axis, left side up, degrees.
    pub roll_deg: f32,
    /// Nose up, degrees: minus the angle about the y axis.
    pub pitch_deg: f32,
    /// About the z axis, counter-clockwise, degrees.
    pub yaw_deg: f32,
}

fn parts(q: &UnitQuaternion<f32>) -> (f32, f32, f32, f32) {
    (q.w, q.i, q.j, q.k)
}
