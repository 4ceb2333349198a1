//! Dryden's continuous turbulence: shaping filters for white noise, exact at the steps of a fixed rate.
//!
//! A filter's stationary covariance and its transition over a step are known in closed form, so that the noise to add
//! at each step follows without approximation: values a step apart have exactly the variance and the correlation of
//! the continuous process, however coarse the step.

use crate::random::Normal;

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Size and shape of the eddies (MIL-F-8785C, low-altitude model).
///
/// The formulas hold from 10 ft up to 1000 ft. Below 10 ft they are carried on towards the ground, where they pass
/// into the law of the surface layer: lengths in proportion to the height, horizontal components twice as strong as
/// the vertical one. At 0.5 m that makes eddies of 4 m; the lengths of 10 ft would be 23 m, too slow a swing to try
/// the drone with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Length of the horizontal components, m.
    pub horizontal_m: f64,
    /// Length of the vertical component, m.
    pub vertical_m: f64,
    /// Standard deviation of the vertical component over that of a horizontal one.
    pub vertical_share: f64,
}

impl Scales {
    /// At a height above the ground, m.
    #[must_use]
    pub fn at_height(height_m: f64) -> Self {
        const FEET_PER_M: f64 = 1.0 / 0.3048;
        let shape = 0.177 + 0.000_823 * height_m * FEET_PER_M;
        Self {
            horizontal_m: height_m / libm::pow(shape, 1.2),
            vertical_m: height_m,
            vertical_share: libm::pow(shape, 0.4),
        }
    }
}

/// The component along the wind: H(s) = σ √(2τ) / (1 + τs), with the correlation e^(-t/τ).
#[derive(Debug, Clone)]
pub struct Longitudinal {
    sigma: f64,
    decay: f64,
    noise: f64,
    state: f64,
}

impl Longitudinal {
    /// A filter of output deviation `sigma` at steps of `step` time constants.
    pub fn new(sigma: f64, step: f64, random: &mut Normal) -> Self {
        Self {
            sigma,
            decay: libm::exp(-step),
            noise: (-libm::expm1(-2.0 * step)).sqrt(),
            state: random.sample(),
        }
    }

    /// The value now; the state moves on to the next step.
    pub fn tick(&mut self, random: &mut Normal) -> f64 {
        let value = self.sigma * self.state;
        self.state = self.decay * self.state + self.noise * random.sample();
        value
    }
}

/// A component across the wind: H(s) = σ √τ (1 + √3 τs) / (1 + τs)², with the correlation e^(-t/τ) (1 - t/2τ).
///
/// States: the noise through one lag and through two, in units that make their stationary covariance
/// ((1/2, 1/4), (1/4, 1/4)).
#[derive(Debug, Clone)]
pub struct Transverse {
    sigma: f64,
    step: f64,
    decay: f64,
    noise: Cholesky,
    state: [f64; 2],
}

impl Transverse {
    const STATIONARY: [f64; 3] = [0.5, 0.25, 0.25];

    /// A filter of output deviation `sigma` at steps of `step` time constants.
    pub fn new(sigma: f64, step: f64, random: &mut Normal) -> Self {
        let decay = libm::exp(-step);
        let square = decay * decay;
        // ∫ (1, s, s²) e^(-2s) ds from 0 to the step.
        let noise = [
            0.5 * (1.0 - square),
            0.25 * (1.0 - (1.0 + 2.0 * step) * square),
            0.25 * (1.0 - (1.0 + 2.0 * step + 2.0 * step * step) * square),
        ];
        Self {
            sigma,
            step,
            decay,
            noise: Cholesky::of(noise),
            state: Cholesky::of(Self::STATIONARY).draw(random),
        }
    }

    /// The value now; the state moves on to the next step.
    pub fn tick(&mut self, random: &mut Normal) -> f64 {
        let [once, twice] = self.state;
        // 1 + √3 τs = √3 (1 + τs) + (1 - √3).
        let value = self.sigma * (SQRT_3 * once + (1.0 - SQRT_3) * twice);
        let [first, second] = self.noise.draw(random);
        self.state = [
            self.decay * once + first,
            self.decay * (twice + self.step * once) + second,
        ];
        value
    }
}

/// Lower triangular root of a 2x2 covariance.
#[derive(Debug, Clone)]
struct Cholesky {
    first: f64,
    cross: f64,
    second: f64,
}

impl Cholesky {
    /// Of the matrix ((a, b), (b, c)). Rounding below zero counts as zero, so that a step of no length adds nothing.
    fn of([a, b, c]: [f64; 3]) -> Self {
        let first = a.max(0.0).sqrt();
        let cross = if first > 0.0 { b / first } else { 0.0 };
        Self {
            first,
            cross,
            second: (c - cross * cross).max(0.0).sqrt(),
        }
    }

    fn draw(&self, random: &mut Normal) -> [f64; 2] {
        let (a, b) = (random.sample(), random.sample());
        [self.first * a, self.cross * a + self.second * b]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_step_of_any_length_keeps_the_stationary_covariance(exponent in -5.0..1.0_f64) {
            let step = 10_f64.powf(exponent);
            let filter = Transverse::new(1.0, step, &mut Normal::new(1, 0));
            let Cholesky { first, cross, second } = filter.noise;
            let [a, b, c] = Transverse::STATIONARY;
            // Transition e^-step ((1, 0), (step, 1)) on both sides of the covariance, and the noise.
            let square = (-2.0 * step).exp();
            let kept = [
                square * a + first * first,
                square * (b + step * a) + first * cross,
                square * (c + 2.0 * step * b + step * step * a) + cross * cross + second * second,
            ];
            for (kept, stationary) in kept.into_iter().zip([a, b, c]) {
                prop_assert!((kept - stationary).abs() < 1e-12, "{kept} against {stationary}");
            }
        }
    }
}
