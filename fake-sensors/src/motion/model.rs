//! How good the sensors are.
//!
//! The defaults are "model A": with it the Crazyflie's filter drifts by 13 cm RMS across a 5 m leg, the figure of the
//! paper's odometry experiment. Driver constants are those of crazyflie-firmware 2a18fc29; what is assumed says so.

/// Quality of all motion sensors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorModel {
    /// Gyroscope and accelerometer.
    pub imu: ImuModel,
    /// Optical flow.
    pub flow: FlowModel,
    /// Range to the ground.
    pub range: RangeModel,
}

impl SensorModel {
    /// Sensors without noise, bias, scale or mounting error. What remains is their rate, filters and rounding.
    #[must_use]
    pub const fn ideal() -> Self {
        Self {
            imu: ImuModel {
                gyro_noise_deg_s: 0.0,
                gyro_bias_sd_deg_s: 0.0,
                gyro_walk_deg_s_per_sqrt_s: 0.0,
                gyro_scale_sd: 0.0,
                acc_noise_g: 0.0,
                acc_bias_sd_g: 0.0,
            },
            flow: FlowModel {
                noise_counts: 0.0,
                scale_sd: 0.0,
                scale_swing: None,
                mounting_yaw_sd_rad: 0.0,
                stated_sd: StatedSd::Fixed,
            },
            range: RangeModel {
                noise_m: 0.0,
                offset_sd_m: 0.0,
            },
        }
    }
}

/// Errors of the BMI088, before the driver's filters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuModel {
    /// White noise of a 1 kHz gyroscope sample, deg/s.
    pub gyro_noise_deg_s: f64,
    /// Standard deviation of the constant bias left after start-up, per axis, deg/s.
    pub gyro_bias_sd_deg_s: f64,
    /// Random walk of the bias, deg/s per √s.
    pub gyro_walk_deg_s_per_sqrt_s: f64,
    /// Standard deviation of the scale error, per axis.
    pub gyro_scale_sd: f64,
    /// White noise of a 1 kHz accelerometer sample, g.
    pub acc_noise_g: f64,
    /// Standard deviation of the constant bias, per axis, g.
    pub acc_bias_sd_g: f64,
}

impl Default for ImuModel {
    fn default() -> Self {
        Self {
            // Assumed in-flight vibration; a Crazyflie at rest logs 0.12 to 0.17.
            gyro_noise_deg_s: 2.0,
            // Other gyroscopes in flight after zeroing: 0.06 to 0.23 (betaflight pull request 4986).
            gyro_bias_sd_deg_s: 0.1,
            // Assumed.
            gyro_walk_deg_s_per_sqrt_s: 0.005,
            // Assumed, typical of MEMS.
            gyro_scale_sd: 0.01,
            // Assumed in-flight vibration; a Crazyflie at rest logs 1 mg.
            acc_noise_g: 0.050,
            // Zero-g offset of the BMI088's class (BMI088 data sheet, table 3: ±20 mg).
            acc_bias_sd_g: 0.020,
        }
    }
}

/// Errors of the PMW3901 on its deck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowModel {
    /// White noise of a reading, per axis, counts.
    pub noise_counts: f64,
    /// Standard deviation of the scale error, common to both axes.
    pub scale_sd: f64,
    /// What the scale does in time besides.
    pub scale_swing: Option<ScaleSwing>,
    /// Standard deviation of the deck's rotation about the body's z axis, rad.
    pub mounting_yaw_sd_rad: f64,
    /// What the driver tells the filter about the noise.
    pub stated_sd: StatedSd,
}

/// A scale error that goes up and down as a sine: the ground below is not as far away or as well lit all along a way.
///
/// A constant scale error cancels on a way out and back; this one does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleSwing {
    /// Its largest value, as a share of the scale.
    pub amplitude: f64,
    /// From one largest value to the next, s. Where in it a flight begins, the seed draws.
    pub period_s: f64,
}

/// How the flow deck's driver comes by the standard deviation it states (`flowdeck_v1v2`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatedSd {
    /// The same for every reading: the firmware's default.
    Fixed,
    /// From the shutter time: the less light, the noisier (parameter `motion.adaptive`).
    Adaptive {
        /// Shutter register of the PMW3901, cycles of its clock.
        shutter: u16,
    },
}

impl StatedSd {
    /// The standard deviation, counts.
    pub fn counts(self) -> f32 {
        match self {
            Self::Fixed => 2.0,
            Self::Adaptive { shutter } => (0.000_798_4 * f32::from(shutter) + 0.433_5).max(0.1),
        }
    }
}

impl Default for FlowModel {
    fn default() -> Self {
        Self {
            // The driver's own standard deviation.
            noise_counts: 2.0,
            // Assumed. The firmware itself once changed its constant by 19 % (commit 72b8f8e2).
            scale_sd: 0.05,
            scale_swing: None,
            // Assumed: one degree.
            mounting_yaw_sd_rad: 1.0 * core::f64::consts::PI / 180.0,
            stated_sd: StatedSd::Fixed,
        }
    }
}

/// Errors of the VL53L1x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeModel {
    /// White noise of a reading, m.
    pub noise_m: f64,
    /// Standard deviation of the constant offset, m.
    pub offset_sd_m: f64,
}

impl Default for RangeModel {
    fn default() -> Self {
        Self {
            // The driver states 2.5 mm at short range.
            noise_m: 0.003,
            // Assumed.
            offset_sd_m: 0.01,
        }
    }
}
