//! A built world: surfaces, solids, what moves, what is far away, and its lights.

pub mod bvh;
pub mod cover;
pub mod fan;
pub mod haze;
pub mod light;
pub mod motion;
pub mod panorama;
pub mod ray;
pub mod sky;
pub mod solid;
pub mod surface;

use std::sync::Arc;

use nalgebra::Vector3;

use super::paint::Tile;
use bvh::Bvh;
use cover::{Cover, Covers, Sight};
use fan::{Directions, FAN, Fan};
use haze::Haze;
use light::Curve;
use motion::Path;
use panorama::Panorama;
use ray::{Aperture, Ray};
use sky::Sky;
use solid::{Form, Solid, Touch};
use surface::{Hit, SeenSurface, Surface};

/// Lights of a world at most, with the one that never changes.
pub const MAX_LIGHTS: usize = 8;
/// Index of the light that never changes.
pub const STEADY: u8 = 0;
/// Radiance where nothing is.
const NOTHING: f32 = 0.0;
/// Share of the overhead light that reaches a face that looks down.
const FROM_BELOW: f32 = 0.35;

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
    /// Whether the widening ray passes through the ball round the thing.
    fn is_near(&self, ray: &Ray) -> bool {
        let to_centre = self.centre - ray.origin;
        let ahead_m = to_centre.dot(&ray.direction).max(0.0);
        let reach_m = self.radius_m + ahead_m * ray.half_across.max(ray.half_up);
        (to_centre - ray.direction * ahead_m).norm_squared() <= reach_m * reach_m
    }
}

impl Viewpoint<'_> {
    /// Radiance from unit `direction`, averaged over a pixel; 1 is white paper in the world's usual
    /// light.
    #[must_use]
    pub fn radiance(&self, direction: Vector3<f32>, aperture: &Aperture) -> f32 {
        self.radiance_of(self.first_hit(&direction), direction, aperture)
    }

    /// [`Self::radiance`] of the first `count` of several directions, which is quicker than one by one.
    #[must_use]
    #[inline(always)]
    pub fn radiances(
        &self,
        directions: &Directions,
        apertures: &[Aperture; FAN],
        count: usize,
    ) -> [f32; FAN] {
        let fan = Fan::first_hits(directions, &self.surfaces);
        let mut radiances = [0.0; FAN];
        if self.holds_solids() {
            for ray in 0..count.min(FAN) {
                let hit = fan.hit(ray, &self.surfaces);
                radiances[ray] = self.radiance_of(hit, directions.get(ray), &apertures[ray]);
            }
            return radiances;
        }
        let footprints_m = fan.footprints_m(apertures);
        for ray in 0..count.min(FAN) {
            radiances[ray] = match fan.hit(ray, &self.surfaces) {
                Some(hit) => hit.radiance_over(footprints_m[ray]) * self.levels[hit.light()],
                None => self.dome(&directions.get(ray), apertures[ray].mean_rad()),
            };
        }
        radiances
    }

    /// Radiance from unit `direction`, where `hit` is the first surface.
    #[inline(never)]
    fn radiance_of(
        &self,
        hit: Option<Hit<'_>>,
        direction: Vector3<f32>,
        aperture: &Aperture,
    ) -> f32 {
        let limit_m = hit.as_ref().map_or(f32::INFINITY, |hit| hit.distance_m);
        if !self.holds_solids() {
            return self.behind(hit.as_ref(), &direction, aperture);
        }
        let ray = Ray::new(self.position_m, direction, aperture);
        let covers = self.covers(&ray, limit_m);
        let (mut through, mut light) = (1.0, 0.0);
        for cover in covers.iter() {
            light += through * cover.share * self.shade(&ray, cover);
            through *= 1.0 - cover.share;
        }
        if covers.closed() {
            // Nothing behind is seen; what little was left is shared out.
            return light / (1.0 - through);
        }
        light + through * self.behind(hit.as_ref(), &direction, aperture)
    }

    fn holds_solids(&self) -> bool {
        !self.moved.is_empty() || !self.scene.solids.is_empty()
    }

    /// Radiance of the surface or the sky behind all solids.
    fn behind(&self, hit: Option<&Hit<'_>>, way: &Vector3<f32>, aperture: &Aperture) -> f32 {
        match hit {
            Some(hit) => hit.radiance(aperture.mean_rad()) * self.levels[hit.light()],
            None => self.dome(way, aperture.mean_rad()),
        }
    }

    /// Metres to the nearest surface or solid in unit `direction`; `None` where there is none.
    #[must_use]
    pub fn distance_m(&self, direction: Vector3<f32>) -> Option<f32> {
        let hit = self.first_hit(&direction);
        let limit_m = hit.as_ref().map_or(f32::INFINITY, |hit| hit.distance_m);
        let ray = Ray::new(self.position_m, direction, &Aperture::POINT);
        let covers = self.covers(&ray, limit_m);
        let solid = covers.iter().find(|cover| cover.share >= 0.5);
        solid
            .map(|cover| cover.distance_m)
            .or(hit.map(|hit| hit.distance_m))
    }

    /// Whether something is seen in unit `direction`, be it the sky.
    #[must_use]
    pub fn sees_something(&self, direction: Vector3<f32>) -> bool {
        !matches!(self.scene.dome, Dome::Nothing) || self.distance_m(direction).is_some()
    }

    fn first_hit(&self, direction: &Vector3<f32>) -> Option<Hit<'_>> {
        let directions = Directions::new(&[*direction; FAN]);
        Fan::first_hits(&directions, &self.surfaces).hit(0, &self.surfaces)
    }

    fn covers(&self, ray: &Ray, limit_m: f32) -> Covers<'_> {
        let mut covers = Covers::before(limit_m);
        for moved in &self.moved {
            if moved.is_near(ray) {
                for solid in &moved.solids {
                    self.offer(ray, solid, &mut covers);
                }
            }
        }
        self.scene.solids.visit(ray, &mut covers, |solid, covers| {
            self.offer(ray, solid, covers)
        });
        covers
    }

    fn offer<'a>(&'a self, ray: &Ray, solid: &'a Solid, covers: &mut Covers<'a>) {
        let Some(touch) = solid.touch(ray, covers.limit_m()) else {
            return;
        };
        let reach_m = solid.ragged * touch.reach_m;
        // Bulges smaller than a pixel do not show, nor do those beside it.
        let visible = 1.0 - touch.half_width_m / touch.reach_m;
        let edge = touch.depth_m - touch.half_width_m < reach_m;
        let shift_m = if reach_m > 0.0 && visible > 0.0 && edge {
            visible * reach_m * self.bulge(ray, solid, &touch)
        } else {
            0.0
        };
        let share = touch.share(shift_m);
        covers.add(Cover {
            sight: Sight::Solid(solid),
            distance_m: touch.distance_m,
            share,
        });
    }

    /// How far a ragged outline lies outside (to 1) or inside (to -1) of the solid's own where the
    /// ray passes: foliage bulges where it is light.
    fn bulge(&self, ray: &Ray, solid: &Solid, touch: &Touch) -> f32 {
        let tile = &self.scene.materials[usize::from(solid.material)].tile;
        let (u, v) = on_tile(solid, &ray.at(touch.distance_m));
        let light = tile.sample(u, v, 2.0 * touch.half_width_m) / tile.mean();
        (light - 1.0).clamp(-1.0, 1.0)
    }

    /// Radiance of what covers a part of a pixel.
    fn shade(&self, ray: &Ray, cover: &Cover<'_>) -> f32 {
        match cover.sight {
            Sight::Solid(solid) => self.shade_solid(ray, solid, cover.distance_m),
            Sight::Haze(haze) => self.shade_haze(ray, haze),
        }
    }

    fn shade_solid(&self, ray: &Ray, solid: &Solid, distance_m: f32) -> f32 {
        let material = &self.scene.materials[usize::from(solid.material)];
        let level = material.gain * self.levels[usize::from(material.light)];
        if material.shines {
            return level;
        }
        let point = ray.at(distance_m);
        let (u, v) = on_tile(solid, &point);
        let footprint_m = 2.0 * ray.half_mean * distance_m;
        let normal = solid.normal(&point);
        let facing = self.sunlight_towards().dot(&normal).max(0.0);
        let light = self.light_on(facing, normal.z);
        level * light * material.tile.sample(u, v, footprint_m)
    }

    /// Light on the visible half of a ball: its mean over the disc. The sun's part is a parabola
    /// through Lambert's sphere at full, half and new phase (2/3, 2/(3 pi), 0).
    fn shade_haze(&self, ray: &Ray, haze: &Haze) -> f32 {
        let phase = -ray.direction.dot(&self.sunlight_towards());
        let facing = 0.212 + phase * (0.333 + phase * 0.121);
        let upward = -2.0 / 3.0 * ray.direction.z;
        self.levels[usize::from(haze.light)] * haze.radiance * self.light_on(facing, upward)
    }

    /// Light on a face that sees the sun under a cosine of `facing` and looks up by `upward`.
    fn light_on(&self, facing: f32, upward: f32) -> f32 {
        let above = FROM_BELOW + (1.0 - FROM_BELOW) * (0.5 + 0.5 * upward);
        match &self.scene.sunlight {
            Some(sun) => sun.share * facing + (1.0 - sun.share) * above,
            None => above,
        }
    }

    fn sunlight_towards(&self) -> Vector3<f32> {
        let sun = self.scene.sunlight.as_ref();
        sun.map_or_else(Vector3::zeros, |sun| sun.towards)
    }

    fn dome(&self, direction: &Vector3<f32>, width_rad: f32) -> f32 {
        match &self.scene.dome {
            Dome::Nothing => NOTHING,
            Dome::Sky(sky, light) => {
                self.levels[usize::from(*light)] * sky.radiance(direction, width_rad)
            }
            Dome::Panorama(picture, light) => {
                self.levels[usize::from(*light)] * picture.radiance(direction, width_rad)
            }
        }
    }
}

/// Where on its material's tile a point of a solid lies: seen along that of the solid's axes which
/// its face is turned to most. Furrows run straight up.
fn on_tile(solid: &Solid, point: &Vector3<f32>) -> (f32, f32) {
    let out = point - solid.centre;
    let [x, y] = match solid.form {
        Form::Block([cos, sin]) => [cos * out.x + sin * out.y, cos * out.y - sin * out.x],
        Form::Column | Form::Ball => [out.x, out.y],
    };
    // Two solids of one material differ: each has its own place on the tile.
    let place = 7.3 * solid.centre.x + 3.1 * solid.centre.y;
    let [along_x, along_y, along_z] = [
        (x / solid.half.x).abs(),
        (y / solid.half.y).abs(),
        (out.z / solid.half.z).abs(),
    ];
    if along_z > along_x.max(along_y) && solid.form != Form::Column {
        (x + place, y)
    } else if along_x > along_y {
        (y + place, out.z)
    } else {
        (x + place, out.z)
    }
}
