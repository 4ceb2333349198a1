//! Equirectangular pictures: what surrounds a world, or is projected on its room.

use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, TAU};
use std::sync::Arc;

use nalgebra::Vector3;

use crate::world::paint::Texture;

/// A picture of every direction.
#[derive(Clone, Debug)]
pub struct Panorama {
    /// One metre of the texture is a radian; a quarter turn is repeated at either side.
    texture: Texture,
    /// How far it is turned counter-clockwise, in radians.
    turn_rad: f32,
}

/// A panorama on a surface, seen from where it was taken.
#[derive(Clone, Debug)]
pub struct Projection {
    /// The picture.
    pub panorama: Arc<Panorama>,
    /// Where it was taken.
    pub eye: Vector3<f32>,
}

impl Panorama {
    /// From radiances row by row, `width` in a row, the zenith first; the picture's middle is at
    /// bearing `turn_rad`, and bearings grow to the left.
    pub fn new(width: usize, texels: &[f32], turn_rad: f32) -> Self {
        let margin = width.div_ceil(4);
        let rows = texels.chunks_exact(width).rev();
        let padded = rows.flat_map(|row| {
            let before = &row[width - margin..];
            let after = &row[..margin];
            [before, row, after].concat()
        });
        let padded: Vec<f32> = padded.collect();
        let texels_per_rad = width as f32 / TAU;
        Self {
            texture: Texture::new(width + 2 * margin, padded, texels_per_rad),
            turn_rad,
        }
    }

    /// Radiance from `direction` (of any length), averaged over `width_rad`.
    #[inline(never)]
    pub fn radiance(&self, direction: &Vector3<f32>, width_rad: f32) -> f32 {
        let level = (direction.x * direction.x + direction.y * direction.y).sqrt();
        let elevation = libm::atan2f(direction.z, level);
        let bearing = libm::atan2f(direction.y, direction.x) - self.turn_rad;
        // From the left edge (bearing +pi) to the right, after the repeated quarter.
        let turns = 0.5 - 0.5 * FRAC_1_PI * bearing;
        let turns = turns - libm::floorf(turns);
        let margin = 0.25 * TAU;
        self.texture
            .sample(margin + TAU * turns, FRAC_PI_2 + elevation, width_rad)
    }
}

impl Projection {
    /// Radiance of `point`, averaged over a footprint of `footprint_m`.
    pub fn radiance(&self, point: &Vector3<f32>, footprint_m: f32) -> f32 {
        let way = point - self.eye;
        let distance_m = way.norm().max(0.01);
        self.panorama.radiance(&way, footprint_m / distance_m)
    }
}
