//! The filter's constants. The defaults are those of crazyflie-firmware 2a18fc29 (2026-08-21).

use nalgebra::Vector3;

/// Gravity as the firmware rounds it, m/s².
pub const GRAVITY_M_S2: f32 = 9.81;

/// Milliseconds between predictions: the firmware predicts at 100 Hz (`estimator_kalman`, `PREDICT_RATE`).
pub const PREDICTION_PERIOD_MS: u64 = 10;

/// Everything a build of the filter can change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Heading assumed at a reset, rad, counter-clockwise (`initialYaw`).
    pub initial_yaw_rad: f32,
    /// Standard deviations after a reset.
    pub reset: ResetDeviations,
    /// Process noise.
    pub process_noise: ProcessNoise,
    /// Share of the way back to the initial attitude taken at each prediction while not flying: 0.001 at 100 Hz
    /// is a time constant of 10 s (`ROLLPITCH_ZERO_REVERSION`). Zero switches it off.
    pub ground_attitude_reversion: f32,
    /// Geometry of the flow sensor.
    pub flow: FlowParameters,
    /// Geometry of the range sensor.
    pub range: RangeParameters,
    /// A position estimated farther away than this on any axis resets the filter, m (`maxPos` of `kalman_supervisor`).
    pub max_position_m: f32,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            initial_yaw_rad: 0.0,
            reset: ResetDeviations::default(),
            process_noise: ProcessNoise::default(),
            ground_attitude_reversion: 0.001,
            flow: FlowParameters::default(),
            range: RangeParameters::default(),
            max_position_m: 100.0,
        }
    }
}

/// Standard deviations of the nine states after a reset (`kalman_core_params_defaults.h`, `stdDevInitial*`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResetDeviations {
    /// Position x, y, z, m. The bound on variances cuts 100 m to 10 m at the first noise step.
    pub position_m: Vector3<f32>,
    /// Velocity in the body frame, m/s.
    pub velocity_m_s: Vector3<f32>,
    /// Attitude about the body's axes, rad.
    pub attitude_rad: Vector3<f32>,
}

impl Default for ResetDeviations {
    fn default() -> Self {
        Self {
            position_m: Vector3::new(100.0, 100.0, 1.0),
            velocity_m_s: Vector3::repeat(0.01),
            attitude_rad: Vector3::repeat(0.01),
        }
    }
}

/// Process noise (`procNoise*`). The firmware's separate velocity, position and attitude noises are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessNoise {
    /// Acceleration per body axis, m/s².
    pub acceleration_m_s2: Vector3<f32>,
    /// Angular rate per body axis, rad/s (`measNoiseGyro_rollpitch`, `measNoiseGyro_yaw`).
    pub angular_rate_rad_s: Vector3<f32>,
}

impl Default for ProcessNoise {
    fn default() -> Self {
        Self {
            acceleration_m_s2: Vector3::new(0.5, 0.5, 1.0),
            angular_rate_rad_s: Vector3::repeat(0.1),
        }
    }
}

/// Geometry of the PMW3901 flow sensor (`mm_flow`, since commit 72b8f8e2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowParameters {
    /// Pixels along one edge of the image.
    pub pixels: f32,
    /// The image's edge at unit distance, 2 sin 21°: the firmware calls it the field of view.
    pub field_of_view_rad: f32,
    /// Pixels in one count of the sensor.
    pub pixels_per_count: f32,
    /// The least height the model divides by, m.
    pub min_height_m: f32,
}

impl Default for FlowParameters {
    fn default() -> Self {
        Self {
            pixels: 35.0,
            field_of_view_rad: 0.716_74,
            pixels_per_count: 0.1,
            min_height_m: 0.1,
        }
    }
}

/// Geometry of the VL53L1x range sensor (`mm_tof`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeParameters {
    /// Half the sensor's cone, rad: tilts within it do not lengthen the distance.
    pub half_cone_rad: f32,
    /// Cosine of the tilt at and beyond which a range is ignored.
    pub min_cos_tilt: f32,
}

impl Default for RangeParameters {
    fn default() -> Self {
        Self {
            half_cone_rad: 7.5 * core::f32::consts::PI / 180.0,
            min_cos_tilt: 0.1,
        }
    }
}
