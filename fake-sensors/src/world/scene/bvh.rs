//! A bounding volume hierarchy with four children a node, for rays that widen.
//!
//! The four children's boxes lie side by side in arrays, so that the compiler tests them with one
//! instruction each. A box is grown by half the pixel's width at its far end before the test.

use nalgebra::Vector3;

use super::cover::Covers;
use super::ray::Ray;
use super::solid::Solid;

/// Solids in a leaf at most.
const LEAF: usize = 4;
/// Nodes that wait at most: three on each of the levels that 2^20 solids make, and some.
const WAITING: usize = 64;

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
    /// Sorts `solids` into a tree.
    pub fn new(mut solids: Vec<Solid>) -> Self {
        let mut nodes = Vec::new();
        if !solids.is_empty() {
            grow(&mut nodes, &mut solids, 0);
        }
        Self { nodes, solids }
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Offers `covers` every solid that may touch the pixel and is not hidden, nearest boxes first.
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
            let (order, enters_m) = node.nearest_first(ray);
            // The last to wait is the first to be visited: leaves at once, nodes farthest first.
            for &lane in &order {
                if enters_m[lane] >= covers.limit_m() {
                    break;
                }
                if let Child::Leaf(first, solids) = node.children[lane] {
                    let leaf = first as usize..(first + solids) as usize;
                    self.solids[leaf]
                        .iter()
                        .for_each(|solid| offer(solid, covers));
                }
            }
            for &lane in order.iter().rev() {
                if let Child::Node(child) = node.children[lane]
                    && enters_m[lane] < covers.limit_m()
                    && count < WAITING
                {
                    waiting[count] = (child, enters_m[lane]);
                    count += 1;
                }
            }
        }
    }
}

impl Node {
    /// The children in order of distance, and where the widening ray enters each; infinite if it
    /// does not.
    #[inline]
    fn nearest_first(&self, ray: &Ray) -> ([usize; 4], [f32; 4]) {
        let enters = self.enters_m(ray);
        let mut order = [0, 1, 2, 3];
        // A sorting network for four.
        for (a, b) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if enters[order[b]] < enters[order[a]] {
                order.swap(a, b);
            }
        }
        (order, enters)
    }

    #[inline]
    fn enters_m(&self, ray: &Ray) -> [f32; 4] {
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
        enter
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
fn grow(nodes: &mut Vec<Node>, solids: &mut [Solid], first: usize) -> usize {
    let index = nodes.len();
    nodes.push(Node {
        middle: [[0.0; 4]; 3],
        half: [[f32::NEG_INFINITY; 4]; 3],
        radius: [0.0; 4],
        children: [Child::Nothing; 4],
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
            Child::Node(grow(nodes, part, start) as u32)
        };
        start += part.len();
        let node = &mut nodes[index];
        for axis in 0..3 {
            node.middle[axis][lane] = middle[axis];
            node.half[axis][lane] = extent[axis];
        }
        node.radius[lane] = extent.norm();
        node.children[lane] = child;
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
