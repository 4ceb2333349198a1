//! What must be known of a panoramic lens to read its ring-shaped image.
//!
//! The image of a panoramic lens is a ring: the angle round its centre is the bearing, the radius is
//! the elevation. The radius is taken as linear in elevation, as the lens maker's own dewarper does.

use core::f32::consts::FRAC_PI_2;
use core::fmt;

use crate::panorama::{FRAME_HEIGHT, FRAME_WIDTH};

/// Which way bearings (counter-clockwise from the nose, seen from above the drone) run in the image
/// as it is shown on a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BearingDirection {
    /// A growing bearing runs clockwise on the screen.
    Clockwise,
    /// A growing bearing runs counter-clockwise on the screen.
    CounterClockwise,
}

/// A lens on a 128 x 96 sensor. Measured once for each unit.
///
/// Image coordinates are continuous: pixel (column, row) covers [column, column + 1) x
/// [row, row + 1), x to the right, y down, so that the middle of a 128 x 96 frame is (64, 48). A body
/// bearing β at radius r lies at (centre.0 + r cos α, centre.1 + r sin α), where
/// α = zero_bearing_rad + β for [`BearingDirection::Clockwise`] and
/// α = zero_bearing_rad - β for [`BearingDirection::CounterClockwise`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensCalibration {
    /// The ring's centre (x, y), pixels. It matters most of all: an error of d pixels bends the
    /// bearings by about d / r, once round the circle.
    pub centre_px: (f32, f32),
    /// The ring's inner edge, pixels.
    pub inner_radius_px: f32,
    /// The ring's outer edge, pixels.
    pub outer_radius_px: f32,
    /// Where things at the height of the lens appear, pixels.
    pub horizon_radius_px: f32,
    /// Where the nose appears: radians from the right (x) towards the bottom (y) of the image, that
    /// is clockwise on the screen.
    pub zero_bearing_rad: f32,
    /// Which way bearings run on the screen.
    pub direction: BearingDirection,
    /// Whether the inner edge looks up: true for a solid one-piece optic over an upward camera
    /// (Kogeto Dot, GoPano), false for a plain convex mirror.
    pub inner_is_up: bool,
}

impl LensCalibration {
    /// A Kogeto Dot 360 in the middle of a 128 x 96 frame.
    ///
    /// The radii are inside the 0.41..0.53 that known units have as inner / outer ratio, and leave
    /// 5 px of mounting tolerance to the frame's edge; the mean circumference of 188 px carries 128
    /// bearings. The nose is at the top, bearings run clockwise: a camera that looks up into the
    /// mirror. A real unit needs its own values.
    pub const DEFAULT: Self = Self {
        centre_px: (64.0, 48.0),
        inner_radius_px: 18.0,
        outer_radius_px: 42.0,
        horizon_radius_px: 30.0,
        zero_bearing_rad: -FRAC_PI_2,
        direction: BearingDirection::Clockwise,
        inner_is_up: true,
    };

    /// Checks that the ring makes sense and lies inside the frame.
    ///
    /// # Errors
    ///
    /// The first [`CalibrationError`] that applies.
    pub fn check(&self) -> Result<(), CalibrationError> {
        let (x, y) = self.centre_px;
        let radii = [
            self.inner_radius_px,
            self.horizon_radius_px,
            self.outer_radius_px,
        ];
        let scalars = [x, y, self.zero_bearing_rad];
        if !radii.iter().chain(&scalars).all(|value| value.is_finite()) {
            return Err(CalibrationError::NotFinite);
        }
        if !(0.0 < self.inner_radius_px && self.inner_radius_px < self.outer_radius_px) {
            return Err(CalibrationError::RadiiOutOfOrder);
        }
        if !(self.inner_radius_px..=self.outer_radius_px).contains(&self.horizon_radius_px) {
            return Err(CalibrationError::HorizonOutsideRing);
        }
        let fits = |centre: f32, size: usize| {
            centre - self.outer_radius_px >= 0.0 && centre + self.outer_radius_px <= size as f32
        };
        if !(fits(x, FRAME_WIDTH) && fits(y, FRAME_HEIGHT)) {
            return Err(CalibrationError::RingOutsideFrame);
        }
        Ok(())
    }
}

impl Default for LensCalibration {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Why a calibration cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CalibrationError {
    /// A value is NaN or infinite.
    NotFinite,
    /// The inner radius is not positive, or not smaller than the outer one.
    RadiiOutOfOrder,
    /// The horizon does not lie between the inner and the outer radius.
    HorizonOutsideRing,
    /// The ring leaves the frame.
    RingOutsideFrame,
}

impl fmt::Display for CalibrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a calibration value is not finite",
            Self::RadiiOutOfOrder => "the radii must be 0 < inner < outer",
            Self::HorizonOutsideRing => "the horizon lies outside the ring",
            Self::RingOutsideFrame => "the ring lies partly outside the 128 x 96 frame",
        })
    }
}

impl core::error::Error for CalibrationError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_valid() {
        assert_eq!(LensCalibration::DEFAULT.check(), Ok(()));
    }

    #[test]
    fn what_cannot_be_a_ring_in_the_frame_is_refused() {
        let good = LensCalibration::DEFAULT;
        let cases = [
            (
                LensCalibration {
                    zero_bearing_rad: f32::NAN,
                    ..good
                },
                CalibrationError::NotFinite,
            ),
            (
                LensCalibration {
                    inner_radius_px: 42.0,
                    ..good
                },
                CalibrationError::RadiiOutOfOrder,
            ),
            (
                LensCalibration {
                    horizon_radius_px: 17.0,
                    ..good
                },
                CalibrationError::HorizonOutsideRing,
            ),
            (
                LensCalibration {
                    centre_px: (64.0, 55.0),
                    ..good
                },
                CalibrationError::RingOutsideFrame,
            ),
        ];
        for (calibration, error) in cases {
            assert_eq!(calibration.check(), Err(error));
        }
    }
}
