//! Position in the world (`mm_position`).

use nalgebra::Vector3;

use crate::ekf::state::{POSITION, State};
use crate::ekf::update::Sensitivity;

/// A position fix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Position in the world, m.
    pub position_m: Vector3<f32>,
    /// Standard deviation of each coordinate, m.
    pub sd_m: f32,
}

impl Position {
    /// Three updates: x, y, z.
    pub(in crate::ekf) fn correct(&self, state: &mut State) {
        for axis in 0..3 {
            let innovation = self.position_m[axis] - state.position[axis];
            state.scalar_update(
                &[Sensitivity::direct(POSITION + axis)],
                innovation,
                self.sd_m,
            );
        }
    }
}
