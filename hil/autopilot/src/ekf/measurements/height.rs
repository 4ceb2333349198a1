//! Height above the origin (`mm_absolute_height`).

use crate::ekf::state::{POSITION, State};
use crate::ekf::update::Sensitivity;

/// A height above the origin, whatever the ground below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AbsoluteHeight {
    /// Height, m.
    pub height_m: f32,
    /// Standard deviation, m.
    pub sd_m: f32,
}

impl AbsoluteHeight {
    /// One update of the height.
    pub(in crate::ekf) fn correct(&self, state: &mut State) {
        let innovation = self.height_m - state.position.z;
        state.scalar_update(&[Sensitivity::direct(POSITION + 2)], innovation, self.sd_m);
    }
}
