//! Where a snapshot was taken, from all vectors of a homing run: odometry gives them their scale.
//!
//! A homing vector is in units of the surroundings' distance R, which nobody knows: 1.5 m in a corridor,
//! 7 m in a hall, 10 m between trees. But the drone moves while it homes, and odometry tells by how much.
//! The vector that a drone at p sees to a snapshot taken at s is
//!
//! ```text
//! h = κ (s - p),   κ = 1 / R
//! ```
//!
//! a straight line in p whose slope -κ and root s are fitted by least squares, with a prior for κ that
//! counts while the drone has hardly moved. κ is fitted to the approach alone: a drone that hovers goes
//! where the noise of its vectors leads, and would take that for a slope. s stands still in the
//! coordinates of the estimate while the drone moves: unlike a low-pass of the vectors, the fit does not
//! lag behind.

use nalgebra::{Point2, Vector2};

use super::parameters::Parameters;
use crate::homing::HomingVector;

/// A vector longer than this share of its bound counts as clipped, and tells a direction alone.
const CLIPPED: f32 = 0.95;

/// The fit: means and mean squares of the newest vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaceFit {
    /// How many vectors count.
    vectors: f32,
    /// Mean of p, metres.
    from: Point2<f32>,
    /// Mean of h, units of R.
    offset: Vector2<f32>,
    /// Mean of |p - mean|², m².
    spread: f32,
    /// Mean of (p - mean)·(h - mean), metres: -κ times the spread, but for noise.
    slope: f32,
    /// Low-passed turn of the snapshot's viewer against the current one, counter-clockwise, radians.
    rotation: f32,
}

impl PlaceFit {
    /// The fit to one vector, seen from a place.
    pub(super) fn to(seen_from: Point2<f32>, vector: &HomingVector) -> Self {
        Self {
            vectors: 1.0,
            from: seen_from,
            offset: vector.displacement,
            spread: 0.0,
            slope: 0.0,
            rotation: vector.rotation,
        }
    }

    /// The fit with one more vector. A clipped one lies on no straight line with the others, and the fit
    /// begins anew with it.
    pub(super) fn and(
        mut self,
        parameters: &Parameters,
        seen_from: Point2<f32>,
        vector: &HomingVector,
    ) -> Self {
        let rotation = self.rotation + (vector.rotation - self.rotation) * parameters.smoothing;
        let bound = parameters.homing.displacement_bound;
        if vector.displacement.norm() >= CLIPPED * bound {
            return Self {
                rotation,
                ..Self::to(seen_from, vector)
            };
        }
        self.rotation = rotation;
        let measures = self.vectors < parameters.measuring_vectors;
        self.vectors = (self.vectors + 1.0).min(parameters.fitted_vectors);
        // Welford's recurrence; once as many count as may, each new one makes all others fade.
        let share = 1.0 / self.vectors;
        let moved = seen_from - self.from;
        let changed = vector.displacement - self.offset;
        self.from += moved * share;
        self.offset += changed * share;
        if measures {
            let rest = 1.0 - share;
            self.spread = rest * (self.spread + share * moved.norm_squared());
            self.slope = rest * (self.slope + share * moved.dot(&changed));
        }
        self
    }

    /// Where the snapshot was taken, in the coordinates of the estimate.
    pub(super) fn place(&self, parameters: &Parameters) -> Point2<f32> {
        self.from + self.offset * self.radius_m(parameters)
    }

    /// The turn of the snapshot's viewer against the current one, counter-clockwise, radians.
    pub(super) const fn rotation(&self) -> f32 {
        self.rotation
    }

    /// R, metres: 1/κ of the fit, within its bounds.
    fn radius_m(&self, parameters: &Parameters) -> f32 {
        let (nearest_m, farthest_m) = parameters.environment_bounds_m;
        let measured = self.vectors.min(parameters.measuring_vectors);
        let prior = parameters.environment_prior_m2 / measured;
        let per_m = (prior / parameters.environment_radius_m - self.slope) / (prior + self.spread);
        // Not `clamp`, which can panic, and takes the printing of numbers along.
        1.0 / per_m.max(1.0 / farthest_m).min(1.0 / nearest_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: Parameters = Parameters::DEFAULT;
    const SNAPSHOT: Point2<f32> = Point2::new(2.0, -1.0);

    /// What is seen from a place where all things are `radius_m` away.
    fn vector(seen_from: Point2<f32>, radius_m: f32) -> HomingVector {
        HomingVector {
            displacement: (SNAPSHOT - seen_from) / radius_m,
            rotation: 0.1,
            difference: 1.0,
        }
    }

    /// The fit to what is seen on a straight way that begins `start_m` before the snapshot.
    fn fit(radius_m: f32, start_m: f32, step_m: f32, vectors: u8) -> PlaceFit {
        let from = |n: u8| SNAPSHOT + Vector2::new(start_m + step_m * f32::from(n), 0.05);
        let first = PlaceFit::to(from(0), &vector(from(0), radius_m));
        (1..vectors).fold(first, |fit, n| {
            fit.and(&PARAMETERS, from(n), &vector(from(n), radius_m))
        })
    }

    fn error_m(fit: &PlaceFit) -> f32 {
        (fit.place(&PARAMETERS) - SNAPSHOT).norm()
    }

    #[test]
    fn the_place_is_found_however_far_away_the_surroundings_are() {
        for radius_m in [1.2, 1.5, 3.0, 6.0] {
            // 0.4 m of way, seen from 0.3 m before the snapshot to 0.1 m behind it.
            let found = fit(radius_m, -0.3, 0.033, 13);
            assert!(error_m(&found) < 0.04, "{radius_m}: {}", error_m(&found));
            // By the usual distance alone the last vector is off by the share that this one differs.
            let last = SNAPSHOT + Vector2::new(0.1, 0.05);
            let way = (SNAPSHOT - last) / radius_m * PARAMETERS.environment_radius_m;
            if radius_m > 3.0 {
                assert!((last + way - SNAPSHOT).norm() > 0.07, "{radius_m}");
            }
        }
    }

    #[test]
    fn a_drone_that_stands_still_takes_the_usual_distance() {
        let found = fit(PARAMETERS.environment_radius_m, 0.2, 0.0, 10);
        assert!(error_m(&found) < 1e-3, "{}", error_m(&found));
        // Twice as far away: half the way.
        let found = fit(2.0 * PARAMETERS.environment_radius_m, 0.2, 0.0, 10);
        let way = 0.2_f32.hypot(0.05);
        assert!((error_m(&found) - 0.5 * way).abs() < 1e-3);
    }

    #[test]
    fn noise_that_turns_the_slope_round_leads_no_farther_than_the_bound() {
        // The farther away, the shorter the vector.
        let fit = (0..10_u8).fold(None, |fit: Option<PlaceFit>, n| {
            let from = Point2::new(0.02 * f32::from(n), 0.0);
            let vector = HomingVector {
                displacement: Vector2::new(0.02 + 0.005 * f32::from(n), 0.0),
                rotation: 0.0,
                difference: 1.0,
            };
            Some(match fit {
                None => PlaceFit::to(from, &vector),
                Some(fit) => fit.and(&PARAMETERS, from, &vector),
            })
        });
        let (_, farthest_m) = PARAMETERS.environment_bounds_m;
        let way = fit.expect("ten vectors").place(&PARAMETERS) - Point2::new(0.09, 0.0);
        assert!(way.norm() <= 0.0426 * farthest_m, "{way:?}");
    }

    #[test]
    fn a_clipped_vector_begins_the_fit_anew() {
        let far = Point2::new(0.0, 0.0);
        let clipped = HomingVector {
            displacement: Vector2::new(PARAMETERS.homing.displacement_bound, 0.0),
            rotation: 0.2,
            difference: 1.0,
        };
        let found = fit(7.0, -0.3, 0.033, 13).and(&PARAMETERS, far, &clipped);
        let way = found.place(&PARAMETERS) - far;
        let usual_m = PARAMETERS.homing.displacement_bound * PARAMETERS.environment_radius_m;
        assert!((way - Vector2::new(usual_m, 0.0)).norm() < 1e-5, "{way:?}");
        // The turn is as good as any.
        assert!(
            (found.rotation() - 0.13).abs() < 1e-5,
            "{}",
            found.rotation()
        );
    }

    #[test]
    fn what_was_seen_long_ago_fades() {
        // The estimate jumps by a metre while the drone stands at the snapshot.
        let before = fit(3.0, 0.0, 0.0, 20);
        let jump = Vector2::new(1.0, 0.0);
        let after = (0..600).fold(before, |fit, _| {
            let from = SNAPSHOT + Vector2::new(0.0, 0.05);
            fit.and(&PARAMETERS, from + jump, &vector(from, 3.0))
        });
        let off = (after.place(&PARAMETERS) - (SNAPSHOT + jump)).norm();
        assert!(off < 0.06, "{off}");
    }
}
