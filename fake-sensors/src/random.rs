//! Normal and uniform deviates that are the same on every machine.
//!
//! ChaCha8 gives the bits, the Box-Muller transform shapes them, and `libm` supplies its logarithm, sine and
//! cosine: no operation here depends on the platform's maths library.

use core::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// A reproducible source of random deviates.
///
/// One seed opens 2^64 independent streams. A sensor takes a stream of its own, so that adding a sensor, or a draw
/// to one, leaves the others' noise as it was.
#[derive(Debug, Clone)]
pub struct Normal {
    generator: ChaCha8Rng,
    /// The second deviate of the last Box-Muller pair.
    spare: Option<f64>,
}

impl Normal {
    /// Opens stream number `stream` of `seed`.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self {
            generator,
            spare: None,
        }
    }

    /// A deviate of mean 0 and standard deviation 1 (Box & Muller 1958).
    pub fn sample(&mut self) -> f64 {
        if let Some(deviate) = self.spare.take() {
            return deviate;
        }
        // 1 - u lies in (0, 1]: the logarithm is finite.
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        let (sin, cos) = libm::sincos(TAU * self.uniform());
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// A deviate spread evenly over [0, 1), in steps of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.generator.next_u64() >> 11) as f64 * STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
        (mean, variance)
    }

    #[test]
    fn normal_deviates_have_mean_zero_and_variance_one() {
        let mut source = Normal::new(7, 0);
        let values: Vec<f64> = (0..100_000).map(|_| source.sample()).collect();
        let (mean, variance) = moments(&values);
        // Five standard errors: 5 / sqrt(n) and 5 sqrt(2 / n).
        assert!(mean.abs() < 0.016, "mean {mean}");
        assert!((variance - 1.0).abs() < 0.023, "variance {variance}");
        let beyond_two = values.iter().filter(|v| v.abs() > 2.0).count() as f64 / 1e5;
        assert!((beyond_two - 0.0455).abs() < 0.004, "tails {beyond_two}");
    }

    #[test]
    fn uniform_deviates_fill_the_unit_interval() {
        let mut source = Normal::new(7, 1);
        let values: Vec<f64> = (0..100_000).map(|_| source.uniform()).collect();
        let (mean, variance) = moments(&values);
        assert!(values.iter().all(|v| (0.0..1.0).contains(v)));
        assert!((mean - 0.5).abs() < 0.005, "mean {mean}");
        assert!((variance - 1.0 / 12.0).abs() < 0.002, "variance {variance}");
    }

    #[test]
    fn a_seed_repeats_and_streams_differ() {
        let draw = |seed, stream| {
            let mut source = Normal::new(seed, stream);
            [source.sample(), source.sample(), source.sample()]
        };
        assert_eq!(draw(3, 1), draw(3, 1));
        assert_ne!(draw(3, 1), draw(3, 2));
        assert_ne!(draw(3, 1), draw(4, 1));
    }
}
