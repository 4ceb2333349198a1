//! The coarse rotation between two views: all rotations are tried.
//!
//! The paper replaced Stürzl & Mallot's phase-based alignment by this, because a symmetric place or a
//! weak low frequency misleads the former.

use nalgebra::Complex;

use super::Weights;
use crate::horizon::{BEARING_STEP_RAD, BEARINGS};
use crate::spectrum::{STORED_FREQUENCIES, Spectrum, StoredCoefficients};

/// Half of all rotations.
const HALF_TURN: u8 = (BEARINGS / 2) as u8;

/// The best of all 128 rotations: how far the stored view's viewer is turned counter-clockwise
/// against the current one, in steps of 2.8 degrees, 0..=127.
pub fn align128(current: &Spectrum, stored: &StoredCoefficients, weights: &Weights) -> u8 {
    best(current, stored, weights, 0, BEARINGS as i16 - 1) as u8
}

/// The best rotation within ±`bound` steps (at most half a turn).
#[inline(never)]
pub fn align_within(
    current: &Spectrum,
    stored: &StoredCoefficients,
    weights: &Weights,
    bound: u8,
) -> i8 {
    let bound = i16::from(bound.min(HALF_TURN - 1));
    best(current, stored, weights, -bound, bound) as i8
}

/// argmax over s in first..=last of Σ w_k Re(c_k conj(t_k) e^{iksδ}), δ = 2π / 128; equal to the
/// argmin of the squared difference, which differs by a constant.
fn best(
    current: &Spectrum,
    stored: &StoredCoefficients,
    weights: &Weights,
    first: i16,
    last: i16,
) -> i16 {
    let start = unit(f32::from(first) * BEARING_STEP_RAD);
    let step = unit(BEARING_STEP_RAD);
    let mut product = [Complex::new(0.0, 0.0); STORED_FREQUENCIES];
    let mut steps = [step; STORED_FREQUENCIES];
    let (mut start_power, mut step_power) = (start, step);
    for k in 0..STORED_FREQUENCIES {
        product[k] = current.coefficients()[k] * stored[k].conj() * weights[k] * start_power;
        steps[k] = step_power;
        start_power *= start;
        step_power *= step;
    }

    let mut best = (first, f32::NEG_INFINITY);
    for rotation in first..=last {
        let score = product.iter().map(|term| term.re).sum();
        if score > best.1 {
            best = (rotation, score);
        }
        for (term, turn) in product.iter_mut().zip(&steps) {
            *term *= turn;
        }
    }
    best.0
}

fn unit(angle: f32) -> Complex<f32> {
    Complex::new(libm::cosf(angle), libm::sinf(angle))
}
