//! The conditions, and the grid of them.

use fake_sensors::camera::Exposure;
use fake_sensors::camera::tcm8230::ExposureLatency;
use serde::Serialize;

use super::Scene;

/// How much brighter the brightest light is than the darkest.
const LIGHT_RANGE: f64 = 1000.0;
/// The brightest light of the grid: a linear sensor needs so many lines in it. With gamma on it needs 0.29 of that in a
/// uniform scene ((68 / 307)^(1 / 0.55 - 1), from set-point, contrast and black level), and one line is the least: there
/// is a setting that reaches the set-point in all of the grid.
const BRIGHTEST_NEEDS_LINES: f64 = 4.0;

/// One condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// What is looked at.
    pub scene: &'static str,
    /// The light: lines at gain 1 with which a linear sensor would hold the set-point in it. More is darker.
    pub needs_lines: f64,
    /// The shutter before frame 1, lines.
    pub initial_lines: u16,
    /// The gain before frame 1.
    pub initial_gain: f32,
    /// Frames until a written setting shows.
    pub latency: usize,
    /// Whether the sensor's gamma of 0.55 is on.
    pub gamma: bool,
}

impl Condition {
    /// The setting before frame 1, as the sensor takes it.
    pub(super) fn initial(&self) -> Exposure {
        Exposure {
            lines: self.initial_lines,
            gain: self.initial_gain,
        }
    }

    pub(super) fn exposure_latency(&self) -> ExposureLatency {
        match self.latency {
            1 => ExposureLatency::One,
            2 => ExposureLatency::Two,
            _ => ExposureLatency::Three,
        }
    }

    /// In a line.
    pub fn in_words(&self) -> String {
        format!(
            "{}, light for {:.1} lines, from {} x {}, latency {}, gamma {}",
            self.scene,
            self.needs_lines,
            self.initial_lines,
            self.initial_gain,
            self.latency,
            if self.gamma { "on" } else { "off" }
        )
    }
}

/// Which conditions are tried: all combinations.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Levels of light, in equal logarithmic steps over 1 : 1000, both ends included.
    pub lights: usize,
    /// Shutter and gain before frame 1.
    pub initial: Vec<(u16, f32)>,
}

impl Grid {
    /// The whole grid.
    pub fn whole() -> Self {
        Self {
            lights: 10,
            initial: vec![
                (1, 1.0),
                (1, 16.0),
                (12, 4.0),
                (135, 1.0),
                (135, 16.0),
                (525, 1.0),
                (525, 16.0),
            ],
        }
    }

    /// A coarse one: its corners and its middle.
    pub fn coarse() -> Self {
        Self {
            lights: 4,
            initial: vec![(1, 1.0), (135, 1.0), (525, 16.0)],
        }
    }

    /// Its conditions in these scenes.
    pub fn conditions(&self, scenes: &[Scene]) -> Vec<Condition> {
        let steps = self.lights.saturating_sub(1).max(1) as f64;
        let lights: Vec<f64> = (0..self.lights)
            .map(|step| BRIGHTEST_NEEDS_LINES * libm::pow(LIGHT_RANGE, step as f64 / steps))
            .collect();
        let mut conditions = Vec::new();
        for scene in scenes {
            for &needs_lines in &lights {
                for &(initial_lines, initial_gain) in &self.initial {
                    for (latency, gamma) in (1..=3).flat_map(|l| [(l, false), (l, true)]) {
                        conditions.push(Condition {
                            scene: scene.name,
                            needs_lines,
                            initial_lines,
                            initial_gain,
                            latency,
                            gamma,
                        });
                    }
                }
            }
        }
        conditions
    }
}
