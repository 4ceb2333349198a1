//! A bounding volume hierarchy with four children a node, for rays that widen.
//!
//! A child's box is tested against the eight rays of a fan at once. Before the test it is grown by half the
//! pixel's width at its far end. Where a pixel is wide against a box, the box's [`Haze`] stands for what is
//! in it.

mod grow;
mod walk;

use nalgebra::Vector3;

use super::haze::Haze;
use super::solid::{Form, Solid};
use grow::grow;

/// Where half a pixel's width is more than this share of a box's half diagonal, the pixel sees the box's haze.
pub(super) const BLURRED: f32 = 0.12;

/// Where a child leads.
#[derive(Clone, Copy, Debug)]
pub(super) enum Child {
    Nothing,
    Node(u32),
    /// First solid and their number.
    Leaf(u32, u32),
}

/// A box with its four children.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Middles of the children's boxes: x, y, z of the four.
    pub(super) middle: [[f32; 4]; 3],
    /// Their half lengths; negative where there is no child.
    pub(super) half: [[f32; 4]; 3],
    /// Their half diagonals.
    pub(super) radius: [f32; 4],
    pub(super) children: [Child; 4],
    pub(super) haze: [Option<Haze>; 4],
}

/// Solids in a tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    pub(super) nodes: Vec<Node>,
    pub(super) solids: Vec<Solid>,
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
}

impl Node {
    /// The ball that fills a child's box, as round as may be.
    pub(super) fn ball(&self, lane: usize) -> Solid {
        let level_m = 0.5 * (self.half[0][lane] + self.half[1][lane]);
        Solid {
            centre: Vector3::from([0, 1, 2].map(|axis| self.middle[axis][lane])),
            half: Vector3::new(level_m, level_m, self.half[2][lane]),
            form: Form::Ball,
            ragged: 0.0,
            material: 0,
        }
    }
}
