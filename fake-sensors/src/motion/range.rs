//! Range to the ground: the VL53L1x of the flow deck with its driver.

use super::model::RangeModel;
use super::{MotionTruth, stream};
use crate::random::Normal;

/// Time between two readings, ms: a budget of 25 ms and the bus (`zranger2` runs at 25 to 40 Hz in practice).
const PERIOD_MS: u32 = 30;
/// The driver drops readings from here on, m.
const MAX_RANGE_M: f64 = 5.0;
/// Half the sensor's cone as the firmware takes it, degrees: the nearest ray within it is measured.
const HALF_CONE_DEG: f64 = 7.5;
/// Cosine of the tilt beyond which no ground is in sight.
const MIN_COS_TILT: f64 = 0.1;

/// One reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeReading {
    /// Distance along the body's downward axis, m, in whole millimetres.
    pub distance_m: f32,
    /// The standard deviation the driver states, m.
    pub sd_m: f32,
}

/// The range sensor.
#[derive(Debug, Clone)]
pub struct RangeSensor {
    noise: Normal,
    noise_m: f64,
    offset_m: f64,
    elapsed_ms: u32,
}

impl RangeSensor {
    /// A sensor whose offset and noise follow from `seed`.
    #[must_use]
    pub fn new(model: &RangeModel, seed: u64) -> Self {
        let mut noise = Normal::new(seed, stream::RANGE);
        Self {
            offset_m: noise.sample() * model.offset_sd_m,
            noise,
            noise_m: model.noise_m,
            elapsed_ms: 0,
        }
    }

    /// One millisecond on. Answers every 30 ms, unless the ground is out of sight.
    pub fn tick(&mut self, truth: &MotionTruth) -> Option<RangeReading> {
        self.elapsed_ms += 1;
        if self.elapsed_ms < PERIOD_MS {
            return None;
        }
        self.elapsed_ms = 0;
        let noise = self.noise.sample() * self.noise_m;
        let distance = distance(truth)? + self.offset_m + noise;
        let distance = libm::round(distance.max(0.0) * 1000.0) / 1000.0;
        (distance < MAX_RANGE_M).then(|| RangeReading {
            distance_m: distance as f32,
            sd_m: stated_sd(distance) as f32,
        })
    }
}

/// Distance to the ground along the nearest ray of the cone.
fn distance(truth: &MotionTruth) -> Option<f64> {
    let cos_tilt = truth.up_in_body().z;
    if cos_tilt <= MIN_COS_TILT {
        return None;
    }
    let beyond_cone = libm::acos(cos_tilt.min(1.0)) - HALF_CONE_DEG.to_radians();
    Some(truth.position_m.z / libm::cos(beyond_cone.max(0.0)))
}

/// The driver's standard deviation, m: 2.5 mm near, 5 mm at 2.5 m, 0.2 m at 4 m.
fn stated_sd(distance_m: f64) -> f64 {
    const NEAR_M: f64 = 0.0025;
    const TURN_M: f64 = 2.5;
    // Eighty times the near value at 4 m.
    let steepness = libm::log(80.0) / 1.5;
    NEAR_M * (1.0 + libm::exp(steepness * (distance_m - TURN_M)))
}
