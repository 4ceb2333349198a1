//! What a pixel sees, front to back.

use core::array::from_fn;

use heapless::Vec;

use super::haze::Haze;
use super::ray::Rays;
use super::solid::Solid;
use crate::vectors::eight::{Eight, LANES, Subset};

/// Nearest things that a pixel keeps: what lies behind that many, each covering a part of it, adds
/// next to nothing.
const KEPT: usize = 20;
/// A pixel that shows less than this of what lies behind shows nothing of it.
const OPAQUE: f32 = 1.0 / 10.0;

/// What covers a part of a pixel.
#[derive(Clone, Copy, Debug)]
pub enum Sight<'a> {
    /// A solid.
    Solid(&'a Solid),
    /// Solids too small for the pixel.
    Haze(&'a Haze),
}

/// Something that covers a part of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Cover<'a> {
    /// What it is.
    pub sight: Sight<'a>,
    /// Its distance.
    pub distance_m: f32,
    /// The part that it covers.
    pub share: f32,
}

/// The nearest things in a pixel, nearest first.
#[derive(Clone, Debug)]
pub struct Covers<'a> {
    kept: Vec<Cover<'a>, KEPT>,
    limit_m: f32,
    /// What all together let through, with those that have been dropped.
    through: f32,
    closed: bool,
}

impl<'a> Covers<'a> {
    /// Nothing yet; nothing beyond `limit_m` counts.
    pub fn before(limit_m: f32) -> Self {
        Self {
            kept: Vec::new(),
            limit_m,
            through: 1.0,
            closed: false,
        }
    }

    /// Nothing yet, again; nothing beyond `limit_m` counts.
    #[inline(always)]
    fn begin(&mut self, limit_m: f32) {
        self.kept.clear();
        self.limit_m = limit_m;
        self.through = 1.0;
        self.closed = false;
    }

    /// What lies beyond does not count.
    #[inline(always)]
    pub fn limit_m(&self) -> f32 {
        self.limit_m
    }

    /// Whether all that is behind is hidden.
    #[inline(always)]
    pub fn closed(&self) -> bool {
        self.closed
    }

    /// The things, nearest first.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = &Cover<'a>> {
        self.kept.iter()
    }

    /// Adds a thing; nothing farther than the last that fits counts. Its place depends on its distance
    /// alone, whatever the order of adding.
    #[inline(always)]
    pub fn add(&mut self, cover: Cover<'a>) {
        if cover.distance_m >= self.limit_m || cover.share <= 0.0 {
            return;
        }
        let farther = self.kept.iter().rev();
        let farther = farther.take_while(|kept| kept.distance_m > cover.distance_m);
        let place = self.kept.len() - farther.count();
        if self.kept.is_full() {
            self.kept.pop();
        }
        // The limit keeps out what would come behind the last of a full list, so there is room.
        if self.kept.insert(place, cover).is_ok()
            && self.kept.is_full()
            && let Some(last) = self.kept.last()
        {
            self.limit_m = last.distance_m;
        }
        self.through *= 1.0 - cover.share;
        if self.through < OPAQUE {
            self.close();
        }
    }

    /// Drops what is hidden.
    #[inline(always)]
    fn close(&mut self) {
        let mut through = 1.0;
        for (index, cover) in self.kept.iter().enumerate() {
            through *= 1.0 - cover.share;
            if through < OPAQUE {
                self.limit_m = cover.distance_m;
                self.closed = true;
                self.kept.truncate(index + 1);
                break;
            }
        }
        self.through = through;
    }
}

/// What the pixels of a fan see. It is kept from one fan to the next, which is quicker than to make it anew.
#[derive(Clone, Debug)]
pub struct Pixels<'a> {
    covers: [Covers<'a>; LANES],
    limits_m: Eight,
    all: Subset,
}

impl<'a> Pixels<'a> {
    /// No pixel yet.
    #[must_use]
    pub fn none() -> Self {
        Self {
            covers: from_fn(|_| Covers::before(0.0)),
            limits_m: Eight::all(0.0),
            all: Subset::NONE,
        }
    }

    /// Nothing yet in the pixels `all`, those of the fan that there are; nothing beyond `limits_m` counts.
    #[inline(always)]
    pub(super) fn begin(&mut self, limits_m: Eight, all: Subset) {
        for (covers, limit_m) in self.covers.iter_mut().zip(limits_m.0) {
            covers.begin(limit_m);
        }
        (self.limits_m, self.all) = (limits_m, all);
    }

    /// Those that there are.
    #[inline(always)]
    pub(super) fn all(&self) -> Subset {
        self.all
    }

    /// What lies beyond does not count, for each.
    #[inline(always)]
    pub(super) fn limits_m(&self) -> Eight {
        self.limits_m
    }

    /// What one of them sees, below [`LANES`].
    #[inline(always)]
    pub(super) fn covers(&self, pixel: usize) -> &Covers<'a> {
        &self.covers[pixel]
    }

    /// Adds a thing to those that it covers a part of, as far away and as large as it is there.
    #[inline(always)]
    pub(super) fn add(&mut self, sight: Sight<'a>, of: Subset, distances_m: Eight, shares: Eight) {
        for pixel in of.iter() {
            self.covers[pixel].add(Cover {
                sight,
                distance_m: distances_m.0[pixel],
                share: shares.0[pixel],
            });
            self.limits_m.0[pixel] = self.covers[pixel].limit_m();
        }
    }

    /// Adds what is in a box that is too small for these pixels: `ball` fills it.
    #[inline(always)]
    pub(super) fn add_haze(&mut self, haze: &'a Haze, ball: &Solid, rays: &Rays, of: Subset) {
        if let Some((touches, met)) = ball.touch_as_ball(rays, self.limits_m) {
            let shares = touches.shares(Eight::all(0.0)) * haze.cover;
            self.add(Sight::Haze(haze), met & of, touches.distance_m, shares);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HAZE: Haze = Haze {
        cover: 1.0,
        radiance: 1.0,
        light: 0,
    };

    fn cover(distance_m: f32, share: f32) -> Cover<'static> {
        Cover {
            sight: Sight::Haze(&HAZE),
            distance_m,
            share,
        }
    }

    fn distances(covers: &Covers<'_>) -> std::vec::Vec<f32> {
        covers.iter().map(|cover| cover.distance_m).collect()
    }

    #[test]
    fn things_lie_in_order_of_distance_whatever_the_order_of_adding() {
        let mut covers = Covers::before(100.0);
        for distance_m in [5.0, 1.0, 3.0, 4.0, 2.0] {
            covers.add(cover(distance_m, 0.1));
        }
        assert_eq!(distances(&covers), [1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn what_is_hidden_is_dropped() {
        let mut covers = Covers::before(100.0);
        covers.add(cover(9.0, 0.5));
        covers.add(cover(4.0, 1.0));
        covers.add(cover(5.0, 0.5));
        covers.add(cover(3.0, 0.5));
        assert_eq!(distances(&covers), [3.0, 4.0]);
        assert!(covers.closed() && covers.limit_m() == 4.0);
    }

    #[test]
    fn the_nearest_are_kept_when_there_are_too_many() {
        let mut covers = Covers::before(100.0);
        for index in (0..2 * KEPT).rev() {
            covers.add(cover(1.0 + index as f32, 0.01));
        }
        let nearest: std::vec::Vec<f32> = (0..KEPT).map(|index| 1.0 + index as f32).collect();
        assert_eq!(distances(&covers), nearest);
        assert!(!covers.closed());
    }
}
