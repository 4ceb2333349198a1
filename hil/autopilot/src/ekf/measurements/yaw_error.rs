//! Error of the estimated yaw (`mm_yaw_error`).

use crate::ekf::state::{ATTITUDE, State};
use crate::ekf::update::Sensitivity;

/// By how much the estimated yaw is too large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YawError {
    /// Estimated minus true yaw, rad, counter-clockwise: a positive value turns the estimate clockwise.
    pub error_rad: f32,
    /// Standard deviation, rad.
    pub sd_rad: f32,
}

impl YawError {
    /// One update of the yaw error, with the firmware's innovation `d2 - error`.
    ///
    /// The error state `d2` is zero unless an earlier measurement of the same tick moved it. That part then enters
    /// with the wrong sign: the firmware doubles it where a Kalman filter would remove it.
    pub(in crate::ekf) fn correct(&self, state: &mut State) {
        let innovation = state.attitude_error.z - self.error_rad;
        state.scalar_update(
            &[Sensitivity::direct(ATTITUDE + 2)],
            innovation,
            self.sd_rad,
        );
    }
}
