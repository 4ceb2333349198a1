//! The filter's task: one pass per millisecond (`estimator_kalman`).

use nalgebra::Vector3;

use super::estimate::Estimate;
use super::measurements::Measurement;
use super::parameters::{GRAVITY_M_S2, PREDICTION_PERIOD_MS, Parameters};
use super::predict::Motion;
use super::state::State;

/// Measurements the queue holds, IMU samples included (`MEASUREMENTS_QUEUE_SIZE`).
pub const QUEUE_LENGTH: usize = 20;

/// The queue held [`QUEUE_LENGTH`] measurements already; the new one is lost, as in the firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the filter's measurement queue is full")]
pub struct QueueFull;

/// The filter with its queue and its clock.
#[derive(Debug, Clone)]
pub struct Ekf {
    parameters: Parameters,
    state: State,
    queue: Vec<Measurement>,
    gyroscope: Average,
    accelerometer: Average,
    /// Newest gyroscope sample, rad/s.
    angular_rate: Vector3<f32>,
    next_prediction_ms: u64,
    last_prediction_ms: u64,
    last_noise_ms: u64,
    reset_requested: bool,
    resets: u32,
}

impl Ekf {
    /// A freshly reset filter whose first tick is at `now_ms`.
    #[must_use]
    pub fn new(parameters: Parameters, now_ms: u64) -> Self {
        Self {
            state: State::initial(&parameters),
            parameters,
            queue: Vec::with_capacity(QUEUE_LENGTH),
            gyroscope: Average::in_units_of(core::f32::consts::PI / 180.0),
            accelerometer: Average::in_units_of(GRAVITY_M_S2),
            angular_rate: Vector3::zeros(),
            next_prediction_ms: now_ms,
            last_prediction_ms: now_ms,
            last_noise_ms: now_ms,
            reset_requested: false,
            resets: 0,
        }
    }

    /// Queues a measurement for the next tick.
    ///
    /// # Errors
    ///
    /// [`QueueFull`] if the queue holds [`QUEUE_LENGTH`] entries.
    pub fn enqueue(&mut self, measurement: Measurement) -> Result<(), QueueFull> {
        if self.queue.len() == QUEUE_LENGTH {
            return Err(QueueFull);
        }
        self.queue.push(measurement);
        Ok(())
    }

    /// Asks for a reset at the beginning of the next tick.
    pub fn request_reset(&mut self) {
        self.reset_requested = true;
    }

    /// How often the filter was reset, by request or by its own supervisor, since it was made.
    #[must_use]
    pub fn resets(&self) -> u32 {
        self.resets
    }

    /// The estimate after the last tick.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        Estimate::of(&self.state)
    }

    /// Covariance entry of states `i` and `j`, numbered 0..9 as position, body velocity, attitude error; `None`
    /// beyond.
    #[must_use]
    pub fn covariance(&self, i: usize, j: usize) -> Option<f32> {
        self.state.covariance.get((i, j)).copied()
    }

    /// One pass at `now_ms`, which must not run backwards. `flying` says whether the propellers carry the drone.
    ///
    /// An IMU sample queued for this tick acts in the next prediction; every other measurement corrects a position
    /// and velocity up to 10 ms old.
    pub fn tick(&mut self, now_ms: u64, flying: bool) {
        if core::mem::take(&mut self.reset_requested) {
            self.reset(now_ms);
        }
        let predicted = self.predict_if_due(now_ms, flying);
        let dt = seconds_between(self.last_noise_ms, now_ms);
        self.last_noise_ms = now_ms;
        self.state
            .add_process_noise(&self.parameters.process_noise, dt);
        let corrected = self.drain_queue();
        if predicted || corrected {
            self.state.finalise();
        }
        self.reset_requested |= self.state.out_of_bounds(self.parameters.max_position_m);
    }

    fn reset(&mut self, now_ms: u64) {
        self.state = State::initial(&self.parameters);
        self.gyroscope.clear();
        self.accelerometer.clear();
        self.last_prediction_ms = now_ms;
        self.last_noise_ms = now_ms;
        self.resets += 1;
    }

    fn predict_if_due(&mut self, now_ms: u64, flying: bool) -> bool {
        if now_ms < self.next_prediction_ms {
            return false;
        }
        let motion = Motion {
            angular_rate: self.gyroscope.take(),
            specific_force: self.accelerometer.take(),
            flying,
        };
        let dt = seconds_between(self.last_prediction_ms, now_ms);
        self.state.predict(&motion, dt, &self.parameters);
        self.last_prediction_ms = now_ms;
        self.next_prediction_ms = now_ms + PREDICTION_PERIOD_MS;
        true
    }

    /// Applies the queue in order of arrival; tells whether any entry corrected the state.
    fn drain_queue(&mut self) -> bool {
        let state = &mut self.state;
        let mut corrected = false;
        for measurement in self.queue.drain(..) {
            corrected |= !matches!(
                measurement,
                Measurement::Gyroscope(_) | Measurement::Accelerometer(_)
            );
            match measurement {
                Measurement::Gyroscope(sample) => {
                    self.gyroscope.add(&sample);
                    self.angular_rate = sample * self.gyroscope.unit;
                }
                Measurement::Accelerometer(sample) => self.accelerometer.add(&sample),
                Measurement::Flow(flow) => {
                    flow.correct(state, &self.angular_rate, &self.parameters.flow);
                }
                Measurement::Range(range) => range.correct(state, &self.parameters.range),
                Measurement::Position(position) => position.correct(state),
                Measurement::YawError(error) => error.correct(state),
                Measurement::AbsoluteHeight(height) => height.correct(state),
                Measurement::Pose(pose) => pose.correct(state),
            }
        }
        corrected
    }
}

/// Mean of the samples since it was last taken (`axis3fSubSampler`).
#[derive(Debug, Clone)]
struct Average {
    /// SI units in one unit of the samples.
    unit: f32,
    sum: Vector3<f32>,
    count: u16,
    /// The last mean, SI units: taken again when no sample has come since.
    mean: Vector3<f32>,
}

impl Average {
    fn in_units_of(unit: f32) -> Self {
        Self {
            unit,
            sum: Vector3::zeros(),
            count: 0,
            mean: Vector3::zeros(),
        }
    }

    fn add(&mut self, sample: &Vector3<f32>) {
        self.sum += sample;
        self.count = self.count.saturating_add(1);
    }

    fn take(&mut self) -> Vector3<f32> {
        if self.count > 0 {
            self.mean = self.sum * (self.unit / f32::from(self.count));
            self.sum.fill(0.0);
            self.count = 0;
        }
        self.mean
    }

    fn clear(&mut self) {
        *self = Self::in_units_of(self.unit);
    }
}

fn seconds_between(from_ms: u64, to_ms: u64) -> f32 {
    to_ms.saturating_sub(from_ms) as f32 * 0.001
}
