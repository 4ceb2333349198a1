//! From INS_CORRECTION to measurements for the filter.

use link::{Implausible, InsCorrection};
use nalgebra::Vector3;

use super::settings::CorrectionSd;
use crate::ekf::{Measurement, Position, YawError};

/// Applies every correction once, by its snapshot index.
#[derive(Debug)]
pub struct Corrections {
    sd: CorrectionSd,
    /// Index applied last. Starts as 0: a first correction with index 0 is ignored.
    last_index: u16,
    applied: u32,
    ignored: u32,
}

impl Corrections {
    /// Corrections to be believed this firmly.
    pub fn new(sd: CorrectionSd) -> Self {
        Self {
            sd,
            last_index: 0,
            applied: 0,
            ignored: 0,
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
            self.ignored += 1;
            return Ok(None);
        }
        let (from, to) = correction.poses()?;
        self.last_index = correction.snapshot_index;
        self.applied += 1;
        let shift = Vector3::new(to.x - from.x, to.y - from.y, 0.0);
        let position = Position {
            position_m: estimate_m + shift,
            sd_m: self.sd.position_m,
        };
        let yaw_error = YawError {
            error_rad: from.yaw - to.yaw,
            sd_rad: self.sd.yaw_rad,
        };
        Ok(Some([
            Measurement::Position(position),
            Measurement::YawError(yaw_error),
        ]))
    }

    /// Corrections applied so far.
    pub fn applied(&self) -> u32 {
        self.applied
    }

    /// Corrections ignored so far as repeats.
    pub fn ignored(&self) -> u32 {
        self.ignored
    }
}

#[cfg(test)]
mod tests {
    use link::InsCorrection;
    use nalgebra::Vector3;

    use super::Corrections;
    use crate::app::settings::CorrectionSd;
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
        let measurements = Corrections::new(CorrectionSd::OVERWRITE).apply(&correction(1), HERE);
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
        let mut corrections = Corrections::new(CorrectionSd::OVERWRITE);
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
        let mut corrections = Corrections::new(CorrectionSd::OVERWRITE);
        assert!(corrections.apply(&broken, HERE).is_err());
        assert_eq!(corrections.applied(), 0);
    }
}
