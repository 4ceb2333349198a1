//! Materials: square grey textures that repeat, prefiltered.

use super::texture::{log2, mix};
use crate::random::Normal;
use crate::vectors::split;

/// Number of texels along an edge: a power of two, so that every level of the pyramid repeats as well.
pub const SIDE: usize = 256;

/// A material, in radiance, with its smaller copies.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Full resolution first, one texel last; each texel with its neighbours to the right, above, and
    /// both, so that a sample is one place in memory.
    levels: Vec<Vec<[f32; 4]>>,
    texels_per_m: f32,
}

impl Tile {
    /// A material of `texels` ([`SIDE`] x [`SIDE`], row by row) that repeats after `edge_m`.
    pub fn new(texels: Vec<f32>, edge_m: f32) -> Self {
        let mut levels = vec![quads(&texels, SIDE)];
        let mut side = SIDE;
        while side > 1 {
            let fine = &levels[levels.len() - 1];
            let half = side / 2;
            let mean = |index: usize| {
                let (u, v) = (2 * (index % half), 2 * (index / half));
                0.25 * fine[v * side + u].iter().sum::<f32>()
            };
            let coarse: Vec<f32> = (0..half * half).map(mean).collect();
            levels.push(quads(&coarse, half));
            side = half;
        }
        Self {
            levels,
            texels_per_m: SIDE as f32 / edge_m,
        }
    }

    /// Radiance at (`u_m`, `v_m`), averaged over about `footprint_m`.
    #[inline(always)]
    pub fn sample(&self, u_m: f32, v_m: f32, footprint_m: f32) -> f32 {
        let (u, v) = (u_m * self.texels_per_m, v_m * self.texels_per_m);
        let top = (self.levels.len() - 1) as f32;
        let lod = log2(footprint_m * self.texels_per_m).clamp(0.0, top);
        let (fine, blend) = split(lod);
        let sharp = self.bilinear(u, v, fine);
        if fine + 1 < self.levels.len() {
            sharp + blend * (self.bilinear(u, v, fine + 1) - sharp)
        } else {
            sharp
        }
    }

    /// Mean radiance.
    #[inline(always)]
    pub fn mean(&self) -> f32 {
        self.levels[self.levels.len() - 1][0][0]
    }

    #[inline(always)]
    fn bilinear(&self, u: f32, v: f32, level: usize) -> f32 {
        let side = SIDE >> level;
        let scale = 1.0 / (1_u32 << level) as f32;
        let (column, across) = place(u * scale, side);
        let (row, up) = place(v * scale, side);
        mix(&self.levels[level][row * side + column], across, up)
    }
}

/// Each of `side` x `side` texels with its neighbours.
fn quads(texels: &[f32], side: usize) -> Vec<[f32; 4]> {
    let at = |u: usize, v: usize| texels[v % side * side + u % side];
    let quad = |index: usize| {
        let (u, v) = (index % side, index / side);
        [at(u, v), at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)]
    };
    (0..side * side).map(quad).collect()
}

/// The texel before coordinate `x` and the weight of the one behind it; they repeat after `side`, a
/// power of two.
#[inline(always)]
fn place(x: f32, side: usize) -> (usize, f32) {
    let x = x - 0.5;
    // The cast rounds towards 0: one lower for negative numbers.
    let whole = x as i32 - i32::from(x < 0.0);
    (whole as usize & (side - 1), x - whole as f32)
}

/// Noise of natural statistics that repeats: every octave from `coarsest` waves an edge on has unit
/// variance. `stretch` draws it out along v (2 to that power).
pub fn periodic_noise(noise: &mut Normal, coarsest: usize, stretch: u32) -> Vec<f32> {
    let mut field = vec![0.0; SIDE * SIDE];
    let mut columns = 2 * coarsest;
    while columns <= SIDE {
        let rows = (columns >> stretch).max(1);
        let lattice: Vec<f32> = (0..rows * columns)
            .map(|_| noise.sample() as f32 / SMOOTHED)
            .collect();
        add_octave(&mut field, &lattice, columns, rows);
        columns *= 2;
    }
    field
}

/// Standard deviation of a field of unit deviates under the cubic B-spline: 151/315 a direction.
const SMOOTHED: f32 = 151.0 / 315.0;

fn add_octave(field: &mut [f32], lattice: &[f32], columns: usize, rows: usize) {
    let across: Vec<_> = (0..SIDE).map(|u| spline(u, columns)).collect();
    let wide: Vec<f32> = lattice
        .chunks_exact(columns)
        .flat_map(|row| {
            across.iter().map(|(nodes, weights)| {
                nodes
                    .iter()
                    .zip(weights)
                    .map(|(n, w)| row[*n] * w)
                    .sum::<f32>()
            })
        })
        .collect();
    for (v, line) in field.chunks_exact_mut(SIDE).enumerate() {
        let (nodes, weights) = spline(v, rows);
        for (node, weight) in nodes.into_iter().zip(weights) {
            let row = &wide[node * SIDE..(node + 1) * SIDE];
            line.iter_mut()
                .zip(row)
                .for_each(|(texel, value)| *texel += weight * value);
        }
    }
}

/// The four lattice points round texel `x` of [`SIDE`], of `count` that repeat, and their weights.
fn spline(x: usize, count: usize) -> ([usize; 4], [f32; 4]) {
    let place = x * count;
    let (first, rest) = (place / SIDE, place % SIDE);
    let (_, weights) = super::canvas::spline(rest, SIDE as f32);
    ([0, 1, 2, 3].map(|n| (first + n) % count), weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile() -> Tile {
        let noise = periodic_noise(&mut Normal::new(1, 1), 2, 0);
        Tile::new(noise.into_iter().map(|x| 1.0 + 0.1 * x).collect(), 4.0)
    }

    #[test]
    fn a_material_repeats_after_its_edge() {
        let tile = tile();
        for i in 0..50 {
            let (u, v) = (0.17 * i as f32 - 4.0, 0.11 * i as f32 - 2.0);
            let here = tile.sample(u, v, 0.05);
            assert!((here - tile.sample(u + 4.0, v - 8.0, 0.05)).abs() < 1e-3);
        }
    }

    #[test]
    fn a_material_has_no_seam() {
        let tile = tile();
        let jump =
            |u: f32| (tile.sample(u + 0.001, 1.0, 0.0) - tile.sample(u - 0.001, 1.0, 0.0)).abs();
        let usual = (1..100).map(|i| jump(0.039 * i as f32)).fold(0.0, f32::max);
        assert!(jump(0.0) <= usual && jump(4.0) <= usual);
    }

    #[test]
    fn from_afar_a_material_is_its_mean() {
        let tile = tile();
        assert_eq!(tile.sample(1.0, 2.0, 100.0), tile.mean());
    }
}
