//! Calibration of a panoramic lens from its own pictures.
//!
//! Centre and radii come from the visible edges of the ring: on many rays, where the dark middle ends
//! and where the bright rim or the dark holder begins; two circles about one centre go through them
//! (trimmed least squares). The band that is unwrapped lies [`EDGE_MARGIN_PX`] inside the edges. Where
//! there are several pictures, taken while the camera was turned about the vertical, their horizons must
//! be shifted against each other and nothing else: that is the check.
//!
//! What no picture tells, the user does: where the nose is, where the horizon is, the field of view.

pub mod circles;
pub mod edges;
pub mod picture;
mod plot;
pub mod spin;
mod steepest;
#[cfg(test)]
mod tests;

use std::path::PathBuf;

use nav::calibration::EDGE_MARGIN_PX;
use nav::{BearingDirection, CalibrationError, LensCalibration};
use pilot::FRAME_LAYOUT;

use circles::distance;
pub use edges::{Edges, NoRing};
pub use picture::{Picture, PictureError};
pub use plot::picture as drawing;
pub use spin::{Band, Spin};

/// Where the firmware looks for the record: the chip's last sector of flash.
pub const LENS_PAGE: u32 = 0x080e_0000;

/// The most that may be left of a spin, pixels RMS. A good centre leaves a fifth of a pixel; one that is
/// off by a pixel, after half a turn, one and a half.
pub const RESIDUAL_LIMIT_PX: f64 = 0.75;

/// The most that the ring may move between two pictures, pixels: the lens is fixed to the camera.
const WANDERING_LIMIT_PX: f64 = 2.0;

/// A step between two pictures that is nearer than this to nothing, or to half a turn, has no direction:
/// degrees.
const UNCLEAR_STEP_DEG: f64 = 5.0;

/// In which order the pictures of a spin were taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Order {
    /// The drone turned to its left, counter-clockwise seen from above, by less than half a turn each
    /// time
    #[default]
    CounterClockwise,
    /// It turned to its right
    Clockwise,
    /// None
    None,
}

/// What the pictures do not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Where the nose appears: radians from the right towards the bottom of the image.
    pub zero_bearing_rad: f32,
    /// Where things at the lens's height appear, pixels from the centre; none: in the band's middle.
    pub horizon_radius_px: Option<f32>,
    /// The angle of view of the band, radians.
    pub vertical_field_rad: f32,
    /// Whether the inner edge looks up.
    pub inner_is_up: bool,
    /// The order of the pictures.
    pub order: Order,
}

impl Default for Settings {
    fn default() -> Self {
        let lens = LensCalibration::DEFAULT;
        Self {
            zero_bearing_rad: lens.zero_bearing_rad,
            horizon_radius_px: None,
            vertical_field_rad: lens.vertical_field_rad,
            inner_is_up: lens.inner_is_up,
            order: Order::default(),
        }
    }
}

/// A picture with the name of its file.
#[derive(Clone, Debug)]
pub struct Named {
    /// The file.
    pub path: PathBuf,
    /// What is in it.
    pub picture: Picture,
}

/// Why pictures make no calibration.
#[derive(Debug, thiserror::Error)]
pub enum CalibrateError {
    /// A picture shows no ring.
    #[error("{}: {source}", path.display())]
    NoRing {
        /// The file.
        path: PathBuf,
        /// Why.
        source: NoRing,
    },
    /// The pictures have no ring in common.
    #[error("each picture shows a ring, but not the same: {0}")]
    NoCommonRing(NoRing),
    /// A picture shows the ring elsewhere.
    #[error(
        "{}: the ring's centre is {distance_px:.1} px from that of the first picture: was the lens moved?",
        path.display()
    )]
    Wanders {
        /// The file.
        path: PathBuf,
        /// How far, pixels.
        distance_px: f64,
    },
    /// The ring is no lens that the firmware takes.
    #[error("the ring that was found is no use: {0}")]
    Impossible(CalibrationError),
    /// Not one picture.
    #[error("no picture")]
    NoPicture,
}

/// A calibration and what speaks for it.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The lens.
    pub lens: LensCalibration,
    /// The mean of the pictures.
    pub mean: Picture,
    /// The visible edges in all of them.
    pub edges: Edges,
    /// The largest distance of a single picture's centre from that of all, pixels.
    pub scatter_px: f64,
    /// The check by a spin; none of one picture, or of pictures without a pattern.
    pub spin: Option<Spin>,
    /// The direction of bearings as the spin shows it; none where it does not, and the lens has the
    /// default.
    pub direction: Option<BearingDirection>,
}

impl Calibrated {
    /// Whether nothing speaks against it.
    pub fn holds(&self) -> bool {
        let residual = |spin: &Spin| spin.residual_px <= RESIDUAL_LIMIT_PX;
        self.spin.as_ref().is_none_or(residual)
    }
}

/// Calibrates a lens.
///
/// # Errors
/// [`CalibrateError`] with the file and the reason.
pub fn calibrate(pictures: &[Named], settings: &Settings) -> Result<Calibrated, CalibrateError> {
    let rings = rings(pictures)?;
    let pictures: Vec<Picture> = pictures.iter().map(|named| named.picture.clone()).collect();
    let mean = Picture::mean(&pictures).ok_or(CalibrateError::NoPicture)?;
    let start = rings.first().ok_or(CalibrateError::NoPicture)?.centre;
    let edges = edges::find_in_all(&pictures, start).map_err(CalibrateError::NoCommonRing)?;
    let margin = f64::from(EDGE_MARGIN_PX);
    let band = Band {
        centre: edges.centre,
        inner_px: edges.rings[0].radius_px + margin,
        outer_px: edges.rings[1].radius_px - margin,
    };
    let spin = Spin::of(&pictures, &band);
    let direction = spin
        .as_ref()
        .and_then(|spin| direction(spin, settings.order));
    let lens = LensCalibration {
        centre_px: (band.centre[0] as f32, band.centre[1] as f32),
        inner_radius_px: band.inner_px as f32,
        outer_radius_px: band.outer_px as f32,
        horizon_radius_px: settings
            .horizon_radius_px
            .unwrap_or((0.5 * (band.inner_px + band.outer_px)) as f32),
        vertical_field_rad: settings.vertical_field_rad,
        zero_bearing_rad: settings.zero_bearing_rad,
        direction: direction.unwrap_or(LensCalibration::DEFAULT.direction),
        inner_is_up: settings.inner_is_up,
    };
    lens.check(&FRAME_LAYOUT)
        .map_err(CalibrateError::Impossible)?;
    let distances = rings
        .iter()
        .map(|ring| distance(&ring.centre, &edges.centre));
    Ok(Calibrated {
        lens,
        mean,
        scatter_px: distances.fold(0.0, f64::max),
        edges,
        spin,
        direction,
    })
}

/// The ring in each picture: one that shows none, or another one, is named.
fn rings(pictures: &[Named]) -> Result<Vec<Edges>, CalibrateError> {
    let mut rings: Vec<Edges> = Vec::new();
    for Named { path, picture } in pictures {
        let ring = edges::find(picture).map_err(|source| CalibrateError::NoRing {
            path: path.clone(),
            source,
        })?;
        let distance_px = rings
            .first()
            .map_or(0.0, |first| distance(&first.centre, &ring.centre));
        if distance_px > WANDERING_LIMIT_PX {
            let path = path.clone();
            return Err(CalibrateError::Wanders { path, distance_px });
        }
        rings.push(ring);
    }
    Ok(rings)
}

/// The direction of bearings: when the drone turns to its left, what it sees moves to its right, towards
/// smaller bearings. None where a step is unclear, or two contradict each other.
fn direction(spin: &Spin, order: Order) -> Option<BearingDirection> {
    let to_the_left = match order {
        Order::CounterClockwise => 1.0,
        Order::Clockwise => -1.0,
        Order::None => return None,
    };
    let steps = spin.steps_deg();
    let clear = |step: &f64| (UNCLEAR_STEP_DEG..180.0 - UNCLEAR_STEP_DEG).contains(&step.abs());
    let same = |step: &f64| step.signum() == steps[0].signum();
    if !(steps.iter().all(clear) && steps.iter().all(same)) {
        return None;
    }
    Some(if steps[0] * to_the_left < 0.0 {
        BearingDirection::Clockwise
    } else {
        BearingDirection::CounterClockwise
    })
}
