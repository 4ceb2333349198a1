//! Optical flow of the ground: the PMW3901 of the flow deck with its driver.

use core::f64::consts::TAU;

use nalgebra::Vector2;

use super::model::{FlowModel, ScaleSwing, StatedSd};
use super::{MotionTruth, stream};
use crate::random::Normal;

/// Counts per radian the ground moves through the image: 35 pixels across 2 sin 21°, ten counts each (`mm_flow`).
const COUNTS_PER_RAD: f64 = 35.0 / 0.716_74 * 10.0;
/// The driver rejects readings of this size and beyond, on either axis.
const MAX_COUNTS: f64 = 100.0;
/// Below this the sensor sees no motion, for want of focus and light. The data sheet promises work from 80 mm;
/// Crazyflies report flow from about 3 cm (assumed).
const MIN_HEIGHT_M: f64 = 0.03;
/// The driver sleeps this long between readings, ms; the reading itself takes up to one more.
const SLEEP_MS: u32 = 10;
/// Each tick is one millisecond.
const TICK_S: f64 = 0.001;

/// One reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowReading {
    /// Counts along the body's x and y axes in the driver's signs: motion along an axis counts up.
    pub counts: [i16; 2],
    /// Time since the last reading, s.
    pub dt_s: f32,
    /// The standard deviation the driver states, counts.
    pub sd_counts: f32,
}

/// The flow deck.
#[derive(Debug, Clone)]
pub struct FlowDeck {
    noise: Normal,
    noise_counts: f64,
    counts_per_rad: f64,
    swing: Option<Swing>,
    stated_sd: StatedSd,
    /// Cosine and sine of the deck's rotation about the body's z axis.
    mounting: (f64, f64),
    /// Counts not reported yet: whole ones of this interval, and what truncation left of earlier ones.
    pending: Vector2<f64>,
    elapsed_ms: u32,
    interval_ms: u32,
}

impl FlowDeck {
    /// A deck whose constant errors and noise follow from `seed`.
    #[must_use]
    pub fn new(model: &FlowModel, seed: u64) -> Self {
        let mut noise = Normal::new(seed, stream::FLOW);
        let (sin, cos) = libm::sincos(noise.sample() * model.mounting_yaw_sd_rad);
        Self {
            counts_per_rad: COUNTS_PER_RAD * (1.0 + noise.sample() * model.scale_sd),
            swing: model.scale_swing.map(|swing| Swing::new(&swing, seed)),
            noise,
            noise_counts: model.noise_counts,
            stated_sd: model.stated_sd,
            mounting: (cos, sin),
            pending: Vector2::zeros(),
            elapsed_ms: 0,
            interval_ms: SLEEP_MS,
        }
    }

    /// One millisecond on. Answers at the end of an interval, unless the driver would drop the reading.
    pub fn tick(&mut self, truth: &MotionTruth) -> Option<FlowReading> {
        let swing = self.swing.as_mut().map_or(1.0, Swing::tick);
        self.pending += self.seen(truth) * (self.counts_per_rad * TICK_S * swing);
        self.elapsed_ms += 1;
        if self.elapsed_ms < self.interval_ms {
            return None;
        }
        let dt_s = (f64::from(self.elapsed_ms) * TICK_S) as f32;
        self.elapsed_ms = 0;
        self.interval_ms = SLEEP_MS + u32::from(self.noise.uniform() < 0.5);
        let counts = self.read_out();
        let in_sight = truth.position_m.z >= MIN_HEIGHT_M && truth.up_in_body().z > 0.0;
        (in_sight && counts.amax() < MAX_COUNTS).then(|| FlowReading {
            counts: [counts.x as i16, counts.y as i16],
            dt_s,
            sd_counts: self.stated_sd.counts(),
        })
    }

    /// Angular velocity of the ground in the deck's axes, rad/s.
    fn seen(&self, truth: &MotionTruth) -> Vector2<f64> {
        let velocity = truth.attitude.inverse_transform_vector(&truth.velocity_m_s);
        let per_metre = truth.up_in_body().z / truth.position_m.z.max(MIN_HEIGHT_M);
        let rate = truth.angular_rate_rad_s;
        let x = velocity.x * per_metre - rate.y;
        let y = velocity.y * per_metre + rate.x;
        let (cos, sin) = self.mounting;
        Vector2::new(cos * x + sin * y, cos * y - sin * x)
    }

    /// Whole counts, towards zero; the rest stays for the next interval.
    fn read_out(&mut self) -> Vector2<f64> {
        self.pending += Vector2::from_fn(|_, _| self.noise.sample()) * self.noise_counts;
        let counts = self.pending.map(libm::trunc);
        self.pending -= counts;
        counts
    }
}

/// The factor on the scale that swings about one.
#[derive(Debug, Clone)]
struct Swing {
    amplitude: f64,
    phase_rad: f64,
    rad_per_tick: f64,
}

impl Swing {
    fn new(swing: &ScaleSwing, seed: u64) -> Self {
        Self {
            amplitude: swing.amplitude,
            phase_rad: TAU * Normal::new(seed, stream::FLOW_SCALE).uniform(),
            rad_per_tick: TAU * TICK_S / swing.period_s,
        }
    }

    fn tick(&mut self) -> f64 {
        self.phase_rad = libm::remainder(self.phase_rad + self.rad_per_tick, TAU);
        1.0 + self.amplitude * libm::sin(self.phase_rad)
    }
}
