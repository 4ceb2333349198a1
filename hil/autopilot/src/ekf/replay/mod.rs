//! Recorded sequences through the filter, against what another filter made of them.
//!
//! A recording is three CSV files: one IMU row per millisecond, the events between them, and every 10 ms the state of
//! the filter that was recorded. [`Recording::load`] reads them, [`deviation`] runs [`Ekf`] over them and tells how
//! far it strays; [`replay`] gives every tick to an observer, to plot or to print.

mod deviation;
pub(in crate::ekf) mod recording;
pub(in crate::ekf) mod table;

pub use deviation::{Deviation, Largest, Limits, deviation};
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
