//! A board on the desk, and how this machine drives it: the rig's description, the probe, the wires,
//! and an emulated board that can take the place of the real one.
//!
//! ```text
//! rig file -> probe: flash, reset, memory, log
//!          -> link:   live autopilot <-> board
//!          -> frames: eye (camera, world) -> board -> shutter, gain
//! ```

pub mod canary;
pub mod check;
pub mod desk;
mod eye;
pub mod file;
mod flight;
pub mod info;
pub mod probe;
mod ready;
pub mod transcript;
mod voices;

pub use eye::{Blind, FrameFigures};
pub use flight::{BoardFlight, BoardSetup, fly_board};
pub use ready::{Unready, in_words};
