//! Recorded sequences through the filter, against what another filter made of them.
//!
//! A recording is three CSV files: one IMU row per millisecond, the events between them, and every 10 ms the state of
//! the filter that was recorded. [`Recording::load`] reads them, [`deviation`] runs [`Ekf`] over them and tells how
//! far it strays; [`replay`] gives every tick to an observer, to plot or to print.

pub(in crate::ekf) mod recording;
pub(in crate::ekf) mod table;

pub use recording::{Action, Event, Recording, Reference};
pub use table::{ReplayError, RowFault};

use super::Parameters;
use super::task::Ekf;

/// Runs the filter over a recording; `observe` sees it after every tick, with the tick's time in ms.
///
/// # Errors
///
/// [`ReplayError::TooManyEvents`] if one tick holds more measurements than the filter's queue.
pub fn replay(
    recording: &Recording,
    parameters: Parameters,
    mut observe: impl FnMut(u64, &Ekf),
) -> Result<(), ReplayError> {
    let mut ekf = Ekf::new(parameters, 0);
    let mut flying = false;
    let mut events = recording.events.iter().peekable();
    for (tick_ms, imu) in (0_u64..).zip(&recording.imu) {
        let full = |_| ReplayError::TooManyEvents { tick_ms };
        for measurement in imu.measurements() {
            ekf.enqueue(measurement).map_err(full)?;
        }
        while let Some(event) = events.next_if(|event| event.tick_ms <= tick_ms) {
            match event.action {
                Action::Measure(measurement) => ekf.enqueue(measurement).map_err(full)?,
                Action::Flying(now) => flying = now,
                Action::Reset => ekf.request_reset(),
            }
        }
        ekf.tick(tick_ms, flying);
        observe(tick_ms, &ekf);
    }
    Ok(())
}

/// The largest distances between two filters over a recording.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deviation {
    /// Instants compared.
    pub compared: usize,
    /// Of positions, m.
    pub position_m: f32,
    /// Of velocities in the world, m/s.
    pub velocity_m_s: f32,
    /// Angle between the attitudes, rad.
    pub attitude_rad: f32,
    /// Of legacy roll, pitch and yaw, degrees.
    pub legacy_angle_deg: f32,
    /// Of the nine variances, as a share of the recorded one.
    pub variance_share: f32,
    /// Of the recorded covariances, as a share of the two standard deviations' product.
    pub correlation: f32,
}

impl Deviation {
    fn include(&mut self, ekf: &Ekf, reference: &Reference) {
        let estimate = ekf.estimate();
        let angles = estimate.legacy_euler();
        let apart = estimate.attitude.conjugate().quaternion() * reference.attitude;
        let angle_pairs = [
            (angles.roll_deg, reference.angles.roll_deg),
            (angles.pitch_deg, reference.angles.pitch_deg),
            (angles.yaw_deg, reference.angles.yaw_deg),
        ];

        self.compared += 1;
        widen(
            &mut self.position_m,
            (estimate.position_m - reference.position_m).norm(),
        );
        widen(
            &mut self.velocity_m_s,
            (estimate.velocity_m_s - reference.velocity_m_s).norm(),
        );
        widen(&mut self.attitude_rad, 2.0 * apart.vector().norm());
        for (ours, theirs) in angle_pairs {
            widen(&mut self.legacy_angle_deg, (ours - theirs).abs());
        }
        for (ours, theirs) in estimate.variances.iter().zip(&reference.variances) {
            widen(&mut self.variance_share, (ours / theirs - 1.0).abs());
        }
        for &(i, j, theirs) in &reference.covariances {
            let scale = (reference.variances[i] * reference.variances[j]).sqrt();
            let ours = ekf.covariance(i, j).unwrap_or(f32::NAN);
            widen(&mut self.correlation, (ours - theirs).abs() / scale);
        }
    }
}

/// Keeps the larger value; a value that is no number is kept for good, so that it cannot pass a limit.
fn widen(largest: &mut f32, value: f32) {
    if value.is_nan() || value > *largest {
        *largest = value;
    }
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
