//! The second-order Butterworth low-pass filter of the IMU driver.

use core::f64::consts::{PI, SQRT_2};

use nalgebra::Vector3;

/// Three axes through a second-order Butterworth low-pass (bilinear transform, transposed direct form II).
#[derive(Debug, Clone)]
pub struct LowPass {
    /// Weights of the newest three inputs; the outer two are equal.
    outer: f64,
    /// Weight of the last output.
    first: f64,
    /// Weight of the output before it.
    second: f64,
    /// What the next two outputs inherit; empty until the first sample.
    memory: Option<[Vector3<f64>; 2]>,
}

impl LowPass {
    /// A filter of the given cut-off at the given sampling rate.
    pub fn new(cutoff_hz: f64, sampling_hz: f64) -> Self {
        let warped = libm::tan(PI * cutoff_hz / sampling_hz);
        let square = warped * warped;
        let norm = 1.0 + SQRT_2 * warped + square;
        Self {
            outer: square / norm,
            first: -2.0 * (square - 1.0) / norm,
            second: -(1.0 - SQRT_2 * warped + square) / norm,
            memory: None,
        }
    }

    /// Takes a sample, gives the filtered one. The first sample is taken for a long-standing one.
    pub fn tick(&mut self, input: Vector3<f64>) -> Vector3<f64> {
        // At rest the output equals the input.
        let [next, after] = self.memory.unwrap_or_else(|| {
            [
                input * (1.0 - self.outer),
                input * (self.outer + self.second),
            ]
        });
        let output = input * self.outer + next;
        self.memory = Some([
            input * (2.0 * self.outer) + output * self.first + after,
            input * self.outer + output * self.second,
        ]);
        output
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    /// Amplitude of the filtered sine, once settled.
    fn gain(cutoff_hz: f64, frequency_hz: f64) -> f64 {
        let mut filter = LowPass::new(cutoff_hz, 1000.0);
        (0..2000)
            .map(|ms| {
                let sine = libm::sin(TAU * frequency_hz * f64::from(ms) / 1000.0);
                (ms, filter.tick(Vector3::repeat(sine)).x.abs())
            })
            .filter(|(ms, _)| *ms > 1000)
            .fold(0.0, |largest, (_, value)| value.max(largest))
    }

    #[test]
    fn the_cut_off_is_three_decibels_down() {
        for cutoff in [30.0, 80.0] {
            assert!((gain(cutoff, cutoff) - 0.5_f64.sqrt()).abs() < 0.01);
            assert!(gain(cutoff, cutoff / 10.0) > 0.995);
            assert!(gain(cutoff, cutoff * 5.0) < 0.04);
        }
    }

    #[test]
    fn a_constant_passes_from_the_first_sample_on() {
        let mut filter = LowPass::new(30.0, 1000.0);
        for _ in 0..100 {
            let out = filter.tick(Vector3::new(0.1, -2.0, 9.81));
            assert!((out - Vector3::new(0.1, -2.0, 9.81)).norm() < 1e-12);
        }
    }
}
