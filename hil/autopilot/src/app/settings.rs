//! The flight app's parameters, with the values of the published app.

use super::quirks::Quirks;

/// Period of the app's loop, ms (`vTaskDelayUntil` with 100 ms).
pub const CYCLE_MS: u64 = 100;

/// Height of the flight, m.
pub const FLIGHT_HEIGHT_M: f32 = 0.5;

/// What a flight may differ in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How long the drone stands before it takes off, ms: the time of the sensors' calibration.
    pub ground_ms: u64,
    /// When in each period of 100 ms the loop runs, ms; taken modulo 100. Camera and loop have no
    /// common clock: any value can occur.
    pub cycle_offset_ms: u64,
    /// How fast the set-point moves along a scripted leg, m/s. `None`: it jumps to the waypoint, as
    /// in the published app, where only the position controller limits the speed (1.1 m/s per axis).
    pub cruise_speed_m_s: Option<f32>,
    /// How firmly the filter is told to believe a correction.
    pub correction: CorrectionSd,
    /// Horizontal distance from the origin at which the drone lands, m.
    pub max_distance_m: f32,
    /// Height at which the drone lands, m.
    pub max_height_m: f32,
    /// How long a command may stay without its echo before the drone lands, ms. Our own: the
    /// published app sends it for ever, the operator lands.
    pub echo_limit_ms: u64,
    /// How long following may take before the drone lands, ms. Our own: stands for the operator.
    pub follow_limit_ms: u64,
    /// How long the whole flight may take before the drone lands, ms. Our own, as above.
    pub flight_limit_ms: u64,
    /// Which of the published app's peculiarities on the link it has.
    pub quirks: Quirks,
}

/// Standard deviations of the measurements that an INS_CORRECTION becomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrectionSd {
    /// Of each coordinate of the position, m.
    pub position_m: f32,
    /// Of the yaw, rad.
    pub yaw_rad: f32,
}

impl CorrectionSd {
    /// The final values of the published app (26 May 2023): the filter is all but overwritten.
    pub const OVERWRITE: Self = Self {
        position_m: 0.001,
        yaw_rad: 0.002,
    };
    /// Its first values (August 2022): positions are averaged, yaw is hardly touched.
    pub const SOFT: Self = Self {
        position_m: 0.5,
        yaw_rad: 0.17,
    };
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            ground_ms: 1_000,
            cycle_offset_ms: 0,
            cruise_speed_m_s: Some(0.5),
            correction: CorrectionSd::OVERWRITE,
            max_distance_m: 8.0,
            max_height_m: 1.0,
            echo_limit_ms: 10_000,
            follow_limit_ms: 900_000,
            flight_limit_ms: 1_800_000,
            quirks: Quirks::PUBLISHED,
        }
    }
}
