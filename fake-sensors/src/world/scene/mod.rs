//! A built world: surfaces, solids, what moves, what is far away, and its lights.

pub mod bvh;
pub mod cover;
pub mod fan;
pub mod haze;
pub mod light;
pub mod motion;
pub mod panorama;
pub mod ray;
mod shading;
#[cfg(test)]
pub mod simple;
pub mod sky;
pub mod solid;
pub mod surface;

use std::sync::Arc;

use nalgebra::Vector3;

use super::paint::Tile;
use crate::vectors::eight::{Eight, Subset};
use crate::vectors::{self, Kernel};
use bvh::Bvh;
use cover::{Covers, Pixels, Sight};
use fan::{Directions, FAN, Fan};
use light::Curve;
use motion::Path;
use panorama::Panorama;
use ray::{Aperture, Ray, Rays};
use sky::Sky;
use solid::Solid;
use surface::{SeenSurface, Surface};

/// Lights of a world at most, with the one that never changes.
pub const MAX_LIGHTS: usize = 8;
/// Index of the light that never changes.
pub const STEADY: u8 = 0;

/// What a solid is made of.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its look, in reflectance.
    pub tile: Arc<Tile>,
    /// Factor on that: its light and brightness. The radiance of what shines.
    pub gain: f32,
    /// Index of the light that it follows.
    pub light: u8,
    /// It shines by itself: no shading.
    pub shines: bool,
}

/// Solids that go along a path together.
#[derive(Clone, Debug)]
pub struct Mover {
    /// Where they go.
    pub path: Path,
    /// The solids at the path's start.
    pub solids: Vec<Solid>,
}

/// What is behind everything.
#[derive(Clone, Debug)]
pub enum Dome {
    /// Nothing: black.
    Nothing,
    /// A painted sky.
    Sky(Sky, u8),
    /// A picture.
    Panorama(Arc<Panorama>, u8),
}

/// The sunlight on solids.
#[derive(Clone, Copy, Debug)]
pub struct Sunlight {
    /// Unit vector to the sun.
    pub towards: Vector3<f32>,
    /// Its share of the light.
    pub share: f32,
}

/// Everything that a camera can see.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Rectangles: few, each asked for every ray.
    pub surfaces: Vec<Surface>,
    /// Solids that stand still.
    pub solids: Bvh,
    /// Things that move.
    pub movers: Vec<Mover>,
    /// What solids are made of.
    pub materials: Vec<Material>,
    /// What is behind everything.
    pub dome: Dome,
    /// The sun on solids.
    pub sunlight: Option<Sunlight>,
    /// Lights after the steady one.
    pub lights: Vec<Curve>,
}

/// A thing that moves, at one time.
#[derive(Clone, Debug)]
struct Moved {
    centre: Vector3<f32>,
    radius_m: f32,
    solids: Vec<Solid>,
}

/// A scene as seen from one point at one time.
#[derive(Clone, Debug)]
pub struct Viewpoint<'a> {
    scene: &'a Scene,
    position_m: Vector3<f32>,
    surfaces: Vec<SeenSurface<'a>>,
    moved: Vec<Moved>,
    levels: [f32; MAX_LIGHTS],
}

impl Scene {
    /// The scene as seen from `position_m` at `time_s`.
    pub fn seen_from(&self, position_m: Vector3<f32>, time_s: f64) -> Viewpoint<'_> {
        let mut surfaces = Vec::with_capacity(self.surfaces.len());
        let seen = |surface| Surface::seen_from(surface, position_m);
        surfaces.extend(self.surfaces.iter().filter_map(seen));
        let mut levels = [1.0; MAX_LIGHTS];
        for (level, curve) in levels[1..].iter_mut().zip(&self.lights) {
            *level = curve.level(time_s);
        }
        Viewpoint {
            scene: self,
            position_m,
            surfaces,
            moved: self.movers.iter().map(|mover| mover.at(time_s)).collect(),
            levels,
        }
    }
}

impl Mover {
    fn at(&self, time_s: f64) -> Moved {
        let offset_m = self.path.offset_m(time_s);
        let solids: Vec<Solid> = self
            .solids
            .iter()
            .map(|solid| Solid {
                centre: solid.centre + offset_m,
                ..*solid
            })
            .collect();
        let low = solids
            .iter()
            .fold(Vector3::repeat(f32::INFINITY), |low, s| {
                low.inf(&(s.centre - s.bounds()))
            });
        let high = solids
            .iter()
            .fold(Vector3::repeat(f32::NEG_INFINITY), |high, s| {
                high.sup(&(s.centre + s.bounds()))
            });
        Moved {
            centre: 0.5 * (low + high),
            radius_m: 0.5 * (high - low).norm(),
            solids,
        }
    }
}

impl Moved {
    /// Which of the rays, as wide as they become, pass through the ball round the thing.
    #[inline(always)]
    fn near(&self, rays: &Rays) -> Subset {
        let to_centre = self.centre - rays.origin;
        let [x, y, z] = rays.direction;
        let along_m = x * to_centre.x + y * to_centre.y + z * to_centre.z;
        let ahead_m = along_m.max(Eight::all(0.0));
        let reach_m = ahead_m * rays.half_across.max(rays.half_up) + self.radius_m;
        let aside_m = [0, 1, 2]
            .map(|axis| Eight::all(to_centre[axis]) - rays.direction[axis] * ahead_m)
            .map(|aside_m| aside_m * aside_m);
        let beside = (aside_m[0] + aside_m[1] + aside_m[2]).above(reach_m * reach_m);
        Subset::ALL.without(beside.lanes())
    }
}

impl Viewpoint<'_> {
    /// Radiance from unit `direction`, averaged over a pixel; 1 is white paper in the world's usual
    /// light.
    #[must_use]
    pub fn radiance(&self, direction: Vector3<f32>, aperture: &Aperture) -> f32 {
        let directions = Directions::new(&[direction; FAN]);
        self.radiances(&directions, &[*aperture; FAN], 1, &mut Pixels::none())[0]
    }

    /// [`Self::radiance`] of the first `count` of several directions, which is quicker than one by one.
    /// `pixels` is room to work in: what it holds before does not matter.
    #[must_use]
    #[inline(always)]
    pub fn radiances<'v>(
        &'v self,
        directions: &Directions,
        apertures: &[Aperture; FAN],
        count: usize,
        pixels: &mut Pixels<'v>,
    ) -> [f32; FAN] {
        let fan = Fan::first_hits(directions, &self.surfaces);
        let footprints_m = fan.footprints_m(apertures);
        let all = Subset::first(count);
        let solid = self.holds_solids();
        let rays = Rays::new(self.position_m, directions, apertures);
        if solid {
            pixels.begin(fan.distances_m(), all);
            self.cover(&rays, pixels);
        }
        let mut radiances = [0.0; FAN];
        for ray in all.iter() {
            let (mut light, mut through) = (0.0, 1.0);
            if solid {
                (light, through) = self.blend(&rays.get(ray), pixels.covers(ray));
            }
            if through > 0.0 {
                let behind = match fan.hit(ray, &self.surfaces) {
                    Some(hit) => hit.radiance_over(footprints_m[ray]) * self.levels[hit.light()],
                    None => self.dome(&directions.get(ray), apertures[ray].mean_rad()),
                };
                light += through * behind;
            }
            radiances[ray] = light;
        }
        radiances
    }

    /// Radiance of what covers a pixel, and how much of what is behind it shows.
    #[inline(always)]
    fn blend(&self, ray: &Ray, covers: &Covers<'_>) -> (f32, f32) {
        let (mut through, mut light) = (1.0, 0.0);
        for cover in covers.iter() {
            light += through * cover.share * self.shade(ray, cover);
            through *= 1.0 - cover.share;
        }
        if covers.closed() {
            // Nothing behind is seen; what little was left is shared out.
            return (light / (1.0 - through), 0.0);
        }
        (light, through)
    }

    #[inline(always)]
    fn holds_solids(&self) -> bool {
        !self.moved.is_empty() || !self.scene.solids.is_empty()
    }

    /// Metres to the nearest surface or solid in unit `direction`; `None` where there is none.
    #[must_use]
    pub fn distance_m(&self, direction: Vector3<f32>) -> Option<f32> {
        let directions = Directions::new(&[direction; FAN]);
        let fan = Fan::first_hits(&directions, &self.surfaces);
        let rays = Rays::new(self.position_m, &directions, &[Aperture::POINT; FAN]);
        let mut pixels = Pixels::none();
        pixels.begin(fan.distances_m(), Subset::only(0));
        self.cover(&rays, &mut pixels);
        let mut covers = pixels.covers(0).iter();
        let solid = covers.find(|cover| cover.share >= 0.5);
        let surface = fan.hit(0, &self.surfaces);
        solid
            .map(|cover| cover.distance_m)
            .or(surface.map(|hit| hit.distance_m))
    }

    /// Whether something is seen in unit `direction`, be it the sky.
    #[must_use]
    pub fn sees_something(&self, direction: Vector3<f32>) -> bool {
        !matches!(self.scene.dome, Dome::Nothing) || self.distance_m(direction).is_some()
    }

    /// Adds to the pixels of a fan what covers them.
    fn cover<'v>(&'v self, rays: &Rays, pixels: &mut Pixels<'v>) {
        vectors::run(Covering {
            viewpoint: self,
            rays,
            pixels,
        });
    }

    /// Adds a solid to those of the pixels `of` a fan that it covers a part of.
    #[inline(always)]
    fn offer<'a>(&'a self, rays: &Rays, of: Subset, solid: &'a Solid, pixels: &mut Pixels<'a>) {
        let Some((touches, met)) = solid.touch(rays, pixels.limits_m()) else {
            return;
        };
        let met = met & of;
        if met.is_empty() {
            return;
        }
        let mut shifts_m = Eight::all(0.0);
        if solid.ragged > 0.0 {
            let reach_m = touches.reach_m * solid.ragged;
            // Bulges smaller than a pixel do not show, nor do those beside it.
            let visible = Eight::all(1.0) - touches.half_width_m / touches.reach_m;
            let edge = (touches.depth_m - touches.half_width_m).below(reach_m);
            let none = Eight::all(0.0);
            let bulges = met & (reach_m.above(none) & visible.above(none) & edge).lanes();
            let most_m = visible * reach_m;
            for ray in bulges.iter() {
                let (distance_m, half_width_m) =
                    (touches.distance_m.0[ray], touches.half_width_m.0[ray]);
                let point = rays.get(ray).at(distance_m);
                shifts_m.0[ray] = most_m.0[ray] * self.bulge(solid, &point, 2.0 * half_width_m);
            }
        }
        let shares = touches.shares(shifts_m);
        pixels.add(Sight::Solid(solid), met, touches.distance_m, shares);
    }
}

/// The inner loop of [`Viewpoint::cover`]: first what moves, then what stands.
struct Covering<'c, 'v> {
    viewpoint: &'v Viewpoint<'v>,
    rays: &'c Rays,
    pixels: &'c mut Pixels<'v>,
}

impl Kernel for Covering<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            viewpoint,
            rays,
            pixels,
        } = self;
        let all = pixels.all();
        let mut moved = viewpoint.moved.iter();
        let mut walk = viewpoint.scene.solids.walk(all);
        loop {
            let (solids, of) = if let Some(moved) = moved.next() {
                (moved.solids.as_slice(), all & moved.near(rays))
            } else if let Some(next) = walk.next(rays, pixels) {
                next
            } else {
                return;
            };
            if of.is_empty() {
                continue;
            }
            for solid in solids {
                viewpoint.offer(rays, of, solid, pixels);
            }
        }
    }
}
