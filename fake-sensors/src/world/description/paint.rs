//! What surfaces look like: a painter by name, and how it is to paint.

use serde::Deserialize;
use toml::Spanned;

use super::quantity::{Coordinate, Length, Level, Share};
use crate::world::paint::Painter;

/// A surface's look.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paint {
    /// Who paints it.
    pub painter: Spanned<Painter>,
    /// Light that falls on it, relative to the world's usual light.
    pub light: Option<Level>,
    /// Factor on the painter's own reflectance.
    pub brightness: Option<Level>,
    /// Log-contrast per octave of the noise over everything; each painter has a usual one.
    pub contrast: Option<Share>,
    /// Edge of a texel of a picture.
    pub texel_m: Option<Length>,
    /// Edge of the square after which a material repeats.
    pub tile_m: Option<Length>,
    /// How far a solid's outline strays from its shape, as a share of its size: foliage.
    pub ragged: Option<Share>,
    /// Name of the light that it follows in time.
    pub follows: Option<Spanned<String>>,
    /// Sunlight on a picture.
    #[serde(default)]
    pub sun: Vec<SunPatch>,
}

/// A patch of sunlight: a parallelogram with two level edges.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SunPatch {
    /// Its lower left corner on the surface.
    pub at: [Coordinate; 2],
    /// Its width and height.
    pub size: [Length; 2],
    /// How far the upper edge is shifted along.
    pub slant_m: Option<Coordinate>,
    /// How many times brighter it is than what lies beside it.
    pub times: Level,
}
