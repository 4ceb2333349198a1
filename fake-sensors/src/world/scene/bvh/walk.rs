//! The way of a fan's rays through the tree, each ray's nearest boxes first.

use core::array::from_fn;

use super::{BLURRED, Bvh, Child, Node};
use crate::vectors::eight::{Eight, LANES, Subset};
use crate::world::scene::cover::Pixels;
use crate::world::scene::ray::Rays;
use crate::world::scene::solid::Solid;

/// Boxes that wait at most. A ray has at most three waiting on each of the 19 levels that a tree of
/// [`MAX_SOLIDS`] has at worst, and four on the last; each ray may have its own.
///
/// [`MAX_SOLIDS`]: crate::world::build::MAX_SOLIDS
const WAITING: usize = 64 * LANES;

/// The way of a fan's rays through a tree, each ray's nearest boxes first.
///
/// Which solids a ray comes to, and in which order, is what it would be if it came alone: boxes that
/// some rays enter in another order than others wait once for each order.
#[derive(Debug)]
pub struct Walk<'a> {
    tree: &'a Bvh,
    waiting: Queue,
}

impl Bvh {
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

impl<'a> Walk<'a> {
    /// The next solids that may touch a pixel and are not hidden, and the rays that come to them; adds
    /// the haze of boxes on the way that are too far away.
    #[inline(always)]
    pub fn next(&mut self, rays: &Rays, pixels: &mut Pixels<'a>) -> Option<(&'a [Solid], Subset)> {
        let tree = self.tree;
        while let Some(next) = self.waiting.0.pop() {
            let of = next.of & next.enters_m.below(pixels.limits_m()).lanes();
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

/// A box that waits to be visited by the rays that enter it.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    child: Child,
    of: Subset,
    /// Where each of the rays enters.
    enters_m: Eight,
}

impl Waiting {
    const NOTHING: Self = Self {
        child: Child::Nothing,
        of: Subset::NONE,
        enters_m: Eight([0.0; LANES]),
    };

    /// The rays that enter both boxes, and the other one first: earlier, or as early if the other is the `later`
    /// child.
    #[inline(always)]
    fn goes_under(&self, other: &Self, later: bool) -> Subset {
        let both = self.of & other.of;
        if later {
            both.without(other.enters_m.above(self.enters_m).lanes())
        } else {
            both & other.enters_m.below(self.enters_m).lanes()
        }
    }
}

impl Node {
    /// Lets the children wait that the widening rays enter; where a child is too small for a pixel, adds its haze
    /// instead.
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
                    .lanes();
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
        let misses = enter.above(leave).lanes();
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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::*;
    use crate::world::scene::fan::{Directions, FAN};
    use crate::world::scene::ray::Aperture;
    use crate::world::scene::solid::Form;

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
