//! A bounding volume hierarchy with four children a node, for rays that widen.
//!
//! The four children's boxes lie side by side in arrays, so that the compiler tests them with one
//! instruction each. A box is grown by half the pixel's width at its far end before the test. Where
//! a pixel is wider than a box, the box's [`Haze`] stands for what is in it.

use nalgebra::Vector3;

use super::cover::{Cover, Covers, Sight};
use super::haze::Haze;
use super::ray::Ray;
use super::solid::{Form, Solid};

/// Solids in a leaf at most.
const LEAF: usize = 4;
/// Children that wait at most: three on each of the 19 levels that [`MAX_SOLIDS`] make at worst, and
/// the last four.
///
/// [`MAX_SOLIDS`]: crate::world::build::MAX_SOLIDS
const WAITING: usize = 64;
/// Up to this many solids are split where it is best, more in the middle.
const SWEPT: usize = 4_096;
/// From this many times a box's half diagonal on, half a pixel's width sees its haze.
const BLURRED: f32 = 0.12;
/// Boxes with more solids than this have no haze: they are never that far away.
const HAZY: usize = 512;

/// Where a child leads.
#[derive(Clone, Copy, Debug)]
enum Child {
    Nothing,
    Node(u32),
    /// First solid and their number.
    Leaf(u32, u32),
}

#[derive(Clone, Debug)]
struct Node {
    /// Middles of the children's boxes: x, y, z of the four.
    middle: [[f32; 4]; 3],
    /// Their half lengths; negative where there is no child.
    half: [[f32; 4]; 3],
    /// Their half diagonals.
    radius: [f32; 4],
    children: [Child; 4],
    haze: [Option<Haze>; 4],
}

/// Solids in a tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    solids: Vec<Solid>,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Vector3<f32>,
    high: Vector3<f32>,
}

impl Bounds {
    const NOTHING: Self = Self {
        low: Vector3::new(f32::INFINITY, f32::INFINITY, f32::INFINITY),
        high: Vector3::new(f32::NEG_INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY),
    };

    fn of(solids: &[Solid]) -> Self {
        solids.iter().fold(Self::NOTHING, Self::with)
    }

    /// The box that holds `solid` as well.
    fn with(self, solid: &Solid) -> Self {
        let half = solid.bounds();
        Self {
            low: self.low.inf(&(solid.centre - half)),
            high: self.high.sup(&(solid.centre + half)),
        }
    }

    /// Half the surface; 0 of nothing.
    fn surface(&self) -> f32 {
        let size = (self.high - self.low).sup(&Vector3::zeros());
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

impl Bvh {
    /// Sorts `solids` into a tree; `haze` sums up what is in a box.
    pub fn new(
        mut solids: Vec<Solid>,
        haze: impl Fn(&[Solid], &Vector3<f32>) -> Option<Haze>,
    ) -> Self {
        let mut nodes = Vec::new();
        if !solids.is_empty() {
            grow(&mut nodes, &mut solids, 0, &haze);
        }
        Self { nodes, solids }
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Offers `covers` every solid that may touch the pixel and is not hidden, nearest boxes first;
    /// adds the haze of those that are too far away.
    pub fn visit<'a>(
        &'a self,
        ray: &Ray,
        covers: &mut Covers<'a>,
        mut offer: impl FnMut(&'a Solid, &mut Covers<'a>),
    ) {
        let mut waiting = [(Child::Nothing, 0.0_f32); WAITING];
        let mut count = 0;
        if !self.nodes.is_empty() {
            waiting[0].0 = Child::Node(0);
            count = 1;
        }
        while count > 0 {
            count -= 1;
            let (child, enter_m) = waiting[count];
            if enter_m >= covers.limit_m() {
                continue;
            }
            match child {
                Child::Leaf(first, solids) => {
                    for solid in &self.solids[first as usize..(first + solids) as usize] {
                        offer(solid, covers);
                    }
                }
                Child::Node(node) => {
                    let first_new = count;
                    self.nodes[node as usize].visit(ray, covers, |child, enter_m| {
                        if count >= WAITING {
                            return;
                        }
                        // The last to wait is the next to be visited: the nearest.
                        let mut place = count;
                        while place > first_new && waiting[place - 1].1 < enter_m {
                            waiting[place] = waiting[place - 1];
                            place -= 1;
                        }
                        waiting[place] = (child, enter_m);
                        count += 1;
                    });
                }
                Child::Nothing => {}
            }
        }
    }
}

impl Node {
    /// The ball that fills a child's box, as round as may be.
    fn ball(&self, lane: usize) -> Solid {
        let level_m = 0.5 * (self.half[0][lane] + self.half[1][lane]);
        Solid {
            centre: Vector3::from([0, 1, 2].map(|axis| self.middle[axis][lane])),
            half: Vector3::new(level_m, level_m, self.half[2][lane]),
            form: Form::Ball,
            ragged: 0.0,
            material: 0,
        }
    }

    /// Gives `wait` the children that the widening ray enters, each with the distance; adds the haze
    /// of those that are too far away.
    #[inline]
    fn visit<'a>(&'a self, ray: &Ray, covers: &mut Covers<'a>, mut wait: impl FnMut(Child, f32)) {
        let (enters_m, leaves_m, widths_m) = self.enters_m(ray, covers.limit_m());
        for lane in 0..4 {
            let enter_m = enters_m[lane];
            if enter_m > leaves_m[lane] {
                continue;
            }
            match &self.haze[lane] {
                Some(haze) if widths_m[lane] > BLURRED * self.radius[lane] => {
                    add_haze(haze, &self.ball(lane), ray, covers);
                }
                _ => wait(self.children[lane], enter_m),
            }
        }
    }

    /// Where the widening ray enters each child's box, where it leaves it (earlier, if it misses it or
    /// the box lies beyond `limit_m`), and half the pixel's width there.
    #[inline]
    fn enters_m(&self, ray: &Ray, limit_m: f32) -> ([f32; 4], [f32; 4], [f32; 4]) {
        let origin = [ray.origin.x, ray.origin.y, ray.origin.z];
        let direction = [ray.direction.x, ray.direction.y, ray.direction.z];
        // No solid looks further aside than this, be it level or upward.
        let level = ray.half_across.max(ray.half_mean);
        let widths = [level, level, ray.half_up.max(ray.half_mean)];
        let mut to_middle = [[0.0; 4]; 3];
        let mut reach = [0.0; 4];
        for axis in 0..3 {
            for lane in 0..4 {
                to_middle[axis][lane] = self.middle[axis][lane] - origin[axis];
                reach[lane] += to_middle[axis][lane] * direction[axis];
            }
        }
        for (reach, radius) in reach.iter_mut().zip(&self.radius) {
            *reach = larger(*reach + radius, 0.0);
        }
        let (mut enter, mut leave) = ([0.0; 4], [limit_m; 4]);
        for axis in 0..3 {
            let (slowness, pace) = (ray.inverse[axis], ray.inverse[axis].abs());
            for lane in 0..4 {
                let middle = to_middle[axis][lane] * slowness;
                let half = (self.half[axis][lane] + widths[axis] * reach[lane]) * pace;
                enter[lane] = larger(enter[lane], middle - half);
                leave[lane] = smaller(leave[lane], middle + half);
            }
        }
        (enter, leave, reach.map(|reach| ray.half_mean * reach))
    }
}

/// Adds what is in a box that is too small for the pixel.
fn add_haze<'a>(haze: &'a Haze, ball: &Solid, ray: &Ray, covers: &mut Covers<'a>) {
    if let Some(touch) = ball.touch(ray, covers.limit_m()) {
        covers.add(Cover {
            sight: Sight::Haze(haze),
            distance_m: touch.distance_m,
            share: haze.cover * touch.share(0.0),
        });
    }
}

/// `max` and `min` as one instruction each: of two numbers, neither of them NaN.
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Builds the node over `solids`, which begin at `first`, and gives its index.
fn grow(
    nodes: &mut Vec<Node>,
    solids: &mut [Solid],
    first: usize,
    haze: &impl Fn(&[Solid], &Vector3<f32>) -> Option<Haze>,
) -> usize {
    let index = nodes.len();
    nodes.push(Node {
        middle: [[0.0; 4]; 3],
        half: [[f32::NEG_INFINITY; 4]; 3],
        radius: [0.0; 4],
        children: [Child::Nothing; 4],
        haze: [None; 4],
    });
    let half = split(solids);
    let (left, right) = solids.split_at_mut(half);
    let (left_half, right_half) = (split(left), split(right));
    let (a, b) = left.split_at_mut(left_half);
    let (c, d) = right.split_at_mut(right_half);
    let mut start = first;
    for (lane, part) in [a, b, c, d].into_iter().enumerate() {
        if part.is_empty() {
            continue;
        }
        let bounds = Bounds::of(part);
        let (middle, extent) = (
            0.5 * (bounds.low + bounds.high),
            0.5 * (bounds.high - bounds.low),
        );
        let child = if part.len() <= LEAF {
            Child::Leaf(start as u32, part.len() as u32)
        } else {
            Child::Node(grow(nodes, part, start, haze) as u32)
        };
        start += part.len();
        let node = &mut nodes[index];
        for axis in 0..3 {
            node.middle[axis][lane] = middle[axis];
            node.half[axis][lane] = extent[axis];
        }
        node.radius[lane] = extent.norm();
        node.children[lane] = child;
        node.haze[lane] = (part.len() <= HAZY).then(|| haze(part, &extent)).flatten();
    }
    index
}

/// Sorts `solids` so that the first and the rest lie apart, and gives the number of the first: where
/// the surfaces of the two boxes, weighted by what they hold, are least (Goldsmith & Salmon 1987).
/// Either holds a quarter at least, which bounds the tree's depth.
fn split(solids: &mut [Solid]) -> usize {
    let total = solids.len();
    if total <= 1 {
        return total;
    }
    if total > SWEPT {
        let bounds = Bounds::of(solids);
        sort_along(solids, (bounds.high - bounds.low).imax());
        return total / 2;
    }
    let (mut best, mut best_axis, mut least) = (total / 2, 0, f32::INFINITY);
    for axis in 0..3 {
        sort_along(solids, axis);
        let mut rest = Bounds::NOTHING;
        let mut after = vec![0.0; total];
        for (place, solid) in solids.iter().enumerate().rev() {
            rest = rest.with(solid);
            after[place] = rest.surface();
        }
        let mut first = Bounds::NOTHING;
        for (place, solid) in solids.iter().enumerate().take((3 * total).div_ceil(4)) {
            let cost = first.surface() * place as f32 + after[place] * (total - place) as f32;
            if place >= total.div_ceil(4) && cost < least {
                (best, best_axis, least) = (place, axis, cost);
            }
            first = first.with(solid);
        }
    }
    sort_along(solids, best_axis);
    best
}

/// Stable, so that solids with one middle keep their order.
fn sort_along(solids: &mut [Solid], axis: usize) {
    solids.sort_by(|a, b| a.centre[axis].total_cmp(&b.centre[axis]));
}
