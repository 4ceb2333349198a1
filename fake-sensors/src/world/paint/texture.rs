//! Prefiltered grey textures: a mip pyramid, sampled trilinearly.

use crate::vectors::{split, within};

/// A grey picture on a surface, in radiance, with its smaller copies.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Each level with the next coarser one, the coarsest with itself; full resolution first, and each
    /// next level averages 2 x 2 texels.
    pairs: Vec<Pair>,
    /// The texels of all levels, each with its neighbours to the right, above, and both (themselves at
    /// the edge), so that a sample is one place in memory.
    quads: Vec<[f32; 4]>,
    texels_per_m: f32,
}

/// What a sample asks of two levels: u and v of the finer, u and v of the coarser, which the compiler
/// takes side by side.
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// Texels of this level for one of the full resolution.
    scale: [f32; 4],
    /// The last column and row.
    last: [f32; 4],
    /// Where the texels of each level begin.
    first: [usize; 2],
    /// Texels in a row of each.
    width: [usize; 2],
}

/// A level of the pyramid.
#[derive(Clone, Copy, Debug)]
struct Level {
    width: usize,
    height: usize,
    scale: f32,
    first: usize,
}

impl Texture {
    /// A texture of `width` columns, `texels` given row by row from the surface's origin.
    pub fn new(width: usize, texels: Vec<f32>, texels_per_m: f32) -> Self {
        let mut level = Level {
            width,
            height: texels.len() / width,
            scale: 1.0,
            first: 0,
        };
        let mut quads = Vec::new();
        level.append(&texels, &mut quads);
        let mut pairs = Vec::new();
        while let Some((next, texels)) = level.halved(&quads) {
            next.append(&texels, &mut quads);
            pairs.push(Pair::of(&level, &next));
            level = next;
        }
        pairs.push(Pair::of(&level, &level));
        Self {
            pairs,
            quads,
            texels_per_m,
        }
    }

    /// Radiance at (`u_m`, `v_m`), averaged over about `footprint_m`.
    #[inline(always)]
    pub fn sample(&self, u_m: f32, v_m: f32, footprint_m: f32) -> f32 {
        let (u, v) = (u_m * self.texels_per_m, v_m * self.texels_per_m);
        let top = (self.pairs.len() - 1) as f32;
        let lod = within(log2(footprint_m * self.texels_per_m), top);
        let (fine, blend) = split(lod);
        let pair = &self.pairs[fine];
        let place = [u, v, u, v];
        let (mut whole, mut rest) = ([0; 4], [0.0; 4]);
        for axis in 0..4 {
            // Texel (0, 0) is centred at (0.5, 0.5).
            let x = within(place[axis] * pair.scale[axis] - 0.5, pair.last[axis]);
            (whole[axis], rest[axis]) = split(x);
        }
        let quad = |level: usize| {
            let [column, row] = [whole[2 * level], whole[2 * level + 1]];
            &self.quads[pair.first[level] + row * pair.width[level] + column]
        };
        let sharp = mix(quad(0), rest[0], rest[1]);
        let coarse = mix(quad(1), rest[2], rest[3]);
        sharp + blend * (coarse - sharp)
    }
}

impl Pair {
    fn of(fine: &Level, coarse: &Level) -> Self {
        let both = [fine, coarse];
        let last = both.map(|level| [level.width, level.height].map(|count| (count - 1) as f32));
        Self {
            scale: [fine.scale, fine.scale, coarse.scale, coarse.scale],
            last: [last[0][0], last[0][1], last[1][0], last[1][1]],
            first: both.map(|level| level.first),
            width: both.map(|level| level.width),
        }
    }
}

impl Level {
    /// Appends the level's `texels`, each with its neighbours.
    fn append(&self, texels: &[f32], quads: &mut Vec<[f32; 4]>) {
        let Self { width, height, .. } = *self;
        let at = |u: usize, v: usize| texels[v.min(height - 1) * width + u.min(width - 1)];
        quads.extend((0..width * height).map(|index| {
            let (u, v) = (index % width, index / width);
            [at(u, v), at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)]
        }));
    }

    /// The next coarser level, whose texels come behind this one's, the last so far; the last column or
    /// row of an odd size is averaged with itself.
    fn halved(&self, quads: &[[f32; 4]]) -> Option<(Self, Vec<f32>)> {
        if self.width < 2 || self.height < 2 {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mean = |index: usize| {
            let (u, v) = (2 * (index % width), 2 * (index / width));
            0.25 * quads[self.first + v * self.width + u].iter().sum::<f32>()
        };
        let texels = (0..width * height).map(mean).collect();
        let level = Self {
            width,
            height,
            scale: 0.5 * self.scale,
            first: quads.len(),
        };
        Some((level, texels))
    }
}

/// Linear between a texel, the one beside it, the one above it and the one above that.
#[inline(always)]
pub(super) fn mix([here, right, above, beyond]: &[f32; 4], across: f32, up: f32) -> f32 {
    let low = here + across * (right - here);
    let high = above + across * (beyond - above);
    low + up * (high - low)
}

/// log2, exact at powers of two and linear between them (error below 0.09): picks mip levels.
#[inline(always)]
pub(super) fn log2(x: f32) -> f32 {
    const MANTISSA: f32 = (1_u32 << 23) as f32;
    const BIAS: f32 = 127.0;
    x.to_bits() as f32 / MANTISSA - BIAS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkerboard() -> Texture {
        let texels = (0..64 * 64).map(|i| ((i % 64 + i / 64) % 2) as f32);
        Texture::new(64, texels.collect(), 10.0)
    }

    #[test]
    fn a_footprint_of_many_texels_sees_their_mean() {
        for i in 0..20 {
            let grey = checkerboard().sample(0.31 * i as f32, 2.0, 0.4);
            assert!((grey - 0.5).abs() < 1e-6);
        }
    }

    #[test]
    fn a_small_footprint_at_a_texel_centre_sees_that_texel() {
        assert_eq!(checkerboard().sample(0.15, 0.05, 0.01), 1.0);
        assert_eq!(checkerboard().sample(0.25, 0.05, 0.01), 0.0);
    }

    #[test]
    fn the_logarithm_is_exact_at_powers_of_two_and_close_between() {
        for exponent in -6..6 {
            let power = libm::exp2f(exponent as f32);
            assert_eq!(log2(power), exponent as f32);
            assert!((log2(1.4 * power) - libm::log2f(1.4 * power)).abs() < 0.09);
        }
    }
}
