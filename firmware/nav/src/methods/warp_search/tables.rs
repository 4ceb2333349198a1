//! The warps as matrices on the coefficients, in the order in which they are used.

use core::f32::consts::PI;

use nalgebra::Complex;

use super::super::quadratic::Weights;
use super::terms::{CROSS, CROSS_PAIRS, OWN, OWN_PAIRS, ROWS, Terms};
use super::{DISTANCES, IN};
use crate::pair::Pair;

/// Samples of the half circle under the integrals.
const SAMPLES: usize = 128;

/// Counts of a factor of one: no sum of any view's products then leaves 32 bits, and a factor is
/// rounded by no more than a view is.
pub const ONE: f32 = 4096.0;

/// Distances whose sums are carried at once: as many as there are registers for.
pub const LANES: usize = 2;
/// Groups of so many.
pub const GROUPS: usize = DISTANCES / LANES;

/// Factors of the terms, two neighbouring ones in a pair: by group of distances, by place, by distance.
pub type Factors<const PAIRS: usize> = [[[Pair; LANES]; PAIRS]; GROUPS];

/// All zero.
pub const fn empty<const PAIRS: usize>() -> Factors<PAIRS> {
    [[[Pair::ZERO; LANES]; PAIRS]; GROUPS]
}

/// The matrix of a warp: what c_m and its conjugate, m = column + 1, add to coefficient row + 1 of the
/// moved view.
#[derive(Clone, Copy)]
struct Matrix {
    plain: [[f32; IN]; ROWS],
    conjugate: [[f32; IN]; ROWS],
}

impl Matrix {
    const NONE: Self = Self {
        plain: [[0.0; IN]; ROWS],
        conjugate: [[0.0; IN]; ROWS],
    };

    /// Of a warp by `distance`: G_k,±m = 1/π ∫ cos(mψ ∓ kθ) dθ.
    fn of(distance: f32) -> Self {
        let mut matrix = Self::NONE;
        let share = 1.0 / SAMPLES as f32;
        for sample in 0..SAMPLES {
            let theta = PI * (sample as f32 + 0.5) / SAMPLES as f32;
            let psi = theta - libm::asinf(distance * libm::sinf(theta));
            let [out, source] =
                [theta, psi].map(|angle| Complex::new(libm::cosf(angle), libm::sinf(angle)));
            let mut echo = out;
            for (plain, conjugate) in matrix.plain.iter_mut().zip(&mut matrix.conjugate) {
                let mut wave = source;
                for (plain, conjugate) in plain.iter_mut().zip(conjugate) {
                    let [even, odd] = [wave.re * echo.re, wave.im * echo.im];
                    *plain += share * (even + odd);
                    *conjugate += share * (even - odd);
                    wave *= source;
                }
                echo *= out;
            }
        }
        matrix
    }

    /// Back from the counts of a table.
    fn from_counts(factors: &Factors<CROSS_PAIRS>, distance: usize) -> Self {
        let mut matrix = Self::NONE;
        for (place, term) in CROSS.all.iter().enumerate() {
            if usize::from(term.first) <= ROWS {
                let [row, column] = [term.first, term.second].map(|k| usize::from(k) - 1);
                let part = if term.is_apart() {
                    &mut matrix.plain
                } else {
                    &mut matrix.conjugate
                };
                part[row][column] = counts(factors, place, distance);
            }
        }
        matrix
    }
}

/// The counts of a factor.
pub fn counts<const PAIRS: usize>(factors: &Factors<PAIRS>, place: usize, distance: usize) -> f32 {
    let pair = factors[distance / LANES][place / 2][distance % LANES];
    f32::from(pair.halves()[place % 2])
}

/// Factors of the products of the stored view with the current one, moved by the distances.
pub fn fill_cross(factors: &mut Factors<CROSS_PAIRS>, distances: &[f32; DISTANCES]) {
    for (index, distance) in distances.iter().enumerate() {
        let matrix = Matrix::of(*distance);
        fill(&CROSS, factors, index, |first, second, apart| {
            let part = if apart {
                &matrix.plain
            } else {
                &matrix.conjugate
            };
            part.get(first).map_or(0.0, |row| row[second] * ONE)
        });
    }
}

/// Factors of the products of the current view with itself, whose sum is the weighted power of its
/// first `compared` frequencies after a move.
pub fn fill_own(
    factors: &mut Factors<OWN_PAIRS>,
    cross: &Factors<CROSS_PAIRS>,
    weights: &Weights,
    compared: usize,
) {
    for distance in 0..DISTANCES {
        let Matrix { plain, conjugate } = Matrix::from_counts(cross, distance);
        fill(&OWN, factors, distance, |m, n, apart| {
            let mut sum = 0.0;
            for k in 0..compared {
                let (plain, conjugate) = (&plain[k], &conjugate[k]);
                sum += weights[k]
                    * if apart {
                        plain[m] * plain[n] + conjugate[m] * conjugate[n]
                    } else {
                        plain[m] * conjugate[n] + plain[n] * conjugate[m]
                    };
            }
            // Each pair of different frequencies occurs in both orders; two of the same one, if one
            // is conjugate, in one.
            let times = if m == n { 1.0 } else { 2.0 };
            times * sum / ONE
        });
    }
}

/// Rounds the factor of each term, by the indices of its frequencies, into the table.
fn fill<const N: usize, const PAIRS: usize>(
    terms: &Terms<N>,
    factors: &mut Factors<PAIRS>,
    distance: usize,
    factor: impl Fn(usize, usize, bool) -> f32,
) {
    let rounded = |place: usize| {
        let term = terms.all[place];
        let [first, second] = [term.first, term.second].map(|k| usize::from(k) - 1);
        if first < IN {
            libm::roundf(factor(first, second, term.is_apart())) as i16
        } else {
            0
        }
    };
    let pairs = factors[distance / LANES].iter_mut();
    for (pair, by_lane) in pairs.enumerate() {
        by_lane[distance % LANES] = Pair::new(rounded(2 * pair), rounded(2 * pair + 1));
    }
}
