//! The link between camera board and autopilot: pprzlink 2.0 frames and the visual-homing messages.
//!
//! Pure: bytes in, messages out, and back. No clock, no peripheral, no allocation; both ends of the
//! wire use this crate, the camera firmware and the flight app that the rig puts in front of it.
//!
//! * [`Parser`] turns received bytes, in pieces of any size, into [`Frame`]s, and says what it drops;
//! * [`Message`] is what a frame says, [`Frame::encode`] what goes on the wire;
//! * [`Mode`] gives the command bytes their names;
//! * [`world`] is the only place where the wire's east/north/clockwise becomes x/y/counter-clockwise.
//!
//! Sources: pprzlink 2.0 (`pprz_transport`, the generated `intermcu` class) and the message list of
//! tomvand/2020-visualhoming-crazyflie.
#![no_std]

mod body;
mod checksum;
mod counters;
mod field;
mod frame;
mod held;
mod kind;
mod message;
mod mode;
mod parser;
mod plausible;
mod refusal;
pub mod world;

pub use counters::Counters;
pub use frame::{Encoded, Frame, MAX_FRAME_LEN, MIN_FRAME_LEN};
pub use message::{
    CAMERA_CAPACITY, COMMAND_CAPACITY, Camera, Command, DEBUG_CAPACITY, Debug, InsCorrection,
    MAP_CAPACITY, Map, Message, Source, State, Vector,
};
pub use mode::{Mode, Record};
pub use parser::{Event, Parser};
pub use plausible::{Implausible, MAX_COORDINATE_M, MAX_HEADING_RAD};
pub use refusal::{Refusal, Refused};
pub use world::{WorldPoint, WorldPose};
