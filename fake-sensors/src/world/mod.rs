//! Worlds: textured surfaces that a camera can look at.
//!
//! A world's frame is that of the route flown in it: x north, y west, z up, in metres; the origin
//! is the route's start, on the floor.

mod arena;
mod canvas;
mod scenery;
mod surface;
mod texture;

use std::sync::Arc;

use nalgebra::Vector3;
use surface::{SeenSurface, Surface};

/// The names that [`World::named`] knows.
pub const WORLD_NAMES: [&str; 2] = ["arena", "arena-panels"];

/// Radiance where no surface is: outside the room.
const NOTHING: f32 = 0.0;

/// No world has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no world named `{0}`; there are: {known}", known = WORLD_NAMES.join(", "))]
pub struct UnknownWorld(pub String);

/// What a line of a world's plan stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// The outline of the room.
    Wall,
    /// A free-standing panel.
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

/// A room with what stands in it. Cheap to clone: the surfaces are shared.
#[derive(Clone, Debug)]
pub struct World {
    surfaces: Arc<[Surface]>,
    plan: Arc<[PlanLine]>,
}

/// A world as seen from one point.
#[derive(Clone, Debug)]
pub struct Viewpoint<'a> {
    surfaces: Vec<SeenSurface<'a>>,
}

impl World {
    /// Builds the world `name`; `seed` fixes its textures.
    ///
    /// # Errors
    /// [`UnknownWorld`] if `name` is not one of [`WORLD_NAMES`].
    pub fn named(name: &str, seed: u64) -> Result<Self, UnknownWorld> {
        match name {
            "arena" => Ok(arena::build(seed, &[])),
            "arena-panels" => Ok(arena::build(seed, &arena::U_ROUTE_PANELS)),
            _ => Err(UnknownWorld(name.to_owned())),
        }
    }

    /// Walls and panels as lines on the floor, for a picture from above.
    #[must_use]
    pub fn plan(&self) -> &[PlanLine] {
        &self.plan
    }

    /// The world as seen from `position_m`, to be asked for many directions.
    #[must_use]
    pub fn seen_from(&self, position_m: Vector3<f32>) -> Viewpoint<'_> {
        let seen = |surface| Surface::seen_from(surface, position_m);
        Viewpoint {
            surfaces: self.surfaces.iter().filter_map(seen).collect(),
        }
    }

    /// Whether nothing stands between two points.
    #[must_use]
    pub fn clear_between(&self, from_m: Vector3<f32>, to_m: Vector3<f32>) -> bool {
        let way = to_m - from_m;
        let distance_m = way.norm();
        let free_m = self.seen_from(from_m).distance_m(way / distance_m);
        free_m.is_none_or(|free_m| free_m >= distance_m)
    }
}

impl Viewpoint<'_> {
    /// Radiance from unit `direction`, averaged over a pixel of `width_rad`; 1 is white paper in
    /// the world's own light.
    #[must_use]
    pub fn radiance(&self, direction: Vector3<f32>, width_rad: f32) -> f32 {
        self.first_hit(&direction)
            .map_or(NOTHING, |hit| hit.radiance(width_rad))
    }

    /// Metres to the nearest surface in unit `direction`; `None` outside the room.
    #[must_use]
    pub fn distance_m(&self, direction: Vector3<f32>) -> Option<f32> {
        self.first_hit(&direction).map(|hit| hit.distance_m)
    }

    fn first_hit(&self, direction: &Vector3<f32>) -> Option<surface::Hit<'_>> {
        let mut nearest = None;
        let mut limit_m = f32::INFINITY;
        for surface in &self.surfaces {
            if let Some(hit) = surface.hit(direction, limit_m) {
                limit_m = hit.distance_m;
                nearest = Some(hit);
            }
        }
        nearest
    }
}

#[cfg(test)]
mod tests;
