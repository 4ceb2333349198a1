//! Folding the attitude error into the reference attitude.

use super::rotation::{covariance_turn, turned};
use super::state::{ATTITUDE, State};

/// Errors up to this are thrown away instead of folded in, rad.
const DEAD_BAND_RAD: f32 = 1e-4;
/// An error beyond this is taken for nonsense and thrown away as well, rad.
const MAX_ERROR_RAD: f32 = 10.0;

impl State {
    /// Moves the attitude error into the reference attitude and refreshes the rotation matrix.
    ///
    /// An error inside the dead band is dropped: keeping it would be more accurate (by 1e-3 rad over a flight), but
    /// it would not be the firmware's filter.
    pub fn finalise(&mut self) {
        let error = self.attitude_error;
        if error.amax() > DEAD_BAND_RAD && error.iter().all(|e| e.abs() < MAX_ERROR_RAD) {
            self.attitude = turned(&self.attitude, &error);
            self.turn_covariance(&covariance_turn(&error));
        }
        self.attitude_error.fill(0.0);
        self.rotation = self.attitude.to_rotation_matrix().into_inner();
        self.bound_covariance();
    }

    /// `A P Aᵀ` for `A = blockdiag(I, I, turn)`.
    fn turn_covariance(&mut self, turn: &nalgebra::Matrix3<f32>) {
        let rows = turn * self.covariance.fixed_rows::<3>(ATTITUDE);
        self.covariance
            .fixed_rows_mut::<3>(ATTITUDE)
            .copy_from(&rows);
        let columns = self.covariance.fixed_columns::<3>(ATTITUDE) * turn.transpose();
        self.covariance
            .fixed_columns_mut::<3>(ATTITUDE)
            .copy_from(&columns);
    }
}
