//! Materials: squares that repeat, in reflectance.

use super::between;
use super::tile::{SIDE, Tile, periodic_noise};
use crate::random::Normal;

/// Reflectance of white paper: nothing in usual light is brighter.
const WHITE: f32 = 0.9;

/// A painted material before light falls on it.
#[derive(Clone, Debug)]
pub struct Swatch {
    texels: Vec<f32>,
    edge_m: f32,
}

impl Swatch {
    /// Even `reflectance` under noise of log-contrast `contrast` an octave.
    fn new(reflectance: f32, edge_m: f32, field: &[f32], contrast: f32) -> Self {
        // The mean of a log-normal number lies half its variance above its median.
        let variance = field.iter().map(|x| x * x).sum::<f32>() / field.len() as f32;
        let median = reflectance * libm::expf(-0.5 * contrast * contrast * variance);
        let texels = field.iter().map(|x| median * libm::expf(contrast * x));
        Self {
            texels: texels.collect(),
            edge_m,
        }
    }

    /// The material in reflectance; `edge_m` replaces its own size.
    pub fn tile(self, edge_m: Option<f32>) -> Tile {
        let texels = self.texels.into_iter().map(|texel| texel.min(WHITE));
        Tile::new(texels.collect(), edge_m.unwrap_or(self.edge_m))
    }

    /// Changes every texel: `shade` gets its place (0..1, 0..1) and what is there.
    fn paint(mut self, mut shade: impl FnMut(f32, f32, f32) -> f32) -> Self {
        for (index, texel) in self.texels.iter_mut().enumerate() {
            let [u, v] = [index % SIDE, index / SIDE].map(|x| (x as f32 + 0.5) / SIDE as f32);
            *texel = shade(u, v, *texel);
        }
        self
    }
}

/// Even, with a little noise.
pub fn plain(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    Swatch::new(
        0.3,
        1.5,
        &periodic_noise(noise, 1, 0),
        contrast.unwrap_or(0.04),
    )
}

/// Carpet tiles, alternately brushed.
pub fn carpet(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    let field = periodic_noise(noise, 2, 0);
    Swatch::new(0.16, 2.0, &field, contrast.unwrap_or(0.1)).paint(|u, v, old| {
        let squares = (4.0 * u) as usize + (4.0 * v) as usize;
        old * if squares.is_multiple_of(2) {
            1.06
        } else {
            0.94
        }
    })
}

/// Concrete with joints and stains.
pub fn concrete(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    let field = periodic_noise(noise, 1, 0);
    Swatch::new(0.22, 6.0, &field, contrast.unwrap_or(0.11)).paint(|u, v, old| {
        let joint = (u - 0.5).abs().min((v - 0.5).abs()) < 0.004;
        if joint { 0.5 * old } else { old }
    })
}

/// Boards, each with a grey of its own.
pub fn wood(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    const BOARDS: usize = 8;
    let greys: Vec<f32> = (0..BOARDS).map(|_| between(noise, 0.85, 1.15)).collect();
    let field = periodic_noise(noise, 8, 3);
    Swatch::new(0.28, 1.6, &field, contrast.unwrap_or(0.09)).paint(|u, _, old| {
        let board = u * BOARDS as f32;
        let gap = board - libm::floorf(board) < 0.03;
        greys[board as usize % BOARDS] * if gap { 0.5 * old } else { old }
    })
}

/// Bark: furrows along the trunk.
pub fn bark(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    let field = periodic_noise(noise, 8, 3);
    Swatch::new(0.13, 1.5, &field, contrast.unwrap_or(0.25))
}

/// Leaves: clumps in the light before gaps in the shade.
pub fn leaves(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    let field = periodic_noise(noise, 4, 0);
    Swatch::new(0.2, 4.0, &field, contrast.unwrap_or(0.28))
}

/// The floor of a forest: litter, moss, and flecks of light that falls through the leaves.
pub fn forest_floor(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    let dapples = periodic_noise(noise, 4, 0);
    let field = periodic_noise(noise, 1, 0);
    let mut fleck = dapples.into_iter();
    Swatch::new(0.11, 20.0, &field, contrast.unwrap_or(0.14)).paint(|_, _, old| {
        let light = ((fleck.next().unwrap_or(0.0) - 1.6) / 0.5).clamp(0.0, 1.0);
        old * (1.0 + 2.5 * light)
    })
}

/// Soil and gravel.
pub fn soil(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    Swatch::new(
        0.13,
        3.0,
        &periodic_noise(noise, 2, 0),
        contrast.unwrap_or(0.16),
    )
}

/// Cardboard boxes in rows, each of its own grey, with tape and a label.
pub fn boxes(noise: &mut Normal, contrast: Option<f32>) -> Swatch {
    const COLUMNS: usize = 4;
    const ROWS: usize = 6;
    let greys: Vec<f32> = (0..COLUMNS * ROWS)
        .map(|_| between(noise, 0.3, 1.6))
        .collect();
    let field = periodic_noise(noise, 4, 0);
    Swatch::new(0.25, 3.2, &field, contrast.unwrap_or(0.06)).paint(|u, v, old| {
        let (column, row) = (u * COLUMNS as f32, v * ROWS as f32);
        let (x, y) = (column - libm::floorf(column), row - libm::floorf(row));
        let grey = greys[row as usize * COLUMNS + column as usize];
        if x < 0.05 || y < 0.08 {
            0.15 * old
        } else if (0.6..0.85).contains(&x) && (0.3..0.6).contains(&y) {
            2.4 * old
        } else if (0.45..0.52).contains(&x) {
            0.75 * grey * old
        } else {
            grey * old
        }
    })
}

/// Cloud cover, 0..1, `share` of it above a half.
pub fn clouds(noise: &mut Normal, share: f32) -> Tile {
    let field = periodic_noise(noise, 1, 0);
    let mut ranked = field.clone();
    ranked.sort_by(f32::total_cmp);
    let rank = ((1.0 - share) * (ranked.len() - 1) as f32) as usize;
    let edge = ranked[rank];
    let cover = field
        .iter()
        .map(|x| ((x - edge) / 1.6 + 0.5).clamp(0.0, 1.0));
    Tile::new(cover.collect(), CLOUDS_M)
}

/// Edge of the cloud tile in units of the clouds' height.
const CLOUDS_M: f32 = 12.0;

/// An outline round the horizon with mean `radiance`: treetops and hills.
pub fn skyline(noise: &mut Normal, radiance: f32) -> Tile {
    let field = periodic_noise(noise, 2, 0);
    Swatch::new(radiance, 2.0, &field, 0.12).tile(None)
}
