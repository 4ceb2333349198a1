//! Homing towards a packed snapshot: the same as [`home`](super::home), with as many frequencies as it has.

use nalgebra::Vector2;

use super::{HomingParameters, HomingVector, NoVectorReason};
use crate::methods::quadratic::{self, Model, Weights};
use crate::methods::{Harmonics, best_rotation};
use crate::snapshot::{PackedSnapshot, Packing};
use crate::spectrum::{Spectrum, rotate};

/// Every frequency counts as it is. Sharper ones are what the last decimetre is made of.
const WEIGHTS: Weights = quadratic::FLAT_WEIGHTS;

/// The homing vector from the current view to a packed snapshot. Its `difference` is luma² over the
/// snapshot's frequencies; [`HomingParameters::weights`] belong to the paper's snapshots and are not used.
///
/// # Errors
///
/// [`NoVectorReason`] where the views do not determine one; without the detail that a fine snapshot asks
/// for there is no view.
#[inline(never)]
pub fn home_packed(
    current: &Spectrum,
    snapshot: &PackedSnapshot,
    parameters: &HomingParameters,
) -> Result<HomingVector, NoVectorReason> {
    if snapshot.packing() == Packing::Fine && current.detail().is_none() {
        return Err(NoVectorReason::NoView);
    }
    let model = Model {
        weights: &WEIGHTS,
        frequencies: usize::from(snapshot.packing().frequencies()),
        next_term: true,
        with_turn: true,
    };
    let mut view = Harmonics::from(current);
    let mut stored = snapshot.dequantise();
    for view in [&view, &stored] {
        let variance = view.variance(model.frequencies);
        if !variance.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        if variance < parameters.least_variance {
            return Err(NoVectorReason::NoContrast);
        }
    }
    let coarse = best_rotation(parameters.rotation_bound, &model, &view, &stored);
    rotate(&mut stored.0[..model.frequencies], -coarse);
    let difference = difference(&model, &view, &stored);
    let mut displacement = Vector2::zeros();
    let mut rotation = coarse;
    for left in (0..parameters.iterations.max(1)).rev() {
        let step = quadratic::minimum(&model, &view, &stored)?;
        displacement += step.xy();
        rotation -= step.z;
        if left > 0 {
            view = quadratic::moved(&model, &view, step.xy());
            rotate(&mut stored.0[..model.frequencies], step.z);
        }
    }
    if (rotation - coarse).abs() > parameters.turn_bound {
        return Err(NoVectorReason::IllConditioned);
    }
    let vector = HomingVector {
        displacement: displacement.cap_magnitude(parameters.displacement_bound),
        rotation,
        difference,
    };
    let finite = vector.displacement.norm().is_finite() && vector.rotation.is_finite();
    if finite && difference.is_finite() {
        Ok(vector)
    } else {
        Err(NoVectorReason::NotFinite)
    }
}

/// Σ w_k |c_k - t_k|².
fn difference(model: &Model, view: &Harmonics, stored: &Harmonics) -> f32 {
    let pairs = view.0.iter().zip(&stored.0).zip(model.weights);
    pairs
        .take(model.frequencies)
        .map(|((c, t), weight)| weight * (c - t).norm_sqr())
        .sum()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;
    use crate::horizon::{BEARINGS, Horizon};

    /// The exact view of a place of 20 frequencies after a move by `h` on the unit circle and a turn of the
    /// viewer: I_h(θ) = I(θ - asin(x sin θ - y cos θ)).
    fn view(h: [f64; 2], turn: f64) -> Spectrum {
        let luma = core::array::from_fn(|n| {
            let seen = n as f64 * TAU / BEARINGS as f64 + turn;
            let shift = libm::asin(h[0] * libm::sin(seen) - h[1] * libm::cos(seen));
            let waves = (1_u8..=20).map(|k| {
                let k = f64::from(k);
                20.0 / k * libm::cos(k * (seen - shift) + k * k)
            });
            (120.0 + waves.sum::<f64>()) as f32
        });
        Spectrum::with_detail(&Horizon::new(luma, 0.0))
    }

    #[test]
    fn a_packed_snapshot_leads_home_and_tells_the_turn() {
        let here = view([0.0, 0.0], 0.0);
        let parameters = HomingParameters {
            iterations: 3,
            ..HomingParameters::DEFAULT
        };
        for (h, turn) in [
            ([0.12, -0.08], 0.0),
            ([-0.07, 0.1], 0.3),
            ([0.1, 0.0], -0.45),
        ] {
            let there = view(h, turn);
            for packing in [Packing::Fine, Packing::Lean] {
                let stored = PackedSnapshot::quantise(&there, packing);
                let vector = home_packed(&here, &stored, &parameters).expect("a vector");
                let [x, y] = h.map(|part| part as f32);
                // What rounding leaves: half a count is a tenth of the strongest wave and a third of the
                // weakest, and twice as many waves outvote it.
                let share = match packing {
                    Packing::Fine => 0.25,
                    Packing::Lean => 0.5,
                };
                let way = Vector2::new(x, y);
                let off = vector.displacement - way;
                assert!(off.norm() < share * way.norm(), "{packing:?}: {vector:?}");
                // 1.7 degrees, at moves twice as far as along a route.
                assert!(
                    (vector.rotation - turn as f32).abs() < 0.03,
                    "{packing:?}: {vector:?}"
                );
            }
        }
    }

    #[test]
    fn a_fine_snapshot_is_not_compared_with_a_view_without_detail() {
        let whole = view([0.02, 0.0], 0.0);
        let coarse = Spectrum::from_coefficients(*whole.coefficients());
        let stored = |packing| PackedSnapshot::quantise(&whole, packing);
        let parameters = HomingParameters::DEFAULT;
        assert_eq!(
            home_packed(&coarse, &stored(Packing::Fine), &parameters),
            Err(NoVectorReason::NoView)
        );
        assert!(home_packed(&coarse, &stored(Packing::Lean), &parameters).is_ok());
        assert_eq!(
            home_packed(
                &whole,
                &PackedSnapshot::from_bytes(Packing::Lean, &[]),
                &parameters
            ),
            Err(NoVectorReason::NoContrast)
        );
    }
}
