//! Flat textured rectangles, and what a ray sees of them.

use std::sync::Arc;

use nalgebra::Vector3;

use super::panorama::Projection;
use crate::world::paint::{Texture, Tile};

/// Surfaces reach this far beyond their edges in metres, so that no ray slips between neighbours.
const OVERLAP_M: f32 = 1e-4;

/// What is on a surface, in radiance.
#[derive(Clone, Debug)]
pub enum Skin {
    /// A picture from edge to edge.
    Picture(Texture),
    /// A material, repeated, and the light on it.
    Material(Arc<Tile>, f32),
    /// A panorama, seen from the place where it was taken.
    Projected(Arc<Projection>),
}

/// A rectangle that is visible from the side its normal points to.
#[derive(Clone, Debug)]
pub struct Surface {
    corner: Vector3<f32>,
    /// Unit vectors along the texture's columns and rows; the normal is u x v.
    u_axis: Vector3<f32>,
    v_axis: Vector3<f32>,
    normal: Vector3<f32>,
    width_m: f32,
    height_m: f32,
    skin: Skin,
    /// Index of the light that it follows.
    light: u8,
}

/// A surface as seen from one point.
#[derive(Clone, Copy, Debug)]
pub struct SeenSurface<'a> {
    surface: &'a Surface,
    /// Height of the viewpoint above the surface's plane in metres; positive on the visible side.
    height_m: f32,
    /// The viewpoint's foot in the surface's plane.
    u_m: f32,
    v_m: f32,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    surface: &'a Surface,
    pub distance_m: f32,
    u_m: f32,
    v_m: f32,
}

impl Surface {
    /// A rectangle with its texture's origin at `corner`; `u_axis` and `v_axis` are orthogonal unit
    /// vectors.
    pub fn new(
        corner: Vector3<f32>,
        (u_axis, width_m): (Vector3<f32>, f32),
        (v_axis, height_m): (Vector3<f32>, f32),
        skin: Skin,
        light: u8,
    ) -> Self {
        Self {
            corner,
            u_axis,
            v_axis,
            normal: u_axis.cross(&v_axis),
            width_m,
            height_m,
            skin,
            light,
        }
    }

    /// The surface from `viewpoint`, or `None` if that shows its back.
    pub fn seen_from(&self, viewpoint: Vector3<f32>) -> Option<SeenSurface<'_>> {
        let offset = viewpoint - self.corner;
        let height_m = offset.dot(&self.normal);
        (height_m > 0.0).then(|| SeenSurface {
            surface: self,
            height_m,
            u_m: offset.dot(&self.u_axis),
            v_m: offset.dot(&self.v_axis),
        })
    }
}

impl<'a> SeenSurface<'a> {
    /// The surface's unit normal, to the visible side.
    pub fn normal(&self) -> &'a Vector3<f32> {
        &self.surface.normal
    }

    /// Unit vector along the texture's columns.
    pub fn u_axis(&self) -> &'a Vector3<f32> {
        &self.surface.u_axis
    }

    /// Unit vector along the texture's rows.
    pub fn v_axis(&self) -> &'a Vector3<f32> {
        &self.surface.v_axis
    }

    /// Height of the viewpoint above the surface's plane in metres, above zero.
    pub fn height_m(&self) -> f32 {
        self.height_m
    }

    /// The viewpoint's foot in the surface's plane: along u and v, in metres.
    pub fn foot_m(&self) -> (f32, f32) {
        (self.u_m, self.v_m)
    }

    /// From where to where the surface reaches along u, and along v, in metres.
    pub fn extent_m(&self) -> ((f32, f32), (f32, f32)) {
        let reach = |extent_m| (-OVERLAP_M, extent_m + OVERLAP_M);
        (reach(self.surface.width_m), reach(self.surface.height_m))
    }

    /// A ray that meets the surface at `(u_m, v_m)`.
    pub fn hit_at(&self, distance_m: f32, (u_m, v_m): (f32, f32)) -> Hit<'a> {
        Hit {
            surface: self.surface,
            distance_m,
            u_m,
            v_m,
        }
    }
}

impl Hit<'_> {
    /// Radiance of the skin, averaged over a footprint.
    #[inline(always)]
    pub fn radiance_over(&self, footprint_m: f32) -> f32 {
        let (u_m, v_m) = (self.u_m, self.v_m);
        match &self.surface.skin {
            Skin::Picture(texture) => texture.sample(u_m, v_m, footprint_m),
            Skin::Material(tile, gain) => gain * tile.sample(u_m, v_m, footprint_m),
            Skin::Projected(projection) => {
                let surface = self.surface;
                let point = surface.corner + surface.u_axis * u_m + surface.v_axis * v_m;
                projection.radiance(&point, footprint_m)
            }
        }
    }

    /// Index of the light that the surface follows.
    pub fn light(&self) -> usize {
        self.surface.light.into()
    }
}

/// The footprint on a surface of a pixel that is `width_rad` wide is a slanted ellipse: the diameter
/// of the circle of the same area, but for a constant.
#[inline(always)]
pub fn footprint_m(distance_m: f32, width_rad: f32, cos_incidence: f32) -> f32 {
    distance_m * width_rad / cos_incidence.sqrt()
}
