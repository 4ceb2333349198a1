//! From the raw frame to the horizon: a look-up table over the ring of a panoramic lens.
//!
//! The paper's pipeline ("Image processing"): 128 bearings x 16 radii by nearest neighbour through a
//! look-up table, aligned with north by offsetting the bearing, averaged vertically.

use core::f32::consts::TAU;

use crate::calibration::{BearingDirection, CalibrationError, LensCalibration};
use crate::exposure::LumaHistogram;
use crate::horizon::{BEARINGS, Horizon};

mod layout;

pub use layout::FrameLayout;

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
    luma_index: [[u16; RADII]; BEARINGS],
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
        let mut luma_index = [[0; RADII]; BEARINGS];
        let band_start = band_start(lens);
        for (bearing, column) in luma_index.iter_mut().enumerate() {
            let turn = bearing as f32 * (TAU / BEARINGS as f32);
            let angle = match lens.direction {
                BearingDirection::Clockwise => lens.zero_bearing_rad + turn,
                BearingDirection::CounterClockwise => lens.zero_bearing_rad - turn,
            };
            let (sin, cos) = libm::sincosf(angle);
            for (row, index) in column.iter_mut().enumerate() {
                let radius = radius_of(lens, (row + band_start) % RADII);
                let x = lens.centre_px.0 + radius * cos;
                let y = lens.centre_px.1 + radius * sin;
                *index = layout.luma_index(x, y);
            }
        }
        Ok(Self {
            luma_index,
            band_start,
        })
    }

    /// The mean luma of each bearing, turned by the heading (radians, counter-clockwise from north)
    /// so that bearing zero is north.
    ///
    /// `frame` has the layout that the map was made for; bytes that it lacks count as black.
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
        let shift = (whole as i32).rem_euclid(BEARINGS as i32) as usize;

        let mut luma = [0.0; BEARINGS];
        let mut in_band = 0;
        for (value, column) in luma[shift..].iter_mut().zip(&self.luma_index) {
            *value = mean(frame, column, &mut in_band);
        }
        let wrapped = &self.luma_index[BEARINGS - shift..];
        for (value, column) in luma[..shift].iter_mut().zip(wrapped) {
            *value = mean(frame, column, &mut in_band);
        }
        let samples = (BAND_ROWS * BEARINGS) as f32;
        (Horizon::new(luma, residual), in_band as f32 / samples)
    }

    /// How bright the samples of the horizon band are.
    pub fn band(&self, frame: &[u8]) -> LumaHistogram {
        let mut histogram = LumaHistogram::new();
        for index in self
            .luma_index
            .iter()
            .flat_map(|column| &column[..BAND_ROWS])
        {
            histogram.add(luma_at(frame, *index));
        }
        histogram
    }

    /// The unwrapped panorama, not turned: rows from the highest elevation to the lowest, columns
    /// by body bearing.
    pub fn unwrap(&self, frame: &[u8]) -> [[u8; BEARINGS]; RADII] {
        let mut image = [[0; BEARINGS]; RADII];
        for (row, pixels) in image.iter_mut().enumerate() {
            for (pixel, column) in pixels.iter_mut().zip(&self.luma_index) {
                *pixel = luma_at(frame, column[(row + RADII - self.band_start) % RADII]);
            }
        }
        image
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

fn luma_at(frame: &[u8], index: u16) -> u8 {
    // Always inside a frame of the map's layout. The zero stands for the bytes that a shorter one
    // lacks, in place of a panic.
    frame.get(usize::from(index)).copied().unwrap_or(0)
}

/// The mean of a column; the sum of its rows in the band is added to `in_band`.
fn mean(frame: &[u8], column: &[u16; RADII], in_band: &mut u32) -> f32 {
    let sum = |rows: &[u16]| -> u16 {
        rows.iter()
            .map(|&index| u16::from(luma_at(frame, index)))
            .sum()
    };
    let (band, others) = column.split_at(BAND_ROWS);
    let band = sum(band);
    *in_band += u32::from(band);
    f32::from(band + sum(others)) * (1.0 / RADII as f32)
}

#[cfg(test)]
mod tests;
