//! Continuous capture: DCMI into two buffers by DMA in hardware double-buffer mode.
//!
//! The DMA fills the buffers in turn and never waits: no frame is lost between captures, and none
//! is copied. The window is cropped to the picture, so that the end-of-frame interrupt comes with
//! its last row, and not with the end of the vertical sync 1.3 ms later. At each end of frame the
//! interrupt checks that exactly one buffer was filled; where it was not, the stream has lost its
//! place, and capture starts afresh with the next frame.
//!
//! Whoever reads a frame has the time of one more frame before the DMA comes back to its buffer.
//! [`Frame::read`] says whether that was enough.

mod buffers;
mod hardware;
mod interrupt;

use core::future::poll_fn;
use core::task::Poll;

use crate::board::CameraPort;
use crate::counters::COUNTERS;
use buffers::buffer_of;
pub use interrupt::InterruptHandler;
use interrupt::STATE;

/// A running capture. Its port is its own for good.
pub struct Capture {
    _port: CameraPort,
    /// Number of the frame handed out last.
    last: u32,
}

impl Capture {
    /// Starts to capture with the next frame the sensor sends.
    pub fn start(port: CameraPort) -> Self {
        interrupt::enable();
        let mut capture = Self {
            _port: port,
            last: 0,
        };
        capture.restart();
        capture
    }

    /// The next whole frame, as soon as its last byte is in memory; the newest where several went
    /// by, and the others are counted as missed. Waits as long as the sensor is silent: give it a
    /// time-out. Dropping the future loses nothing.
    pub async fn next(&mut self) -> Frame {
        poll_fn(|context| {
            STATE.waker.register(context.waker());
            match STATE.progress() {
                (number, _) if number == self.last => Poll::Pending,
                (number, restarts) => Poll::Ready(self.hand_out(number, restarts)),
            }
        })
        .await
    }

    fn hand_out(&mut self, number: u32, restarts: u32) -> Frame {
        let skipped = number.wrapping_sub(self.last).wrapping_sub(1);
        COUNTERS.frames_missed.count_many(skipped);
        self.last = number;
        Frame { number, restarts }
    }

    /// Drops a capture that may be under way and starts with the next frame the sensor sends.
    pub fn restart(&mut self) {
        critical_section::with(|_| interrupt::restart());
    }
}

/// What became of a frame while it was being read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrity {
    /// Every byte belonged to this frame.
    Intact,
    /// The DMA was back at the buffer before the reader was done.
    Torn,
}

/// A whole frame in its buffer.
pub struct Frame {
    number: u32,
    restarts: u32,
}

impl Frame {
    /// Frames captured since boot, this one included.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Whether no later frame is complete yet.
    pub fn is_newest(&self) -> bool {
        STATE.progress().0 == self.number
    }

    /// Shows the frame's bytes to `reader` where they lie, and tells afterwards whether they held
    /// still.
    pub fn read<R>(self, reader: impl FnOnce(&buffers::Bytes) -> R) -> (R, Integrity) {
        // SAFETY: the buffer was filled by the DMA before this frame was made. While `reader`
        // runs the DMA fills the other buffer, for the time of one frame; a reader slower than
        // that sees bytes of two frames, which are bytes all the same, and is told.
        let bytes = unsafe { buffers::bytes(buffer_of(self.number)) };
        let result = reader(bytes);
        (result, self.integrity())
    }

    fn integrity(&self) -> Integrity {
        critical_section::with(|_| {
            let (newest, restarts) = STATE.progress();
            let intact = match newest.wrapping_sub(self.number) {
                // The DMA fills the other buffer.
                0 => true,
                // This buffer is next: it is whole as long as the next frame has not begun, and
                // no beginning of it was thrown away.
                1 => restarts == self.restarts && !hardware::frame_has_begun(),
                _ => false,
            };
            if intact {
                Integrity::Intact
            } else {
                Integrity::Torn
            }
        })
    }
}
