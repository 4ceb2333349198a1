//! What stands, hangs and walks in a world.

use serde::Deserialize;
use toml::Spanned;

use super::paint::Paint;
use super::quantity::{Coordinate, Count, Degrees, Length, Level, Point, Seconds, Share, Speed};

/// Free-standing panels, seen from both sides.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    /// The ends of consecutive panels.
    pub through: Vec<Point>,
    /// From lower to upper edge.
    pub height: Length,
    /// Height of the lower edge above the floor.
    pub base: Option<Coordinate>,
    /// What is on them.
    pub paint: Paint,
}

/// A box.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Its middle on the floor.
    pub at: Point,
    /// Lengths along x and y, and height.
    pub size: [Length; 3],
    /// Height of its lower face above the floor.
    pub base: Option<Coordinate>,
    /// How far it is turned, counter-clockwise from above.
    pub turn_deg: Option<Degrees>,
    /// A material.
    pub paint: Paint,
    /// More of the same.
    pub repeat: Option<Repeat>,
    /// Where it goes.
    pub route: Option<Route>,
}

/// An upright round column.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    /// Its middle on the floor.
    pub at: Point,
    /// Half its width.
    pub radius: Length,
    /// From lower to upper end.
    pub height: Length,
    /// Height of its lower end above the floor.
    pub base: Option<Coordinate>,
    /// A material.
    pub paint: Paint,
    /// More of the same.
    pub repeat: Option<Repeat>,
    /// Where it goes.
    pub route: Option<Route>,
}

/// A ball, flattened or drawn out upwards.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Its middle.
    pub at: [Coordinate; 3],
    /// Half its width and half its height.
    pub radii: [Length; 2],
    /// A material.
    pub paint: Paint,
    /// More of the same.
    pub repeat: Option<Repeat>,
    /// Where it goes.
    pub route: Option<Route>,
}

/// Somebody.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Person {
    /// Where they stand, or begin to walk.
    pub at: Point,
    /// How tall they are; 1.75 m.
    pub height: Option<Length>,
    /// Reflectance of what they wear above and below the waist.
    pub clothes: Option<[Share; 2]>,
    /// Where they walk.
    pub route: Option<Route>,
}

/// A way round, walked for ever: from the start through all places and back to the start.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Route {
    /// The places after the start.
    pub through: Vec<Point>,
    /// How fast.
    pub speed: Speed,
    /// How much of the way is behind at time 0.
    pub ahead_s: Option<Seconds>,
}

/// A grid of copies; the first is the thing itself.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    /// Copies along x, y (and z).
    pub count: Vec<Count>,
    /// Distance from one to the next along x, y (and z).
    pub step: Vec<Coordinate>,
    /// Largest shift of a copy along x and along y; from the seed.
    pub jitter: Option<Length>,
}

/// A lamp: a bright rectangle that shines down, or a bright ball.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// Its middle.
    pub at: [Coordinate; 3],
    /// Lengths along x and y of a flat lamp.
    pub size: Option<[Length; 2]>,
    /// Radius of a ball.
    pub radius: Option<Length>,
    /// Radiance; white paper in the world's own light is 1.
    pub radiance: Level,
    /// More of the same.
    pub repeat: Option<Repeat>,
    /// Name of the light that it follows in time.
    pub follows: Option<Spanned<String>>,
}

/// Trees and bushes, scattered by the seed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grove {
    /// One corner of the rectangle.
    pub from: Point,
    /// The opposite corner.
    pub to: Point,
    /// Area for each tree, in square metres.
    pub tree_area: Length,
    /// Area for each bush, in square metres; none without it.
    pub bush_area: Option<Length>,
    /// Share of the trees that are conifers.
    pub conifers: Option<Share>,
    /// Rectangles (two opposite corners) in which nothing grows.
    #[serde(default)]
    pub glades: Vec<[Point; 2]>,
}

/// A row of plants.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantRow {
    /// One end.
    pub from: Point,
    /// The other.
    pub to: Point,
    /// From plant to plant.
    pub spacing: Length,
    /// Half a plant's width.
    pub radius: Length,
    /// How tall they are.
    pub height: Length,
    /// Height of the bench or bed that they stand on.
    pub base: Option<Coordinate>,
    /// More of the same.
    pub repeat: Option<Repeat>,
    /// Reflectance of the leaves; 0.2.
    pub leaves: Option<Share>,
}

/// A light whose level changes in time.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// What surfaces and lamps call it.
    pub name: Spanned<String>,
    /// Times in seconds, ascending, and levels; linear between, constant before and after.
    pub levels: Spanned<Vec<(Seconds, Level)>>,
    /// When it begins again.
    pub period_s: Option<super::quantity::Duration>,
}
