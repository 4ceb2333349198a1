//! The low frequencies of the horizon.

use core::f32::consts::FRAC_PI_4;

use nalgebra::Complex;

use crate::horizon::{BEARING_STEP_RAD, BEARINGS, Horizon, SUMMED};

mod detail;
mod folded;

pub use detail::{DETAIL_FREQUENCIES, Detail};

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
    detail: Option<Detail>,
}

impl Spectrum {
    /// The spectrum of a horizon, turned by what the horizon left of the turn to north.
    #[inline(never)]
    pub fn of(horizon: &Horizon) -> Self {
        let sums = folded::low_frequencies(horizon.sums());
        let mut coefficients = sums.map(|sum| {
            let parts = Complex::new(sum.re as f32, sum.im as f32);
            parts * (folded::SUM_SCALE * 2.0 / (BEARINGS * SUMMED) as f32)
        });
        // The sums look from the middle between two bearings.
        rotate(
            &mut coefficients,
            0.5 * BEARING_STEP_RAD - horizon.residual_rad(),
        );
        Self::from_coefficients(coefficients)
    }

    /// The spectrum of a horizon with its detail.
    pub fn with_detail(horizon: &Horizon) -> Self {
        Self {
            detail: Some(Detail::of(horizon)),
            ..Self::of(horizon)
        }
    }

    /// A spectrum from c_1..c_9.
    pub const fn from_coefficients(coefficients: [Complex<f32>; VIEW_FREQUENCIES]) -> Self {
        Self {
            coefficients,
            detail: None,
        }
    }

    /// c_10..c_17, where they were asked for.
    pub const fn detail(&self) -> Option<&Detail> {
        self.detail.as_ref()
    }

    /// c_1..c_9.
    pub const fn coefficients(&self) -> &[Complex<f32>; VIEW_FREQUENCIES] {
        &self.coefficients
    }

    /// Whether no coefficient is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        let detail = self.detail.iter().flat_map(|detail| &detail.0);
        self.coefficients
            .iter()
            .chain(detail)
            .all(|c| c.re.is_finite() && c.im.is_finite())
    }

    /// What a viewer at the same place sees who is turned counter-clockwise by `angle` (radians).
    pub fn rotated(&self, angle: f32) -> Self {
        let mut coefficients = self.coefficients;
        rotate(&mut coefficients, angle);
        Self {
            coefficients,
            detail: self.detail.map(|detail| detail.rotated(angle)),
        }
    }

    /// The same without the ninth term: what a view restored from a snapshot has.
    pub fn truncated(&self) -> Self {
        let mut coefficients = self.coefficients;
        coefficients[STORED_FREQUENCIES] = Complex::new(0.0, 0.0);
        Self::from_coefficients(coefficients)
    }
}

/// Turns the viewer of c_1, c_2, ... counter-clockwise by `angle`: c_k e^{ik angle}.
pub fn rotate(coefficients: &mut [Complex<f32>], angle: f32) {
    // One sine and one cosine; the powers follow by multiplication.
    let step = unit(angle);
    let mut turn = step;
    for coefficient in coefficients {
        *coefficient *= turn;
        turn *= step;
    }
}

/// e^{i angle}. Up to an eighth of a turn, where nearly all of a flight's are, by Taylor's series: the
/// first terms left out are below 3e-8, and `libm` would compute in double precision, which the
/// Cortex-M4F has not.
pub(crate) fn unit(angle: f32) -> Complex<f32> {
    // Written so that NaN goes to `libm`.
    let is_small = angle.abs() <= FRAC_PI_4;
    if !is_small {
        let (sin, cos) = libm::sincosf(angle);
        return Complex::new(cos, sin);
    }
    let y = angle * angle;
    let cos = 1.0 - y * (1.0 / 2.0 - y * (1.0 / 24.0 - y * (1.0 / 720.0 - y * (1.0 / 40_320.0))));
    let sin =
        1.0 - y * (1.0 / 6.0 - y * (1.0 / 120.0 - y * (1.0 / 5_040.0 - y * (1.0 / 362_880.0))));
    Complex::new(cos, angle * sin)
}

#[cfg(test)]
mod tests;
