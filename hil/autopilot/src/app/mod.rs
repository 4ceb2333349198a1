//! The flight app: the twin of the published Crazyflie app for visual homing, as far as a flight
//! needs it, with the operator in the form of a script.
//!
//! Ten times a second while airborne: the script decides, STATE is sent, a COMMAND is sent until
//! its echo comes, the UART is read for 10 ms, and the position set-point is issued. On the ground,
//! in take-off and in landing the link is silent and unread.
//!
//! ```text
//! estimate -> safety -> script -> set-point
//!                |         ^
//!              STATE       | VECTOR of an earlier cycle
//! bytes -> reception -> handlers -> INS_CORRECTION -> measurements for the filter
//! ```
//!
//! Sans-IO: one call of [`FlightApp::tick`] a millisecond takes the time, the estimate and the bytes
//! received, and returns what to send, where to fly and what to tell the filter.
//!
//! Source: tomvand/2020-visualhoming-crazyflie, branch `visualhoming` (June 2023); what its branch
//! `master` (August 2022) did differently is in [`Settings::MASTER_2022_08`]. What the real client
//! does wrong on the link is in [`Quirks`], each with a switch.
//!
//! Our own are the limits that stand for an operator's patience, and [`Settings::default`]'s
//! set-points that travel. One app is one flight: after landing, or after a restart of the
//! autopilot, a new one takes off.

mod camera;
mod correction;
mod experiment;
mod flight_app;
mod goal;
mod handshake;
mod mission;
mod phase;
mod pilot;
mod quirks;
mod reception;
mod route;
mod safety;
mod script;
mod settings;
mod signals;
mod value_check;
mod vertical;

#[cfg(test)]
mod tests;

pub use camera::{Counters, Received};
pub use experiment::Experiment;
pub use flight_app::{FlightApp, Output};
pub use phase::{Outcome, Phase};
pub use quirks::Quirks;
pub use reception::{DropReason, Dropped, published_receiver};
pub use route::{Arrival, Route, Waypoint};
pub use script::{Script, Step, Until};
pub use settings::{CYCLE_MS, CorrectionSd, FLIGHT_HEIGHT_M, Settings};
pub use signals::Signals;
