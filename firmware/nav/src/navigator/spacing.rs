//! How far apart snapshots may be: as far as odometry leads from one into the catchment of the next with a
//! stated probability.
//!
//! On the way back the drone leaves a snapshot with the error of a realignment, flies by odometry, and has
//! to arrive where homing still converges. Both errors are taken as Gaussian and alike in all directions, so
//! that the distance from the snapshot follows Rayleigh's distribution:
//! P(|e| < r) = 1 - exp(-r² / 2σ²).

use crate::homing::{ImageDifference, Weights};
use crate::spectrum::{STORED_FREQUENCIES, Spectrum};

/// What odometry does to a pose that was right. Standard deviations, each independent of the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Of the position that a realignment leaves, metres along each axis.
    pub fix_m: f32,
    /// Growth of the position's variance along each axis, m² a second.
    pub walk_m2_per_s: f32,
    /// Of the scale, 1.
    pub scale: f32,
    /// Of the heading after a realignment, radians.
    pub heading_rad: f32,
    /// Of the turn rate's bias, radians a second.
    pub turn_rad_per_s: f32,
}

impl Drift {
    /// The drone's odometry.
    ///
    /// - Fix 0.06 m: homing ends early when nearer than that.
    /// - Walk: flow of 2 counts of 1/488.3 rad at 100 Hz and a height of 0.5 m (the flow deck's driver):
    ///   (2 / 488.3 x 0.5 m)² x 100 Hz.
    /// - Scale: 5 % of the flow's and 2 % of the height's, squared and summed.
    /// - Heading 1.7 degrees: 1 degree of the flow sensor's mounting and what a snapshot of 8 bits leaves.
    /// - Turn 0.1 degrees a second: the gyro's bias in flight.
    ///
    /// After 5 m at 0.5 m/s that is 0.18 m across, where the paper measured 0.13 m (Fig. 5), and 0.28 m
    /// along.
    pub const DEFAULT: Self = Self {
        fix_m: 0.06,
        walk_m2_per_s: 4.2e-4,
        scale: 0.054,
        heading_rad: 0.03,
        turn_rad_per_s: 0.001_75,
    };

    /// Standard deviation of the position along the worse of two axes, along the way and across, metres,
    /// after a straight way in a time.
    pub fn sd_m(&self, way_m: f32, time_s: f32) -> f32 {
        // A constant bias turns the heading by b t: across, the mean of that counts.
        let turned_rad = 0.5 * self.turn_rad_per_s * time_s;
        let along = self.scale * self.scale;
        let across = self.heading_rad * self.heading_rad + turned_rad * turned_rad;
        let still = self.fix_m * self.fix_m + self.walk_m2_per_s * time_s;
        libm::sqrtf(still + along.max(across) * (way_m * way_m))
    }
}

/// The radius in standard deviations within which a Gaussian error of the plane lies with a probability
/// (Rayleigh's distribution): 3.03 for 99 %.
pub fn deviations_within(probability: f32) -> f32 {
    libm::sqrtf(-2.0 * libm::logf(1.0 - probability))
}

/// From how far away homing converges to a view, units of the surroundings' distance R, 1 at most.
///
/// Near the snapshot the views differ by E = ½ hᵀA h; far from it by E∞, the power of both. Taken as the
/// bell between, E∞ (1 - exp(-½ hᵀA h / E∞)), the difference is steepest at h = sqrt(E∞ / λ), with λ the
/// larger eigenvalue of A. Up to there Newton's step leads to the snapshot. A view without power has no
/// catchment.
pub fn catchment(view: &Spectrum, weights: &Weights) -> f32 {
    let mut stored = [Default::default(); STORED_FREQUENCIES];
    stored.copy_from_slice(&view.coefficients()[..STORED_FREQUENCIES]);
    let power: f32 = stored
        .iter()
        .zip(weights)
        .map(|(coefficient, weight)| weight * coefficient.norm_sqr())
        .sum();
    let curvature = ImageDifference::between(view, &stored, weights).largest_curvature();
    if curvature > 0.0 {
        libm::sqrtf(2.0 * power / curvature).min(1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests;
