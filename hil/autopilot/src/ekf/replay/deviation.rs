//! How far two filters are apart over a recording, and how far they may be.

use super::recording::{Recording, Reference};
use super::{ReplayError, replay};
use crate::ekf::{Ekf, Parameters};

/// The largest value of something over a recording, and when it was met.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Largest {
    /// The value.
    pub value: f32,
    /// The tick, ms.
    pub tick_ms: u64,
}

impl Largest {
    /// Keeps the larger value; a value that is no number is kept for good, so that it cannot pass a limit.
    fn widen(&mut self, value: f32, tick_ms: u64) {
        if !self.value.is_nan() && (value.is_nan() || value > self.value) {
            *self = Self { value, tick_ms };
        }
    }
}

/// The largest distances between the filter and the recorded one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deviation {
    /// Instants compared.
    pub compared: usize,
    /// Of positions, m.
    pub position_m: Largest,
    /// Of velocities in the world, m/s.
    pub velocity_m_s: Largest,
    /// Angle between the attitudes, rad.
    pub attitude_rad: Largest,
    /// Of legacy roll, pitch and yaw, degrees.
    pub legacy_angle_deg: Largest,
    /// Of the nine variances, as a share of the recorded one.
    pub variance_share: Largest,
    /// Of the recorded covariances, as a share of the two standard deviations' product.
    pub correlation: Largest,
}

/// How far an implementation in other arithmetic may be from the firmware's filter, whose table of sines alone costs
/// 2e-5 rad. Double precision on the same equations stays within a quarter of the first two limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Of positions, m.
    pub position_m: f32,
    /// Of velocities in the world, m/s.
    pub velocity_m_s: f32,
    /// Of attitudes, rad.
    pub attitude_rad: f32,
    /// Of variances, as a share of the recorded one.
    pub variance_share: f32,
}

impl Limits {
    /// The limits recordings of the firmware's filter are held to.
    pub const FIRMWARE: Self = Self {
        position_m: 5e-4,
        velocity_m_s: 2e-4,
        attitude_rad: 1e-4,
        variance_share: 1e-3,
    };
}

impl Deviation {
    /// Whether position, velocity, attitude and variances stay within the limits; never if nothing was compared.
    #[must_use]
    pub fn within(&self, limits: &Limits) -> bool {
        // Written so that a value that is no number fails.
        self.compared > 0
            && self.position_m.value <= limits.position_m
            && self.velocity_m_s.value <= limits.velocity_m_s
            && self.attitude_rad.value <= limits.attitude_rad
            && self.variance_share.value <= limits.variance_share
    }

    fn include(&mut self, ekf: &Ekf, reference: &Reference) {
        let tick_ms = reference.tick_ms;
        let estimate = ekf.estimate();
        let angles = estimate.legacy_euler();
        let apart = estimate.attitude.conjugate().quaternion() * reference.attitude;
        let angle_pairs = [
            (angles.roll_deg, reference.angles.roll_deg),
            (angles.pitch_deg, reference.angles.pitch_deg),
            (angles.yaw_deg, reference.angles.yaw_deg),
        ];

        self.compared += 1;
        let position_m = (estimate.position_m - reference.position_m).norm();
        self.position_m.widen(position_m, tick_ms);
        let velocity_m_s = (estimate.velocity_m_s - reference.velocity_m_s).norm();
        self.velocity_m_s.widen(velocity_m_s, tick_ms);
        self.attitude_rad
            .widen(2.0 * apart.vector().norm(), tick_ms);
        for (ours, theirs) in angle_pairs {
            self.legacy_angle_deg
                .widen(turn_between_deg(ours, theirs), tick_ms);
        }
        for (ours, theirs) in estimate.variances.iter().zip(&reference.variances) {
            self.variance_share
                .widen((ours / theirs - 1.0).abs(), tick_ms);
        }
        for &(i, j, theirs) in &reference.covariances {
            let scale = (reference.variances[i] * reference.variances[j]).sqrt();
            let ours = ekf.covariance(i, j).unwrap_or(f32::NAN);
            self.correlation
                .widen((ours - theirs).abs() / scale, tick_ms);
        }
    }
}

/// The smaller angle between two directions, degrees: 179° and -179° are 2° apart.
fn turn_between_deg(a: f32, b: f32) -> f32 {
    let apart = (a - b).abs();
    apart.min((360.0 - apart).abs())
}

/// How far the filter strays from the recorded one.
///
/// # Errors
///
/// As [`replay`].
pub fn deviation(recording: &Recording, parameters: Parameters) -> Result<Deviation, ReplayError> {
    let mut deviation = Deviation::default();
    let mut references = recording.references.iter().peekable();
    replay(recording, parameters, |tick_ms, ekf| {
        while let Some(reference) = references.next_if(|reference| reference.tick_ms <= tick_ms) {
            deviation.include(ekf, reference);
        }
    })?;
    Ok(deviation)
}
