//! The flight logic without the hardware: frames and messages in, messages and exposures out.
//!
//! The board's tasks and the rig's native backend run this same room, so that a flight is the same
//! flight on both, bit for bit. It has no clock and no peripherals: time comes as an argument.
#![no_std]

pub mod outbox;

pub use outbox::Outbox;
