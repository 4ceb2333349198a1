//! The level horizon of a tilted camera.
//!
//! The paper implemented derotation of pitch and roll and did not use it, "because the angles during the
//! experiment remained sufficiently small"; here it is off by default for the same reason. It costs a
//! projection for each sample instead of a look-up.

use core::f32::consts::TAU;

use crate::calibration::{BearingDirection, CalibrationError, LensCalibration};
use crate::horizon::{BEARINGS, Horizon};
use crate::panorama::{FrameLayout, RADII, radius_of};

/// How the camera leans, in the aircraft's convention (north-east-down, yaw, pitch, roll), as the link's
/// STATE has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tilt {
    /// Radians, positive with the right side down.
    pub roll_rad: f32,
    /// Radians, positive with the nose up.
    pub pitch_rad: f32,
}

impl Tilt {
    fn is_finite(&self) -> bool {
        self.roll_rad.is_finite() && self.pitch_rad.is_finite()
    }
}

/// Looks level through a lens that leans.
#[derive(Clone, Debug)]
pub struct Derotation {
    lens: LensCalibration,
    layout: FrameLayout,
    /// Sine and cosine of the zero bearing.
    zero: (f32, f32),
    /// Pixels along the radius for a radian up; negative where the inner edge looks up.
    radius_per_rad: f32,
    /// Sine and cosine of the elevation of each row, from the highest to the lowest.
    elevations: [(f32, f32); RADII],
}

impl Derotation {
    /// For a lens over a sensor with frames of this layout.
    ///
    /// # Errors
    ///
    /// [`CalibrationError`] as for the [`PanoramaMap`](crate::PanoramaMap).
    pub fn new(lens: &LensCalibration, layout: &FrameLayout) -> Result<Self, CalibrationError> {
        lens.check(layout)?;
        let span = lens.outer_radius_px - lens.inner_radius_px;
        let outwards = if lens.inner_is_up { -span } else { span };
        let radius_per_rad = outwards / lens.vertical_field_rad;
        let mut elevations = [(0.0, 0.0); RADII];
        for (row, elevation) in elevations.iter_mut().enumerate() {
            let above = radius_of(lens, row) - lens.horizon_radius_px;
            *elevation = libm::sincosf(above / radius_per_rad);
        }
        Ok(Self {
            lens: *lens,
            layout: *layout,
            zero: libm::sincosf(lens.zero_bearing_rad),
            radius_per_rad,
            elevations,
        })
    }

    /// The mean luma of each bearing as a level camera would see it, bearing zero to the north: the
    /// counterpart of [`PanoramaMap::horizon`](crate::PanoramaMap::horizon). In directions that
    /// the tilted band does not show the luma of its edge stands in, which keeps the shares of high and
    /// low; in rendered worlds that comes nearer to the level horizon than leaving them out. A tilt that
    /// is not finite counts as none.
    pub fn horizon(&self, frame: &[u8], heading: f32, tilt: Tilt) -> Horizon {
        let tilt = if tilt.is_finite() {
            tilt
        } else {
            Tilt::default()
        };
        let to_body = ToBody::new(tilt);
        let mut sums = [0; BEARINGS];
        for (n, sum) in sums.iter_mut().enumerate() {
            let (sin, cos) = libm::sincosf(n as f32 * (TAU / BEARINGS as f32) - heading);
            let column = self.elevations.iter().map(|(up, level)| {
                let direction = [level * cos, level * sin, *up];
                u16::from(self.look(frame, to_body.turn(direction)))
            });
            *sum = column.sum();
        }
        Horizon::from_sums(sums, 0.0)
    }

    /// The luma in a direction of the body (x forward, y left, z up), or that of the band's edge.
    fn look(&self, frame: &[u8], [x, y, z]: [f32; 3]) -> u8 {
        let level = libm::sqrtf(x * x + y * y).max(f32::MIN_POSITIVE);
        let radius = self.lens.horizon_radius_px + self.radius_per_rad * libm::atan2f(z, level);
        let radius = radius
            .max(self.lens.inner_radius_px)
            .min(self.lens.outer_radius_px);
        // The bearing is added to the zero bearing or taken from it, as complex numbers.
        let (cos, sin) = match self.lens.direction {
            BearingDirection::Clockwise => (x / level, y / level),
            BearingDirection::CounterClockwise => (x / level, -y / level),
        };
        let (zero_sin, zero_cos) = self.zero;
        let column = self.lens.centre_px.0 + radius * (zero_cos * cos - zero_sin * sin);
        let row = self.lens.centre_px.1 + radius * (zero_sin * cos + zero_cos * sin);
        let index = self.layout.luma_index(column, row);
        frame.get(usize::from(index)).copied().unwrap_or(0)
    }
}

/// Turns directions of the level frame (x forward, y left, z up) into the body's.
struct ToBody {
    roll: (f32, f32),
    pitch: (f32, f32),
}

impl ToBody {
    fn new(tilt: Tilt) -> Self {
        Self {
            roll: libm::sincosf(tilt.roll_rad),
            pitch: libm::sincosf(tilt.pitch_rad),
        }
    }

    /// Pitch back, then roll back: the order in which they were made, reversed.
    fn turn(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let (sin, cos) = self.pitch;
        let [x, z] = [cos * x + sin * z, cos * z - sin * x];
        let (sin, cos) = self.roll;
        [x, cos * y + sin * z, cos * z - sin * y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PanoramaMap;

    const LAYOUT: FrameLayout = FrameLayout::SUBQCIF_UYVY;

    fn lenses() -> [LensCalibration; 2] {
        let other = LensCalibration {
            centre_px: (61.0, 49.5),
            horizon_radius_px: 28.0,
            zero_bearing_rad: 0.7,
            direction: BearingDirection::CounterClockwise,
            inner_is_up: false,
            ..LensCalibration::DEFAULT
        };
        // Off the pixels' corners, on which rounding would decide between two.
        let off_corners = LensCalibration {
            centre_px: (63.7, 47.8),
            ..LensCalibration::DEFAULT
        };
        [off_corners, other]
    }

    /// A frame without symmetry, smooth over some pixels.
    fn frame() -> [u8; LAYOUT.bytes()] {
        core::array::from_fn(|index| {
            let (x, y) = ((index / 2 % 128) as f32, (index / 256) as f32);
            (120.0 + 60.0 * libm::sinf(0.08 * x) + 40.0 * libm::cosf(0.13 * y + 0.02 * x)) as u8
        })
    }

    #[test]
    fn without_a_tilt_it_is_the_panoramas_horizon() {
        for lens in lenses() {
            let map = PanoramaMap::new(&lens, &LAYOUT).unwrap();
            let derotation = Derotation::new(&lens, &LAYOUT).unwrap();
            // A whole number of columns, so that the panorama's turn leaves no rest.
            let heading = 21.0 * TAU / BEARINGS as f32;
            let plain = map.horizon(&frame(), heading);
            let level = derotation.horizon(&frame(), heading, Tilt::default());
            for (a, b) in plain.luma().iter().zip(level.luma()) {
                assert!((a - b).abs() < 2.0, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_direction_turns_against_the_tilt() {
        let close = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        let (sin, cos) = libm::sincosf(0.2);
        // Nose up: what is level ahead lies below the nose.
        let nose_up = ToBody::new(Tilt {
            roll_rad: 0.0,
            pitch_rad: 0.2,
        });
        assert!(close(nose_up.turn([1.0, 0.0, 0.0]), [cos, 0.0, -sin]));
        assert!(close(nose_up.turn([0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]));
        // Right side down: what is level to the left lies below the left side, which is up.
        let right_down = ToBody::new(Tilt {
            roll_rad: 0.2,
            pitch_rad: 0.0,
        });
        assert!(close(right_down.turn([0.0, 1.0, 0.0]), [0.0, cos, -sin]));
        assert!(close(right_down.turn([1.0, 0.0, 0.0]), [1.0, 0.0, 0.0]));
    }

    #[test]
    fn whatever_the_tilt_luma_stays_luma() {
        let derotation = Derotation::new(&LensCalibration::DEFAULT, &LAYOUT).unwrap();
        for angle in [f32::NAN, f32::INFINITY, 1.5, -3.0, 1e9] {
            let tilt = Tilt {
                roll_rad: angle,
                pitch_rad: -angle,
            };
            let horizon = derotation.horizon(&[7; LAYOUT.bytes()], 0.3, tilt);
            assert!(horizon.luma().iter().all(|luma| *luma == 7.0));
        }
    }
}
