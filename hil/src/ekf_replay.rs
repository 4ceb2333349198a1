//! Holds the filter against a recording of the firmware's own: the largest deviations and the verdict.

use std::path::Path;

use autopilot::ekf::Parameters;
use autopilot::ekf::replay::{Deviation, Limits, Recording, ReplayError, deviation};
use serde::Serialize;

/// What became of a recording.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Largest distance between the positions, metres.
    pub position_m: f32,
    /// Largest difference of the velocities in the world, m/s.
    pub velocity_mps: f32,
    /// Largest angle between the attitudes, radians.
    pub attitude_rad: f32,
    /// Largest difference of a variance, as a share of the recorded one.
    pub variance_relative: f32,
    /// Whether all four are within [`Limits::FIRMWARE`].
    pub within: bool,
    /// Instants compared.
    pub compared: usize,
    /// All deviations, and when each was met.
    #[serde(skip)]
    pub deviation: Deviation,
}

/// Replays `PREFIX.imu.csv`, `PREFIX.events.csv` and `PREFIX.ekf.csv`. At each reset the filter assumes a heading of
/// `initial_yaw_rad`, counter-clockwise.
pub fn check(prefix: &Path, initial_yaw_rad: f32) -> Result<Report, ReplayError> {
    let parameters = Parameters {
        initial_yaw_rad,
        ..Parameters::default()
    };
    let deviation = deviation(&Recording::load(prefix)?, parameters)?;
    Ok(Report {
        position_m: deviation.position_m.value,
        velocity_mps: deviation.velocity_m_s.value,
        attitude_rad: deviation.attitude_rad.value,
        variance_relative: deviation.variance_share.value,
        within: deviation.within(&Limits::FIRMWARE),
        compared: deviation.compared,
        deviation,
    })
}
