//! Wind: a mean, the turbulence that comes with it, and single gusts.
//!
//! Turbulence is Dryden's, in the forms and with the low-altitude scales of MIL-F-8785C, section 3.7. Frozen eddies
//! drift past with the mean wind, so a drone that hovers meets them at the wind's speed; that a drone moves too, at
//! 1 m/s at most, is left out. Without a mean wind there is no turbulence.

mod dryden;
mod gust;
#[cfg(test)]
mod tests;

pub use dryden::Scales;
pub use gust::Gust;

use nalgebra::Vector3;

use crate::random::Normal;
use dryden::{Longitudinal, Transverse};

/// Seconds between two values of the wind.
pub const STEP_S: f64 = 0.001;

/// Stream of the seed: the room's name in ASCII, clear of the sensors' streams.
const STREAM: u64 = u64::from_be_bytes(*b"windgust");

/// What the air does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindModel {
    /// Mean velocity of the air in the world, m/s: x north, y west, z up. Turbulence is laid along and across its
    /// horizontal part.
    pub mean_m_s: Vector3<f64>,
    /// Turbulence intensity: standard deviation of the horizontal components over the mean speed.
    pub intensity: f64,
    /// Height that sets the size of the eddies, m.
    pub height_m: f64,
    /// A single gust on top.
    pub gust: Option<Gust>,
}

impl WindModel {
    /// Turbulence intensity close to the ground: MIL-F-8785C gives the vertical component a tenth of the wind 20 ft
    /// up, and the horizontal ones twice as much. The wind at the drone's own height is weaker than that, so that
    /// turbulence stated as a share of it may be greater.
    pub const TYPICAL_INTENSITY: f64 = 0.2;

    /// No wind.
    #[must_use]
    pub fn calm() -> Self {
        Self {
            mean_m_s: Vector3::zeros(),
            intensity: 0.0,
            height_m: Self::FLIGHT_HEIGHT_M,
            gust: None,
        }
    }

    /// A horizontal wind of mean speed `mean_m_s` that comes from the bearing `from_rad` (counter-clockwise from
    /// north), with turbulence of the given [`WindModel::intensity`].
    #[must_use]
    pub fn new(mean_m_s: f64, from_rad: f64, intensity: f64) -> Self {
        let (sin, cos) = libm::sincos(from_rad);
        Self {
            mean_m_s: Vector3::new(cos, sin, 0.0) * -mean_m_s,
            intensity,
            ..Self::calm()
        }
    }

    /// The same wind with a gust on top.
    #[must_use]
    pub fn with_gust(self, gust: Gust) -> Self {
        Self {
            gust: Some(gust),
            ..self
        }
    }

    /// Height at which the flight app holds the drone, m.
    const FLIGHT_HEIGHT_M: f64 = 0.5;
}

impl Default for WindModel {
    fn default() -> Self {
        Self::calm()
    }
}

/// The wind at one place, millisecond by millisecond.
#[derive(Debug, Clone)]
pub struct Wind {
    model: WindModel,
    /// Along the mean wind, horizontally across it, and up.
    axes: [Vector3<f64>; 3],
    along: Longitudinal,
    across: Transverse,
    up: Transverse,
    random: Normal,
    ticks: u64,
}

impl Wind {
    /// Wind of the given model; `seed` draws its turbulence, which is in full swing from the start.
    #[must_use]
    pub fn new(model: &WindModel, seed: u64) -> Self {
        let speed_m_s = model.mean_m_s.norm();
        let scales = Scales::at_height(model.height_m);
        let horizontal_m_s = model.intensity * speed_m_s;
        let vertical_m_s = horizontal_m_s * scales.vertical_share;
        let horizontal = Vector3::new(model.mean_m_s.x, model.mean_m_s.y, 0.0);
        let downwind = horizontal
            .try_normalize(f64::EPSILON)
            .unwrap_or_else(Vector3::x);
        let mut random = Normal::new(seed, STREAM);
        let wide = STEP_S * speed_m_s / scales.horizontal_m;
        let high = STEP_S * speed_m_s / scales.vertical_m;
        Self {
            axes: [downwind, Vector3::z().cross(&downwind), Vector3::z()],
            along: Longitudinal::new(horizontal_m_s, wide, &mut random),
            across: Transverse::new(horizontal_m_s, wide, &mut random),
            up: Transverse::new(vertical_m_s, high, &mut random),
            model: *model,
            random,
            ticks: 0,
        }
    }

    /// Velocity of the air in the world, m/s; the first call is for the instant zero, each further one for a
    /// millisecond later.
    pub fn tick(&mut self) -> Vector3<f64> {
        let time_s = self.ticks as f64 * STEP_S;
        self.ticks += 1;
        let [along, across, up] = self.axes;
        let turbulence = along * self.along.tick(&mut self.random)
            + across * self.across.tick(&mut self.random)
            + up * self.up.tick(&mut self.random);
        let gust = self
            .model
            .gust
            .map_or_else(Vector3::zeros, |gust| gust.at(time_s));
        self.model.mean_m_s + turbulence + gust
    }
}
