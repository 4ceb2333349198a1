//! What is wrong with a particular camera for good: dust on its optic, dead and hot pixels.

use core::f32::consts::TAU;

use super::lens::PanoramicLens;
use super::{HEIGHT, WIDTH};
use crate::random::Normal;

/// Stream of the seed that the blemishes are drawn from: "dust" in ASCII.
const STREAM: u64 = u32::from_be_bytes(*b"dust") as u64;
/// Specks of dust in the ring; a camera in use has a few. An assumption, as their size and depth.
const SPECKS: usize = 4;
/// Radius of a speck, pixels: out of focus, it is as wide as the optic's blur.
const SPECK_RADIUS_PX: f32 = 1.5;
/// Light that a speck takes in its middle.
const SPECK_DEPTH: f32 = 0.2;
/// Bad pixels: one in a thousand, a cheap sensor's usual share. Half of them are hot.
const BAD_PIXELS: usize = WIDTH * HEIGHT / 1000;

/// A pixel that shows something else than the light that falls on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadPixel {
    /// It sees nothing.
    Dead,
    /// It is full whatever falls on it.
    Hot,
}

/// The blemishes of one camera.
#[derive(Clone, Debug)]
pub struct Blemishes {
    specks_px: [[f32; 2]; SPECKS],
    /// By index, ascending.
    bad: Vec<(usize, BadPixel)>,
}

impl Blemishes {
    /// The blemishes of the camera `seed` behind `lens`.
    pub fn new(lens: &PanoramicLens, seed: u64) -> Self {
        let mut dice = Normal::new(seed, STREAM);
        let specks_px = core::array::from_fn(|_| {
            let way = dice.uniform() as f32;
            let radius = lens.inner_radius_px + way * (lens.outer_radius_px - lens.inner_radius_px);
            let (sin, cos) = libm::sincosf(TAU * dice.uniform() as f32);
            let [x, y] = lens.centre_px;
            [x + radius * cos, y + radius * sin]
        });
        let mut bad: Vec<_> = (0..BAD_PIXELS)
            .map(|number| {
                let index = (dice.uniform() * (WIDTH * HEIGHT) as f64) as usize;
                let kind = if number % 2 == 0 {
                    BadPixel::Dead
                } else {
                    BadPixel::Hot
                };
                (index, kind)
            })
            .collect();
        bad.sort_by_key(|(index, _)| *index);
        bad.dedup_by_key(|(index, _)| *index);
        Self { specks_px, bad }
    }

    /// The share of light that the dust lets through to a point of the image.
    pub fn transmission(&self, [x, y]: [f32; 2]) -> f32 {
        let shade = |speck: &[f32; 2]| {
            let (dx, dy) = (x - speck[0], y - speck[1]);
            let squares = (dx * dx + dy * dy) / (SPECK_RADIUS_PX * SPECK_RADIUS_PX);
            1.0 - SPECK_DEPTH * libm::expf(-squares)
        };
        self.specks_px.iter().map(shade).product()
    }

    /// The bad pixels of a row: column and kind.
    pub fn bad_in(&self, row: usize) -> impl Iterator<Item = (usize, BadPixel)> + '_ {
        let first = self.bad.partition_point(|(index, _)| *index < row * WIDTH);
        self.bad[first..]
            .iter()
            .take_while(move |(index, _)| *index < (row + 1) * WIDTH)
            .map(move |(index, kind)| (index - row * WIDTH, *kind))
    }
}
