//! A view as a few grey values, and these without their high frequencies.

use core::f32::consts::TAU;

use heapless::Vec;
use nalgebra::Complex;

use super::{Luma, MOST_BYTES, Memory};
use crate::horizon::BEARINGS;

/// Grey values by pixel; pixel n of N looks along bearing 2πn / N.
pub type Pixels = Vec<f32, MOST_BYTES>;

/// The fewest pixels that can tell a direction.
const FEWEST: usize = 3;

/// As many pixels as there can be.
pub fn count(bytes: u8) -> usize {
    usize::from(bytes).clamp(FEWEST, MOST_BYTES)
}

/// Means of the view over `count` equal sectors.
pub fn pixels(view: &Luma, count: usize) -> Pixels {
    let width = BEARINGS as f32 / count as f32;
    let sector = |n: usize| {
        // Bin j covers j - ½ to j + ½.
        let from = (n as f32 - 0.5) * width;
        mean(view, from, from + width)
    };
    (0..count).map(sector).collect()
}

/// Mean of the view from one bearing to another, in bins.
fn mean(view: &Luma, from: f32, to: f32) -> f32 {
    let [from, to] = [from + 0.5, to + 0.5];
    let mut sum = 0.0;
    let mut bin = libm::floorf(from);
    while bin < to {
        let covered = (bin + 1.0).min(to) - bin.max(from);
        let index = (bin as i32).rem_euclid(BEARINGS as i32) as usize;
        sum += view[index] * covered;
        bin += 1.0;
    }
    sum / (to - from)
}

/// A byte for each pixel.
pub fn to_bytes(pixels: &Pixels) -> Memory {
    pixels
        .iter()
        .map(|luma| libm::roundf(*luma) as u8)
        .collect()
}

/// The pixels back; black where the memory is too short.
pub fn from_bytes(memory: &Memory, count: usize) -> Pixels {
    let byte = |n: usize| memory.get(n).copied().unwrap_or(0);
    (0..count).map(|n| f32::from(byte(n))).collect()
}

/// A ring of pixels through a low-pass filter, with its derivatives by the bearing.
#[derive(Clone, Copy, Debug)]
pub struct LowPass {
    count: usize,
    frequencies: usize,
    /// e^{2πin/N}
    roots: [Complex<f32>; MOST_BYTES],
}

/// A filtered ring: values, first and second derivative by the bearing.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Without the mean.
    pub value: Pixels,
    /// Per radian.
    pub slope: Pixels,
    /// Per radian².
    pub bend: Pixels,
}

impl LowPass {
    /// A filter for `count` pixels that keeps this many frequencies, or as many as so many pixels
    /// have.
    pub fn new(count: usize, frequencies: u8) -> Self {
        Self {
            count,
            frequencies: usize::from(frequencies).clamp(1, count / 2),
            roots: core::array::from_fn(|n| {
                let angle = TAU * n as f32 / count as f32;
                Complex::new(libm::cosf(angle), libm::sinf(angle))
            }),
        }
    }

    /// The ring without its mean and its high frequencies.
    pub fn curve(&self, pixels: &Pixels) -> Curve {
        let mut curve = Curve::default();
        for ring in [&mut curve.value, &mut curve.slope, &mut curve.bend] {
            *ring = (0..self.count).map(|_| 0.0).collect();
        }
        for k in 1..=self.frequencies {
            let mut coefficient = Complex::new(0.0, 0.0);
            for (n, luma) in pixels.iter().enumerate() {
                coefficient += self.root(k, n).conj() * *luma;
            }
            // An even ring's highest frequency is its own mirror image.
            let images = if 2 * k == self.count { 1.0 } else { 2.0 };
            coefficient *= images / self.count as f32;
            let k_f = k as f32;
            for n in 0..self.count {
                let wave = coefficient * self.root(k, n);
                curve.value[n] += wave.re;
                curve.slope[n] -= wave.im * k_f;
                curve.bend[n] -= wave.re * (k_f * k_f);
            }
        }
        curve
    }

    /// e^{2πikn/N}
    fn root(&self, k: usize, n: usize) -> Complex<f32> {
        self.roots[k * n % self.count]
    }

    /// The direction in which pixel n looks: cosine and sine.
    pub fn direction(&self, n: usize) -> Complex<f32> {
        self.roots[n]
    }
}
