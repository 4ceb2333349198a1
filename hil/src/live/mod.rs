//! Flights against the clock on the wall, with one half of them somebody else's: the emulated board
//! for a real autopilot, the emulated autopilot for a real board, or both in two programs.
//!
//! ```text
//! hil emulate:   port <-> emulated board <- camera <- eyes <- port (true pose) or STATE
//! hil autopilot: port <-> aircraft -> truth -> port
//! ```
//!
//! Each half stays one loop of milliseconds, as in virtual time; what it meets at its ports, and
//! when, is the world's doing, and no two flights are alike.

mod autopilot;
mod emulate;
mod endpoint;
mod frames;
mod pace;
mod port;
mod pose;
mod scribe;
mod stop;
mod watch;

pub use autopilot::{Account, Attendant, AutopilotSetup, Moment, fly_aircraft, fly_attended};
pub use emulate::{EmulateSetup, emulate};
pub use endpoint::{Endpoint, EndpointError, PoseSource, TcpPort, beside};
pub use pace::{LATE, Pacer};
pub use port::{News, OpenError, Port, Unsent};
pub use pose::{Eyes, PoseError, PoseLine, PoseLines, Seen};
pub use scribe::{Notice, Scribe};
pub use stop::Stop;

use fake_sensors::world::WorldError;

use crate::board::BoardError;
use crate::gdb::PortError;
use crate::rig::Unready;

/// A live flight that could not be flown.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// There is no such world, or its file is bad.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The board cannot go on.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// A port cannot be opened.
    #[error(transparent)]
    Port(#[from] OpenError),
    /// The GDB server's port cannot be opened.
    #[error(transparent)]
    Gdb(#[from] PortError),
    /// The board on the desk does not take part.
    #[error(transparent)]
    Rig(#[from] Unready),
}

/// What both halves share of their setup.
#[derive(Debug)]
pub struct Common<'s> {
    /// Where the other half is met.
    pub link: Endpoint,
    /// Baud rate of a serial device.
    pub baud: u32,
    /// Virtual over real time; 1 for all that is real.
    pub speed: f64,
    /// When to end, virtual milliseconds.
    pub limit_ms: Option<u64>,
    /// Asks to end.
    pub stop: &'s Stop,
}

impl Common<'_> {
    /// Whether it is time to end.
    pub(crate) fn over(&self, now_ms: u64) -> bool {
        self.stop.requested() || self.limit_ms.is_some_and(|limit_ms| now_ms >= limit_ms)
    }
}
