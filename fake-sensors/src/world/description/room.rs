//! What encloses everything: a room, or ground and sky, or a panorama.

use serde::Deserialize;
use toml::Spanned;

use super::paint::Paint;
use super::quantity::{Coordinate, Length, Level, Point, Share};

/// A room: floor, ceiling and four walls.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// Its south-east corner.
    pub corner: Point,
    /// Its lengths along x and y.
    pub size: [Length; 2],
    /// From floor to ceiling.
    pub height: Length,
    /// The floor; without it the panorama is projected there, as on the others.
    pub floor: Option<Paint>,
    /// The ceiling.
    pub ceiling: Option<Paint>,
    /// The north, east, south and west wall; one alone stands for all.
    #[serde(default)]
    pub walls: Vec<Paint>,
    /// Factors on the light of the four walls: daylight comes from one side. The seed turns the
    /// order.
    pub daylight: Option<[Level; 4]>,
}

/// Level ground without end.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ground {
    /// A material.
    pub paint: Paint,
}

/// A painted sky, with a line of distant trees or hills on its horizon.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sky {
    /// Radiance at the zenith.
    pub zenith: Level,
    /// Radiance above the horizon.
    pub horizon: Level,
    /// Share of the sky that clouds cover.
    pub clouds: Option<Share>,
    /// Radiance of the sun's disc and glare.
    pub sun: Option<Level>,
    /// Tangent of the elevation that the distant skyline reaches.
    pub skyline: Option<Share>,
    /// Radiance of what stands on the horizon.
    pub far: Option<Level>,
    /// Name of the light that it follows in time.
    pub follows: Option<Spanned<String>>,
}

/// An equirectangular picture of everything, in HDR, EXR, PNG or JPEG.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panorama {
    /// The file, seen from the folder of the world's own file.
    pub file: Spanned<String>,
    /// Mean radiance within 45 degrees of the horizon, to which the picture is scaled.
    pub mean: Option<Level>,
    /// Where it was taken: it is projected on the room from there. Without it, it is distant.
    pub eye: Option<[Coordinate; 3]>,
    /// How far it is turned, counter-clockwise from above.
    pub turn_deg: Option<super::quantity::Degrees>,
    /// Name of the light that it follows in time.
    pub follows: Option<Spanned<String>>,
}

/// Where the sunlight on solids comes from.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sun {
    /// Towards the sun: any length but 0.
    pub towards: [Coordinate; 3],
    /// Its share of the light on a face that is turned to it; the rest comes from above.
    pub share: Share,
}
