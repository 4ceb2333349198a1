//! The horizon: one luma value for each of 128 bearings.

use core::f32::consts::TAU;

use crate::panorama::RADII;

/// Bearings round the horizon; 2.8 degrees apart.
pub const BEARINGS: usize = 128;
/// The angle between two neighbouring bearings, radians.
pub const BEARING_STEP_RAD: f32 = TAU / BEARINGS as f32;

/// Samples of a bearing. Their sum is exact; a horizon holds it as it is.
pub(crate) const SUMMED: usize = RADII;

/// The vertical mean of the panorama: luma 0..=255, in sixteenths, at bearing 2πn / 128,
/// counter-clockwise from north.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    /// Sums of sixteen samples.
    sums: [u16; BEARINGS],
    residual_rad: f32,
}

impl Horizon {
    /// A horizon from luma values, each rounded to the nearest sixteenth of 0..=255; NaN is black.
    /// `residual_rad` is what is left of the turn to north: the viewer of these values still looks that
    /// much too far counter-clockwise.
    pub fn new(luma: [f32; BEARINGS], residual_rad: f32) -> Self {
        // The cast makes zero of NaN.
        let sixteenths = |luma: f32| libm::roundf(luma.clamp(0.0, 255.0) * SUMMED as f32) as u16;
        Self::from_sums(luma.map(sixteenths), residual_rad)
    }

    /// A horizon from the sums of each bearing's sixteen samples.
    pub(crate) const fn from_sums(sums: [u16; BEARINGS], residual_rad: f32) -> Self {
        Self { sums, residual_rad }
    }

    /// Luma by bearing.
    pub fn luma(&self) -> [f32; BEARINGS] {
        self.sums.map(|sum| f32::from(sum) * (1.0 / SUMMED as f32))
    }

    /// Luma by bearing in sixteenths, at most 4,080.
    pub(crate) const fn sums(&self) -> &[u16; BEARINGS] {
        &self.sums
    }

    /// What is left of the turn to north, radians; at most half a bearing step for a panorama.
    pub const fn residual_rad(&self) -> f32 {
        self.residual_rad
    }
}
