//! Position and attitude (`mm_pose`).

use nalgebra::{UnitQuaternion, Vector3};

use super::Position;
use crate::ekf::state::{ATTITUDE, State};
use crate::ekf::update::Sensitivity;

/// A fix of position and attitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position in the world, m.
    pub position_m: Vector3<f32>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f32>,
    /// Standard deviation of each coordinate, m. The radio localisation service sends 0.01.
    pub sd_position_m: f32,
    /// Standard deviation about each body axis, rad. The radio localisation service sends 4.5e-3.
    pub sd_attitude_rad: f32,
}

impl Pose {
    /// The position, then three updates of the attitude error.
    ///
    /// The residual is `2 vec(dq) / w(dq)` of `dq = q* ⊗ q_measured`, in the body frame of the reference attitude:
    /// attitude errors gathered earlier in the tick are not taken off.
    pub(in crate::ekf) fn correct(&self, state: &mut State) {
        Position {
            position_m: self.position_m,
            sd_m: self.sd_position_m,
        }
        .correct(state);

        let error = state.attitude.conjugate() * self.attitude;
        let residual = error.vector() * (2.0 / error.w);
        for axis in 0..3 {
            state.scalar_update(
                &[Sensitivity::direct(ATTITUDE + axis)],
                residual[axis],
                self.sd_attitude_rad,
            );
        }
    }
}
