//! How the tree is built: by the surface area heuristic.

use nalgebra::Vector3;

use super::{Child, Node};
use crate::world::scene::haze::Haze;
use crate::world::scene::solid::Solid;

/// Solids in a leaf at most.
const LEAF: usize = 4;
/// Up to this many solids are split where it is best, more in the middle.
const SWEPT: usize = 4_096;
/// Boxes with more solids than this have no haze: they are never that far away.
const HAZY: usize = 512;

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

/// Builds the node over `solids`, which begin at `first`, and gives its index.
pub(super) fn grow(
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
