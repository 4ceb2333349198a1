//! Prefiltered grey textures: a mip pyramid, sampled trilinearly.

/// A grey picture on a surface, in radiance, with its smaller copies.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Full resolution first; each next level averages 2 x 2 texels.
    levels: Vec<Level>,
    texels_per_m: f32,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    /// Texels of this level for one of the full resolution.
    scale: f32,
    /// Each texel with its neighbours to the right, above, and both (themselves at the edge), so that a
    /// sample is one place in memory.
    quads: Vec<[f32; 4]>,
}

impl Texture {
    /// A texture of `width` columns, `texels` given row by row from the surface's origin.
    pub fn new(width: usize, texels: Vec<f32>, texels_per_m: f32) -> Self {
        let height = texels.len() / width;
        let mut levels = vec![Level::new(width, height, 1.0, &texels)];
        while let Some(next) = levels.last().and_then(Level::halved) {
            levels.push(next);
        }
        Self {
            levels,
            texels_per_m,
        }
    }

    /// Radiance at (`u_m`, `v_m`), averaged over about `footprint_m`.
    pub fn sample(&self, u_m: f32, v_m: f32, footprint_m: f32) -> f32 {
        let (u, v) = (u_m * self.texels_per_m, v_m * self.texels_per_m);
        let top = (self.levels.len() - 1) as f32;
        let lod = log2(footprint_m * self.texels_per_m).clamp(0.0, top);
        let (fine, blend) = split(lod);
        let sharp = self.levels[fine].bilinear(u, v);
        match self.levels.get(fine + 1) {
            Some(coarse) => sharp + blend * (coarse.bilinear(u, v) - sharp),
            None => sharp,
        }
    }
}

impl Level {
    fn new(width: usize, height: usize, scale: f32, texels: &[f32]) -> Self {
        let at = |u: usize, v: usize| texels[v.min(height - 1) * width + u.min(width - 1)];
        let quads = (0..width * height).map(|index| {
            let (u, v) = (index % width, index / width);
            [at(u, v), at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)]
        });
        Self {
            width,
            height,
            scale,
            quads: quads.collect(),
        }
    }

    /// `u`, `v` in texels of level 0, whose texel (0, 0) is centred at (0.5, 0.5).
    fn bilinear(&self, u: f32, v: f32) -> f32 {
        let (column, across) = place(u * self.scale, self.width);
        let (row, up) = place(v * self.scale, self.height);
        mix(&self.quads[row * self.width + column], across, up)
    }

    /// The next coarser level; the last column or row of an odd size is averaged with itself.
    fn halved(&self) -> Option<Self> {
        if self.width < 2 || self.height < 2 {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mean = |index: usize| {
            let (u, v) = (2 * (index % width), 2 * (index / width));
            0.25 * self.quads[v * self.width + u].iter().sum::<f32>()
        };
        let texels: Vec<f32> = (0..width * height).map(mean).collect();
        Some(Self::new(width, height, 0.5 * self.scale, &texels))
    }
}

/// The texel before coordinate `x`, clamped to the edge, and the weight of the one behind it.
fn place(x: f32, count: usize) -> (usize, f32) {
    split((x - 0.5).clamp(0.0, (count - 1) as f32))
}

/// Linear between a texel, the one beside it, the one above it and the one above that.
pub(super) fn mix([here, right, above, beyond]: &[f32; 4], across: f32, up: f32) -> f32 {
    let low = here + across * (right - here);
    let high = above + across * (beyond - above);
    low + up * (high - low)
}

/// Whole and fractional part of a number from 0 on, below 2^31. (`floor` is a call where the processor
/// is not known to have an instruction for it, and a cast to 64 bits a dozen.)
pub(super) fn split(x: f32) -> (usize, f32) {
    let whole = x as i32;
    (whole as usize, x - whole as f32)
}

/// log2, exact at powers of two and linear between them (error below 0.09): picks mip levels.
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
