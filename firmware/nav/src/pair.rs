//! Two 16-bit numbers in a word, and the instructions of the Cortex-M4 that work on both at once
//! (ARM DDI0403 §A4.4.6, "parallel addition and subtraction", §A4.4.3, "signed multiply"). Elsewhere the
//! same in plain Rust, to the bit.

#[cfg(all(target_arch = "arm", target_os = "none"))]
use cortex_m4 as machine;
#[cfg(not(all(target_arch = "arm", target_os = "none")))]
use plain as machine;

/// Two signed 16-bit numbers; the first in the lower half. All arithmetic wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair(u32);

impl Pair {
    /// A pair of zeros.
    pub(crate) const ZERO: Self = Self(0);

    /// A pair of these two.
    #[inline(always)]
    pub(crate) const fn new(first: i16, second: i16) -> Self {
        Self(first.cast_unsigned() as u32 | (second.cast_unsigned() as u32) << 16)
    }

    /// The first and the second.
    #[inline(always)]
    pub(crate) const fn halves(self) -> [i16; 2] {
        [self.0 as i16, (self.0 >> 16) as i16]
    }

    /// The second before the first.
    #[inline(always)]
    pub(crate) const fn swapped(self) -> Self {
        Self(self.0.rotate_left(16))
    }

    /// The sums of the firsts and of the seconds.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self(machine::sadd16(self.0, other.0))
    }

    /// The differences of the firsts and of the seconds.
    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        Self(machine::ssub16(self.0, other.0))
    }

    /// `sum` and the products of the firsts and of the seconds.
    #[inline(always)]
    pub(crate) fn dot(self, other: Self, sum: i32) -> i32 {
        machine::smlad(self.0, other.0, sum)
    }
}

#[cfg(all(target_arch = "arm", target_os = "none"))]
mod cortex_m4 {
    use core::arch::asm;

    #[inline(always)]
    pub(super) fn sadd16(a: u32, b: u32) -> u32 {
        let sum;
        // SAFETY: reads and writes these registers alone, and the flags, which are not promised to be
        // kept.
        unsafe {
            asm!("sadd16 {}, {}, {}", lateout(reg) sum, in(reg) a, in(reg) b,
                options(pure, nomem, nostack));
        }
        sum
    }

    #[inline(always)]
    pub(super) fn ssub16(a: u32, b: u32) -> u32 {
        let difference;
        // SAFETY: as above.
        unsafe {
            asm!("ssub16 {}, {}, {}", lateout(reg) difference, in(reg) a, in(reg) b,
                options(pure, nomem, nostack));
        }
        difference
    }

    #[inline(always)]
    pub(super) fn smlad(a: u32, b: u32, sum: i32) -> i32 {
        let result;
        // SAFETY: as above.
        unsafe {
            asm!("smlad {}, {}, {}, {}", lateout(reg) result, in(reg) a, in(reg) b, in(reg) sum,
                options(pure, nomem, nostack));
        }
        result
    }
}

#[cfg(not(all(target_arch = "arm", target_os = "none")))]
mod plain {
    use super::Pair;

    fn halves(word: u32) -> [i32; 2] {
        Pair(word).halves().map(i32::from)
    }

    fn each(a: u32, b: u32, operation: fn(i16, i16) -> i16) -> u32 {
        let ([a, c], [b, d]) = (Pair(a).halves(), Pair(b).halves());
        Pair::new(operation(a, b), operation(c, d)).0
    }

    pub(super) fn sadd16(a: u32, b: u32) -> u32 {
        each(a, b, i16::wrapping_add)
    }

    pub(super) fn ssub16(a: u32, b: u32) -> u32 {
        each(a, b, i16::wrapping_sub)
    }

    pub(super) fn smlad(a: u32, b: u32, sum: i32) -> i32 {
        let ([a, c], [b, d]) = (halves(a), halves(b));
        sum.wrapping_add(a * b).wrapping_add(c * d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_do_not_touch_each_other() {
        let (a, b) = (Pair::new(-1, i16::MAX), Pair::new(-3, 1));
        assert_eq!(a.plus(b), Pair::new(-4, i16::MIN));
        assert_eq!(b.minus(a), Pair::new(-2, 2 - i16::MAX - 1));
        assert_eq!(a.swapped(), Pair::new(i16::MAX, -1));
    }

    #[test]
    fn a_dot_product_adds_both_products_to_the_sum() {
        let (a, b) = (Pair::new(-100, 300), Pair::new(7, -11));
        assert_eq!(a.dot(b, 5), 5 - 700 - 3300);
        let least = Pair::new(i16::MIN, i16::MIN);
        assert_eq!(least.dot(least, 0), i32::MIN);
    }
}
