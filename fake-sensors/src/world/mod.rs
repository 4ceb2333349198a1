//! Worlds: what a camera can look at.
//!
//! A world's frame is that of the route flown in it: x north, y west, z up, in metres; the origin
//! is the route's start, on the floor. Worlds are described in TOML (see `description`), built from a
//! seed, and seen from a point at a time: things move, light changes.
//!
//! | room | what it does |
//! | --- | --- |
//! | `description` | what a file may say, and its errors with their line |
//! | `build` | from a description to a scene |
//! | `paint` | textures from a seed, by named painters |
//! | `scene` | surfaces, solids, their tree, what a ray sees |
//! | `library` | the worlds that come with the crate |

mod build;
mod description;
mod error;
mod library;
mod paint;
mod scene;

use std::path::Path;
use std::sync::Arc;

use nalgebra::Vector3;

pub use error::{Reason, UnknownWorld, WorldError};
pub use scene::Viewpoint;
pub use scene::cover::Pixels;
pub use scene::fan::{Directions, FAN};
pub use scene::ray::Aperture;

use build::{Built, Files};
use description::quantity::metres;
use description::{Description, line_of};
use scene::Scene;

/// The names that [`World::named`] knows.
pub const WORLD_NAMES: [&str; library::NAMES.len()] = library::NAMES;

/// What a line of a world's plan stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// The outline of the room.
    Wall,
    /// A free-standing panel, or the outline of what stands in the room.
    Panel,
}

/// A vertical surface seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanLine {
    /// What stands there.
    pub structure: Structure,
    /// One end: x, y in metres.
    pub from_m: [f32; 2],
    /// The other end.
    pub to_m: [f32; 2],
}

/// A rectangle on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Its corner with the least x and y, in metres.
    pub low_m: [f32; 2],
    /// The opposite corner.
    pub high_m: [f32; 2],
}

/// A place with what stands and moves in it. Cheap to clone: the scene is shared.
#[derive(Clone, Debug)]
pub struct World {
    scene: Arc<Scene>,
    plan: Arc<[PlanLine]>,
    free: Option<Rectangle>,
    about: Arc<str>,
}

impl World {
    /// Builds the world `name`; `seed` fixes its textures and all that its description leaves open.
    ///
    /// # Errors
    /// [`UnknownWorld`] if `name` is not one of [`WORLD_NAMES`].
    ///
    /// # Panics
    /// Never: every world of the library is built in a test.
    pub fn named(name: &str, seed: u64) -> Result<Self, UnknownWorld> {
        let text = library::description(name).ok_or_else(|| UnknownWorld(name.to_owned()))?;
        let built = Self::build(text, Path::new(name), Files::BuiltIn, seed);
        Ok(built.expect("the worlds of the library are sound"))
    }

    /// Builds the world that a file describes; pictures are looked for beside it.
    ///
    /// # Errors
    /// [`WorldError`] with the file, the line and the reason.
    pub fn from_file(path: &Path, seed: u64) -> Result<Self, WorldError> {
        let text = std::fs::read_to_string(path).map_err(|source| WorldError::Unreadable {
            file: path.to_owned(),
            source,
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::build(&text, path, Files::Folder(folder), seed)
    }

    /// Builds the world that `text` describes, as if it stood in a file at `path`.
    ///
    /// # Errors
    /// As [`from_file`](Self::from_file).
    pub fn from_text(text: &str, path: &Path, seed: u64) -> Result<Self, WorldError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::build(text, path, Files::Folder(folder), seed)
    }

    /// Builds a world of the library, or one that a file describes: `what` is a name or a path.
    ///
    /// # Errors
    /// [`WorldError::Unknown`] if it is neither; otherwise as [`from_file`](Self::from_file).
    pub fn open(what: &str, seed: u64) -> Result<Self, WorldError> {
        let path = Path::new(what);
        if library::description(what).is_none() && path.extension().is_some() {
            return Self::from_file(path, seed);
        }
        Ok(Self::named(what, seed)?)
    }

    /// The names of the library's worlds.
    #[must_use]
    pub fn names() -> &'static [&'static str] {
        &WORLD_NAMES
    }

    fn build(text: &str, path: &Path, files: Files<'_>, seed: u64) -> Result<Self, WorldError> {
        let parsed = Description::parse(text);
        let built = parsed.and_then(|description| {
            let built = build::build(&description, files, seed)?;
            Ok((built, description))
        });
        let (Built { scene, plan }, description) = built.map_err(|mistake| WorldError::Bad {
            file: path.to_owned(),
            line: line_of(text, &mistake.span),
            reason: mistake.reason,
        })?;
        Ok(Self {
            scene: Arc::new(scene),
            plan: plan.into(),
            about: description.about.unwrap_or_default().into(),
            free: description.free.map(|free| {
                let (from, to) = (metres(free.from), metres(free.to));
                Rectangle {
                    low_m: [0, 1].map(|axis: usize| from[axis].min(to[axis])),
                    high_m: [0, 1].map(|axis: usize| from[axis].max(to[axis])),
                }
            }),
        })
    }

    /// Walls, panels and obstacles as lines on the floor, for a picture from above.
    #[must_use]
    pub fn plan(&self) -> &[PlanLine] {
        &self.plan
    }

    /// What it is, in a sentence.
    #[must_use]
    pub fn about(&self) -> &str {
        &self.about
    }

    /// Where a drone may fly, if the description says so.
    #[must_use]
    pub fn free(&self) -> Option<Rectangle> {
        self.free
    }

    /// The world as seen from `position_m` at `time_s` (seconds of flight, from 0), to be asked for
    /// many directions.
    #[must_use]
    pub fn seen_from(&self, position_m: Vector3<f32>, time_s: f64) -> Viewpoint<'_> {
        self.scene.seen_from(position_m, time_s)
    }

    /// Whether nothing stands between two points at time 0.
    #[must_use]
    pub fn clear_between(&self, from_m: Vector3<f32>, to_m: Vector3<f32>) -> bool {
        let way = to_m - from_m;
        let distance_m = way.norm();
        let free_m = self.seen_from(from_m, 0.0).distance_m(way / distance_m);
        free_m.is_none_or(|free_m| free_m >= distance_m)
    }
}

#[cfg(test)]
mod tests;
