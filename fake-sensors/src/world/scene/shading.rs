//! What light comes from where a ray ends: from solids, haze and the dome behind everything.

use nalgebra::Vector3;

use super::cover::{Cover, Sight};
use super::haze::Haze;
use super::ray::Ray;
use super::solid::{Form, Solid};
use super::{Dome, Viewpoint};

/// Radiance where nothing is.
const NOTHING: f32 = 0.0;
/// Share of the overhead light that reaches a face that looks down.
const FROM_BELOW: f32 = 0.35;

impl Viewpoint<'_> {
    /// How far a ragged outline lies outside (to 1) or inside (to -1) of the solid's own where the
    /// ray passes: foliage bulges where it is light.
    #[inline(always)]
    pub(super) fn bulge(&self, solid: &Solid, point: &Vector3<f32>, footprint_m: f32) -> f32 {
        let tile = &self.scene.materials[usize::from(solid.material)].tile;
        let (u, v) = on_tile(solid, point);
        let light = tile.sample(u, v, footprint_m) / tile.mean();
        (light - 1.0).clamp(-1.0, 1.0)
    }

    /// Radiance of what covers a part of a pixel.
    #[inline(always)]
    pub(super) fn shade(&self, ray: &Ray, cover: &Cover<'_>) -> f32 {
        match cover.sight {
            Sight::Solid(solid) => self.shade_solid(ray, solid, cover.distance_m),
            Sight::Haze(haze) => self.shade_haze(ray, haze),
        }
    }

    #[inline(always)]
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
    #[inline(always)]
    fn shade_haze(&self, ray: &Ray, haze: &Haze) -> f32 {
        let phase = -ray.direction.dot(&self.sunlight_towards());
        let facing = 0.212 + phase * (0.333 + phase * 0.121);
        let upward = -2.0 / 3.0 * ray.direction.z;
        self.levels[usize::from(haze.light)] * haze.radiance * self.light_on(facing, upward)
    }

    /// Light on a face that sees the sun under a cosine of `facing` and looks up by `upward`.
    #[inline(always)]
    fn light_on(&self, facing: f32, upward: f32) -> f32 {
        let above = FROM_BELOW + (1.0 - FROM_BELOW) * (0.5 + 0.5 * upward);
        match &self.scene.sunlight {
            Some(sun) => sun.share * facing + (1.0 - sun.share) * above,
            None => above,
        }
    }

    #[inline(always)]
    fn sunlight_towards(&self) -> Vector3<f32> {
        let sun = self.scene.sunlight.as_ref();
        sun.map_or_else(Vector3::zeros, |sun| sun.towards)
    }

    /// Radiance of what is behind everything.
    pub(super) fn dome(&self, direction: &Vector3<f32>, width_rad: f32) -> f32 {
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
#[inline(always)]
pub(super) fn on_tile(solid: &Solid, point: &Vector3<f32>) -> (f32, f32) {
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
