//! What a pixel sees, front to back.

use super::haze::Haze;
use super::solid::Solid;

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
#[derive(Clone, Copy, Debug)]
pub struct Covers<'a> {
    kept: [Option<Cover<'a>>; KEPT],
    count: usize,
    limit_m: f32,
    /// What all together let through, with those that have been dropped.
    through: f32,
    closed: bool,
}

impl<'a> Covers<'a> {
    /// Nothing yet; nothing beyond `limit_m` counts.
    pub fn before(limit_m: f32) -> Self {
        Self {
            kept: [None; KEPT],
            count: 0,
            limit_m,
            through: 1.0,
            closed: false,
        }
    }

    /// What lies beyond does not count.
    pub fn limit_m(&self) -> f32 {
        self.limit_m
    }

    /// Whether all that is behind is hidden.
    pub fn closed(&self) -> bool {
        self.closed
    }

    /// The things, nearest first.
    pub fn iter(&self) -> impl Iterator<Item = &Cover<'a>> {
        self.kept[..self.count].iter().flatten()
    }

    /// Adds a thing; nothing farther than the last that fits counts. Its place depends on its distance alone, whatever the order of adding.
    pub fn add(&mut self, cover: Cover<'a>) {
        if cover.distance_m >= self.limit_m || cover.share <= 0.0 {
            return;
        }
        let farther = self.kept[..self.count].iter().rev().flatten();
        let farther = farther
            .take_while(|kept| kept.distance_m > cover.distance_m)
            .count();
        let place = self.count - farther;
        self.count = (self.count + 1).min(KEPT);
        self.kept[place..self.count].rotate_right(1);
        self.kept[place] = Some(cover);
        if let Some(Some(last)) = self.kept.get(KEPT - 1)
            && self.count == KEPT
        {
            self.limit_m = last.distance_m;
        }
        self.through *= 1.0 - cover.share;
        if self.through < OPAQUE {
            self.close();
        }
    }

    /// Drops what is hidden.
    fn close(&mut self) {
        let mut through = 1.0;
        for (index, cover) in self.kept[..self.count].iter().flatten().enumerate() {
            through *= 1.0 - cover.share;
            if through < OPAQUE {
                self.limit_m = cover.distance_m;
                self.count = index + 1;
                self.closed = true;
                break;
            }
        }
        self.through = through;
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

    fn distances(covers: &Covers<'_>) -> Vec<f32> {
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
        let nearest: Vec<f32> = (0..KEPT).map(|index| 1.0 + index as f32).collect();
        assert_eq!(distances(&covers), nearest);
        assert!(!covers.closed());
    }
}
