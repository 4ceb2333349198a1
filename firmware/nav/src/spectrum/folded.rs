//! The nine lowest frequencies of 128 values in integers, by folding: 408 products instead of the
//! definition's 2,304.
//!
//! Seen from the middle between two bearings the directions are φ_n = (n + ½) 2π/128, and
//!
//! ```text
//! cos kφ_{127-n} = cos kφ_n            sin kφ_{127-n} = -sin kφ_n
//! cos kφ_{63-n}  = (-1)^k cos kφ_n     sin kφ_{63-n}  = -(-1)^k sin kφ_n
//! ```
//!
//! so that values may be added to, or taken from, their mirror images before anything is multiplied.
//! The first fold parts cosines from sines, the second odd from even k. What is left for the even k is
//! the same problem of half the length with k/2, and is folded again:
//!
//! | values left | frequencies |
//! |---|---|
//! | 32 | 1, 3, 5, 7, 9 |
//! | 16 | 2, 6; and 8, which a further fold would carry beyond 16 bits |
//! | 8 | 4 |
//!
//! For odd k, sin kφ_n = ± cos kφ_{31-n}: with the sines' values in reverse, both sums take the same
//! factors. All sums are exact in 16 and 32 bits; the factors, cosines in parts of 2^13, are off by
//! 2^-14 at most.

use nalgebra::Complex;

use super::VIEW_FREQUENCIES;
use crate::cosine::{ONE, cosine};
use crate::horizon::BEARINGS;
use crate::pair::Pair;

/// What the sums of [`low_frequencies`] are to be multiplied by for Σ of values times cosines. With 2^13
/// parts the largest sum, 4080 x 128/π of a horizon half white and half black, is below 2^31.
pub(super) const SUM_SCALE: f32 = 1.0 / ONE as f32;

/// Values that meet cosines and values that meet sines, two each.
#[derive(Clone, Copy)]
struct Waves {
    cos: Pair,
    sin: Pair,
}

const NO_WAVES: Waves = Waves {
    cos: Pair::ZERO,
    sin: Pair::ZERO,
};

/// Factors cos kφ_n, n in the order of the values, for some k side by side.
type Factors<const K: usize, const WORDS: usize> = [[Pair; K]; WORDS];

/// All factors, in 432 bytes.
struct Table {
    low: Factors<3, 16>,
    high: Factors<2, 16>,
    halves: Factors<2, 8>,
    quarter: Factors<1, 4>,
    eighth: Factors<1, 8>,
}

static TABLE: Table = Table {
    low: factors([1, 3, 5]),
    high: factors([7, 9]),
    halves: factors([2, 6]),
    quarter: factors([4]),
    eighth: factors([8]),
};

/// Σ x_n cos kφ_n and -Σ x_n sin kφ_n for k = 1..=9, in parts of [`SUM_SCALE`]. Values up to 4,080.
pub(super) fn low_frequencies(values: &[u16; BEARINGS]) -> [Complex<i32>; VIEW_FREQUENCIES] {
    let (values, _) = values.as_chunks();
    let mut odd = [NO_WAVES; 16];
    let mut even = [NO_WAVES; 16];
    fold(|word| mirror(values, word), &mut odd, &mut even);
    let mut half = [NO_WAVES; 8];
    let mut rest = [NO_WAVES; 8];
    fold(|word| even[word], &mut half, &mut rest);
    let mut quarter = [NO_WAVES; 4];
    fold(|word| rest[word], &mut quarter, &mut [NO_WAVES; 4]);
    let [c1, c3, c5] = sums(&odd, &TABLE.low);
    let [c7, c9] = sums(&odd, &TABLE.high);
    let [c2, c6] = sums(&half, &TABLE.halves);
    let [c4] = sums(&quarter, &TABLE.quarter);
    // Of k = 3, 7 and 6 the sine is minus the mirrored cosine.
    let [c3, c7, c6] = [c3, c7, c6].map(|c| c.conj());
    [c1, c2, c3, c4, c5, c6, c7, eighth(&rest), c9]
}

/// The first fold, of two values: sums for the cosines, differences for the sines.
#[inline(always)]
fn mirror(values: &[[u16; 2]], word: usize) -> Waves {
    // The compiler makes one load of it.
    let pair = |word: usize| Pair::new(values[word][0] as i16, values[word][1] as i16);
    let (value, image) = (pair(word), pair(BEARINGS / 2 - 1 - word).swapped());
    Waves {
        cos: value.plus(image),
        sin: value.minus(image),
    }
}

/// A fold of twice as many words into what odd k need, with the sines' values in reverse, and what even
/// k need.
#[inline(always)]
fn fold<const HALF: usize>(
    waves: impl Fn(usize) -> Waves,
    odd: &mut [Waves; HALF],
    even: &mut [Waves; HALF],
) {
    for word in 0..HALF {
        let (waves, image) = (waves(word), waves(2 * HALF - 1 - word));
        let cos = image.cos.swapped();
        odd[word].cos = waves.cos.minus(cos);
        even[word].cos = waves.cos.plus(cos);
        odd[HALF - 1 - word].sin = image.sin.plus(waves.sin.swapped());
        even[word].sin = waves.sin.minus(image.sin.swapped());
    }
}

/// Σ values times factors, of the cosines and, negative, of the sines.
#[inline(always)]
fn sums<const K: usize, const WORDS: usize>(
    waves: &[Waves; WORDS],
    factors: &Factors<K, WORDS>,
) -> [Complex<i32>; K] {
    let mut sums = [Complex::new(0, 0); K];
    for (waves, factors) in waves.iter().zip(factors) {
        for (sum, factor) in sums.iter_mut().zip(factors) {
            sum.re = waves.cos.dot(*factor, sum.re);
            sum.im = waves.sin.dot(*factor, sum.im);
        }
    }
    sums.map(|sum| Complex::new(sum.re, sum.im.wrapping_neg()))
}

/// k = 8 of 16 values: sin 8φ_n = cos 8φ_{n-4}.
#[inline(always)]
fn eighth(waves: &[Waves; 8]) -> Complex<i32> {
    let [mut cos, mut sin] = [0; 2];
    for (word, waves) in waves.iter().enumerate() {
        cos = waves.cos.dot(TABLE.eighth[word][0], cos);
        sin = waves.sin.dot(TABLE.eighth[(word + 6) % 8][0], sin);
    }
    Complex::new(cos, sin.wrapping_neg())
}

const fn factors<const K: usize, const WORDS: usize>(k: [usize; K]) -> Factors<K, WORDS> {
    let mut factors = [[Pair::ZERO; K]; WORDS];
    let mut word = 0;
    while word < WORDS {
        let mut column = 0;
        while column < K {
            let [first, second] = [4 * word + 1, 4 * word + 3];
            factors[word][column] =
                Pair::new(cosine(k[column] * first), cosine(k[column] * second));
            column += 1;
        }
        word += 1;
    }
    factors
}
