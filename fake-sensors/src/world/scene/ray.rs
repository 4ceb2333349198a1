//! What pixels look along: rays that widen.

use nalgebra::Vector3;

use super::fan::{Directions, FAN};
use crate::vectors::eight::Eight;

/// How wide a pixel is, seen from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aperture {
    /// Level width in radians.
    pub across_rad: f32,
    /// Height in radians.
    pub up_rad: f32,
    /// Their geometric mean: the width of a square of the same area.
    mean_rad: f32,
}

impl Aperture {
    /// A pixel of the given width and height.
    #[must_use]
    pub fn new(across_rad: f32, up_rad: f32) -> Self {
        Self {
            across_rad,
            up_rad,
            mean_rad: (across_rad * up_rad).sqrt(),
        }
    }

    /// A single line of sight: sees what it meets, all or nothing.
    pub(super) const POINT: Self = Self {
        across_rad: 1e-6,
        up_rad: 1e-6,
        mean_rad: 1e-6,
    };

    /// Width of a square of the same area, in radians.
    pub(super) fn mean_rad(&self) -> f32 {
        self.mean_rad
    }
}

/// A ray from one point.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vector3<f32>,
    /// Unit vector.
    pub direction: Vector3<f32>,
    /// Half the pixel's width as a square, per metre of distance.
    pub half_mean: f32,
}

impl Ray {
    /// The point at `distance_m`.
    #[inline(always)]
    pub fn at(&self, distance_m: f32) -> Vector3<f32> {
        self.origin + self.direction * distance_m
    }
}

/// Rays of a fan side by side, with what their tests against solids share.
#[derive(Clone, Copy, Debug)]
pub struct Rays {
    /// Where all of them start.
    pub origin: Vector3<f32>,
    /// Unit vectors: their x, y and z.
    pub direction: [Eight; 3],
    /// One over each component of the directions.
    pub inverse: [Eight; 3],
    /// One over the directions' level lengths.
    pub inverse_level: Eight,
    /// Half the pixels' level widths per metre of distance.
    pub half_across: Eight,
    /// Half their heights per metre of distance.
    pub half_up: Eight,
    /// Half their widths as squares, per metre of distance.
    pub half_mean: Eight,
    /// Half their widest along x, y and z: no solid looks further aside than this.
    pub half_widest: [Eight; 3],
}

/// Components of a direction nearer to 0 count as this, so that all arithmetic stays finite.
const TINY: f32 = 1e-9;

impl Rays {
    /// The rays from `origin` in unit `directions`.
    #[inline(always)]
    pub fn new(origin: Vector3<f32>, directions: &Directions, apertures: &[Aperture; FAN]) -> Self {
        let direction = directions.components();
        let [x, y, z] = direction;
        let half = |width: fn(&Aperture) -> f32| {
            Eight(core::array::from_fn(|ray| 0.5 * width(&apertures[ray])))
        };
        let half_across = half(|aperture| aperture.across_rad);
        let half_up = half(|aperture| aperture.up_rad);
        let half_mean = half(|aperture| aperture.mean_rad);
        let level = half_across.max(half_mean);
        Self {
            origin,
            direction,
            inverse: [inverse(x), inverse(y), inverse(z)],
            inverse_level: Eight::all(1.0) / (x * x + y * y).max(Eight::all(TINY)).sqrt(),
            half_across,
            half_up,
            half_mean,
            half_widest: [level, level, half_up.max(half_mean)],
        }
    }

    /// One of them.
    #[inline(always)]
    pub fn get(&self, ray: usize) -> Ray {
        let [x, y, z] = &self.direction;
        Ray {
            origin: self.origin,
            direction: Vector3::new(x.0[ray], y.0[ray], z.0[ray]),
            half_mean: self.half_mean.0[ray],
        }
    }
}

/// 1 / `x`, finite for all `x`.
#[inline(always)]
pub fn inverse(x: Eight) -> Eight {
    let too_small = x.abs().below(Eight::all(TINY));
    let tiny = Eight(x.0.map(|x| TINY.copysign(x)));
    Eight::all(1.0) / too_small.select(tiny, x)
}
