//! What controller and filter are told of the values of a message.

use link::{Implausible, InsCorrection, Vector, WorldPoint, WorldPose};

/// Looks at values, or hands them on as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueCheck {
    /// What the link takes for implausible is refused.
    Checked,
    /// Nothing is looked at, as in the published app.
    Unchecked,
}

impl ValueCheck {
    /// Where a vector leads.
    ///
    /// # Errors
    /// [`Implausible`] if that is nowhere in this world.
    pub fn target(self, vector: &Vector) -> Result<WorldPoint, Implausible> {
        match self {
            Self::Checked => vector.target(),
            Self::Unchecked => Ok(WorldPoint::from_north_east(
                vector.target_n,
                vector.target_e,
            )),
        }
    }

    /// How far a vector asks to turn, rad, counter-clockwise.
    ///
    /// # Errors
    /// [`Implausible`] if that is no angle.
    pub fn turn(self, vector: &Vector) -> Result<f32, Implausible> {
        match self {
            Self::Checked => vector.turn(),
            Self::Unchecked => Ok(-vector.delta_yaw),
        }
    }

    /// From where to where a correction moves the estimate.
    ///
    /// # Errors
    /// [`Implausible`] if either is nowhere in this world.
    pub fn poses(self, correction: &InsCorrection) -> Result<(WorldPose, WorldPose), Implausible> {
        let pose = WorldPose::from_north_east;
        match self {
            Self::Checked => correction.poses(),
            Self::Unchecked => Ok((
                pose(correction.n_from, correction.e_from, correction.psi_from),
                pose(correction.n_to, correction.e_to, correction.psi_to),
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use link::{InsCorrection, Vector, WorldPoint, WorldPose};

    use super::ValueCheck::{Checked, Unchecked};

    #[test]
    fn values_that_are_no_numbers_or_absurd_are_refused_unless_nobody_looks() {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
            let vector = Vector {
                target_n: value,
                delta_yaw: value,
                ..Vector::default()
            };
            let correction = InsCorrection {
                e_to: value,
                ..InsCorrection::default()
            };
            assert!(Checked.target(&vector).is_err(), "{value}");
            assert!(Checked.turn(&vector).is_err(), "{value}");
            assert!(Checked.poses(&correction).is_err(), "{value}");
            assert!(Unchecked.target(&vector).is_ok());
            assert!(Unchecked.turn(&vector).is_ok());
            assert!(Unchecked.poses(&correction).is_ok());
        }
    }

    #[test]
    fn where_nobody_looks_the_axes_are_the_same() {
        let vector = Vector {
            target_n: 1.0,
            target_e: 2.0,
            delta_yaw: 0.5,
            ..Vector::default()
        };
        let correction = InsCorrection {
            snapshot_index: 1,
            n_from: 1.0,
            e_from: 2.0,
            psi_from: 0.5,
            n_to: 3.0,
            e_to: 4.0,
            psi_to: 0.25,
        };
        for check in [Checked, Unchecked] {
            assert_eq!(check.target(&vector), Ok(WorldPoint { x: 1.0, y: -2.0 }));
            assert_eq!(check.turn(&vector), Ok(-0.5));
            let from = WorldPose {
                x: 1.0,
                y: -2.0,
                yaw: -0.5,
            };
            let to = WorldPose {
                x: 3.0,
                y: -4.0,
                yaw: -0.25,
            };
            assert_eq!(check.poses(&correction), Ok((from, to)));
        }
    }
}
