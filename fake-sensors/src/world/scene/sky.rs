//! A painted sky.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::world::paint::Tile;

/// Height of the clouds over the camera, in units of the cloud tile's metres.
const CLOUD_HEIGHT_M: f32 = 1.0;
/// Cosine of the angle from the sun's middle where its disc ends: 1.2 degrees, with its glare.
const DISC: f32 = 0.999_78;
/// Sharpness of the glow round the sun.
const GLOW: f32 = 60.0;

/// Radiance from above and from the horizon.
#[derive(Clone, Debug)]
pub struct Sky {
    /// Radiance at the zenith.
    pub zenith: f32,
    /// Radiance just above the skyline.
    pub horizon: f32,
    /// Cloud cover: 0 where the sky is clear, 1 in the middle of a cloud.
    pub clouds: Option<Arc<Tile>>,
    /// Unit vector to the sun, and its radiance.
    pub sun: Option<(Vector3<f32>, f32)>,
    /// Tangent of the elevation up to which something stands on the horizon; its outline.
    pub skyline: f32,
    /// The outline's shape and the radiance of what stands there.
    pub far: Arc<Tile>,
}

impl Sky {
    /// Radiance from unit `direction`, averaged over `width_rad`.
    pub fn radiance(&self, direction: &Vector3<f32>, width_rad: f32) -> f32 {
        let rise = direction.z.max(0.0);
        // The nearer the horizon, the longer the way through the air.
        let haze = (1.0 - rise) * (1.0 - rise) * (1.0 - rise);
        let mut light = self.zenith + (self.horizon - self.zenith) * haze;
        if let Some(clouds) = &self.clouds {
            let distance = CLOUD_HEIGHT_M / rise.max(0.02);
            let footprint = distance * distance * width_rad;
            let [u, v] = [direction.x, direction.y].map(|x| x * distance);
            light += clouds.sample(u, v, footprint) * (self.horizon - 0.5 * light);
        }
        if let Some((towards, radiance)) = &self.sun {
            light += glare(direction.dot(towards), width_rad) * radiance;
        }
        self.before_skyline(direction, width_rad, light)
    }

    /// What stands on the horizon covers the pixel's lower part.
    fn before_skyline(&self, direction: &Vector3<f32>, width_rad: f32, light: f32) -> f32 {
        if direction.z > 2.0 * self.skyline + width_rad {
            return light;
        }
        let level = (direction.x * direction.x + direction.y * direction.y)
            .sqrt()
            .max(1e-3);
        // The outline goes round the horizon on a circle of radius 1 in the tile.
        let [u, v] = [direction.x, direction.y].map(|x| x / level);
        let far = self.far.sample(u, v, width_rad);
        let top = self.skyline * (far / self.far.mean());
        let covered = ((top - direction.z / level) / width_rad + 0.5).clamp(0.0, 1.0);
        light + covered * (far - light)
    }
}

/// Share of a pixel that the sun's disc fills, with the glow of the air round it.
fn glare(cosine: f32, width_rad: f32) -> f32 {
    if cosine <= 0.0 {
        return 0.0;
    }
    // 1 - cos is half the square of a small angle.
    let aside = (2.0 * (1.0 - cosine).max(0.0)).sqrt();
    let disc = (2.0 * (1.0 - DISC)).sqrt();
    let fills = ((disc + 0.5 * width_rad - aside) / width_rad).clamp(0.0, 1.0);
    let dilution = (disc / width_rad).min(1.0);
    fills * dilution + 0.02 / (1.0 + GLOW * aside * aside)
}
