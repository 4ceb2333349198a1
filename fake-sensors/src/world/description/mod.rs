//! A world as its file describes it, in TOML.
//!
//! Lengths are in metres, angles in degrees, times in seconds. Every number has a range, every table
//! a closed list of keys: what does not fit is refused with the line where it stands.

pub mod paint;
pub mod quantity;
pub mod room;
pub mod things;

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;

use super::error::{Mistake, Reason};
use quantity::Point;
use room::{Ground, Panorama, Room, Sky, Sun};
use things::{Ball, Block, Column, Grove, Lamp, Light, Panel, Person, PlantRow};

/// Everything that a file says.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// What it is, for people.
    pub about: Option<String>,
    /// Where a drone may fly.
    pub free: Option<Free>,
    /// What encloses it.
    pub room: Option<Spanned<Room>>,
    /// What is below, without a room.
    pub ground: Option<Ground>,
    /// What is above, without a room.
    pub sky: Option<Spanned<Sky>>,
    /// A picture of everything around.
    pub panorama: Option<Spanned<Panorama>>,
    /// Where sunlight comes from.
    pub sun: Option<Spanned<Sun>>,
    /// Lights that change in time.
    #[serde(default)]
    pub light: Vec<Light>,
    /// Free-standing panels.
    #[serde(default)]
    pub panel: Vec<Spanned<Panel>>,
    /// Boxes.
    #[serde(default, rename = "box")]
    pub block: Vec<Spanned<Block>>,
    /// Columns.
    #[serde(default)]
    pub column: Vec<Spanned<Column>>,
    /// Balls.
    #[serde(default)]
    pub ball: Vec<Spanned<Ball>>,
    /// People.
    #[serde(default)]
    pub person: Vec<Spanned<Person>>,
    /// Lamps.
    #[serde(default)]
    pub lamp: Vec<Spanned<Lamp>>,
    /// Trees and bushes.
    #[serde(default)]
    pub grove: Vec<Spanned<Grove>>,
    /// Rows of plants.
    #[serde(default)]
    pub plants: Vec<Spanned<PlantRow>>,
}

/// A rectangle clear of obstacles at flight height.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Free {
    /// One corner.
    pub from: Point,
    /// The opposite corner.
    pub to: Point,
}

impl Description {
    /// Reads a description.
    ///
    /// # Errors
    /// The first [`Mistake`]: what is wrong and where.
    pub fn parse(text: &str) -> Result<Self, Mistake> {
        toml::from_str(text).map_err(|error: toml::de::Error| Mistake {
            span: error.span().unwrap_or(0..0),
            reason: Reason::Syntax(error.message().to_owned()),
        })
    }
}

/// The line, from 1, on which a byte of a text stands.
#[must_use]
pub fn line_of(text: &str, span: &Range<usize>) -> usize {
    let before = text.as_bytes().iter().take(span.start);
    1 + before.filter(|byte| **byte == b'\n').count()
}
