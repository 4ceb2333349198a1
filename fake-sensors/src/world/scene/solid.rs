//! Convex solids, and which part of a pixel each covers.
//!
//! A pixel of the panoramic camera is 2 to 4 degrees wide: a trunk is narrower than that from 10 m
//! on. A single ray would meet it or not, and the picture would flicker as the camera moves. So every
//! solid tells the *share* of the pixel's square that it covers: the overlap of the square with its
//! outline, along each of the two directions for itself. It changes continuously with the pose.

use core::array::from_fn;
use core::f32::consts::FRAC_PI_4;

use nalgebra::Vector3;

use super::ray::{Rays, inverse};
use crate::vectors::eight::{Eight, Mask, Subset};

/// The form of a solid within its bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A box turned about its vertical axis: cosine and sine of the turn.
    Block([f32; 2]),
    /// An upright cylinder.
    Column,
    /// A ball, flattened or drawn out upwards.
    Ball,
}

/// A convex solid.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    /// Its middle.
    pub centre: Vector3<f32>,
    /// Half its lengths along x, y (before its turn) and z; x and y are equal for round forms.
    pub half: Vector3<f32>,
    /// Its form.
    pub form: Form,
    /// How far its outline strays, as a share of its size.
    pub ragged: f32,
    /// Index of its material.
    pub material: u16,
}

/// How the rays of a fan meet a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touches {
    /// Where each enters, or is nearest to the axis.
    pub distance_m: Eight,
    /// Half the pixel's width there.
    pub half_width_m: Eight,
    /// How far within the outline each ray passes in metres; negative outside.
    pub depth_m: Eight,
    /// Least half extent of the outline.
    pub reach_m: Eight,
    /// Share of the pixel's square covered in the direction in which `depth_m` does not run.
    pub other_share: Eight,
}

impl Touches {
    /// Shares of the pixels covered, if the outline lies `shift_m` further out for each.
    #[inline(always)]
    pub fn shares(&self, shift_m: Eight) -> Eight {
        overlap(self.depth_m + shift_m, self.reach_m, self.half_width_m) * self.other_share
    }
}

impl Solid {
    /// How rays meet the solid, and which of them do, with a part of the pixel at least, nearer than
    /// their `limits_m`; `None` if none can.
    #[inline(always)]
    pub fn touch(&self, rays: &Rays, limits_m: Eight) -> Option<(Touches, Subset)> {
        let (touches, ahead) = match self.form {
            Form::Block(turn) => self.touch_block(rays, turn),
            Form::Column => self.touch_column(rays),
            Form::Ball => self.touch_ball(rays),
        }?;
        Some((touches, self.met(&touches, ahead, limits_m)))
    }

    /// The same of what is known to be a ball.
    #[inline(always)]
    pub fn touch_as_ball(&self, rays: &Rays, limits_m: Eight) -> Option<(Touches, Subset)> {
        let (touches, ahead) = self.touch_ball(rays)?;
        Some((touches, self.met(&touches, ahead, limits_m)))
    }

    /// Those of the rays for which the solid is `ahead` that meet it.
    #[inline(always)]
    fn met(&self, touches: &Touches, ahead: Mask, limits_m: Eight) -> Subset {
        let none = Eight::all(0.0);
        let margin_m = touches.half_width_m + touches.reach_m * self.ragged;
        let met = (touches.depth_m + margin_m).above(none)
            & touches.other_share.above(none)
            & touches.distance_m.below(limits_m)
            & ahead;
        met.lanes()
    }

    /// In the vertical plane through ray and axis nothing changes sideways: the level overlap is that
    /// of two intervals, and so is the upright one.
    #[inline(always)]
    fn touch_column(&self, rays: &Rays) -> Option<(Touches, Mask)> {
        let radius_m = self.half.x;
        let squared = Eight::all(radius_m * radius_m);
        let to_axis = self.centre - rays.origin;
        let [x, y, z] = rays.direction;
        let ahead_m = (x * to_axis.x + y * to_axis.y) * rays.inverse_level;
        let aside_m = (y * to_axis.x - x * to_axis.y) * rays.inverse_level;
        let outside =
            ahead_m.above(Eight::all(0.0)) & (ahead_m * ahead_m + aside_m * aside_m).above(squared);
        let within_m = (squared - aside_m * aside_m).max(Eight::all(0.0)).sqrt();
        let axis_m = ahead_m * rays.inverse_level;
        let half_height_m = rays.half_up * axis_m * rays.inverse_level;
        let height_m = (z * axis_m - to_axis.z).abs();
        let half_m = Eight::all(self.half.z);
        let touches = Touches {
            distance_m: (ahead_m - within_m) * rays.inverse_level,
            half_width_m: rays.half_across * axis_m,
            depth_m: Eight::all(radius_m) - aside_m.abs(),
            reach_m: Eight::all(radius_m),
            other_share: overlap(half_m - height_m, half_m, half_height_m),
        };
        Some((touches, outside))
    }

    /// Scaled upwards so that it becomes a sphere.
    #[inline(always)]
    fn touch_ball(&self, rays: &Rays) -> Option<(Touches, Mask)> {
        let radius_m = self.half.x;
        let upward = radius_m / self.half.z;
        let to_centre = self.centre - rays.origin;
        let to_centre = Vector3::new(to_centre.x, to_centre.y, to_centre.z * upward);
        let away_squared = to_centre.norm_squared();
        if away_squared <= radius_m * radius_m {
            return None;
        }
        let [x, y, z] = rays.direction;
        let z = z * upward;
        let length_squared = x * x + y * y + z * z;
        let ahead = (x * to_centre.x + y * to_centre.y + z * to_centre.z) / length_squared;
        let away_squared = Eight::all(away_squared);
        let none = Eight::all(0.0);
        let aside_squared = (away_squared - ahead * ahead * length_squared).max(none);
        let half_width_m = rays.half_mean * ahead;
        let reach_m = half_width_m + radius_m * (1.0 + self.ragged);
        let near = ahead.above(none) & aside_squared.below(reach_m * reach_m);
        let squared = Eight::all(radius_m * radius_m);
        let within = ((squared - aside_squared).max(none) / length_squared).sqrt();
        let touches = Touches {
            distance_m: ahead - within,
            half_width_m,
            depth_m: Eight::all(radius_m) - aside_squared.sqrt(),
            reach_m: Eight::all(radius_m),
            // A disc fills that much of its square; it shows once the disc is the smaller.
            other_share: (Eight::all(FRAC_PI_4 * self.half.z) / half_width_m).min(Eight::all(1.0)),
        };
        Some((touches, near))
    }

    /// How far its faces could move inwards until the ray only just meets it: the least over the
    /// pairs of faces that the ray could pass between.
    #[inline(always)]
    fn touch_block(&self, rays: &Rays, [cos, sin]: [f32; 2]) -> Option<(Touches, Mask)> {
        let to_centre = self.centre - rays.origin;
        let middle = [
            cos * to_centre.x + sin * to_centre.y,
            cos * to_centre.y - sin * to_centre.x,
            to_centre.z,
        ];
        let half = [self.half.x, self.half.y, self.half.z];
        if (0..3).all(|axis| middle[axis].abs() <= half[axis]) {
            return None;
        }
        let [x, y, z] = rays.direction;
        let slowness = if sin == 0.0 && cos == 1.0 {
            rays.inverse
        } else {
            [x * cos + y * sin, y * cos - x * sin, z].map(inverse)
        };
        let pace = slowness.map(Eight::abs);
        let near: [Eight; 3] = from_fn(|i| slowness[i] * middle[i] - pace[i] * half[i]);
        let far: [Eight; 3] = from_fn(|i| slowness[i] * middle[i] + pace[i] * half[i]);
        let (mut depth_m, mut reach_m) = (Eight::all(f32::INFINITY), Eight::all(f32::INFINITY));
        let mut other_m = Eight::all(0.0);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let share = Eight::all(1.0) / (pace[i] + pace[j]);
            depth_m = depth_m.min((far[j] - near[i]).min(far[i] - near[j]) * share);
            // The same of a ray through the middle: the outline's half extent.
            let extent_m = (pace[i] * half[i] + pace[j] * half[j]) * share;
            reach_m = reach_m.min(extent_m);
            other_m = other_m.max(extent_m);
        }
        let enter_m = near[0].max(near[1]).max(near[2]);
        let leave_m = far[0].min(far[1]).min(far[2]);
        let none = Eight::all(0.0);
        let ahead = leave_m.max(enter_m).above(none);
        // A ray that misses enters one pair of faces after it has left another: it is nearest between.
        let abreast_m = x * to_centre.x + y * to_centre.y + z * to_centre.z;
        let between_m = abreast_m.max(leave_m).min(enter_m);
        let distance_m = enter_m.above(leave_m).select(between_m, enter_m).max(none);
        let half_width_m = rays.half_mean * distance_m;
        let touches = Touches {
            distance_m,
            half_width_m,
            depth_m,
            reach_m,
            other_share: (other_m / half_width_m).min(Eight::all(1.0)),
        };
        Some((touches, ahead))
    }

    /// The outward normal of the solid's face at `point` (on it or near it).
    #[inline(always)]
    pub fn normal(&self, point: &Vector3<f32>) -> Vector3<f32> {
        let out = point - self.centre;
        match self.form {
            Form::Column => {
                let level = Vector3::new(out.x, out.y, 0.0);
                level / level.norm().max(f32::MIN_POSITIVE)
            }
            Form::Ball => {
                let (a, c) = (self.half.x * self.half.x, self.half.z * self.half.z);
                let normal = Vector3::new(out.x / a, out.y / a, out.z / c);
                normal / normal.norm().max(f32::MIN_POSITIVE)
            }
            Form::Block([cos, sin]) => {
                let local = [cos * out.x + sin * out.y, cos * out.y - sin * out.x, out.z];
                let [x, y, z] = core::array::from_fn(|i| local[i] / self.half[i]);
                if z.abs() >= x.abs().max(y.abs()) {
                    Vector3::new(0.0, 0.0, 1.0_f32.copysign(z))
                } else if x.abs() >= y.abs() {
                    Vector3::new(cos, sin, 0.0) * 1.0_f32.copysign(x)
                } else {
                    Vector3::new(-sin, cos, 0.0) * 1.0_f32.copysign(y)
                }
            }
        }
    }

    /// Half the lengths of the box along the axes that holds the solid with its ragged outline.
    pub fn bounds(&self) -> Vector3<f32> {
        let half = match self.form {
            Form::Block([cos, sin]) => {
                let (cos, sin) = (cos.abs(), sin.abs());
                let (x, y) = (self.half.x, self.half.y);
                Vector3::new(cos * x + sin * y, sin * x + cos * y, self.half.z)
            }
            Form::Column | Form::Ball => self.half,
        };
        half * (1.0 + self.ragged)
    }
}

/// Shares of intervals of half width `half_m` that lie within those of half width `reach_m`, whose
/// edges are `depth_m` beyond the first ones' middles.
#[inline(always)]
fn overlap(depth_m: Eight, reach_m: Eight, half_m: Eight) -> Eight {
    // The middle of the first is (reach - depth) from the middle of the second.
    let aside_m = reach_m - depth_m;
    let low_m = (aside_m - half_m).max(-reach_m);
    let high_m = (aside_m + half_m).min(reach_m);
    ((high_m - low_m) / (half_m * 2.0)).clamp(0.0, 1.0)
}
