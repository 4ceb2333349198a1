//! Single-precision arithmetic on bit patterns, with the NaNs of an ARM on every host
//! (ARM DDI0403 §A2.5).

use super::super::Core;

/// The sign bit.
pub(super) const SIGN: u32 = 1 << 31;
/// The NaN that invalid operations make.
const DEFAULT_NAN: u32 = 0x7fc0_0000;
/// What tells a quiet from a signalling NaN.
const QUIET: u32 = 1 << 22;

fn value(bits: u32) -> f32 {
    f32::from_bits(bits)
}

/// FPProcessNaNs: the first signalling operand, or else the first quiet one, or the default NaN.
#[cold]
#[inline(never)]
fn nan_of(operands: &[u32]) -> u32 {
    let nan = |bits: &&u32| value(**bits).is_nan();
    let signalling = operands.iter().filter(nan).find(|bits| **bits & QUIET == 0);
    match signalling.or_else(|| operands.iter().find(nan)) {
        Some(bits) => bits | QUIET,
        None => DEFAULT_NAN,
    }
}

/// The result of an operation, with the NaN that its operands ask for.
#[inline(always)]
fn finish(result: f32, operands: &[u32]) -> u32 {
    if result.is_nan() {
        nan_of(operands)
    } else {
        result.to_bits()
    }
}

#[inline(always)]
pub(super) fn add(a: u32, b: u32) -> u32 {
    finish(value(a) + value(b), &[a, b])
}

#[inline(always)]
pub(super) fn subtract(a: u32, b: u32) -> u32 {
    finish(value(a) - value(b), &[a, b])
}

#[inline(always)]
pub(super) fn multiply(a: u32, b: u32) -> u32 {
    finish(value(a) * value(b), &[a, b])
}

#[inline(always)]
pub(super) fn divide(a: u32, b: u32) -> u32 {
    finish(value(a) / value(b), &[a, b])
}

#[inline(always)]
pub(super) fn square_root(a: u32) -> u32 {
    finish(value(a).sqrt(), &[a])
}

/// `addend + a * b` with one rounding.
#[inline(never)]
pub(super) fn fused(addend: u32, a: u32, b: u32) -> u32 {
    let result = value(a).mul_add(value(b), value(addend));
    // Zero times infinity is invalid even where the addend is a quiet NaN.
    let invalid = (value(a) * value(b)).is_nan() && !value(a).is_nan() && !value(b).is_nan();
    if invalid && addend & QUIET != 0 {
        return DEFAULT_NAN;
    }
    finish(result, &[addend, a, b])
}

/// Flips the sign, of NaNs too.
#[inline(always)]
pub(super) fn negate(bits: u32) -> u32 {
    bits ^ SIGN
}

impl Core {
    /// VCMP: the flags of FPSCR.
    #[inline(always)]
    pub(super) fn compare_floats(&mut self, a: u32, b: u32) {
        use std::cmp::Ordering::*;
        let nzcv = match value(a).partial_cmp(&value(b)) {
            Some(Less) => 0b1000,
            Some(Equal) => 0b0110,
            Some(Greater) => 0b0010,
            None => 0b0011,
        };
        self.registers.fpscr = self.registers.fpscr & 0x0fff_ffff | nzcv << 28;
    }
}

/// From IEEE half precision.
pub(super) fn from_half(half: u16) -> u32 {
    let half = u32::from(half);
    let sign = (half & 0x8000) << 16;
    let (exponent, mantissa) = (half >> 10 & 31, half & 0x3ff);
    match exponent {
        // Zeros and subnormals: an integer times 2^-24, exact.
        0 => sign | (mantissa as f32 / 16_777_216.0).to_bits(),
        31 if mantissa == 0 => sign | 0x7f80_0000,
        31 => sign | DEFAULT_NAN | mantissa << 13,
        _ => sign | (exponent + 112) << 23 | mantissa << 13,
    }
}

/// To IEEE half precision, to nearest, ties to even.
pub(super) fn to_half(bits: u32) -> u16 {
    /// Half of a step above the largest half, 65 504: from here on it is infinity.
    const OVERFLOW: f32 = 65_520.0;
    /// The smallest normal half.
    const NORMAL: f32 = 1.0 / 16_384.0;
    let sign = (bits >> 16 & 0x8000) as u16;
    let magnitude = value(bits & !SIGN);
    let half = if magnitude.is_nan() {
        0x7e00 | (bits >> 13 & 0x1ff) as u16
    } else if magnitude >= OVERFLOW {
        0x7c00
    } else if magnitude < NORMAL {
        (magnitude * 16_777_216.0).round_ties_even() as u16
    } else {
        let magnitude = magnitude.to_bits();
        let odd = magnitude >> 13 & 1;
        (((magnitude + 0xfff + odd) >> 13) - (112 << 10)) as u16
    };
    sign | half
}

/// 2 to the power of a number of fraction bits, 0 to 32, or its inverse: exact.
fn power_of_two(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Fixed to floating point, to nearest. `kind`: 1 unsigned, 2 of 32 bits.
pub(super) fn from_fixed(bits: u32, kind: u8, fraction_bits: u32) -> u32 {
    let integer = match kind & 3 {
        0 => f64::from(bits as i16),
        1 => f64::from(bits as u16),
        2 => f64::from(bits as i32),
        _ => f64::from(bits),
    };
    ((integer * power_of_two(-i64::from(fraction_bits))) as f32).to_bits()
}

/// Floating to fixed point, towards zero, saturating.
pub(super) fn to_fixed(bits: u32, kind: u8, fraction_bits: u32) -> u32 {
    let scaled = f64::from(value(bits)) * power_of_two(fraction_bits.into());
    match kind & 3 {
        0 => scaled as i16 as u32,
        1 => (scaled as u16).into(),
        2 => scaled as i32 as u32,
        _ => scaled as u32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_operations_make_the_positive_default_nan() {
        let infinity = f32::INFINITY.to_bits();
        assert_eq!(subtract(infinity, infinity), DEFAULT_NAN);
        assert_eq!(multiply(0, infinity), DEFAULT_NAN);
        assert_eq!(divide(0, SIGN), DEFAULT_NAN);
        assert_eq!(square_root((-1f32).to_bits()), DEFAULT_NAN);
    }

    #[test]
    fn a_signalling_nan_goes_before_a_quiet_one_and_comes_out_quiet() {
        let (quiet, signalling) = (0xffc0_1234, 0x7f80_0001);
        assert_eq!(add(quiet, 0), quiet);
        assert_eq!(add(quiet, signalling), signalling | QUIET);
        assert_eq!(subtract(0, quiet), quiet);
        assert_eq!(fused(quiet, 0, f32::INFINITY.to_bits()), DEFAULT_NAN);
    }

    #[test]
    fn a_chained_multiply_add_rounds_twice_and_a_fused_one_once() {
        // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24; the last term is lost when the product is rounded.
        let a = (1.0 + 2f32.powi(-12)).to_bits();
        let minus = (-(1.0 + 2f32.powi(-11))).to_bits();
        assert_eq!(add(minus, multiply(a, a)), 0);
        assert_eq!(fused(minus, a, a), 2f32.powi(-24).to_bits());
    }

    #[test]
    fn halves_go_to_single_and_back() {
        for half in 0..=u16::MAX {
            let is_signalling = half & 0x7e00 == 0x7c00 && half & 0x1ff != 0;
            let expected = if is_signalling { half | 0x200 } else { half };
            assert_eq!(to_half(from_half(half)), expected, "{half:#06x}");
        }
    }

    #[test]
    fn conversion_to_half_rounds_ties_to_even_and_overflows_to_infinity() {
        let half = |x: f32| to_half(x.to_bits());
        assert_eq!(half(2049.0), 0x6800, "2048");
        assert_eq!(half(2051.0), 0x6802, "2052");
        assert_eq!(half(65_519.0), 0x7bff);
        assert_eq!(half(65_520.0), 0x7c00);
        assert_eq!(half(2f32.powi(-25)), 0, "a tie with zero");
    }

    #[test]
    fn fixed_point_saturates_and_truncates() {
        let bits = |x: f32| x.to_bits();
        assert_eq!(to_fixed(bits(-1.75), 2, 1), -3i32 as u32);
        assert_eq!(to_fixed(bits(1e9), 0, 8), 0x7fff);
        assert_eq!(to_fixed(bits(-1.0), 1, 0), 0);
        assert_eq!(from_fixed(0xffff_ff80, 0, 7), bits(-1.0));
        assert_eq!(from_fixed(0x8000_0000, 3, 31), bits(1.0));
    }
}
