//! Distance to the ground (`mm_tof`).

use crate::ekf::parameters::RangeParameters;
use crate::ekf::state::{POSITION, State};
use crate::ekf::update::Sensitivity;

/// Distance to the ground along the body's downward axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Distance, m.
    pub distance_m: f32,
    /// Standard deviation, m.
    pub sd_m: f32,
}

impl Range {
    /// One update of the height; ignored near and beyond a tilt of 90°.
    pub(in crate::ekf) fn correct(&self, state: &mut State, geometry: &RangeParameters) {
        let cos_tilt = state.rotation[(2, 2)];
        if cos_tilt <= geometry.min_cos_tilt {
            return;
        }
        // Rounding can lift the cosine above one, where the arc cosine is no number.
        let beyond_cone = (libm::acosf(cos_tilt.min(1.0)) - geometry.half_cone_rad).max(0.0);
        let slope = 1.0 / libm::cosf(beyond_cone);
        let row = [Sensitivity {
            state: POSITION + 2,
            slope,
        }];
        let innovation = self.distance_m - state.position.z * slope;
        state.scalar_update(&row, innovation, self.sd_m);
    }
}
