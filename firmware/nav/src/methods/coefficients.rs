//! A view as Fourier coefficients, and these in few bits.

use microfft::real::rfft_128;
use nalgebra::Complex;

use super::{Luma, MOST_BYTES, Memory};
use crate::horizon::BEARINGS;
use crate::spectrum::Spectrum;

/// Frequencies that a memory holds at most.
pub const MOST_FREQUENCIES: usize = 32;

/// Luma that the largest count stands for at k = 1 with 8 bits: 127 counts of 0.60, the law of the
/// original system's snapshots.
const FULL_SCALE_LUMA: f32 = 127.0 * 0.60;
/// By how much it shrinks from one frequency to the next, as in those snapshots.
const FULL_SCALE_RATIO: f32 = 0.826;

/// c_1, c_2, ... of a view, luma: one more than a memory holds, because the gradient of the last
/// leans on its successor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonics(pub [Complex<f32>; MOST_FREQUENCIES + 1]);

impl Harmonics {
    /// All zero: a uniform view.
    pub const NONE: Self = Self([Complex::new(0.0, 0.0); MOST_FREQUENCIES + 1]);

    /// The coefficients of a view.
    pub fn of(view: &Luma) -> Self {
        let mut samples = *view;
        let bins = rfft_128(&mut samples);
        let mut harmonics = Self::NONE;
        // Bin 0 holds frequency zero and, packed as its imaginary part, frequency 64.
        for (coefficient, bin) in harmonics.0.iter_mut().zip(&bins[1..]) {
            *coefficient = bin * (2.0 / BEARINGS as f32);
        }
        harmonics
    }

    /// c_1..c_9.
    pub fn lowest(&self) -> Spectrum {
        Spectrum::from_coefficients(core::array::from_fn(|index| self.0[index]))
    }

    /// Variance of the view's first `frequencies`, luma² (Parseval).
    pub fn variance(&self, frequencies: usize) -> f32 {
        let used = self.0.iter().take(frequencies);
        0.5 * used.map(Complex::norm_sqr).sum::<f32>()
    }
}

/// The frequencies that a spectrum has; those beyond are zero.
impl From<&Spectrum> for Harmonics {
    fn from(view: &Spectrum) -> Self {
        let mut harmonics = Self::NONE;
        let detail = view.detail().into_iter().flat_map(|detail| &detail.0);
        let known = view.coefficients().iter().chain(detail);
        for (coefficient, known) in harmonics.0.iter_mut().zip(known) {
            *coefficient = *known;
        }
        harmonics
    }
}

/// How coefficients become bytes: a_1, b_1, a_2, ..., each a signed count of so many bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientCode {
    /// Frequencies k = 1, 2, ... that are kept; 1 to [`MOST_FREQUENCIES`].
    pub frequencies: u8,
    /// Bits of each number; 2 to 8.
    pub bits: u8,
    /// Luma of the largest count, relative to that of the 8-bit snapshots. Few bits are better spent
    /// on the range that views really have.
    pub range: f32,
}

impl CoefficientCode {
    /// Frequencies, held to what there is room for.
    pub fn kept(&self) -> usize {
        usize::from(self.frequencies).clamp(1, MOST_FREQUENCIES)
    }

    fn width(&self) -> usize {
        usize::from(self.bits).clamp(2, 8)
    }

    /// Bytes of a memory.
    pub fn bytes(&self) -> usize {
        (2 * self.kept() * self.width()).div_ceil(8).min(MOST_BYTES)
    }

    fn largest(&self) -> f32 {
        ((1_i32 << (self.width() - 1)) - 1) as f32
    }

    /// Rounds to counts, to the nearest, saturating. NaN becomes zero.
    pub fn encode(&self, view: &Harmonics) -> Memory {
        let mut packer = Packer::default();
        let largest = self.largest();
        let mut full_scale = FULL_SCALE_LUMA * self.range;
        for coefficient in &view.0[..self.kept()] {
            for part in [coefficient.re, -coefficient.im] {
                let count = libm::roundf(part / full_scale * largest);
                packer.push(count.clamp(-largest, largest) as i8, self.width());
            }
            full_scale *= FULL_SCALE_RATIO;
        }
        packer.finish()
    }

    /// The coefficients back; zero beyond those that are kept, or that the memory is too short for.
    pub fn decode(&self, memory: &Memory) -> Harmonics {
        let mut harmonics = Harmonics::NONE;
        let mut counts = Unpacker {
            bytes: memory,
            bit: 0,
        };
        let mut count_luma = FULL_SCALE_LUMA * self.range / self.largest();
        for coefficient in &mut harmonics.0[..self.kept()] {
            let [a, b] = [0, 1].map(|_| f32::from(counts.next(self.width())));
            *coefficient = Complex::new(a * count_luma, -(b * count_luma));
            count_luma *= FULL_SCALE_RATIO;
        }
        harmonics
    }
}

/// Numbers of few bits one behind the other, the least significant bit first.
#[derive(Default)]
struct Packer {
    bytes: Memory,
    pending: u32,
    bits: usize,
}

impl Packer {
    fn push(&mut self, value: i8, width: usize) {
        let mask = (1 << width) - 1;
        self.pending |= (u32::from(value as u8) & mask) << self.bits;
        self.bits += width;
        while self.bits >= 8 {
            self.flush_byte();
            self.bits -= 8;
        }
    }

    fn flush_byte(&mut self) {
        // A code's bytes are as many as a memory holds at most.
        let _ = self.bytes.push(self.pending as u8);
        self.pending >>= 8;
    }

    fn finish(mut self) -> Memory {
        if self.bits > 0 {
            self.flush_byte();
        }
        self.bytes
    }
}

struct Unpacker<'a> {
    bytes: &'a [u8],
    bit: usize,
}

impl Unpacker<'_> {
    /// The next number; zero behind the end.
    fn next(&mut self, width: usize) -> i8 {
        let byte = |index: usize| u32::from(self.bytes.get(index).copied().unwrap_or(0));
        let word = byte(self.bit / 8) | byte(self.bit / 8 + 1) << 8;
        let value = (word >> (self.bit % 8)) as u8;
        self.bit += width;
        // Shifted up and down again, the number's highest bit becomes its sign.
        let unused = 8 - width;
        (value << unused) as i8 >> unused
    }
}
