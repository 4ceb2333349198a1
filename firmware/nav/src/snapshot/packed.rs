//! A place in 4 bits a number.

use crate::methods::{CoefficientCode, Harmonics, Memory};
use crate::spectrum::Spectrum;

/// The most bytes of a packed snapshot.
pub const MOST_PACKED_BYTES: usize = 16;

/// Luma of the largest count over that of the paper's snapshots: with 7 counts instead of 127 the range
/// is better spent on what views really have.
const RANGE: f32 = 0.4;

/// How a view is packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Packing {
    /// Sixteen frequencies in 16 bytes: the most exact.
    Fine,
    /// Eight frequencies in 8 bytes: the smallest.
    Lean,
}

impl Packing {
    /// Frequencies k = 1, 2, ... that are kept.
    pub const fn frequencies(self) -> u8 {
        match self {
            Self::Fine => 16,
            Self::Lean => 8,
        }
    }

    /// Bytes of a snapshot.
    pub const fn bytes(self) -> usize {
        // Two numbers of half a byte.
        self.frequencies() as usize
    }

    /// Counts and their luma.
    pub const fn code(self) -> CoefficientCode {
        CoefficientCode {
            frequencies: self.frequencies(),
            bits: 4,
            range: RANGE,
        }
    }
}

/// A view as it is stored: a_1, b_1, a_2, ..., a signed count in each half of a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackedSnapshot {
    packing: Packing,
    bytes: [u8; MOST_PACKED_BYTES],
}

impl PackedSnapshot {
    /// Rounds a view to counts, to the nearest, saturating. Frequencies that the view has not are zero.
    pub fn quantise(view: &Spectrum, packing: Packing) -> Self {
        Self::from_bytes(packing, &packing.code().encode(&Harmonics::from(view)))
    }

    /// A snapshot that was stored; zero where there are too few bytes.
    pub fn from_bytes(packing: Packing, stored: &[u8]) -> Self {
        let mut bytes = [0; MOST_PACKED_BYTES];
        for (byte, stored) in bytes.iter_mut().zip(stored) {
            *byte = *stored;
        }
        Self { packing, bytes }
    }

    /// How it is packed.
    pub const fn packing(&self) -> Packing {
        self.packing
    }

    /// The stored form.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.packing.bytes()]
    }

    /// The view back, luma.
    pub fn dequantise(&self) -> Harmonics {
        let memory = Memory::from_slice(self.bytes()).unwrap_or_default();
        self.packing.code().decode(&memory)
    }
}
