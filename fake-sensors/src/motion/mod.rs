//! Motion sensors of a Crazyflie with a flow deck: IMU, optical flow of the ground, range to the ground.
//!
//! Each takes the truth once a millisecond and answers when its hardware would. The drivers' part of the way is
//! included (filters, truncation, rejects), so a reading is what the autopilot's estimator is handed.
//!
//! Frames: world x forward, y left, z up; body x front, y left, z up.

mod flow;
mod imu;
mod low_pass;
mod model;
mod range;
#[cfg(test)]
mod tests;

pub use flow::{FlowDeck, FlowReading};
pub use imu::{Imu, ImuReading};
pub use model::{FlowModel, ImuModel, RangeModel, ScaleSwing, SensorModel, StatedSd};
pub use range::{RangeReading, RangeSensor};

use nalgebra::{UnitQuaternion, Vector3};

/// True motion of the body at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionTruth {
    /// Position in the world, m. The ground is at height zero.
    pub position_m: Vector3<f64>,
    /// Velocity in the world, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f64>,
    /// Angular rate, body frame, rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// Specific force, body frame, m/s²: what an ideal accelerometer reads.
    pub specific_force_m_s2: Vector3<f64>,
}

impl MotionTruth {
    /// The world's up direction in the body frame.
    fn up_in_body(&self) -> Vector3<f64> {
        self.attitude.inverse_transform_vector(&Vector3::z())
    }
}

/// What the sensors deliver in one millisecond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionReadings {
    /// The IMU answers every time.
    pub imu: ImuReading,
    /// The flow deck, every 10 to 11 ms.
    pub flow: Option<FlowReading>,
    /// The range sensor, every 30 ms.
    pub range: Option<RangeReading>,
}

/// The three sensors together.
#[derive(Debug, Clone)]
pub struct MotionSensors {
    imu: Imu,
    flow: FlowDeck,
    range: RangeSensor,
}

impl MotionSensors {
    /// Sensors of the given quality; `seed` draws their constant errors and their noise.
    #[must_use]
    pub fn new(model: &SensorModel, seed: u64) -> Self {
        Self {
            imu: Imu::new(&model.imu, seed),
            flow: FlowDeck::new(&model.flow, seed),
            range: RangeSensor::new(&model.range, seed),
        }
    }

    /// One millisecond on: takes the truth at its end.
    pub fn tick(&mut self, truth: &MotionTruth) -> MotionReadings {
        MotionReadings {
            imu: self.imu.tick(truth),
            flow: self.flow.tick(truth),
            range: self.range.tick(truth),
        }
    }
}

/// Streams of the seed: one per sensor. The numbers are the sensors' initials in ASCII, clear of the small numbers
/// other rooms count from.
mod stream {
    pub const GYROSCOPE: u64 = u64::from_be_bytes(*b"gyroscop");
    pub const ACCELEROMETER: u64 = u64::from_be_bytes(*b"accelero");
    pub const FLOW: u64 = u64::from_be_bytes(*b"flowdeck");
    pub const FLOW_SCALE: u64 = u64::from_be_bytes(*b"flowscal");
    pub const RANGE: u64 = u64::from_be_bytes(*b"rangetof");
}
