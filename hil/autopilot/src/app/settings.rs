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
    /// The share of a correction's turn that the filter is told of, 0..=1.
    pub yaw_error_share: f32,
    /// Whether the app, while it stands on the ground, tells the filter ten times a second that it is
    /// at the origin.
    pub zeroes_on_ground: bool,
    /// Whether the drone lands when the radio link to the operator is down.
    pub watches_radio: bool,
    /// Whether the drone lands when the battery is low.
    pub watches_battery: bool,
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

impl Settings {
    /// The published app at the end of its branch `visualhoming` (June 2023).
    pub const VISUALHOMING_2023_06: Self = Self {
        ground_ms: 1_000,
        cycle_offset_ms: 0,
        cruise_speed_m_s: None,
        correction: CorrectionSd::OVERWRITE,
        yaw_error_share: 1.0,
        zeroes_on_ground: true,
        watches_radio: true,
        watches_battery: true,
        max_distance_m: 8.0,
        max_height_m: 1.0,
        echo_limit_ms: 10_000,
        follow_limit_ms: 900_000,
        flight_limit_ms: 1_800_000,
        quirks: Quirks::PUBLISHED,
    };

    /// The published app at the end of its branch `master` (August 2022): nearer fence, soft
    /// corrections of which half the turn is used, and an operator who watches radio and battery.
    pub const MASTER_2022_08: Self = Self {
        correction: CorrectionSd::SOFT,
        yaw_error_share: 0.5,
        zeroes_on_ground: false,
        watches_radio: false,
        watches_battery: false,
        max_distance_m: 4.0,
        ..Self::VISUALHOMING_2023_06
    };
}

impl Default for Settings {
    /// The newest published app, with set-points that travel.
    fn default() -> Self {
        Self {
            cruise_speed_m_s: Some(0.5),
            ..Self::VISUALHOMING_2023_06
        }
    }
}
