//! The low frequencies of the horizon.

use microfft::real::rfft_128;
use nalgebra::Complex;

use crate::horizon::{BEARINGS, Horizon};

/// Frequencies that a snapshot stores: k = 1..=8 (paper, Fig. 8).
pub const STORED_FREQUENCIES: usize = 8;
/// Frequencies of the current view: one more, because the gradient of frequency k needs its
/// neighbours k - 1 and k + 1 (Stürzl & Mallot 2006).
pub const VIEW_FREQUENCIES: usize = STORED_FREQUENCIES + 1;

/// c_1..c_8 of a stored view, or of the current one without its ninth term.
pub type StoredCoefficients = [Complex<f32>; STORED_FREQUENCIES];

/// The coefficients c_k = a_k - i b_k = 2 F_k of a view, k = 1..=9, in luma. Frequency zero is
/// dropped: it says how bright the place is, not where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    coefficients: [Complex<f32>; VIEW_FREQUENCIES],
}

impl Spectrum {
    /// The spectrum of a horizon, turned by what the horizon left of the turn to north.
    pub fn of(horizon: &Horizon) -> Self {
        let mut samples = *horizon.luma();
        let bins = rfft_128(&mut samples);
        let mut coefficients = [Complex::new(0.0, 0.0); VIEW_FREQUENCIES];
        // Bin 0 holds frequency zero and, packed as its imaginary part, frequency 64.
        for (coefficient, bin) in coefficients.iter_mut().zip(&bins[1..]) {
            *coefficient = bin * (2.0 / BEARINGS as f32);
        }
        Self { coefficients }.rotated(-horizon.residual_rad())
    }

    /// A spectrum from c_1..c_9.
    pub const fn from_coefficients(coefficients: [Complex<f32>; VIEW_FREQUENCIES]) -> Self {
        Self { coefficients }
    }

    /// c_1..c_9.
    pub const fn coefficients(&self) -> &[Complex<f32>; VIEW_FREQUENCIES] {
        &self.coefficients
    }

    /// Whether no coefficient is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        self.coefficients
            .iter()
            .all(|c| c.re.is_finite() && c.im.is_finite())
    }

    /// What a viewer at the same place sees who is turned counter-clockwise by `angle` (radians).
    pub fn rotated(&self, angle: f32) -> Self {
        let mut coefficients = self.coefficients;
        rotate(&mut coefficients, angle);
        Self { coefficients }
    }

    /// The same without the ninth term: what a view restored from a snapshot has.
    pub fn truncated(&self) -> Self {
        let mut coefficients = self.coefficients;
        coefficients[STORED_FREQUENCIES] = Complex::new(0.0, 0.0);
        Self { coefficients }
    }
}

/// Turns the viewer of c_1, c_2, ... counter-clockwise by `angle`: c_k e^{ik angle}.
pub fn rotate(coefficients: &mut [Complex<f32>], angle: f32) {
    // One sine and one cosine; the powers follow by multiplication.
    let step = Complex::new(libm::cosf(angle), libm::sinf(angle));
    let mut turn = step;
    for coefficient in coefficients {
        *coefficient *= turn;
        turn *= step;
    }
}

#[cfg(test)]
mod tests;
