//! Several rays from one point at once: which surface each meets first.
//!
//! The rays lie side by side in arrays, so that the compiler tests a surface against all of them with
//! a few instructions each. For each ray the arithmetic, and so the result, is that of a ray that comes
//! alone.

use nalgebra::{Rotation3, Vector3};

use super::ray::Aperture;
use super::surface::{Hit, SeenSurface, footprint_m};
use crate::vectors::eight::{Eight, LANES};

/// Rays in a fan.
pub const FAN: usize = LANES;

/// No surface.
const NONE: u32 = u32::MAX;

/// Unit vectors side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions {
    x: [f32; FAN],
    y: [f32; FAN],
    z: [f32; FAN],
}

impl Directions {
    /// Of these unit vectors.
    #[must_use]
    pub fn new(ways: &[Vector3<f32>; FAN]) -> Self {
        Self {
            x: ways.map(|way| way.x),
            y: ways.map(|way| way.y),
            z: ways.map(|way| way.z),
        }
    }

    /// Each of them turned.
    #[must_use]
    #[inline(always)]
    pub fn turned(&self, by: &Rotation3<f32>) -> Self {
        let row = |axis: usize| Vector3::new(by[(axis, 0)], by[(axis, 1)], by[(axis, 2)]);
        Self {
            x: self.along(&row(0)),
            y: self.along(&row(1)),
            z: self.along(&row(2)),
        }
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn get(&self, ray: usize) -> Vector3<f32> {
        Vector3::new(self.x[ray], self.y[ray], self.z[ray])
    }

    /// The components of all of them along x, y and z.
    #[inline(always)]
    pub(super) fn components(&self) -> [Eight; 3] {
        [Eight(self.x), Eight(self.y), Eight(self.z)]
    }

    /// The component of each along an axis.
    #[inline(always)]
    fn along(&self, axis: &Vector3<f32>) -> [f32; FAN] {
        core::array::from_fn(|ray| {
            self.x[ray] * axis.x + self.y[ray] * axis.y + self.z[ray] * axis.z
        })
    }
}

/// Rays from one point, and what each has met so far.
#[derive(Debug)]
pub struct Fan<'d> {
    directions: &'d Directions,
    /// Index of the nearest surface so far.
    surface: [u32; FAN],
    distance_m: [f32; FAN],
    u_m: [f32; FAN],
    v_m: [f32; FAN],
    cos_incidence: [f32; FAN],
}

impl<'d> Fan<'d> {
    /// What rays in these directions meet first.
    #[inline(always)]
    pub fn first_hits(directions: &'d Directions, surfaces: &[SeenSurface<'_>]) -> Self {
        let mut fan = Self {
            directions,
            surface: [NONE; FAN],
            distance_m: [f32::INFINITY; FAN],
            u_m: [0.0; FAN],
            v_m: [0.0; FAN],
            cos_incidence: [0.0; FAN],
        };
        for (index, surface) in (0..).zip(surfaces) {
            fan.meet(index, surface);
        }
        fan
    }

    /// What a ray has met, of the same surfaces.
    #[inline(always)]
    pub fn hit<'a>(&self, ray: usize, surfaces: &[SeenSurface<'a>]) -> Option<Hit<'a>> {
        let surface = surfaces.get(self.surface[ray] as usize)?;
        let place_m = (self.u_m[ray], self.v_m[ray]);
        Some(surface.hit_at(self.distance_m[ray], place_m))
    }

    /// How far away what each ray has met is; infinitely, if that is nothing.
    #[inline(always)]
    pub fn distances_m(&self) -> Eight {
        Eight(self.distance_m)
    }

    /// How far a pixel reaches over the surface that its ray has met, in metres.
    #[inline(always)]
    pub fn footprints_m(&self, apertures: &[Aperture; FAN]) -> [f32; FAN] {
        core::array::from_fn(|ray| {
            let width_rad = apertures[ray].mean_rad();
            footprint_m(self.distance_m[ray], width_rad, self.cos_incidence[ray])
        })
    }

    #[inline(always)]
    fn meet(&mut self, index: u32, surface: &SeenSurface<'_>) {
        let height_m = surface.height_m();
        let along = self.directions.along(surface.normal());
        let cos_incidence = along.map(|along| -along);
        let nearer: [u32; FAN] =
            core::array::from_fn(|ray| mask(cos_incidence[ray] * self.distance_m[ray] > height_m));
        // Most surfaces are behind, or hidden, for all of them.
        if nearer.iter().fold(0, |any, nearer| any | nearer) == 0 {
            return;
        }
        let distance_m = cos_incidence.map(|cos| height_m / cos);
        let (foot_u_m, foot_v_m) = surface.foot_m();
        let (u_range, v_range) = surface.extent_m();
        let u_m = self.places_m(foot_u_m, surface.u_axis(), &distance_m);
        let v_m = self.places_m(foot_v_m, surface.v_axis(), &distance_m);
        let met = core::array::from_fn(|ray| {
            nearer[ray] & inside(u_m[ray], u_range) & inside(v_m[ray], v_range)
        });
        self.surface = core::array::from_fn(|ray| index & met[ray] | self.surface[ray] & !met[ray]);
        take(&mut self.distance_m, &distance_m, &met);
        take(&mut self.u_m, &u_m, &met);
        take(&mut self.v_m, &v_m, &met);
        take(&mut self.cos_incidence, &cos_incidence, &met);
    }

    /// Where each ray is along an axis of a plane, at its distance.
    #[inline(always)]
    fn places_m(&self, foot_m: f32, axis: &Vector3<f32>, distance_m: &[f32; FAN]) -> [f32; FAN] {
        let along = self.directions.along(axis);
        core::array::from_fn(|ray| foot_m + distance_m[ray] * along[ray])
    }
}

/// All ones where `condition` holds: what a comparison of several numbers at once gives.
#[inline(always)]
fn mask(condition: bool) -> u32 {
    u32::from(condition).wrapping_neg()
}

#[inline(always)]
fn inside(x: f32, (low, high): (f32, f32)) -> u32 {
    mask(x >= low) & mask(x <= high)
}

/// Takes the new values where the mask is set.
#[inline(always)]
fn take(old: &mut [f32; FAN], new: &[f32; FAN], mask: &[u32; FAN]) {
    *old = core::array::from_fn(|ray| {
        f32::from_bits(new[ray].to_bits() & mask[ray] | old[ray].to_bits() & !mask[ray])
    });
}
