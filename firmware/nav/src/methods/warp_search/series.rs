//! The differences of two views over all directions of a move, as a series of harmonics in fixed point.

use core::f32::consts::TAU;

use nalgebra::Complex;

use super::tables::{Factors, GROUPS, LANES};
use super::terms::{HARMONICS, Term, Terms};
use super::{DIRECTIONS, DISTANCES, IN};
use crate::pair::Pair;

/// Counts of a view's or of two views' size, the square root of the sum of its squared coefficients:
/// the product of two such is just 15 bits after the shift below.
pub const SIZE: f32 = 32_000.0;
/// Bits that products lose.
const PRODUCT_SHIFT: u32 = 15;
/// Bits that sums of products lose before they are summed up over the harmonics. A sum of the size of
/// a view's power is then a quarter of a word.
const SUM_SHIFT: u32 = 14;
/// Bits of the cosines.
const WAVE_SHIFT: u32 = 14;

/// Counts of a squared luma in the differences, for views at `scale` counts a luma.
pub fn counts_per_square_luma(scale: f32) -> f32 {
    let shift = PRODUCT_SHIFT + SUM_SHIFT - WAVE_SHIFT;
    scale * scale * super::tables::ONE / (1_u32 << shift) as f32
}

/// Coefficients as counts, real and imaginary part.
pub fn counts(view: &[Complex<f32>], scale: f32) -> [Pair; IN] {
    // Half of what is rounded to is added, and enough to make it positive: the rounding of the core's
    // conversion is towards zero.
    let round = |luma: f32| (((luma * scale + 32_768.5) as i32) - 32_768) as i16;
    let mut counts = [Pair::ZERO; IN];
    for (counts, c) in counts.iter_mut().zip(view) {
        *counts = Pair::new(round(c.re), round(c.im));
    }
    counts
}

/// What a coefficient is multiplied by: for the real and for the imaginary part of the product, by
/// [`Term::factor`](super::terms::Term::factor).
pub struct Multipliers([[Pair; 2]; 4 * IN]);

impl Multipliers {
    /// Of a view's counts.
    pub fn of(view: &[Pair; IN]) -> Self {
        let mut all = [[Pair::ZERO; 2]; 4 * IN];
        for (index, c) in view.iter().enumerate() {
            let [re, im] = c.halves();
            // The product; its conjugate; that of the conjugate; and the conjugate of that.
            all[index] = [Pair::new(re, -im), Pair::new(im, re)];
            all[IN + index] = [Pair::new(re, -im), Pair::new(-im, -re)];
            all[2 * IN + index] = [Pair::new(re, im), Pair::new(im, -re)];
            all[3 * IN + index] = [Pair::new(re, im), Pair::new(-im, re)];
        }
        Self(all)
    }
}

/// Products of two views, in the order of their terms: real and imaginary parts.
pub struct Products<const PAIRS: usize>([[Pair; 2]; PAIRS]);

impl<const PAIRS: usize> Products<PAIRS> {
    /// The first so many terms of each harmonic.
    pub fn of<const N: usize>(
        terms: &Terms<N>,
        lengths: &[u8; HARMONICS],
        firsts: &[Pair; IN],
        seconds: &Multipliers,
    ) -> Self {
        let mut products = Self([[Pair::ZERO; 2]; PAIRS]);
        for (harmonic, length) in lengths.iter().enumerate() {
            let start = terms.places(harmonic).start;
            let used = &terms.all[start..start + usize::from(*length)];
            let product = |term: &Term| {
                let first = firsts[usize::from(term.first) - 1];
                seconds.0[usize::from(term.factor)].map(|second| {
                    (first.dot(second, 1 << (PRODUCT_SHIFT - 1)) >> PRODUCT_SHIFT) as i16
                })
            };
            let together = |one: [i16; 2], other: [i16; 2]| {
                [0, 1].map(|part: usize| Pair::new(one[part], other[part]))
            };
            let pairs = products.0[start / 2..].iter_mut();
            let (twos, last) = used.as_chunks::<2>();
            for (pair, [one, other]) in pairs.zip(twos) {
                *pair = together(product(one), product(other));
            }
            if let [one] = last {
                products.0[start / 2 + twos.len()] = together(product(one), [0; 2]);
            }
        }
        products
    }
}

/// Real and imaginary part of each harmonic, by group of distances, harmonic, distance.
pub type Sums = [[[[i32; 2]; LANES]; HARMONICS]; GROUPS];

/// Sums the products with their factors.
#[inline(never)]
pub fn sums<const N: usize, const PAIRS: usize>(
    terms: &Terms<N>,
    lengths: &[u8; HARMONICS],
    products: &Products<PAIRS>,
    factors: &Factors<PAIRS>,
) -> Sums {
    let mut all = [[[[0; 2]; LANES]; HARMONICS]; GROUPS];
    for (sums, factors) in all.iter_mut().zip(factors) {
        for (harmonic, (sums, length)) in sums.iter_mut().zip(lengths).enumerate() {
            let start = terms.places(harmonic).start / 2;
            let pairs = start..start + usize::from(*length).div_ceil(2);
            let mut here = [[0; 2]; LANES];
            let products = &products.0[pairs.clone()];
            for (factors, [re, im]) in factors[pairs].iter().zip(products) {
                for (sums, factor) in here.iter_mut().zip(factors) {
                    sums[0] = factor.dot(*re, sums[0]);
                    sums[1] = factor.dot(*im, sums[1]);
                }
            }
            *sums = here;
        }
    }
    all
}

/// Pairs of harmonics of the same parity.
const PAIRS: usize = HARMONICS.div_ceil(4);
/// A quarter of the directions, both ends included; the others are their mirror images.
const QUARTER: usize = DIRECTIONS as usize / 4 + 1;

/// Cosines of the even and of the odd harmonics, sines of the even and of the odd ones.
type Parts = [[Pair; PAIRS]; 4];

/// The waves of the harmonics at the directions of a quarter.
#[derive(Clone, Debug)]
pub struct Waves([Parts; QUARTER]);

impl Waves {
    /// Before they are computed.
    pub const NONE: Self = Self([[[Pair::ZERO; PAIRS]; 4]; QUARTER]);

    /// Computes them.
    pub fn fill(&mut self) {
        for (direction, waves) in self.0.iter_mut().enumerate() {
            *waves = in_parts(|harmonic| {
                let turns = (direction * harmonic) % usize::from(DIRECTIONS);
                let angle = TAU * turns as f32 / f32::from(DIRECTIONS);
                [libm::cosf(angle), libm::sinf(angle)]
                    .map(|wave| libm::roundf(wave * (1 << WAVE_SHIFT) as f32) as i16)
            });
        }
    }

    /// The difference of two views, less the power of the stored one, at each direction of a move by
    /// the distance: from the power of the moved view and from what both have in common.
    pub fn differences(
        &self,
        power: &Sums,
        common: &Sums,
        distance: usize,
        mut visit: impl FnMut(usize, i32),
    ) {
        let (group, lane) = (distance / LANES, distance % LANES);
        let series = in_parts(|harmonic| {
            [0, 1].map(|part| {
                let [power, common] =
                    [power, common].map(|sums| sums[group][harmonic][lane][part] >> 1);
                let sum = (power - common).saturating_sub(common);
                let sum = sum.saturating_add(1 << (SUM_SHIFT - 2)) >> (SUM_SHIFT - 1);
                sum.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
            })
        });
        for (direction, waves) in self.0.iter().enumerate() {
            let mut sums = [0; 4];
            for (sum, (waves, series)) in sums.iter_mut().zip(waves.iter().zip(&series)) {
                for (wave, harmonics) in waves.iter().zip(series) {
                    *sum = wave.dot(*harmonics, *sum);
                }
            }
            // Re(z e^{ikα}) = Re z cos kα - Im z sin kα, and its three mirror images.
            let [even, odd] = [sums[0], sums[1]];
            let [across_even, across_odd] = [sums[2], sums[3]];
            let [ahead, back] = [even.saturating_add(odd), even.saturating_sub(odd)];
            let [left, right] = [
                across_even.saturating_add(across_odd),
                across_even.saturating_sub(across_odd),
            ];
            let half = usize::from(DIRECTIONS) / 2;
            let mirror = (2 * half - direction) % (2 * half);
            visit(direction, ahead.saturating_sub(left));
            visit(mirror, ahead.saturating_add(left));
            visit(half - direction, back.saturating_add(right));
            visit(half + direction, back.saturating_sub(right));
        }
    }
}

/// Two numbers of each harmonic, the first ones and the second ones, each by parity.
fn in_parts(numbers: impl Fn(usize) -> [i16; 2]) -> Parts {
    let of = |harmonic: usize| {
        if harmonic < HARMONICS {
            numbers(harmonic)
        } else {
            [0; 2]
        }
    };
    let mut parts = [[Pair::ZERO; PAIRS]; 4];
    let [even_cosines, odd_cosines, even_sines, odd_sines] = &mut parts;
    for (parity, cosines, sines) in [(0, even_cosines, even_sines), (1, odd_cosines, odd_sines)] {
        for (pair, (cosines, sines)) in cosines.iter_mut().zip(sines).enumerate() {
            let first = 4 * pair + parity;
            let [one, other] = [of(first), of(first + 2)];
            *cosines = Pair::new(one[0], other[0]);
            *sines = Pair::new(one[1], other[1]);
        }
    }
    parts
}

const _: () = assert!(GROUPS * LANES == DISTANCES);
