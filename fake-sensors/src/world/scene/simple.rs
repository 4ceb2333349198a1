//! The renderer for one ray at a time, in plain scalar code. Tests hold the fans of rays, which go through a scene
//! together, against it: to the bit.

use core::f32::consts::FRAC_PI_4;

use nalgebra::Vector3;

use super::bvh::{BLURRED, Bvh, Child, Node};
use super::cover::{Cover, Covers, Sight};
use super::fan::{Directions, FAN, Fan};
use super::ray::{Aperture, Ray};
use super::shading::on_tile;
use super::solid::{Form, Solid};
use super::{Moved, Viewpoint};

/// A component of a direction that is nearer to 0 counts as this.
const TINY: f32 = 1e-9;

/// A ray that widens.
struct Wide {
    ray: Ray,
    half_across: f32,
    half_up: f32,
}

/// How it meets a solid: one ray's part of `Touches`.
struct Touch {
    distance_m: f32,
    half_width_m: f32,
    depth_m: f32,
    reach_m: f32,
    other_share: f32,
}

impl Viewpoint<'_> {
    /// Radiance from unit `direction`, averaged over a pixel.
    pub fn simple_radiance(&self, direction: Vector3<f32>, aperture: &Aperture) -> f32 {
        let directions = Directions::new(&[direction; FAN]);
        let fan = Fan::first_hits(&directions, &self.surfaces);
        let wide = Wide {
            ray: Ray {
                origin: self.position_m,
                direction,
                half_mean: 0.5 * aperture.mean_rad(),
            },
            half_across: 0.5 * aperture.across_rad,
            half_up: 0.5 * aperture.up_rad,
        };
        let mut covers = Covers::before(fan.distances_m().0[0]);
        for moved in self.moved.iter().filter(|moved| wide.passes(moved)) {
            for solid in &moved.solids {
                self.simple_offer(&wide, solid, &mut covers);
            }
        }
        self.simple_visit(&wide, &self.scene.solids, &mut covers);
        let (light, through) = self.blend(&wide.ray, &covers);
        let behind = match fan.hit(0, &self.surfaces) {
            Some(hit) => {
                let footprints_m = fan.footprints_m(&[*aperture; FAN]);
                hit.radiance_over(footprints_m[0]) * self.levels[hit.light()]
            }
            None => self.dome(&direction, aperture.mean_rad()),
        };
        light + through * behind
    }

    /// Depth first, the nearest box first; of two at one distance, the later child.
    fn simple_visit<'a>(&'a self, wide: &Wide, tree: &'a Bvh, covers: &mut Covers<'a>) {
        let mut waiting = Vec::new();
        if !tree.nodes.is_empty() {
            waiting.push((Child::Node(0), 0.0));
        }
        while let Some((child, enter_m)) = waiting.pop() {
            if enter_m >= covers.limit_m() {
                continue;
            }
            match child {
                Child::Leaf(first, solids) => {
                    for solid in &tree.solids[first as usize..(first + solids) as usize] {
                        self.simple_offer(wide, solid, covers);
                    }
                }
                Child::Node(node) => {
                    let node = &tree.nodes[node as usize];
                    let limit_m = covers.limit_m();
                    let mut children = Vec::new();
                    for lane in 0..4 {
                        let (enter_m, leave_m, width_m) = wide.enters_m(node, lane, limit_m);
                        match &node.haze[lane] {
                            _ if enter_m > leave_m => {}
                            Some(haze) if width_m > BLURRED * node.radius[lane] => {
                                if let Some(touch) = wide.touch(&node.ball(lane), covers.limit_m())
                                {
                                    covers.add(Cover {
                                        sight: Sight::Haze(haze),
                                        distance_m: touch.distance_m,
                                        share: haze.cover * touch.share(0.0),
                                    });
                                }
                            }
                            _ => children.push((node.children[lane], enter_m)),
                        }
                    }
                    // Stable: of two at one distance the later child is visited first.
                    children.sort_by(|(_, a), (_, b)| b.total_cmp(a));
                    waiting.extend(children);
                }
                Child::Nothing => {}
            }
        }
    }

    fn simple_offer<'a>(&'a self, wide: &Wide, solid: &'a Solid, covers: &mut Covers<'a>) {
        let Some(touch) = wide.touch(solid, covers.limit_m()) else {
            return;
        };
        let reach_m = solid.ragged * touch.reach_m;
        let visible = 1.0 - touch.half_width_m / touch.reach_m;
        let edge = touch.depth_m - touch.half_width_m < reach_m;
        let mut shift_m = 0.0;
        if reach_m > 0.0 && visible > 0.0 && edge {
            let tile = &self.scene.materials[usize::from(solid.material)].tile;
            let (u, v) = on_tile(solid, &wide.ray.at(touch.distance_m));
            let light = tile.sample(u, v, 2.0 * touch.half_width_m) / tile.mean();
            shift_m = visible * reach_m * (light - 1.0).clamp(-1.0, 1.0);
        }
        covers.add(Cover {
            sight: Sight::Solid(solid),
            distance_m: touch.distance_m,
            share: touch.share(shift_m),
        });
    }
}

impl Touch {
    fn share(&self, shift_m: f32) -> f32 {
        overlap(self.depth_m + shift_m, self.reach_m, self.half_width_m) * self.other_share
    }
}

impl Wide {
    fn passes(&self, moved: &Moved) -> bool {
        let to_centre = moved.centre - self.ray.origin;
        let ahead_m = to_centre.dot(&self.ray.direction).max(0.0);
        let reach_m = moved.radius_m + ahead_m * self.half_across.max(self.half_up);
        (to_centre - self.ray.direction * ahead_m).norm_squared() <= reach_m * reach_m
    }

    /// Where it enters a child's box, where it leaves it, and half its width there.
    fn enters_m(&self, node: &Node, lane: usize, limit_m: f32) -> (f32, f32, f32) {
        let middle = Vector3::from_fn(|axis, _| node.middle[axis][lane]);
        let to_middle = middle - self.ray.origin;
        let far_m = to_middle.dot(&self.ray.direction) + node.radius[lane];
        let far_m = far_m.max(0.0);
        let (mut enter_m, mut leave_m) = (0.0_f32, limit_m);
        for axis in 0..3 {
            let aside = if axis < 2 {
                self.half_across
            } else {
                self.half_up
            };
            let widened = node.half[axis][lane] + aside.max(self.ray.half_mean) * far_m;
            let slowness = inverse(self.ray.direction[axis]);
            let (middle_m, half_m) = (to_middle[axis] * slowness, widened * slowness.abs());
            enter_m = enter_m.max(middle_m - half_m);
            leave_m = leave_m.min(middle_m + half_m);
        }
        (enter_m, leave_m, self.ray.half_mean * far_m)
    }

    fn touch(&self, solid: &Solid, limit_m: f32) -> Option<Touch> {
        let touch = match solid.form {
            Form::Block(turn) => self.touch_block(solid, turn),
            Form::Column => self.touch_column(solid),
            Form::Ball => self.touch_ball(solid),
        };
        touch.filter(|touch| {
            let margin_m = touch.half_width_m + solid.ragged * touch.reach_m;
            touch.depth_m + margin_m > 0.0 && touch.other_share > 0.0 && touch.distance_m < limit_m
        })
    }

    fn touch_column(&self, solid: &Solid) -> Option<Touch> {
        let (radius_m, way) = (solid.half.x, self.ray.direction);
        let to_axis = solid.centre - self.ray.origin;
        let level = 1.0 / (way.x * way.x + way.y * way.y).max(TINY).sqrt();
        let ahead_m = (to_axis.x * way.x + to_axis.y * way.y) * level;
        let aside_m = (to_axis.x * way.y - to_axis.y * way.x) * level;
        if ahead_m <= 0.0 || ahead_m * ahead_m + aside_m * aside_m <= radius_m * radius_m {
            return None;
        }
        let within_m = (radius_m * radius_m - aside_m * aside_m).max(0.0).sqrt();
        let axis_m = ahead_m * level;
        let height_m = (way.z * axis_m - to_axis.z).abs();
        let half_height_m = self.half_up * axis_m * level;
        Some(Touch {
            distance_m: (ahead_m - within_m) * level,
            half_width_m: self.half_across * axis_m,
            depth_m: radius_m - aside_m.abs(),
            reach_m: radius_m,
            other_share: overlap(solid.half.z - height_m, solid.half.z, half_height_m),
        })
    }

    fn touch_ball(&self, solid: &Solid) -> Option<Touch> {
        let radius_m = solid.half.x;
        let upward = radius_m / solid.half.z;
        let stretch = |v: Vector3<f32>| Vector3::new(v.x, v.y, v.z * upward);
        let to_centre = stretch(solid.centre - self.ray.origin);
        let way = stretch(self.ray.direction);
        let length_squared = way.norm_squared();
        let ahead = to_centre.dot(&way) / length_squared;
        let away_squared = to_centre.norm_squared();
        if ahead <= 0.0 || away_squared <= radius_m * radius_m {
            return None;
        }
        let aside_squared = (away_squared - ahead * ahead * length_squared).max(0.0);
        let half_width_m = self.ray.half_mean * ahead;
        let reach_m = radius_m * (1.0 + solid.ragged) + half_width_m;
        if aside_squared >= reach_m * reach_m {
            return None;
        }
        let within = ((radius_m * radius_m - aside_squared).max(0.0) / length_squared).sqrt();
        Some(Touch {
            distance_m: ahead - within,
            half_width_m,
            depth_m: radius_m - aside_squared.sqrt(),
            reach_m: radius_m,
            other_share: (FRAC_PI_4 * solid.half.z / half_width_m).min(1.0),
        })
    }

    fn touch_block(&self, solid: &Solid, [cos, sin]: [f32; 2]) -> Option<Touch> {
        let into = |v: Vector3<f32>| [cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z];
        let to_centre = solid.centre - self.ray.origin;
        let middle = into(to_centre);
        let slowness = into(self.ray.direction).map(inverse);
        let half = [solid.half.x, solid.half.y, solid.half.z];
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
            let extent_m = (half[i] * pace[i] + half[j] * pace[j]) * share;
            reach_m = reach_m.min(extent_m);
            other_m = other_m.max(extent_m);
        }
        let enter_m = near[0].max(near[1]).max(near[2]);
        let leave_m = far[0].min(far[1]).min(far[2]);
        if leave_m.max(enter_m) <= 0.0 {
            return None;
        }
        let mut distance_m = enter_m.max(0.0);
        if enter_m > leave_m {
            let abreast_m = to_centre.dot(&self.ray.direction);
            distance_m = abreast_m.max(leave_m).min(enter_m).max(0.0);
        }
        let half_width_m = self.ray.half_mean * distance_m;
        Some(Touch {
            distance_m,
            half_width_m,
            depth_m,
            reach_m,
            other_share: (other_m / half_width_m).min(1.0),
        })
    }
}

fn overlap(depth_m: f32, reach_m: f32, half_m: f32) -> f32 {
    let aside_m = reach_m - depth_m;
    let low_m = (aside_m - half_m).max(-reach_m);
    let high_m = (aside_m + half_m).min(reach_m);
    ((high_m - low_m) / (2.0 * half_m)).clamp(0.0, 1.0)
}

fn inverse(x: f32) -> f32 {
    if x.abs() < TINY {
        1.0 / TINY.copysign(x)
    } else {
        1.0 / x
    }
}
