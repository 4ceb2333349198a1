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
//! bytes -> UART buffer -> parser -> INS_CORRECTION -> measurements for the filter
//! ```
//!
//! Sans-IO: one call of [`FlightApp::tick`] a millisecond takes the time, the estimate and the bytes
//! received, and returns what to send, where to fly and what to tell the filter.
//!
//! Source: tomvand/2020-visualhoming-crazyflie, branch `visualhoming` (June 2023). Left out: the
//! radio's and the battery's checks, and the zeroing of the position on the ground, which the
//! filter's reset at take-off makes void.

mod camera;
mod correction;
mod dropped;
mod experiment;
mod flight_app;
mod goal;
mod handshake;
mod ledger;
mod mission;
mod phase;
pub mod published_receiver;
mod quirks;
mod receive_loop;
mod receiver;
mod route;
mod safety;
mod script;
mod settings;
mod signals;
mod uart;
mod value_check;
mod vertical;

#[cfg(test)]
mod tests;

pub use camera::{Counters, Received};
pub use dropped::{DropReason, Dropped};
pub use experiment::Experiment;
pub use flight_app::{FlightApp, Output};
pub use phase::{Outcome, Phase};
pub use quirks::Quirks;
pub use route::{Arrival, Route, Waypoint};
pub use script::{Script, Step, Until};
pub use settings::{CYCLE_MS, CorrectionSd, FLIGHT_HEIGHT_M, Settings};
pub use signals::Signals;
