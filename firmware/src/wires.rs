//! What runs between the tasks: who tells whom what, and how much of it may wait.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::pipe::Pipe;
use embassy_sync::signal::Signal;
use embassy_time::Instant;
use pilot::{Exposure, PERIOD_BYTES};

use crate::capture::Frame;

/// What vision acts on, in the order in which it happened.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to box a message in, and four of them are 1.1 KiB"
)]
pub enum Event {
    /// From the camera task: a whole frame.
    Frame(Frame),
    /// From the link's receiver.
    Message {
        /// When its last byte was decoded.
        at: Instant,
        /// What the autopilot says.
        message: link::Message,
    },
}

/// Camera and link receiver to vision. One queue, so that frames and messages keep their order
/// while vision is busy: for 0.3 ms at most, in which not even one message arrives. At most two frames
/// are of use at a time, and the autopilot sends two messages in 100 ms.
pub static EVENTS: Channel<CriticalSectionRawMutex, Event, 4> = Channel::new();

/// Vision to exposure: the newest wish wins.
pub static EXPOSURE: Signal<CriticalSectionRawMutex, Exposure> = Signal::new();

/// Camera to exposure: no frames come although the sensor was set up.
pub static SENSOR_SILENT: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// Exposure to camera: the sensor was set up again, and so many frames show nothing yet.
pub static SENSOR_STARTED: Signal<CriticalSectionRawMutex, u8> = Signal::new();

/// Vision to the link's transmitter. Two periods of what the autopilot can take.
pub static OUTGOING: Pipe<CriticalSectionRawMutex, { 2 * PERIOD_BYTES }> = Pipe::new();

/// Vision to the task that takes frames over serial: the board's number of the frame it has looked at,
/// and the exposure it wants.
#[cfg(feature = "rig")]
pub static SEEN: Signal<CriticalSectionRawMutex, (u32, Exposure)> = Signal::new();
