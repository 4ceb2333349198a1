//! A small model of what the controller sees: a band of samples, and a sensor's luma chain.

extern crate std;

use std::collections::VecDeque;
use std::vec;
use std::vec::Vec;

use super::super::{Exposure, ExposureParameters, LumaHistogram};

/// Samples of the horizon band.
const SAMPLES: usize = 768;
/// Read noise as a share of full scale at gain 1: 20 of 9000 electrons.
const READ_NOISE: f32 = 20.0 / 9000.0;
/// Factor on luma after gamma: the contrast of the TCM8230MD after reset.
const CONTRAST: f32 = 1.2;

/// A random number generator (xorshift32, Marsaglia 2003).
#[derive(Clone, Debug)]
struct Random(u32);

impl Random {
    /// Even in 0..1.
    fn even(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }

    /// Nearly normal, of mean 0 and variance 1: four even ones, each of variance 1/12.
    fn normal(&mut self) -> f32 {
        let sum: f32 = (0..4).map(|_| self.even()).sum();
        (sum - 2.0) * libm::sqrtf(3.0)
    }
}

/// The light on each sample.
#[derive(Clone, Debug)]
pub struct Band(Vec<f32>);

impl Band {
    /// Light whose logarithm has this standard deviation.
    pub fn of_texture(contrast: f32, seed: u32) -> Self {
        let mut random = Random(seed);
        Self(
            (0..SAMPLES)
                .map(|_| libm::expf(contrast * random.normal()))
                .collect(),
        )
    }

    /// A share of the band is brighter than it was: a window, the sun.
    pub fn with_bright_part(mut self, share: f32, times: f32) -> Self {
        let bright = (share * SAMPLES as f32) as usize;
        self.0[..bright]
            .iter_mut()
            .for_each(|light| *light *= times);
        self
    }
}

/// A sensor that shows a setting some frames after it was written.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Share of full scale on each sample at one line and gain 1.
    light: Vec<f32>,
    gamma: f32,
    black: f32,
    pipeline: VecDeque<Exposure>,
    random: Random,
}

impl Sensor {
    /// A sensor in light in which it needs `lines` at gain 1 for the set-point.
    pub fn new(band: &Band, lines: f32, parameters: &ExposureParameters, latency: usize) -> Self {
        let mut sensor = Self {
            light: band.0.clone(),
            gamma: parameters.gamma,
            black: parameters.black_level,
            pipeline: VecDeque::from(vec![parameters.initial; latency - 1]),
            random: Random(7),
        };
        let scale = sensor.scale_for(parameters.set_point) / lines;
        sensor.light.iter_mut().for_each(|light| *light *= scale);
        sensor
    }

    /// The exposure that gives this mean without noise, by halving the interval.
    fn scale_for(&self, mean: f32) -> f32 {
        let (mut low, mut high) = (1e-6_f32, 1e6_f32);
        for _ in 0..60 {
            let middle = libm::sqrtf(low * high);
            let lumas = self.light.iter().map(|light| self.luma(light * middle));
            if lumas.sum::<f32>() < mean * SAMPLES as f32 {
                low = middle;
            } else {
                high = middle;
            }
        }
        libm::sqrtf(low * high)
    }

    fn luma(&self, signal: f32) -> f32 {
        let signal = signal.clamp(0.0, 1.0);
        (255.0 * CONTRAST * libm::powf(signal, self.gamma) + self.black).min(255.0)
    }

    /// The next frame's band and its mean luma: `written` was written after the frame before it.
    pub fn frame(&mut self, written: Exposure) -> (f32, LumaHistogram) {
        self.pipeline.push_back(written);
        let shown = self.pipeline.pop_front().unwrap();
        let mut histogram = LumaHistogram::new();
        let mut sum = 0.0;
        for index in 0..self.light.len() {
            let signal = self.light[index] * f32::from(shown.shutter_lines);
            let shot = signal / 9000.0;
            let noise = libm::sqrtf(shot + READ_NOISE * READ_NOISE) * self.random.normal();
            let luma = self.luma((signal + noise).min(1.0) * shown.gain) + 0.5;
            histogram.add(luma as u8);
            sum += libm::floorf(luma.min(255.0));
        }
        (sum / SAMPLES as f32, histogram)
    }
}
