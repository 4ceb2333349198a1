//! From the raw frame to the horizon: a look-up table over the ring of a panoramic lens.
//!
//! The paper's pipeline ("Image processing"): 128 bearings x 16 radii by nearest neighbour through a
//! look-up table, aligned with north by offsetting the bearing, averaged vertically.

use core::f32::consts::TAU;

use crate::calibration::{BearingDirection, CalibrationError, LensCalibration};
use crate::exposure::LumaHistogram;
use crate::horizon::{BEARINGS, Horizon};

mod layout;
mod samples;

pub use layout::FrameLayout;

use samples::SampleTable;

/// Samples along the radius.
pub const RADII: usize = 16;
/// Rows of the horizon band, on which the exposure is metered: three above the horizon and three below,
/// 17 degrees each way where the ring spans 90.
///
/// So wide that what is level with the drone stays inside while it tilts (10 degrees), and that it
/// holds 768 samples; so narrow that a lamp 2 m above the drone is outside within 6 m of it, and with
/// it the sky above whatever is taller than a third of its distance.
pub const BAND_ROWS: usize = 6;

/// Where in the frame each bearing and elevation is seen: 128 x 16 byte indices of luma, 4 KiB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PanoramaMap {
    /// By body bearing 2πn / 128, then by elevation: from the highest row of the horizon band to the
    /// lowest of all, and on from the highest of all.
    samples: SampleTable,
    /// The highest row of the horizon band, counted from the highest of all.
    band_start: usize,
}

impl PanoramaMap {
    /// The table for a lens over a sensor with frames of this layout. Takes 128 sines: at start, not
    /// for each frame.
    ///
    /// # Errors
    ///
    /// [`CalibrationError`] where the ring makes no sense or leaves the frame, or where the frame is
    /// too large for the table.
    pub fn new(lens: &LensCalibration, layout: &FrameLayout) -> Result<Self, CalibrationError> {
        lens.check(layout)?;
        let band_start = band_start(lens);
        let directions: [_; BEARINGS] = core::array::from_fn(|bearing| {
            let turn = bearing as f32 * (TAU / BEARINGS as f32);
            libm::sincosf(match lens.direction {
                BearingDirection::Clockwise => lens.zero_bearing_rad + turn,
                BearingDirection::CounterClockwise => lens.zero_bearing_rad - turn,
            })
        });
        let samples = SampleTable::new(layout.bytes(), |bearing, sample| {
            let (sin, cos) = directions[bearing];
            let radius = radius_of(lens, (sample + band_start) % RADII);
            let x = lens.centre_px.0 + radius * cos;
            let y = lens.centre_px.1 + radius * sin;
            layout.luma_index(x, y)
        });
        Ok(Self {
            samples: samples.ok_or(CalibrationError::FrameTooLarge)?,
            band_start,
        })
    }

    /// The mean luma of each bearing, turned by the heading (radians, counter-clockwise from north)
    /// so that bearing zero is north.
    ///
    /// `frame` has the layout that the map was made for; one that is shorter counts as black.
    ///
    /// The turn is a whole number of columns; the horizon carries the rest of it, and its spectrum
    /// is turned by that exactly.
    pub fn horizon(&self, frame: &[u8], heading: f32) -> Horizon {
        self.horizon_and_band(frame, heading).0
    }

    /// The same, and the mean luma of the horizon band, which costs nothing beside it.
    #[inline(never)]
    pub fn horizon_and_band(&self, frame: &[u8], heading: f32) -> (Horizon, f32) {
        let columns = heading * (BEARINGS as f32 / TAU);
        let whole = libm::roundf(columns);
        let residual = (columns - whole) * (TAU / BEARINGS as f32);
        let first = (whole as i32).wrapping_neg().rem_euclid(BEARINGS as i32) as usize;

        let mut sums = [0; BEARINGS];
        let in_band = self.samples.sum_columns(frame, first, &mut sums);
        let samples = (BAND_ROWS * BEARINGS) as f32;
        (Horizon::from_sums(sums, residual), in_band as f32 / samples)
    }

    /// How bright the samples of the horizon band are.
    pub fn band(&self, frame: &[u8]) -> LumaHistogram {
        let mut histogram = LumaHistogram::new();
        self.samples.look_at_band(frame, |luma| histogram.add(luma));
        histogram
    }

    /// The unwrapped panorama, not turned: rows from the highest elevation to the lowest, columns
    /// by body bearing.
    pub fn unwrap(&self, frame: &[u8]) -> [[u8; BEARINGS]; RADII] {
        let mut image = [[0; BEARINGS]; RADII];
        for (row, pixels) in image.iter_mut().enumerate() {
            let sample = (row + RADII - self.band_start) % RADII;
            for (bearing, pixel) in pixels.iter_mut().enumerate() {
                *pixel = self.luma(frame, bearing, sample);
            }
        }
        image
    }

    fn luma(&self, frame: &[u8], bearing: usize, sample: usize) -> u8 {
        let index = self.samples.index(bearing, sample);
        frame.get(index).copied().unwrap_or(0)
    }
}

/// The radius of a row: the middles of 16 equal rings, counted from the one that looks highest.
pub(crate) fn radius_of(lens: &LensCalibration, row: usize) -> f32 {
    let fraction = (row as f32 + 0.5) / RADII as f32;
    let span = lens.outer_radius_px - lens.inner_radius_px;
    if lens.inner_is_up {
        lens.inner_radius_px + span * fraction
    } else {
        lens.outer_radius_px - span * fraction
    }
}

/// The first of the rows nearest to the horizon.
fn band_start(lens: &LensCalibration) -> usize {
    let span = lens.outer_radius_px - lens.inner_radius_px;
    let below_the_top = if lens.inner_is_up {
        lens.horizon_radius_px - lens.inner_radius_px
    } else {
        lens.outer_radius_px - lens.horizon_radius_px
    };
    let start = libm::roundf(below_the_top / span * RADII as f32) - (BAND_ROWS / 2) as f32;
    // The cast saturates at 0.
    (start as usize).min(RADII - BAND_ROWS)
}

#[cfg(test)]
mod tests;
