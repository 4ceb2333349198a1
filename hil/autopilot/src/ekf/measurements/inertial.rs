//! One sample of the inertial sensors.

use nalgebra::Vector3;

use super::Measurement;

/// What the IMU's driver delivers each millisecond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuSample {
    /// Angular rate, body frame, deg/s, after the driver's 80 Hz filter.
    pub gyro_deg_s: Vector3<f32>,
    /// Specific force, body frame, in units of g, after the driver's 30 Hz filter.
    pub acc_g: Vector3<f32>,
}

impl ImuSample {
    /// The two entries it makes in the filter's queue, in the firmware's order.
    #[must_use]
    pub fn measurements(&self) -> [Measurement; 2] {
        [
            Measurement::Gyroscope(self.gyro_deg_s),
            Measurement::Accelerometer(self.acc_g),
        ]
    }
}
