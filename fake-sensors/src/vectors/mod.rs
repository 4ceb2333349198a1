//! Inner loops, compiled for the vectors of the processor at hand.
//!
//! The same operations on more numbers at once: no multiplication is fused with an addition, so the
//! results are those of every other machine, to the bit.

pub mod eight;

/// An inner loop. Whatever `run` calls must be inlined into it, or it is compiled for any processor.
pub trait Kernel {
    /// What it gives.
    type Output;

    /// Does it; to be marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// Runs a kernel on the widest vectors that are worth it: eight numbers where there is AVX2.
#[inline]
pub fn run<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has AVX2.
        return unsafe { run_on_eight(kernel) };
    }
    run_on_any(kernel)
}

#[inline(never)]
fn run_on_any<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_on_eight<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

/// `x`, but from 0 to `last`, and 0 of what is no number: an instruction each way, which `clamp` is not.
#[inline(always)]
pub fn within(x: f32, last: f32) -> f32 {
    let x = if x > 0.0 { x } else { 0.0 };
    if x < last { x } else { last }
}

/// Whole and fractional part of a number from 0 to 2^22. (A cast from float to integer saturates, for
/// which there is no instruction, and `floor` is a call where the processor may have none for it.)
#[inline(always)]
pub fn split(x: f32) -> (usize, f32) {
    /// 2^23: the last bit of what is added to it is one.
    const ONES: f32 = 8_388_608.0;
    let shifted = x + ONES;
    let nearest = shifted - ONES;
    let (less, whole) = if nearest > x {
        (1, nearest - 1.0)
    } else {
        (0, nearest)
    };
    let count = shifted.to_bits() - ONES.to_bits() - less;
    (count as usize, x - whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a fused multiplication would change.
    struct Squares<'n>(&'n [f32; 64]);

    impl Kernel for Squares<'_> {
        type Output = [f32; 64];

        #[inline(always)]
        fn run(self) -> [f32; 64] {
            self.0.map(|x| (x * x + x).sqrt() / (x + 0.1))
        }
    }

    #[test]
    fn a_kernel_gives_the_same_bits_on_wide_vectors_and_on_any_processor() {
        let numbers = core::array::from_fn(|n| 1e-3 + 1.7 * n as f32 / (3.0 + n as f32));
        let bits = |numbers: [f32; 64]| numbers.map(f32::to_bits);
        assert_eq!(bits(run(Squares(&numbers))), bits(Squares(&numbers).run()));
    }

    #[test]
    fn a_number_splits_into_what_floor_says_and_the_rest() {
        let places = [
            0.0,
            0.25,
            0.5,
            0.999_999_94,
            1.0,
            1.5,
            2.5,
            3.5,
            4_194_303.5,
        ];
        for x in places {
            let (whole, rest) = split(x);
            assert_eq!((whole as f32, rest), (x.floor(), x.fract()));
        }
    }

    #[test]
    fn what_is_no_number_is_within_as_zero() {
        let clamped = [f32::NAN, -1.0, 0.5, 9.0, f32::INFINITY].map(|x| within(x, 7.0));
        assert_eq!(clamped, [0.0, 0.0, 0.5, 7.0, 7.0]);
    }
}
