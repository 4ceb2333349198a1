//! Several rays from one point at once: which surface each meets first.
//!
//! The rays lie side by side in arrays, so that the compiler tests a surface against all of them with
//! a few instructions each. Ray by ray the arithmetic, and so the result, is that of
//! [`SeenSurface::hit`].

use nalgebra::Vector3;

use super::surface::{Hit, SeenSurface};

/// Rays in a fan.
pub const FAN: usize = 8;

/// No surface.
const NONE: u32 = u32::MAX;

/// Rays from one point, and what each has met so far.
#[derive(Debug)]
pub struct Fan {
    x: [f32; FAN],
    y: [f32; FAN],
    z: [f32; FAN],
    /// Index of the nearest surface so far.
    surface: [u32; FAN],
    distance_m: [f32; FAN],
    u_m: [f32; FAN],
    v_m: [f32; FAN],
    cos_incidence: [f32; FAN],
}

impl Fan {
    /// Rays in unit directions that have met nothing yet.
    pub fn new(ways: &[Vector3<f32>; FAN]) -> Self {
        Self {
            x: ways.map(|way| way.x),
            y: ways.map(|way| way.y),
            z: ways.map(|way| way.z),
            surface: [NONE; FAN],
            distance_m: [f32::INFINITY; FAN],
            u_m: [0.0; FAN],
            v_m: [0.0; FAN],
            cos_incidence: [0.0; FAN],
        }
    }

    /// What each ray meets first.
    pub fn first_hits<'a>(mut self, surfaces: &[SeenSurface<'a>]) -> [Option<Hit<'a>>; FAN] {
        for (index, surface) in (0..).zip(surfaces) {
            self.meet(index, surface);
        }
        core::array::from_fn(|ray| {
            let surface = surfaces.get(self.surface[ray] as usize)?;
            let place_m = (self.u_m[ray], self.v_m[ray]);
            Some(surface.hit_at(self.distance_m[ray], place_m, self.cos_incidence[ray]))
        })
    }

    fn meet(&mut self, index: u32, surface: &SeenSurface<'_>) {
        let cos_incidence = self.along(surface.normal()).map(|along| -along);
        let height_m = surface.height_m();
        let nearer = |ray: usize| cos_incidence[ray] * self.distance_m[ray] > height_m;
        // Most surfaces are behind, or hidden, for all of them.
        let mut any = false;
        for ray in 0..FAN {
            any |= nearer(ray);
        }
        if !any {
            return;
        }
        let (u, v) = (self.along(surface.u_axis()), self.along(surface.v_axis()));
        let (foot_u_m, foot_v_m) = surface.foot_m();
        let (u_range, v_range) = surface.extent_m();
        for ray in 0..FAN {
            let distance_m = height_m / cos_incidence[ray];
            let u_m = foot_u_m + distance_m * u[ray];
            let v_m = foot_v_m + distance_m * v[ray];
            let met = (cos_incidence[ray] * self.distance_m[ray] > height_m)
                & (u_m >= u_range.0)
                & (u_m <= u_range.1)
                & (v_m >= v_range.0)
                & (v_m <= v_range.1);
            let take = |new: f32, old: f32| if met { new } else { old };
            self.surface[ray] = if met { index } else { self.surface[ray] };
            self.distance_m[ray] = take(distance_m, self.distance_m[ray]);
            self.u_m[ray] = take(u_m, self.u_m[ray]);
            self.v_m[ray] = take(v_m, self.v_m[ray]);
            self.cos_incidence[ray] = take(cos_incidence[ray], self.cos_incidence[ray]);
        }
    }

    /// The component of each direction along an axis.
    #[inline]
    fn along(&self, axis: &Vector3<f32>) -> [f32; FAN] {
        core::array::from_fn(|ray| {
            self.x[ray] * axis.x + self.y[ray] * axis.y + self.z[ray] * axis.z
        })
    }
}
