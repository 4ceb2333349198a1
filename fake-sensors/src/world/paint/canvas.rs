//! Painting textures: natural image statistics and simple shapes, from a seed.
//!
//! Natural scenes have an amplitude spectrum that falls as 1/f (Field 1987): every octave of
//! spatial frequency holds the same contrast. A canvas gets that from noise lattices, one per
//! octave, all of one amplitude; and because radiances of natural scenes are log-normal, the sum
//! goes through an exponential.

use super::texture::Texture;
use crate::random::Normal;

/// Usual edge length of a texel in metres: below a pixel's footprint at the nearest distance a
/// flight comes to a surface (0.5 m above the floor).
pub const TEXEL_M: f32 = 0.03;
/// Wavelength of the coarsest octave in metres: that of a whole wall.
const COARSEST_M: f32 = 8.0;
/// Reflectance of white paper: nothing on a canvas is brighter.
const WHITE: f32 = 0.9;

/// A rectangle on a canvas in metres: from (`u`, `v`) to (`u + width`, `v + height`).
#[derive(Clone, Copy, Debug)]
pub struct Area {
    pub u: f32,
    pub v: f32,
    pub width: f32,
    pub height: f32,
}

/// Size and resolution of a canvas.
#[derive(Clone, Copy, Debug)]
pub struct Sheet {
    /// Width in metres.
    pub width_m: f32,
    /// Height in metres.
    pub height_m: f32,
    /// Edge length of a texel in metres.
    pub texel_m: f32,
}

impl Sheet {
    /// Columns and rows of texels.
    pub fn texels(&self) -> [usize; 2] {
        [self.width_m, self.height_m].map(|m| (m / self.texel_m + 0.5) as usize + 1)
    }

    /// All of it.
    pub fn area(&self) -> Area {
        Area {
            u: 0.0,
            v: 0.0,
            width: self.width_m,
            height: self.height_m,
        }
    }
}

/// A patch of sunlight: a parallelogram with two level edges.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// The rectangle that it would be without its slant.
    pub area: Area,
    /// How far the upper edge is shifted along u, in metres.
    pub slant_m: f32,
    /// How many times brighter it is than what lies beside it.
    pub times: f32,
}

/// A texture being painted in reflectance; u along its width, v up its height.
#[derive(Clone, Debug)]
pub struct Canvas {
    sheet: Sheet,
    width: usize,
    height: usize,
    texels: Vec<f32>,
}

impl Canvas {
    /// An even canvas.
    pub fn new(sheet: &Sheet, reflectance: f32) -> Self {
        let [width, height] = sheet.texels();
        Self {
            sheet: *sheet,
            width,
            height,
            texels: vec![reflectance; width * height],
        }
    }

    /// Multiplies all of the canvas by noise of natural statistics: each octave from
    /// [`COARSEST_M`] down has log-contrast `contrast` (standard deviation).
    pub fn weather(&mut self, noise: &mut Normal, contrast: f32) {
        let mut field = vec![0.0; self.texels.len()];
        let mut wavelength_m = COARSEST_M;
        while wavelength_m > 2.0 * self.sheet.texel_m {
            let cell = 0.5 * wavelength_m / self.sheet.texel_m;
            Lattice::new(noise, self.width, self.height, cell).add_to(&mut field, self.width);
            wavelength_m *= 0.5;
        }
        for (texel, log) in self.texels.iter_mut().zip(field) {
            *texel *= libm::expf(contrast * log);
        }
    }

    /// Paints `area` with `shade`, which gets (0..1, 0..1) within the area and the old
    /// reflectance, and gives the new.
    pub fn paint(&mut self, area: Area, shade: impl Fn(f32, f32, f32) -> f32) {
        let texel_m = self.sheet.texel_m;
        for v in 0..self.height {
            let y = ((v as f32 + 0.5) * texel_m - area.v) / area.height;
            if !(0.0..1.0).contains(&y) {
                continue;
            }
            for u in 0..self.width {
                let x = ((u as f32 + 0.5) * texel_m - area.u) / area.width;
                if (0.0..1.0).contains(&x) {
                    let texel = &mut self.texels[v * self.width + u];
                    *texel = shade(x, y, *texel);
                }
            }
        }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, area: Area, reflectance: f32) {
        self.paint(area, |_, _, _| reflectance);
    }

    /// Fills the ellipse that touches the edges of `area`.
    pub fn fill_ellipse(&mut self, area: Area, reflectance: f32) {
        self.paint(area, |x, y, old| {
            let (x, y) = (2.0 * x - 1.0, 2.0 * y - 1.0);
            if x * x + y * y < 1.0 {
                reflectance
            } else {
                old
            }
        });
    }

    /// The finished picture as radiance under `light`, with `sun` on it; 1 is white paper in the
    /// world's usual light.
    pub fn lit_by(self, light: f32, brightness: f32, sun: &[Patch]) -> Texture {
        let texel_m = self.sheet.texel_m;
        let mut radiances: Vec<f32> = self
            .texels
            .into_iter()
            .map(|texel| light * (brightness * texel).min(WHITE))
            .collect();
        for (v, line) in radiances.chunks_exact_mut(self.width).enumerate() {
            for patch in sun {
                let y = ((v as f32 + 0.5) * texel_m - patch.area.v) / patch.area.height;
                if (0.0..1.0).contains(&y) {
                    let start_m = patch.area.u + patch.slant_m * y;
                    shine(
                        line,
                        texel_m,
                        start_m,
                        start_m + patch.area.width,
                        patch.times,
                    );
                }
            }
        }
        Texture::new(self.width, radiances, 1.0 / texel_m)
    }
}

/// Makes the texels between `start_m` and `end_m` brighter.
fn shine(line: &mut [f32], texel_m: f32, start_m: f32, end_m: f32, times: f32) {
    for (u, texel) in line.iter_mut().enumerate() {
        if (start_m..end_m).contains(&((u as f32 + 0.5) * texel_m)) {
            *texel *= times;
        }
    }
}

/// Noise of one octave: normal deviates on a square lattice, smoothed by cubic B-splines.
struct Lattice {
    columns: usize,
    cell: f32,
    values: Vec<f32>,
}

impl Lattice {
    /// Standard deviation of a field of unit deviates under the cubic B-spline, averaged over the
    /// cell: the sum of its squared weights, 151/315 in each direction.
    const SMOOTHED: f32 = 151.0 / 315.0;

    fn new(noise: &mut Normal, width: usize, height: usize, cell: f32) -> Self {
        let [columns, rows] = [width, height].map(|texels| (texels as f32 / cell) as usize + 4);
        let values = (0..columns * rows)
            .map(|_| noise.sample() as f32 / Self::SMOOTHED)
            .collect();
        Self {
            columns,
            cell,
            values,
        }
    }

    fn add_to(&self, field: &mut [f32], width: usize) {
        let wide = self.widened(width);
        for (v, line) in field.chunks_exact_mut(width).enumerate() {
            let (first_row, weights) = spline(v, self.cell);
            let rows = wide.chunks_exact(width).skip(first_row);
            for (row, weight) in rows.zip(weights) {
                for (texel, value) in line.iter_mut().zip(row) {
                    *texel += weight * value;
                }
            }
        }
    }

    /// Each row of the lattice, smoothed along its `width` texels.
    fn widened(&self, width: usize) -> Vec<f32> {
        let across: Vec<_> = (0..width).map(|u| spline(u, self.cell)).collect();
        let rows = self.values.chunks_exact(self.columns);
        rows.flat_map(|row| {
            across.iter().map(|&(first, weights)| {
                let values = &row[first..first + 4];
                values.iter().zip(weights).map(|(a, b)| a * b).sum::<f32>()
            })
        })
        .collect()
    }
}

/// First lattice point and the four cubic B-spline weights at texel `x`.
pub fn spline(x: usize, cell: f32) -> (usize, [f32; 4]) {
    let x = x as f32 / cell;
    let t = x - x.floor();
    let (t2, t3) = (t * t, t * t * t);
    let weights = [
        1.0 - 3.0 * t + 3.0 * t2 - t3,
        4.0 - 6.0 * t2 + 3.0 * t3,
        1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3,
        t3,
    ];
    (x as usize, weights.map(|weight| weight / 6.0))
}
