//! What a pixel looks along: a ray that widens.

use nalgebra::Vector3;

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

/// A ray from one point, with what its tests against solids share.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vector3<f32>,
    /// Unit vector.
    pub direction: Vector3<f32>,
    /// One over each component of the direction.
    pub inverse: [f32; 3],
    /// One over the direction's level length.
    pub inverse_level: f32,
    /// Half the pixel's level width per metre of distance.
    pub half_across: f32,
    /// Half its height per metre of distance.
    pub half_up: f32,
    /// Half its width as a square, per metre of distance.
    pub half_mean: f32,
}

/// Components of a direction nearer to 0 count as this, so that all arithmetic stays finite.
const TINY: f32 = 1e-9;

impl Ray {
    /// The ray from `origin` in unit `direction`.
    pub fn new(origin: Vector3<f32>, direction: Vector3<f32>, aperture: &Aperture) -> Self {
        let level = direction.x * direction.x + direction.y * direction.y;
        Self {
            origin,
            direction,
            inverse: [direction.x, direction.y, direction.z].map(inverse),
            inverse_level: 1.0 / level.max(TINY).sqrt(),
            half_across: 0.5 * aperture.across_rad,
            half_up: 0.5 * aperture.up_rad,
            half_mean: 0.5 * aperture.mean_rad,
        }
    }

    /// The point at `distance_m`.
    pub fn at(&self, distance_m: f32) -> Vector3<f32> {
        self.origin + self.direction * distance_m
    }
}

/// 1 / `x`, finite for all `x`.
pub fn inverse(x: f32) -> f32 {
    if x.abs() < TINY {
        1.0 / TINY.copysign(x)
    } else {
        1.0 / x
    }
}
