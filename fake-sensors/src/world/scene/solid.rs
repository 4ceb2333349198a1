//! Convex solids, and which part of a pixel each covers.
//!
//! A pixel of the panoramic camera is 2 to 4 degrees wide: a trunk is narrower than that from 10 m
//! on. A single ray would meet it or not, and the picture would flicker as the camera moves. So every
//! solid tells the *share* of the pixel's square that it covers: the overlap of the square with its
//! outline, along each of the two directions for itself. It changes continuously with the pose.

use core::f32::consts::FRAC_PI_4;

use nalgebra::Vector3;

use super::ray::{Ray, inverse};

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

/// How a ray meets a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Where it enters, or is nearest to the axis.
    pub distance_m: f32,
    /// Half the pixel's width there.
    pub half_width_m: f32,
    /// How far within the outline the ray passes in metres; negative outside.
    pub depth_m: f32,
    /// Least half extent of the outline.
    pub reach_m: f32,
    /// Share of the pixel's square covered in the direction in which `depth_m` does not run.
    pub other_share: f32,
}

impl Touch {
    /// Share of the pixel covered, if the outline lies `shift_m` further out.
    pub fn share(&self, shift_m: f32) -> f32 {
        overlap(self.depth_m + shift_m, self.reach_m, self.half_width_m) * self.other_share
    }
}

impl Solid {
    /// How the ray meets the solid, nearer than `limit_m`; `None` if no part of the pixel does.
    pub fn touch(&self, ray: &Ray, limit_m: f32) -> Option<Touch> {
        let touch = match self.form {
            Form::Block(turn) => self.touch_block(ray, turn),
            Form::Column => self.touch_column(ray),
            Form::Ball => self.touch_ball(ray),
        };
        touch.filter(|touch| {
            let margin_m = touch.half_width_m + self.ragged * touch.reach_m;
            touch.depth_m + margin_m > 0.0 && touch.other_share > 0.0 && touch.distance_m < limit_m
        })
    }

    /// In the vertical plane through ray and axis nothing changes sideways: the level overlap is that
    /// of two intervals, and so is the upright one.
    fn touch_column(&self, ray: &Ray) -> Option<Touch> {
        let radius_m = self.half.x;
        let to_axis = self.centre - ray.origin;
        let ahead_m =
            (to_axis.x * ray.direction.x + to_axis.y * ray.direction.y) * ray.inverse_level;
        let aside_m =
            (to_axis.x * ray.direction.y - to_axis.y * ray.direction.x) * ray.inverse_level;
        if ahead_m <= 0.0 || ahead_m * ahead_m + aside_m * aside_m <= radius_m * radius_m {
            return None;
        }
        let within_m = (radius_m * radius_m - aside_m * aside_m).max(0.0).sqrt();
        let axis_m = ahead_m * ray.inverse_level;
        let half_width_m = ray.half_across * axis_m;
        let half_height_m = ray.half_up * axis_m * ray.inverse_level;
        let height_m = (ray.direction.z * axis_m - to_axis.z).abs();
        Some(Touch {
            distance_m: (ahead_m - within_m) * ray.inverse_level,
            half_width_m,
            depth_m: radius_m - aside_m.abs(),
            reach_m: radius_m,
            other_share: overlap(self.half.z - height_m, self.half.z, half_height_m),
        })
    }

    /// Scaled upwards so that it becomes a sphere.
    fn touch_ball(&self, ray: &Ray) -> Option<Touch> {
        let radius_m = self.half.x;
        let upward = radius_m / self.half.z;
        let stretch = |v: Vector3<f32>| Vector3::new(v.x, v.y, v.z * upward);
        let to_centre = stretch(self.centre - ray.origin);
        let way = stretch(ray.direction);
        let length_squared = way.norm_squared();
        let ahead = to_centre.dot(&way) / length_squared;
        let away_squared = to_centre.norm_squared();
        if ahead <= 0.0 || away_squared <= radius_m * radius_m {
            return None;
        }
        let aside_squared = (away_squared - ahead * ahead * length_squared).max(0.0);
        let half_width_m = ray.half_mean * ahead;
        let reach_m = radius_m * (1.0 + self.ragged) + half_width_m;
        if aside_squared >= reach_m * reach_m {
            return None;
        }
        let aside_m = aside_squared.sqrt();
        let within = ((radius_m * radius_m - aside_squared).max(0.0) / length_squared).sqrt();
        Some(Touch {
            distance_m: ahead - within,
            half_width_m,
            depth_m: radius_m - aside_m,
            reach_m: radius_m,
            // A disc fills that much of its square; it shows once the disc is the smaller.
            other_share: (FRAC_PI_4 * self.half.z / half_width_m).min(1.0),
        })
    }

    /// How far its faces could move inwards until the ray only just meets it: the least over the
    /// pairs of faces that the ray could pass between.
    fn touch_block(&self, ray: &Ray, turn: [f32; 2]) -> Option<Touch> {
        let into = |v: Vector3<f32>| {
            let [cos, sin] = turn;
            [cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z]
        };
        let middle = into(self.centre - ray.origin);
        let slowness = if turn[1] == 0.0 && turn[0] == 1.0 {
            ray.inverse
        } else {
            into(ray.direction).map(inverse)
        };
        let half = [self.half.x, self.half.y, self.half.z];
        if (0..3).all(|axis| middle[axis].abs() <= half[axis]) {
            return None;
        }
        let pace = slowness.map(f32::abs);
        let near: [f32; 3] = core::array::from_fn(|i| middle[i] * slowness[i] - half[i] * pace[i]);
        let far: [f32; 3] = core::array::from_fn(|i| middle[i] * slowness[i] + half[i] * pace[i]);
        let (mut depth_m, mut reach_m, mut other_m) = (f32::INFINITY, f32::INFINITY, 0.0_f32);
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let share = 1.0 / (pace[i] + pace[j]);
            depth_m = depth_m.min((far[j] - near[i]).min(far[i] - near[j]) * share);
            // The same of a ray through the middle: the outline's half extent.
            let extent_m = (half[i] * pace[i] + half[j] * pace[j]) * share;
            reach_m = reach_m.min(extent_m);
            other_m = other_m.max(extent_m);
        }
        let enter_m = near[0].max(near[1]).max(near[2]);
        let leave_m = far[0].min(far[1]).min(far[2]);
        if leave_m.max(enter_m) <= 0.0 {
            return None;
        }
        // A ray that misses enters one pair of faces after it has left another: it is nearest between.
        let abreast_m = (self.centre - ray.origin).dot(&ray.direction);
        let distance_m = if enter_m > leave_m {
            abreast_m.max(leave_m).min(enter_m).max(0.0)
        } else {
            enter_m.max(0.0)
        };
        let half_width_m = ray.half_mean * distance_m;
        Some(Touch {
            distance_m,
            half_width_m,
            depth_m,
            reach_m,
            other_share: (other_m / half_width_m).min(1.0),
        })
    }

    /// The outward normal of the solid's face at `point` (on it or near it).
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

/// Share of an interval of half width `half_m` that lies within one of half width `reach_m`, whose
/// edge is `depth_m` beyond the first one's middle.
fn overlap(depth_m: f32, reach_m: f32, half_m: f32) -> f32 {
    // The middle of the first is (reach - depth) from the middle of the second.
    let aside_m = reach_m - depth_m;
    let low_m = (aside_m - half_m).max(-reach_m);
    let high_m = (aside_m + half_m).min(reach_m);
    ((high_m - low_m) / (2.0 * half_m)).clamp(0.0, 1.0)
}
