//! Eight numbers side by side (SIMD), and for which of them a condition holds.
//!
//! Every operation is eight times that of one number, in plain loops that the compiler turns into one
//! instruction where the processor has it: the bits are those of one number at a time.

use core::array::from_fn;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// How many numbers.
pub const LANES: usize = 8;

/// Eight numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub struct Eight(pub [f32; LANES]);

/// For which of eight numbers a comparison holds: all bits of a lane are ones there, else zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(32))]
pub struct Mask([u32; LANES]);

/// Some of the eight lanes: a bit each, the first in the lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subset(u8);

impl Eight {
    /// The same number eight times.
    #[inline(always)]
    pub fn all(x: f32) -> Self {
        Self([x; LANES])
    }

    /// Each without its sign.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.each(f32::abs)
    }

    /// The square root of each.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.each(f32::sqrt)
    }

    /// The larger of two; where one of them is NaN, the other.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.with(other, f32::max)
    }

    /// The smaller of two; where one of them is NaN, the other.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.with(other, f32::min)
    }

    /// Each, but not below `low` nor above `high`.
    #[inline(always)]
    pub fn clamp(self, low: f32, high: f32) -> Self {
        self.each(|x| x.clamp(low, high))
    }

    /// The larger of two, neither of them NaN: a single instruction.
    #[inline(always)]
    pub fn larger(self, other: Self) -> Self {
        self.with(other, |a, b| if a > b { a } else { b })
    }

    /// The smaller of two, neither of them NaN: a single instruction.
    #[inline(always)]
    pub fn smaller(self, other: Self) -> Self {
        self.with(other, |a, b| if a < b { a } else { b })
    }

    /// Whether each is above the other.
    #[inline(always)]
    pub fn above(self, other: Self) -> Mask {
        Mask(from_fn(|lane| ones(self.0[lane] > other.0[lane])))
    }

    /// Whether each is below the other.
    #[inline(always)]
    pub fn below(self, other: Self) -> Mask {
        other.above(self)
    }

    #[inline(always)]
    fn each(self, of: impl Fn(f32) -> f32) -> Self {
        Self(from_fn(|lane| of(self.0[lane])))
    }

    #[inline(always)]
    fn with(self, other: Self, of: impl Fn(f32, f32) -> f32) -> Self {
        Self(from_fn(|lane| of(self.0[lane], other.0[lane])))
    }
}

/// An operator between eight numbers and eight others, or one.
macro_rules! operator {
    ($name:ident, $method:ident) => {
        impl $name for Eight {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(other, $name::$method)
            }
        }

        impl $name<f32> for Eight {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f32) -> Self {
                self.with(Self::all(other), $name::$method)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Eight {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.each(Neg::neg)
    }
}

/// All bits of a lane where a condition holds.
#[inline(always)]
fn ones(holds: bool) -> u32 {
    u32::from(holds).wrapping_neg()
}

impl Mask {
    /// `these` where the comparison holds, `others` elsewhere.
    #[inline(always)]
    pub fn select(self, these: Eight, others: Eight) -> Eight {
        Eight(from_fn(|lane| {
            let (these, others) = (these.0[lane].to_bits(), others.0[lane].to_bits());
            f32::from_bits(these & self.0[lane] | others & !self.0[lane])
        }))
    }

    /// The lanes where the comparison holds.
    #[inline(always)]
    pub fn lanes(self) -> Subset {
        let [a, b, c, d, e, f, g, h] = self.0;
        Subset(signs([a, b, c, d]) | signs([e, f, g, h]) << 4)
    }
}

/// The highest bits of four words, for which x86 has an instruction that no compiler finds by itself.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn signs(words: [u32; 4]) -> u8 {
    use core::arch::x86_64::{_mm_castsi128_ps, _mm_movemask_ps, _mm_set_epi32};
    let [a, b, c, d] = words.map(u32::cast_signed);
    // SAFETY: every x86-64 has SSE2.
    unsafe { _mm_movemask_ps(_mm_castsi128_ps(_mm_set_epi32(d, c, b, a))) as u8 }
}

/// The highest bits of four words.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
fn signs(words: [u32; 4]) -> u8 {
    words
        .iter()
        .rev()
        .fold(0, |bits, word| bits << 1 | (word >> 31) as u8)
}

impl BitAnd for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

impl Subset {
    /// None of them.
    pub const NONE: Self = Self(0);
    /// Each of them.
    pub const ALL: Self = Self(!0);

    /// The lane `place`, below [`LANES`], alone.
    #[inline(always)]
    pub fn only(place: usize) -> Self {
        Self(1 << place)
    }

    /// The first `count`, all if there are no more.
    #[inline(always)]
    pub fn first(count: usize) -> Self {
        Self(((1_u32 << count.min(LANES)) - 1) as u8)
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The first of them; [`LANES`] if there are none.
    #[inline(always)]
    pub fn leader(self) -> usize {
        self.0.trailing_zeros() as usize
    }

    /// Those that are not among the others.
    #[inline(always)]
    pub fn without(self, others: Self) -> Self {
        Self(self.0 & !others.0)
    }

    /// Their places, ascending.
    #[inline(always)]
    pub fn iter(self) -> impl Iterator<Item = usize> {
        let mut left = self.0;
        core::iter::from_fn(move || {
            let place = left.trailing_zeros() as usize;
            let more = left != 0;
            left &= left.wrapping_sub(1);
            more.then_some(place)
        })
    }
}

impl BitAnd for Subset {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Subset {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subset_lists_its_lanes_in_order() {
        let numbers = Eight([3.0, -1.0, 4.0, -1.0, 5.0, -9.0, 2.0, 6.0]);
        let positive = numbers.above(Eight::all(0.0)).lanes();
        assert_eq!(positive.iter().collect::<Vec<_>>(), [0, 2, 4, 6, 7]);
        let early = positive & Subset::first(5);
        assert_eq!(early.iter().collect::<Vec<_>>(), [0, 2, 4]);
        assert_eq!(positive.without(early).leader(), 6);
        assert!(Subset::first(0).is_empty() && Subset::first(9) == Subset(255));
    }

    #[test]
    fn a_mask_selects_one_of_two_numbers_in_each_lane() {
        let (a, b) = (
            Eight([1.0, 5.0, 3.0, 0.0, 9.0, 2.0, 7.0, 8.0]),
            Eight::all(4.0),
        );
        assert_eq!(a.above(b).select(a, b), a.max(b));
        assert_eq!(a.below(b).select(a, b), a.min(b));
        assert_eq!((a.larger(b), a.smaller(b)), (a.max(b), a.min(b)));
    }
}
