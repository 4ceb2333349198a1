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
/// Nodes that wait at most: three on each of the levels that 2^20 solids make, and some.
const WAITING: usize = 64;
/// From this many times a box's half diagonal on, half a pixel's width sees its haze.
const BLURRED: f32 = 0.3;
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
    fn of(solids: &[Solid]) -> Self {
        let nothing = Self {
            low: Vector3::repeat(f32::INFINITY),
            high: Vector3::repeat(f32::NEG_INFINITY),
        };
        solids.iter().fold(nothing, |bounds, solid| Self {
            low: bounds.low.inf(&(solid.centre - solid.bounds())),
            high: bounds.high.sup(&(solid.centre + solid.bounds())),
        })
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
        let mut waiting = [(0_u32, 0.0_f32); WAITING];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let (node, enter_m) = waiting[count];
            if enter_m >= covers.limit_m() {
                continue;
            }
            let node = &self.nodes[node as usize];
            let (order, enters_m, widths_m) = node.nearest_first(ray);
            let first_new = count;
            for &lane in &order {
                if enters_m[lane] >= covers.limit_m() {
                    break;
                }
                if let Some(haze) = &node.haze[lane]
                    && widths_m[lane] > BLURRED * node.radius[lane]
                {
                    add_haze(haze, &node.ball(lane), ray, covers);
                    continue;
                }
                match node.children[lane] {
                    Child::Leaf(first, solids) => {
                        for solid in &self.solids[first as usize..(first + solids) as usize] {
                            offer(solid, covers);
                        }
                    }
                    Child::Node(child) if count < WAITING => {
                        waiting[count] = (child, enters_m[lane]);
                        count += 1;
                    }
                    Child::Node(_) | Child::Nothing => {}
                }
            }
            // The last to wait is the next to be visited: the nearest.
            waiting[first_new..count].reverse();
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

    /// The children in order of distance, where the widening ray enters each (infinite if it does
    /// not), and half the pixel's width there.
    #[inline]
    fn nearest_first(&self, ray: &Ray) -> ([usize; 4], [f32; 4], [f32; 4]) {
        let (enters, widths) = self.enters_m(ray);
        let mut order = [0, 1, 2, 3];
        // A sorting network for four.
        for (a, b) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if enters[order[b]] < enters[order[a]] {
                order.swap(a, b);
            }
        }
        (order, enters, widths)
    }

    #[inline]
    fn enters_m(&self, ray: &Ray) -> ([f32; 4], [f32; 4]) {
        let origin = [ray.origin.x, ray.origin.y, ray.origin.z];
        let direction = [ray.direction.x, ray.direction.y, ray.direction.z];
        let width = ray.half_across.max(ray.half_up);
        let mut to_middle = [[0.0; 4]; 3];
        let mut grown = [0.0; 4];
        for axis in 0..3 {
            for lane in 0..4 {
                to_middle[axis][lane] = self.middle[axis][lane] - origin[axis];
                grown[lane] += to_middle[axis][lane] * direction[axis];
            }
        }
        for lane in 0..4 {
            grown[lane] = width * larger(grown[lane] + self.radius[lane], 0.0);
        }
        let (mut enter, mut leave) = ([0.0; 4], [f32::INFINITY; 4]);
        for axis in 0..3 {
            let (slowness, pace) = (ray.inverse[axis], ray.inverse[axis].abs());
            for lane in 0..4 {
                let middle = to_middle[axis][lane] * slowness;
                let half = (self.half[axis][lane] + grown[lane]) * pace;
                enter[lane] = larger(enter[lane], middle - half);
                leave[lane] = smaller(leave[lane], middle + half);
            }
        }
        for lane in 0..4 {
            if enter[lane] > leave[lane] {
                enter[lane] = f32::INFINITY;
            }
        }
        (enter, grown)
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

/// Puts the half with the smaller middles along the longest axis first, and gives its size.
fn split(solids: &mut [Solid]) -> usize {
    if solids.len() <= 1 {
        return solids.len();
    }
    let bounds = Bounds::of(solids);
    let axis = (bounds.high - bounds.low).imax();
    // Stable, so that solids with one middle keep their order.
    solids.sort_by(|a, b| a.centre[axis].total_cmp(&b.centre[axis]));
    solids.len() / 2
}
