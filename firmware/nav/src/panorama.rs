//! From the raw frame to the horizon: a look-up table over the ring of a panoramic lens.
//!
//! The paper's pipeline ("Image processing"): 128 bearings x 16 radii by nearest neighbour through a
//! look-up table, aligned with north by offsetting the bearing, averaged vertically.

use core::f32::consts::TAU;

use crate::calibration::{BearingDirection, CalibrationError, LensCalibration};
use crate::horizon::{BEARINGS, Horizon};

mod layout;

pub use layout::FrameLayout;

/// Samples along the radius.
pub const RADII: usize = 16;

/// Where in the frame each bearing and elevation is seen: 128 x 16 byte indices of luma, 4 KiB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PanoramaMap {
    /// By body bearing 2πn / 128, then by elevation from the highest to the lowest.
    luma_index: [[u16; RADII]; BEARINGS],
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
        for (bearing, column) in luma_index.iter_mut().enumerate() {
            let turn = bearing as f32 * (TAU / BEARINGS as f32);
            let angle = match lens.direction {
                BearingDirection::Clockwise => lens.zero_bearing_rad + turn,
                BearingDirection::CounterClockwise => lens.zero_bearing_rad - turn,
            };
            let (sin, cos) = libm::sincosf(angle);
            for (row, index) in column.iter_mut().enumerate() {
                let radius = radius_of(lens, row);
                let x = lens.centre_px.0 + radius * cos;
                let y = lens.centre_px.1 + radius * sin;
                *index = layout.luma_index(x, y);
            }
        }
        Ok(Self { luma_index })
    }

    /// The mean luma of each bearing, turned by the heading (radians, counter-clockwise from north)
    /// so that bearing zero is north.
    ///
    /// `frame` has the layout that the map was made for; bytes that it lacks count as black.
    ///
    /// The turn is a whole number of columns; the horizon carries the rest of it, and its spectrum
    /// is turned by that exactly.
    pub fn horizon(&self, frame: &[u8], heading: f32) -> Horizon {
        let columns = heading * (BEARINGS as f32 / TAU);
        let whole = libm::roundf(columns);
        let residual = (columns - whole) * (TAU / BEARINGS as f32);
        let shift = (whole as i32).rem_euclid(BEARINGS as i32) as usize;

        let mut luma = [0.0; BEARINGS];
        for (value, column) in luma[shift..].iter_mut().zip(&self.luma_index) {
            *value = mean(frame, column);
        }
        let wrapped = &self.luma_index[BEARINGS - shift..];
        for (value, column) in luma[..shift].iter_mut().zip(wrapped) {
            *value = mean(frame, column);
        }
        Horizon::new(luma, residual)
    }

    /// The unwrapped panorama, not turned: rows from the highest elevation to the lowest, columns
    /// by body bearing.
    pub fn unwrap(&self, frame: &[u8]) -> [[u8; BEARINGS]; RADII] {
        let mut image = [[0; BEARINGS]; RADII];
        for (row, pixels) in image.iter_mut().enumerate() {
            for (pixel, column) in pixels.iter_mut().zip(&self.luma_index) {
                *pixel = luma_at(frame, column[row]);
            }
        }
        image
    }
}

/// The radius of a row: the middles of 16 equal rings, counted from the one that looks highest.
fn radius_of(lens: &LensCalibration, row: usize) -> f32 {
    let fraction = (row as f32 + 0.5) / RADII as f32;
    let span = lens.outer_radius_px - lens.inner_radius_px;
    if lens.inner_is_up {
        lens.inner_radius_px + span * fraction
    } else {
        lens.outer_radius_px - span * fraction
    }
}

fn luma_at(frame: &[u8], index: u16) -> u8 {
    // Always inside a frame of the map's layout. The zero stands for the bytes that a shorter one
    // lacks, in place of a panic.
    frame.get(usize::from(index)).copied().unwrap_or(0)
}

fn mean(frame: &[u8], column: &[u16; RADII]) -> f32 {
    let sum: u16 = column
        .iter()
        .map(|&index| u16::from(luma_at(frame, index)))
        .sum();
    f32::from(sum) * (1.0 / RADII as f32)
}

#[cfg(test)]
mod tests;
