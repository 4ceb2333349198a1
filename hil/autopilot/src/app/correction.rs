//! From INS_CORRECTION to measurements for the filter.

use link::{Implausible, InsCorrection, WorldPoint};
use nalgebra::Vector3;

use super::settings::{CorrectionSd, Settings};
use super::value_check::ValueCheck;
use crate::ekf::{Measurement, Position, YawError};

/// Applies every correction once, by its snapshot index.
#[derive(Debug)]
pub struct Corrections {
    sd: CorrectionSd,
    yaw_error_share: f32,
    check: ValueCheck,
    /// Index applied last. Starts as 0: a first correction with index 0 is ignored.
    last_index: u16,
    applied: u32,
}

impl Corrections {
    /// Corrections that are used as the settings say.
    pub fn new(settings: &Settings) -> Self {
        Self {
            sd: settings.correction,
            yaw_error_share: settings.yaw_error_share,
            check: settings.quirks.value_check(),
            last_index: 0,
            applied: 0,
        }
    }

    /// The measurements to queue: the estimated position moved by what the message moves, with the
    /// estimated height, and the heading's error. `None` if this index was the last one applied.
    ///
    /// # Errors
    /// [`Implausible`] if the message holds what cannot be believed.
    pub fn apply(
        &mut self,
        correction: &InsCorrection,
        estimate_m: Vector3<f32>,
    ) -> Result<Option<[Measurement; 2]>, Implausible> {
        if correction.snapshot_index == self.last_index {
            return Ok(None);
        }
        let (from, to) = self.check.poses(correction)?;
        self.last_index = correction.snapshot_index;
        self.applied += 1;
        let shift = Vector3::new(to.x - from.x, to.y - from.y, 0.0);
        let yaw_error_rad = self.yaw_error_share * (from.yaw - to.yaw);
        Ok(Some(self.measurements(estimate_m + shift, yaw_error_rad)))
    }

    /// The measurements by which a script realigns the filter where the drone has homed to a known
    /// place: it is there, at the estimated height, and its heading is off by `turn_rad`, the turn
    /// that the last vector asked for, counter-clockwise (psi += -delta_yaw in the published scripts).
    pub fn realignment(&self, place: WorldPoint, height_m: f32, turn_rad: f32) -> [Measurement; 2] {
        self.measurements(Vector3::new(place.x, place.y, height_m), turn_rad)
    }

    fn measurements(&self, position_m: Vector3<f32>, yaw_error_rad: f32) -> [Measurement; 2] {
        let position = Position {
            position_m,
            sd_m: self.sd.position_m,
        };
        let yaw_error = YawError {
            error_rad: yaw_error_rad,
            sd_rad: self.sd.yaw_rad,
        };
        [
            Measurement::Position(position),
            Measurement::YawError(yaw_error),
        ]
    }

    /// Corrections applied so far.
    pub fn applied(&self) -> u32 {
        self.applied
    }
}

#[cfg(test)]
mod tests {
    use link::InsCorrection;
    use nalgebra::Vector3;

    use super::Corrections;
    use crate::app::settings::Settings;
    use crate::ekf::{Measurement, Position, YawError};

    const HERE: Vector3<f32> = Vector3::new(1.0, 2.0, 0.5);

    fn correction(snapshot_index: u16) -> InsCorrection {
        InsCorrection {
            snapshot_index,
            e_from: 1.0,
            n_from: 0.0,
            psi_from: 0.25,
            e_to: 1.5,
            n_to: 2.0,
            psi_to: 0.5,
        }
    }

    #[test]
    fn a_correction_to_the_north_east_moves_the_estimate_to_plus_x_and_minus_y() {
        let measurements = Corrections::new(&Settings::default()).apply(&correction(1), HERE);
        let position = Position {
            position_m: Vector3::new(3.0, 1.5, 0.5),
            sd_m: 0.001,
        };
        // psi_to - psi_from: the filter is to turn clockwise, its yaw is too large.
        let yaw_error = YawError {
            error_rad: 0.25,
            sd_rad: 0.002,
        };
        let expected = [
            Measurement::Position(position),
            Measurement::YawError(yaw_error),
        ];
        assert_eq!(measurements, Ok(Some(expected)));
    }

    #[test]
    fn only_a_changed_index_is_applied_and_never_a_first_zero() {
        let mut corrections = Corrections::new(&Settings::default());
        let mut applied = |index| {
            let result = corrections.apply(&correction(index), HERE);
            matches!(result, Ok(Some(_)))
        };
        let indices = [0, 7, 7, 8, 7, 0, 0];
        let expected = [false, true, false, true, true, true, false];
        assert_eq!(indices.map(&mut applied), expected);
    }

    #[test]
    fn a_correction_that_is_no_number_is_reported_not_applied() {
        let mut broken = correction(1);
        broken.e_to = f32::NAN;
        let mut corrections = Corrections::new(&Settings::default());
        assert!(corrections.apply(&broken, HERE).is_err());
        assert_eq!(corrections.applied(), 0);
    }
}
