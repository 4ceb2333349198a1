//! Gyroscope and accelerometer (BMI088) with the driver's filters.

use nalgebra::Vector3;

use super::low_pass::LowPass;
use super::model::ImuModel;
use super::{MotionTruth, stream};
use crate::random::Normal;

/// Samples per second, and calls to [`Imu::tick`].
const RATE_HZ: f64 = 1000.0;
/// The driver's cut-off for the gyroscope (`GYRO_LPF_CUTOFF_FREQ`).
const GYRO_CUTOFF_HZ: f64 = 80.0;
/// The driver's cut-off for the accelerometer (`ACCEL_LPF_CUTOFF_FREQ`).
const ACC_CUTOFF_HZ: f64 = 30.0;
/// The driver's range of the gyroscope.
const GYRO_RANGE_DEG_S: f64 = 2000.0;
/// The driver's range of the accelerometer.
const ACC_RANGE_G: f64 = 24.0;
/// Gravity as the firmware rounds it, m/s².
const GRAVITY_M_S2: f64 = 9.81;

/// One sample, in the units of the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuReading {
    /// Angular rate, body frame, deg/s.
    pub gyro_deg_s: Vector3<f32>,
    /// Specific force, body frame, g.
    pub acc_g: Vector3<f32>,
}

/// The IMU.
#[derive(Debug, Clone)]
pub struct Imu {
    model: ImuModel,
    gyro_noise: Normal,
    acc_noise: Normal,
    gyro_bias_deg_s: Vector3<f64>,
    gyro_scale: Vector3<f64>,
    acc_bias_g: Vector3<f64>,
    gyro_filter: LowPass,
    acc_filter: LowPass,
}

impl Imu {
    /// An IMU whose constant errors and noise follow from `seed`.
    #[must_use]
    pub fn new(model: &ImuModel, seed: u64) -> Self {
        let mut gyro_noise = Normal::new(seed, stream::GYROSCOPE);
        let mut acc_noise = Normal::new(seed, stream::ACCELEROMETER);
        Self {
            model: *model,
            gyro_bias_deg_s: deviates(&mut gyro_noise) * model.gyro_bias_sd_deg_s,
            gyro_scale: deviates(&mut gyro_noise).map(|d| 1.0 + d * model.gyro_scale_sd),
            acc_bias_g: deviates(&mut acc_noise) * model.acc_bias_sd_g,
            gyro_noise,
            acc_noise,
            gyro_filter: LowPass::new(GYRO_CUTOFF_HZ, RATE_HZ),
            acc_filter: LowPass::new(ACC_CUTOFF_HZ, RATE_HZ),
        }
    }

    /// One millisecond on.
    pub fn tick(&mut self, truth: &MotionTruth) -> ImuReading {
        let step = self.model.gyro_walk_deg_s_per_sqrt_s / RATE_HZ.sqrt();
        self.gyro_bias_deg_s += deviates(&mut self.gyro_noise) * step;

        let rate = truth.angular_rate_rad_s.map(f64::to_degrees);
        let gyro = rate.component_mul(&self.gyro_scale)
            + self.gyro_bias_deg_s
            + deviates(&mut self.gyro_noise) * self.model.gyro_noise_deg_s;
        let acc = truth.specific_force_m_s2 / GRAVITY_M_S2
            + self.acc_bias_g
            + deviates(&mut self.acc_noise) * self.model.acc_noise_g;

        let within = |limit: f64| move |value: f64| value.clamp(-limit, limit);
        ImuReading {
            gyro_deg_s: self
                .gyro_filter
                .tick(gyro.map(within(GYRO_RANGE_DEG_S)))
                .cast(),
            acc_g: self.acc_filter.tick(acc.map(within(ACC_RANGE_G))).cast(),
        }
    }
}

/// Three normal deviates.
fn deviates(source: &mut Normal) -> Vector3<f64> {
    Vector3::from_fn(|_, _| source.sample())
}
