//! A place in 16 bytes.

mod format;
mod packed;

use nalgebra::Complex;

pub use format::{MOST_SNAPSHOT_BYTES, SnapshotFormat, StoredView};
pub use packed::{PackedSnapshot, Packing};

use crate::spectrum::{STORED_FREQUENCIES, Spectrum, StoredCoefficients};

/// Bytes of a snapshot.
pub const SNAPSHOT_BYTES: usize = 2 * STORED_FREQUENCIES;

/// Luma of one count at k = 1. With [`COUNT_RATIO`] it is the law by which the published logging
/// tools of the original system read its snapshots.
const FIRST_COUNT_LUMA: f32 = 0.60;
/// By how much a count shrinks from one frequency to the next: natural views hold less power at
/// higher frequencies, and the counts shall cover most of the 8 bits everywhere.
const COUNT_RATIO: f32 = 0.826;

/// Luma of one count of frequency k = 1..=8.
pub const COUNT_LUMA: [f32; STORED_FREQUENCIES] = {
    let mut table = [FIRST_COUNT_LUMA; STORED_FREQUENCIES];
    let mut k = 1;
    while k < STORED_FREQUENCIES {
        table[k] = table[k - 1] * COUNT_RATIO;
        k += 1;
    }
    table
};

/// The inverse: a product costs the core one cycle, a quotient fourteen.
const COUNTS_PER_LUMA: [f32; STORED_FREQUENCIES] = {
    let mut table = [1.0; STORED_FREQUENCIES];
    let mut k = 0;
    while k < STORED_FREQUENCIES {
        table[k] /= COUNT_LUMA[k];
        k += 1;
    }
    table
};

/// A view as it is stored: a_1..a_8, then b_1..b_8, each a signed byte in counts of
/// [`COUNT_LUMA`] (paper, "Image processing" and Fig. 8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Snapshot(pub [i8; SNAPSHOT_BYTES]);

impl Snapshot {
    /// Rounds a view to counts, to the nearest, saturating at ±127. NaN becomes zero.
    #[inline(never)]
    pub fn quantise(view: &Spectrum) -> Self {
        let mut counts = [0; SNAPSHOT_BYTES];
        let (a, b) = counts.split_at_mut(STORED_FREQUENCIES);
        let steps = view.coefficients().iter().zip(&COUNTS_PER_LUMA);
        for ((a, b), (coefficient, counts)) in a.iter_mut().zip(b).zip(steps) {
            *a = to_count(coefficient.re * counts);
            *b = to_count(-coefficient.im * counts);
        }
        Self(counts)
    }

    /// The view back, c_1..c_8 in luma; off by at most half a count where nothing saturated.
    pub fn dequantise(&self) -> StoredCoefficients {
        let (a, b) = self.0.split_at(STORED_FREQUENCIES);
        let mut coefficients = [Complex::new(0.0, 0.0); STORED_FREQUENCIES];
        for ((coefficient, luma), (a, b)) in coefficients
            .iter_mut()
            .zip(&COUNT_LUMA)
            .zip(a.iter().zip(b))
        {
            *coefficient = Complex::new(f32::from(*a) * luma, -(f32::from(*b) * luma));
        }
        coefficients
    }

    /// The snapshot as it lies in memory and goes over the wire.
    pub const fn bytes(&self) -> &[i8; SNAPSHOT_BYTES] {
        &self.0
    }
}

/// The nearest count; of two that are equally near the one farther from zero.
fn to_count(counts: f32) -> i8 {
    // The cast cuts off. -128 is left out, so that a view and its negative round alike.
    ((counts + 0.5_f32.copysign(counts)) as i8).max(-i8::MAX)
}

#[cfg(test)]
mod tests;
