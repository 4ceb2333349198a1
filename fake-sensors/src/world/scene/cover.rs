//! What a pixel sees, front to back.

use super::solid::Solid;

/// Nearest solids that a pixel keeps: what lies behind that many, each covering a part of it, adds
/// next to nothing.
const KEPT: usize = 16;
/// A pixel that shows less than this of what lies behind shows nothing of it.
const OPAQUE: f32 = 1.0 / 128.0;

/// A solid that covers a part of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Cover<'a> {
    /// The solid.
    pub solid: &'a Solid,
    /// Its distance.
    pub distance_m: f32,
    /// The part that it covers.
    pub share: f32,
}

/// The nearest solids in a pixel, nearest first.
#[derive(Clone, Copy, Debug)]
pub struct Covers<'a> {
    kept: [Option<Cover<'a>>; KEPT],
    count: usize,
    limit_m: f32,
}

impl<'a> Covers<'a> {
    /// Nothing yet; nothing beyond `limit_m` counts.
    pub fn before(limit_m: f32) -> Self {
        Self {
            kept: [None; KEPT],
            count: 0,
            limit_m,
        }
    }

    /// What lies beyond is hidden.
    pub fn limit_m(&self) -> f32 {
        self.limit_m
    }

    /// The solids, nearest first.
    pub fn iter(&self) -> impl Iterator<Item = &Cover<'a>> {
        self.kept[..self.count].iter().flatten()
    }

    /// Adds a solid. Its place depends on its distance alone, whatever the order of adding.
    pub fn add(&mut self, cover: Cover<'a>) {
        if cover.distance_m >= self.limit_m {
            return;
        }
        let nearer = self
            .iter()
            .take_while(|kept| kept.distance_m <= cover.distance_m)
            .count();
        if nearer == KEPT {
            return;
        }
        self.count = (self.count + 1).min(KEPT);
        self.kept[nearer..self.count].rotate_right(1);
        self.kept[nearer] = Some(cover);
        self.close();
    }

    /// Drops what is hidden.
    fn close(&mut self) {
        let mut through = 1.0;
        for (index, cover) in self.kept[..self.count].iter().flatten().enumerate() {
            through *= 1.0 - cover.share;
            if through < OPAQUE {
                self.limit_m = cover.distance_m;
                self.count = index + 1;
                return;
            }
        }
    }
}
