//! Whether two views are of one place.

use nalgebra::Vector2;

use super::{HomingParameters, NoVectorReason, difference, home};
use crate::snapshot::Snapshot;
use crate::spectrum::{STORED_FREQUENCIES, Spectrum};

/// Solutions at most. After three the rest of a difference is not the viewer's move any more.
const SOLUTIONS: u8 = 3;

/// How much a view is like a snapshot, once it is turned and moved to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resemblance {
    /// What differs, as a share of the power of both views: 0 for the same view, 1 for two that have
    /// nothing in common.
    pub difference: f32,
    /// From here to the snapshot, in units of the surroundings' distance R; an estimate on the low side,
    /// for R is the distance of the nearest things.
    pub displacement: Vector2<f32>,
    /// How far the snapshot's viewer is turned counter-clockwise against the current one, radians.
    pub rotation: f32,
}

impl Resemblance {
    /// Moves the current view by one homing vector after the other as long as that makes it more like
    /// the snapshot.
    ///
    /// # Errors
    ///
    /// As [`home`], of the first vector.
    pub fn of(
        current: &Spectrum,
        snapshot: &Snapshot,
        parameters: &HomingParameters,
    ) -> Result<Self, NoVectorReason> {
        let mut vector = home(current, snapshot, parameters)?;
        let mut moved = *current;
        let mut displacement = Vector2::zeros();
        for _ in 0..SOLUTIONS {
            let nearer = difference::moved(&moved, vector.displacement);
            match home(&nearer, snapshot, parameters) {
                Ok(next) if next.difference < vector.difference => {
                    displacement += vector.displacement;
                    (moved, vector) = (nearer, next);
                }
                _ => break,
            }
        }
        let stored = snapshot.dequantise();
        let views = current.coefficients()[..STORED_FREQUENCIES]
            .iter()
            .chain(&stored);
        let weights = parameters.weights.iter().cycle();
        let power: f32 = views.zip(weights).map(|(c, w)| w * c.norm_sqr()).sum();
        Ok(Self {
            difference: vector.difference / power,
            displacement,
            rotation: vector.rotation,
        })
    }
}
