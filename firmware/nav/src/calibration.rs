//! What must be known of a panoramic lens to read its ring-shaped image.
//!
//! The image of a panoramic lens is a ring: the angle round its centre is the bearing, the radius is
//! the elevation. The radius is taken as linear in elevation, as the lens maker's own dewarper does.

use core::f32::consts::{FRAC_PI_2, PI};
use core::fmt;

use crate::panorama::FrameLayout;

pub mod record;

pub use record::RecordError;

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

/// A lens on a sensor. Measured once for each unit, by `hil calibrate` from its own pictures, and kept
/// in flash as a [`record`].
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
    /// Where the band that is unwrapped begins, pixels: [`EDGE_MARGIN_PX`] outside the inner edge of
    /// what the optic images.
    pub inner_radius_px: f32,
    /// Where the band ends, pixels: [`EDGE_MARGIN_PX`] inside the outer edge of what the optic images.
    pub outer_radius_px: f32,
    /// Where things at the height of the lens appear, pixels.
    pub horizon_radius_px: f32,
    /// The angle of view between the band's edges, radians. Only the [derotation](crate::Derotation)
    /// asks for it.
    pub vertical_field_rad: f32,
    /// Where the nose appears: radians from the right (x) towards the bottom (y) of the image, that
    /// is clockwise on the screen.
    pub zero_bearing_rad: f32,
    /// Which way bearings run on the screen.
    pub direction: BearingDirection,
    /// Whether the inner edge looks up: true for a solid one-piece optic over an upward camera
    /// (Kogeto Dot, GoPano), false for a plain convex mirror.
    pub inner_is_up: bool,
}

/// How far inside the visible edges of the ring the band ends that is unwrapped, pixels of a 128 x 96
/// frame. The optic is not sharp there (1 to 2 pixels): what is nearer to an edge has light of the dark
/// middle or of the bright rim in it.
pub const EDGE_MARGIN_PX: f32 = 1.5;

impl LensCalibration {
    /// A Kogeto Dot 360 in the middle of a 128 x 96 frame.
    ///
    /// The radii are inside the 0.41..0.53 that known units have as inner / outer ratio, and leave
    /// 5 px of mounting tolerance to the frame's edge; the mean circumference of 188 px carries 128
    /// bearings. The nose is at the top, bearings run clockwise: a camera that looks up into the
    /// mirror. The field of view is not published; users estimate 90 degrees. A real unit needs its own
    /// values.
    pub const DEFAULT: Self = Self {
        centre_px: (64.0, 48.0),
        inner_radius_px: 18.0,
        outer_radius_px: 42.0,
        horizon_radius_px: 30.0,
        vertical_field_rad: FRAC_PI_2,
        zero_bearing_rad: -FRAC_PI_2,
        direction: BearingDirection::Clockwise,
        inner_is_up: true,
    };

    /// Checks that the ring makes sense and lies inside a frame of this layout.
    ///
    /// # Errors
    ///
    /// The first [`CalibrationError`] that applies.
    pub fn check(&self, layout: &FrameLayout) -> Result<(), CalibrationError> {
        let (x, y) = self.centre_px;
        let (inner, outer) = (self.inner_radius_px, self.outer_radius_px);
        let angles = [self.vertical_field_rad, self.zero_bearing_rad];
        let lengths = [x, y, inner, self.horizon_radius_px, outer];
        if !layout.is_indexable() {
            return Err(CalibrationError::FrameTooLarge);
        }
        if !lengths.iter().chain(&angles).all(|value| value.is_finite()) {
            return Err(CalibrationError::NotFinite);
        }
        if !(0.0 < inner && inner < outer) {
            return Err(CalibrationError::RadiiOutOfOrder);
        }
        if !(inner..=outer).contains(&self.horizon_radius_px) {
            return Err(CalibrationError::HorizonOutsideRing);
        }
        if !(0.0 < self.vertical_field_rad && self.vertical_field_rad <= PI) {
            return Err(CalibrationError::ImpossibleField);
        }
        let fits =
            |centre: f32, size: u16| centre - outer >= 0.0 && centre + outer <= f32::from(size);
        if !(fits(x, layout.width) && fits(y, layout.height)) {
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
    /// The angle of view is not positive, or wider than a half-circle.
    ImpossibleField,
    /// The ring leaves the frame.
    RingOutsideFrame,
    /// The frame is too large for a table of 16-bit indices, or its pixels have no luma.
    FrameTooLarge,
}

impl fmt::Display for CalibrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a calibration value is not finite",
            Self::RadiiOutOfOrder => "the radii must be 0 < inner < outer",
            Self::HorizonOutsideRing => "the horizon lies outside the ring",
            Self::ImpossibleField => {
                "the vertical field must be more than 0 and at most 180 degrees"
            }
            Self::RingOutsideFrame => "the ring lies partly outside the frame",
            Self::FrameTooLarge => "the frame is larger than 64 KiB, or its pixels have no luma",
        })
    }
}

impl core::error::Error for CalibrationError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_valid() {
        assert_eq!(
            LensCalibration::DEFAULT.check(&FrameLayout::SUBQCIF_UYVY),
            Ok(())
        );
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
            (
                LensCalibration {
                    vertical_field_rad: 0.0,
                    ..good
                },
                CalibrationError::ImpossibleField,
            ),
        ];
        for (calibration, error) in cases {
            assert_eq!(calibration.check(&FrameLayout::SUBQCIF_UYVY), Err(error));
        }
    }

    #[test]
    fn a_ring_that_leaves_a_small_frame_fits_a_larger_one() {
        let lens = LensCalibration {
            centre_px: (80.0, 60.0),
            ..LensCalibration::DEFAULT
        };
        let larger = FrameLayout {
            width: 160,
            height: 120,
            bytes_per_pixel: 1,
            luma_offset: 0,
        };
        assert_eq!(lens.check(&larger), Ok(()));
        let smaller = lens.check(&FrameLayout::SUBQCIF_UYVY);
        assert_eq!(smaller, Err(CalibrationError::RingOutsideFrame));
    }

    #[test]
    fn frames_beyond_16_bit_indices_or_without_luma_are_refused() {
        let layout = |width, height, bytes_per_pixel, luma_offset| FrameLayout {
            width,
            height,
            bytes_per_pixel,
            luma_offset,
        };
        let check = |layout| LensCalibration::DEFAULT.check(&layout);
        assert_eq!(check(layout(256, 128, 2, 1)), Ok(()));
        for unusable in [
            layout(256, 129, 2, 1),
            layout(128, 96, 2, 2),
            layout(0, 96, 2, 1),
            layout(u16::MAX, u16::MAX, u8::MAX, 0),
        ] {
            assert_eq!(check(unusable), Err(CalibrationError::FrameTooLarge));
        }
    }
}
