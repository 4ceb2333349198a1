//! The horizon: one luma value for each of 128 bearings.

use core::f32::consts::TAU;

/// Bearings round the horizon; 2.8 degrees apart.
pub const BEARINGS: usize = 128;
/// The angle between two neighbouring bearings, radians.
pub const BEARING_STEP_RAD: f32 = TAU / BEARINGS as f32;

/// The vertical mean of the panorama: luma 0..=255 at bearing 2πn / 128, counter-clockwise from
/// north.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    luma: [f32; BEARINGS],
    residual_rad: f32,
}

impl Horizon {
    /// A horizon from its values. `residual_rad` is what is left of the turn to north: the viewer of
    /// these values still looks that much too far counter-clockwise.
    pub const fn new(luma: [f32; BEARINGS], residual_rad: f32) -> Self {
        Self { luma, residual_rad }
    }

    /// Luma by bearing.
    pub const fn luma(&self) -> &[f32; BEARINGS] {
        &self.luma
    }

    /// What is left of the turn to north, radians; at most half a bearing step for a panorama.
    pub const fn residual_rad(&self) -> f32 {
        self.residual_rad
    }
}
