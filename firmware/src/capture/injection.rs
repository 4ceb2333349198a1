//! Frames of another source in the capture's buffers, for images that are not for flight.
//!
//! The processor writes here, and not the DMA: so a buffer that is being read is not written, and no
//! frame is ever torn.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::buffers::{Buffer, Bytes, FRAME_BYTES, buffer_of, bytes_mut};
use super::interrupt::{self, STATE};
use super::{Capture, Frame, Integrity, hardware};

/// Whether interface and DMA are stopped, and an [`Injection`] fills the buffers.
static DIVERTED: AtomicBool = AtomicBool::new(false);

/// Nobody reads.
const NONE: u32 = u32::MAX;

/// The buffer that is being read, by its number, or [`NONE`].
static READ: AtomicU32 = AtomicU32::new(NONE);

impl Capture {
    /// Stops interface and DMA: the buffers are filled by hand until the injection is dropped.
    pub fn divert(&mut self) -> Injection<'_> {
        interrupt::disable();
        hardware::stop();
        DIVERTED.store(true, Ordering::Relaxed);
        Injection {
            capture: self,
            written: [false; 2],
        }
    }
}

/// The capture's buffers, to be filled by hand.
pub struct Injection<'c> {
    capture: &'c mut Capture,
    /// Whether a buffer holds bytes at all: memory is not, before it was written to.
    written: [bool; 2],
}

impl Injection<'_> {
    /// The buffer of the next frame; none while somebody reads it. The same one until it is
    /// [complete](Self::complete).
    pub fn buffer(&mut self) -> Option<&mut Bytes> {
        let buffer = self.next();
        if READ.load(Ordering::Acquire) == buffer as u32 {
            return None;
        }
        // SAFETY: `divert` stopped the DMA. Nobody reads this buffer, and nobody begins to while the
        // reference lives: readers are tasks below the one that calls this, or the same.
        let memory = unsafe { bytes_mut(buffer) };
        let written = self.written.get_mut(buffer as usize)?;
        if !*written {
            memory.write([0; FRAME_BYTES]);
            *written = true;
        }
        // SAFETY: written above, now or at an earlier call.
        Some(unsafe { memory.assume_init_mut() })
    }

    /// The buffer holds a whole frame: this one.
    pub fn complete(&mut self) -> Frame {
        let number = STATE.count_frame();
        self.capture.hand_out(number, STATE.progress().1)
    }

    fn next(&self) -> Buffer {
        buffer_of(STATE.progress().0.wrapping_add(1))
    }
}

impl Drop for Injection<'_> {
    fn drop(&mut self) {
        DIVERTED.store(false, Ordering::Relaxed);
        interrupt::enable();
        self.capture.restart();
    }
}

/// Keeps a frame's buffer from being filled by hand while it is read.
pub struct Hold {
    /// Whether the frame was the newest when the reading began: its buffer is not the next.
    newest: bool,
}

impl Hold {
    /// Holds the buffer of frame `number`. There is one reader.
    pub fn of(number: u32) -> Self {
        READ.store(buffer_of(number) as u32, Ordering::Release);
        Self {
            newest: STATE.progress().0 == number,
        }
    }

    /// Lets go of it. What became of the frame meanwhile; nothing is known of it here while the DMA
    /// fills the buffers.
    pub fn release(self) -> Option<Integrity> {
        READ.store(NONE, Ordering::Release);
        let diverted = DIVERTED.load(Ordering::Relaxed);
        diverted.then_some(if self.newest {
            Integrity::Intact
        } else {
            Integrity::Torn
        })
    }
}
