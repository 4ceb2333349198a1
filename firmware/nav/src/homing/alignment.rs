//! The coarse rotation between two views: all rotations are tried.
//!
//! The paper replaced Stürzl & Mallot's phase-based alignment by this, because a symmetric place or a
//! weak low frequency misleads the former.
//!
//! How well the views fit at a rotation by s steps of δ = 2π/128 is a short Fourier series,
//!
//! ```text
//! score(s) = Σ w_k Re(c_k conj(t_k) e^{iksδ}) = Σ p_k cos ksδ - q_k sin ksδ,   p_k + iq_k = w_k c_k conj(t_k)
//! ```
//!
//! its maximum the least squared difference, which differs from it by a constant. The cosine is the same
//! at s and -s, and at 64 - s but for the sign of odd k; the sine takes the other sign at -s, and at
//! 64 - s for even k. One table of s = 0..=32 and four sums therefore serve four rotations.

use super::Weights;
use crate::cosine::cosine;
use crate::horizon::BEARINGS;
use crate::pair::Pair;
use crate::spectrum::{STORED_FREQUENCIES, Spectrum, StoredCoefficients};

/// Half and a quarter of all rotations.
const HALF_TURN: i16 = (BEARINGS / 2) as i16;
const QUARTER_TURN: usize = BEARINGS / 4;

/// What the numbers of a series add up to, in integers: each of them fits into 16 bits, and their sum
/// times a cosine of 2^13 parts into 32.
const SERIES_SUM: f32 = 32_767.0;

/// The best of all 128 rotations: how far the stored view's viewer is turned counter-clockwise
/// against the current one, in steps of 2.8 degrees, 0..=127.
#[inline(never)]
pub fn align128(current: &Spectrum, stored: &StoredCoefficients, weights: &Weights) -> u8 {
    let best = Series::new(current, stored, weights).best_within(HALF_TURN);
    best.rem_euclid(BEARINGS as i16) as u8
}

/// The best rotation within ±`bound` steps (at most half a turn).
#[inline(never)]
pub fn align_within(
    current: &Spectrum,
    stored: &StoredCoefficients,
    weights: &Weights,
    bound: u8,
) -> i8 {
    let bound = i16::from(bound).min(HALF_TURN - 1);
    Series::new(current, stored, weights).best_within(bound) as i8
}

/// Numbers that belong to k = 1..=8, odd and even k apart.
#[derive(Clone, Copy)]
struct ByFrequency {
    odd: [Pair; 2],
    even: [Pair; 2],
}

impl ByFrequency {
    const fn new(numbers: [i16; STORED_FREQUENCIES]) -> Self {
        let [n1, n2, n3, n4, n5, n6, n7, n8] = numbers;
        Self {
            odd: [Pair::new(n1, n3), Pair::new(n5, n7)],
            even: [Pair::new(n2, n4), Pair::new(n6, n8)],
        }
    }

    /// Sums of products over odd k and over even k.
    #[inline(always)]
    fn dots(&self, other: &Self) -> [i32; 2] {
        let dot = |a: &[Pair; 2], b: &[Pair; 2]| a[1].dot(b[1], a[0].dot(b[0], 0));
        [dot(&self.odd, &other.odd), dot(&self.even, &other.even)]
    }
}

/// cos ksδ and sin ksδ.
struct Row {
    cos: ByFrequency,
    sin: ByFrequency,
}

static ROWS: [Row; QUARTER_TURN + 1] = {
    const ROW: Row = row(0);
    let mut rows = [ROW; QUARTER_TURN + 1];
    let mut steps = 1;
    while steps < rows.len() {
        rows[steps] = row(steps);
        steps += 1;
    }
    rows
};

const fn row(steps: usize) -> Row {
    let (mut cos, mut sin) = ([0; STORED_FREQUENCIES], [0; STORED_FREQUENCIES]);
    let mut k = 1;
    while k <= STORED_FREQUENCIES {
        // In steps of half a bearing; a quarter turn is 64 of them.
        cos[k - 1] = cosine(2 * k * steps);
        sin[k - 1] = cosine(2 * k * steps + 192);
        k += 1;
    }
    Row {
        cos: ByFrequency::new(cos),
        sin: ByFrequency::new(sin),
    }
}

/// The series whose maximum is sought, scaled to integers.
struct Series {
    cos: ByFrequency,
    sin: ByFrequency,
}

impl Series {
    fn new(current: &Spectrum, stored: &StoredCoefficients, weights: &Weights) -> Self {
        let (mut p, mut q) = ([0.0; STORED_FREQUENCIES], [0.0; STORED_FREQUENCIES]);
        let mut sum = 0.0;
        for k in 0..STORED_FREQUENCIES {
            let product = current.coefficients()[k] * stored[k].conj() * weights[k];
            (p[k], q[k]) = (product.re, product.im);
            sum += product.re.abs() + product.im.abs();
        }
        // Where nothing is to be seen, or nothing finite, all becomes next to nothing: the first cast makes
        // zero of NaN. It is one instruction; straight to 16 bits it would be twelve.
        let scale = SERIES_SUM / sum;
        let scaled = |numbers: [f32; STORED_FREQUENCIES]| {
            ByFrequency::new(numbers.map(|number| (number * scale) as i32 as i16))
        };
        Self {
            cos: scaled(p),
            sin: scaled(q),
        }
    }

    /// The best rotation within ±`bound` steps; the smallest turn where several are. Of two opposite
    /// turns, with scores cos - sin and cos + sin, the sine's sign says which is the better.
    fn best_within(&self, bound: i16) -> i16 {
        let (mut best, mut best_score) = (0, i32::MIN);
        let mut consider = |rotation: i16, cos: i32, sin: i32| {
            let score = cos + sin.abs();
            if score > best_score {
                best = if sin > 0 { -rotation } else { rotation };
                best_score = score;
            }
        };
        // From here on the other half of the circle is within the bound.
        let goes_round = HALF_TURN - bound;
        for (steps, row) in (0..=bound).zip(&ROWS) {
            let [odd_cos, even_cos] = self.cos.dots(&row.cos);
            let [odd_sin, even_sin] = self.sin.dots(&row.sin);
            consider(steps, even_cos + odd_cos, even_sin + odd_sin);
            if steps >= goes_round {
                consider(HALF_TURN - steps, even_cos - odd_cos, odd_sin - even_sin);
            }
        }
        best
    }
}
