//! A bounding volume hierarchy with four children a node, for rays that widen.
//!
//! The four children's boxes lie side by side in arrays, so that the compiler tests them with one
//! instruction each. A box is grown by half the pixel's width at its far end before the test. Where
//! a pixel is wider than a box, the box's [`Haze`] stands for what is in it.

use core::array::from_fn;

use nalgebra::Vector3;

use super::cover::Pixels;
use super::haze::Haze;
use super::ray::Rays;
use super::solid::{Form, Solid};
use crate::vectors::eight::{Eight, LANES, Subset};

/// Solids in a leaf at most.
const LEAF: usize = 4;
/// Children that wait at most, if each ray has its own: three on each of the 19 levels that [`MAX_SOLIDS`]
/// make at worst, and the last four.
///
/// [`MAX_SOLIDS`]: crate::world::build::MAX_SOLIDS
const WAITING: usize = 64 * LANES;
/// Up to this many solids are split where it is best, more in the middle.
const SWEPT: usize = 4_096;
/// From this many times a box's half diagonal on, half a pixel's width sees its haze.
pub(super) const BLURRED: f32 = 0.12;
/// Boxes with more solids than this have no haze: they are never that far away.
const HAZY: usize = 512;

/// Where a child leads.
#[derive(Clone, Copy, Debug)]
pub(super) enum Child {
    Nothing,
    Node(u32),
    /// First solid and their number.
    Leaf(u32, u32),
}

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

    /// The way of some rays of a fan through the tree.
    #[inline(always)]
    pub fn walk(&self, of: Subset) -> Walk<'_> {
        let mut waiting = Queue(heapless::Vec::new());
        if !self.nodes.is_empty() {
            waiting.add(Waiting {
                child: Child::Node(0),
                of,
                enters_m: Eight::all(0.0),
            });
        }
        Walk {
            tree: self,
            waiting,
        }
    }
}

/// The way of a fan's rays through a tree, each ray's nearest boxes first.
///
/// Which solids a ray comes to, and in which order, is what it would be if it came alone: boxes that
/// some rays enter in another order than others wait once for each order.
#[derive(Debug)]
pub struct Walk<'a> {
    tree: &'a Bvh,
    waiting: Queue,
}

impl<'a> Walk<'a> {
    /// The next solids that may touch a pixel and are not hidden, and the rays that come to them; adds
    /// the haze of boxes on the way that are too far away.
    #[inline(always)]
    pub fn next(&mut self, rays: &Rays, pixels: &mut Pixels<'a>) -> Option<(&'a [Solid], Subset)> {
        let tree = self.tree;
        while let Some(next) = self.waiting.0.pop() {
            let of = next.of & next.enters_m.below(pixels.limits_m()).yes();
            if of.is_empty() {
                continue;
            }
            match next.child {
                Child::Leaf(first, solids) => {
                    return Some((&tree.solids[first as usize..(first + solids) as usize], of));
                }
                Child::Node(node) => {
                    tree.nodes[node as usize].visit(rays, of, pixels, &mut self.waiting);
                }
                Child::Nothing => {}
            }
        }
        None
    }
}

/// Boxes that wait, the next to be visited last.
#[derive(Debug)]
struct Queue(heapless::Vec<Waiting, WAITING>);

impl Queue {
    /// Adds a box; there is room for as many as can come together.
    #[inline(always)]
    fn add(&mut self, next: Waiting) {
        let added = self.0.push(next);
        debug_assert!(added.is_ok(), "a tree deeper than its splits allow");
    }
}

/// A box that waits for the rays that enter it.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    child: Child,
    of: Subset,
    /// Where each of them does.
    enters_m: Eight,
}

impl Waiting {
    const NOTHING: Self = Self {
        child: Child::Nothing,
        of: Subset::NONE,
        enters_m: Eight([0.0; LANES]),
    };
}

impl Waiting {
    /// The rays that enter both boxes, and the other one earlier, or as early if it is the `later` child.
    #[inline(always)]
    fn goes_under(&self, other: &Self, later: bool) -> Subset {
        let both = self.of & other.of;
        if later {
            both.without(other.enters_m.above(self.enters_m).yes())
        } else {
            both & other.enters_m.below(self.enters_m).yes()
        }
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

    /// Lets the children wait that the widening rays enter; adds the haze of those that are too far
    /// away.
    #[inline(always)]
    fn visit<'a>(&'a self, rays: &Rays, of: Subset, pixels: &mut Pixels<'a>, waiting: &mut Queue) {
        let limits_m = pixels.limits_m();
        let mut entered = [Waiting::NOTHING; 4];
        let mut count = 0;
        for lane in 0..4 {
            let child = self.children[lane];
            if matches!(child, Child::Nothing) {
                continue;
            }
            let (enters_m, enter, widths_m) = self.enters_m(lane, rays, limits_m);
            let mut of = of & enter;
            if of.is_empty() {
                continue;
            }
            if let Some(haze) = &self.haze[lane] {
                let blurred = widths_m
                    .above(Eight::all(BLURRED * self.radius[lane]))
                    .yes();
                if !(of & blurred).is_empty() {
                    pixels.add_haze(haze, &self.ball(lane), rays, of & blurred);
                }
                of = of.without(blurred);
                if of.is_empty() {
                    continue;
                }
            }
            entered[count] = Waiting {
                child,
                of,
                enters_m,
            };
            count += 1;
        }
        wait(&entered[..count], waiting);
    }

    /// Where the widening rays enter a child's box, which of them do nearer than `limits_m`, and half
    /// the pixels' width there.
    #[inline(always)]
    fn enters_m(&self, lane: usize, rays: &Rays, limits_m: Eight) -> (Eight, Subset, Eight) {
        let to_middle: [f32; 3] = from_fn(|axis| self.middle[axis][lane] - rays.origin[axis]);
        let [x, y, z] = rays.direction;
        let reach = x * to_middle[0] + y * to_middle[1] + z * to_middle[2];
        let reach = (reach + self.radius[lane]).larger(Eight::all(0.0));
        let (mut enter, mut leave) = (Eight::all(0.0), limits_m);
        for (axis, to_middle) in to_middle.into_iter().enumerate() {
            let (slowness, pace) = (rays.inverse[axis], rays.inverse[axis].abs());
            let middle = slowness * to_middle;
            let half = (rays.half_widest[axis] * reach + self.half[axis][lane]) * pace;
            enter = enter.larger(middle - half);
            leave = leave.smaller(middle + half);
        }
        let misses = enter.above(leave).yes();
        (enter, Subset::ALL.without(misses), rays.half_mean * reach)
    }
}

/// Lets boxes wait so that each ray's nearest is the next to be visited; of two at the same distance,
/// the later child.
#[inline(always)]
fn wait(entered: &[Waiting], waiting: &mut Queue) {
    if let [alone] = entered {
        waiting.add(*alone);
        return;
    }
    let mut left = entered.iter().fold(Subset::NONE, |all, next| all | next.of);
    while !left.is_empty() {
        // In the order of the first ray that is left, for all that agree with it.
        let leader = left.leader();
        let mut order = [0, 1, 2, 3];
        for place in 1..entered.len() {
            let mut at = place;
            let enter_m = entered[order[place]].enters_m.0[leader];
            while at > 0 && entered[order[at - 1]].enters_m.0[leader] < enter_m {
                order.swap(at - 1, at);
                at -= 1;
            }
        }
        let order = &order[..entered.len()];
        let mut agree = left;
        for (place, &under) in order.iter().enumerate() {
            for &over in &order[place + 1..] {
                agree = agree.without(entered[over].goes_under(&entered[under], over < under));
            }
        }
        let agree = agree | Subset::only(leader);
        for &next in order {
            let of = entered[next].of & agree;
            if !of.is_empty() {
                waiting.add(Waiting {
                    of,
                    ..entered[next]
                });
            }
        }
        left = left.without(agree);
    }
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::world::scene::fan::{Directions, FAN};
    use crate::world::scene::ray::Aperture;

    /// Balls in disorder, a few metres round the origin.
    fn balls(places: &[[f32; 3]]) -> Vec<Solid> {
        let ball = |place: &[f32; 3]| Solid {
            centre: Vector3::from(*place),
            half: Vector3::repeat(0.4),
            form: Form::Ball,
            ragged: 0.0,
            material: 0,
        };
        places.iter().map(ball).collect()
    }

    /// Where the solids are that each ray comes to, in this order, where nothing is hidden.
    fn ways(tree: &Bvh, directions: &[[f32; 3]; FAN], of: Subset) -> [Vec<Vector3<f32>>; FAN] {
        let directions = directions.map(|way| Vector3::from(way).normalize());
        let apertures = [Aperture::new(0.05, 0.05); FAN];
        let rays = Rays::new(Vector3::zeros(), &Directions::new(&directions), &apertures);
        let mut pixels = Pixels::none();
        pixels.begin(Eight::all(f32::INFINITY), of);
        let mut walk = tree.walk(of);
        let mut ways: [Vec<Vector3<f32>>; FAN] = Default::default();
        while let Some((solids, of)) = walk.next(&rays, &mut pixels) {
            for ray in of.iter() {
                ways[ray].extend(solids.iter().map(|solid| solid.centre));
            }
        }
        ways
    }

    proptest! {
        #[test]
        fn each_ray_of_a_fan_comes_to_solids_in_the_order_in_which_it_would_come_alone(
            places in prop::collection::vec(prop::array::uniform3(-4.0_f32..4.0), 5..80),
            directions in prop::array::uniform8(prop::array::uniform3(0.1_f32..1.0)),
        ) {
            let tree = Bvh::new(balls(&places), |_, _| None);
            let together = ways(&tree, &directions, Subset::ALL);
            for ray in 0..FAN {
                let alone = ways(&tree, &directions, Subset::only(ray));
                prop_assert_eq!(&together[ray], &alone[ray]);
            }
        }
    }
}
