//! Continuous capture that never hangs: DCMI into two buffers by DMA in hardware double-buffer
//! mode, on the registers (STM32F405/407/415/417, RM0090 §15 and §10).
//!
//! ```text
//! let mut capture = Capture::start(port);
//! // ... set the sensor up, then:
//! capture.expect_signal(Instant::now() + first_frame);
//! loop {
//!     match capture.next().await {
//!         Ok(frame) => { let (result, integrity) = frame.read(|bytes| ...); }
//!         Err(fault) => ..., // counted, logged; the capture has recovered by itself
//!     }
//! }
//! ```
//!
//! # Why not the HAL's
//! `embassy_stm32::dcmi::Dcmi::capture` takes one frame and stops. It waits for the interface and
//! for the DMA, both: after an overrun, a short frame or a lost vertical sync the DMA never ends,
//! and neither does the wait. Dropping its future leaves the interface running with half a word in
//! its FIFO, so that the next frame arrives shifted. And between two calls a frame is lost unless
//! the second is made within the vertical blanking.
//!
//! # How
//! The DMA fills the buffers in turn and never waits: no frame is lost between captures, and none
//! is copied. Interrupts at the end of each line and of each frame hold the count of words in
//! memory against the count of lines: 64 words a line, 96 lines a frame. Whatever does not fit is a
//! [`Fault`] with a name, and capture starts afresh with the next frame; so a frame that was
//! handed out has every byte in its place, and the signal's return costs no more than the rest of
//! the frame it returns in. What cannot be seen from an interrupt, because none comes, is seen by
//! [`Capture::next`], which watches the clock while it waits.
//!
//! # When a frame is whole
//! With its last line, 2.5 ms before VSYNC falls: the interface is given a window of as many lines as
//! a frame has, wider than they are, and says so at the end of the last of them, when it has filled
//! up an unfinished word. Then the count of words tells every byte that was lost or won since VSYNC rose,
//! and the times between the lines tell that they are of one frame: 3.9 ms lie between two, more than any
//! line may wait for the next. So 96 lines of 64 words each are the whole frame that followed the rise of
//! VSYNC, and nothing that VSYNC does later makes them less so.
//!
//! What comes after the last line belongs to nobody. No byte of it is stored; a line before VSYNC
//! falls, as of the next frame where VSYNC stays high, is told as [`Fault::NoVsync`] and has capture
//! start afresh with the frame after, but takes nothing back of the frame that was handed over. Where
//! the interface says nothing at the last line, for want of a line, the frame ends with VSYNC
//! and is told as the fault it is. 3.9 ms of blanking are left after a frame, time enough to start afresh
//! and still catch the next.
//!
//! Whoever reads a frame has the time of one more frame before the DMA comes back to its buffer.
//! [`Frame::read`] says whether that was enough.
//!
//! # What it needs
//! - DCMI, DMA2 stream 1 and both their interrupts, at one priority, bound to
//!   [`InterruptHandler`] and [`DmaInterruptHandler`]. A line's interrupt must be served before the
//!   next line ends (0.15 ms), or that line is not checked by itself; its frame still is.
//! - An output section `.uninit` in memory that DMA2 reaches: SRAM1 or SRAM2, not the core-coupled
//!   memory. Two frames, 48 KiB.
//! - `embassy-time`, and a sensor with hardware sync whose geometry and times stand in `buffers`
//!   and `timing`.
//!
//! # Frames from elsewhere
//! With the cargo feature `rig`, `Capture::divert` stops interface and DMA and hands out the buffers
//! to whoever has frames of another source; readers see no difference.
//!
//! # Cancelling
//! A dropped [`Capture::next`] loses nothing: frames and faults wait for the next call, and a frame
//! that a newer one overtakes is counted as [missed](Frame::missed). A dropped [`Capture`] stops
//! interface, DMA and interrupts: no byte moves afterwards.

mod buffers;
mod fault;
mod hardware;
#[cfg(feature = "rig")]
mod injection;
mod interrupt;
mod port;
mod timing;
mod watch;

use core::future::poll_fn;
use core::task::Poll;

use embassy_time::{Instant, with_deadline};

use buffers::{FRAME_WORDS, buffer_of};
pub use fault::Fault;
#[cfg(feature = "rig")]
pub use injection::Injection;
use interrupt::STATE;
pub use interrupt::{DmaInterruptHandler, InterruptHandler};
pub use port::{Port, pin};
use watch::Watch;

/// A running capture; there is one.
pub struct Capture {
    _port: Port,
    watch: Watch,
    /// Number of the frame handed out last.
    last: u32,
}

impl Capture {
    /// Starts to capture with the next frame the sensor sends. Silence is no fault before
    /// [`expect_signal`](Self::expect_signal).
    pub fn start(port: Port) -> Self {
        interrupt::enable();
        let mut capture = Self {
            _port: port,
            watch: Watch::new(),
            last: 0,
        };
        capture.restart();
        capture
    }

    /// From `at` on the sensor is expected to send, and its silence is a fault.
    pub fn expect_signal(&mut self, at: Instant) {
        self.watch.expect_signal(at);
    }

    /// The sensor is being reset: its silence is no fault from now on.
    pub fn expect_silence(&mut self) {
        self.watch.expect_silence();
    }

    /// What comes next: a whole frame as soon as its last line is in memory, or the name of what became of it. While a signal is
    /// [expected](Self::expect_signal) the wait ends, with the longest when every frame is lost in
    /// silence: with [`Fault::NoSignal`], after which a signal must be expected anew.
    ///
    /// A frame is the newest; where several went by, the others are [missed](Frame::missed).
    ///
    /// # Errors
    /// The fault. The capture has already started afresh where it had to.
    pub async fn next(&mut self) -> Result<Frame, Fault> {
        loop {
            let Some(look) = self.watch.next_look() else {
                return self.event().await;
            };
            if let Ok(event) = with_deadline(look, self.event()).await {
                return event;
            }
            if let Some(fault) = self.watch.look(Instant::now()) {
                if fault == Fault::NoSignal {
                    // What has come of a frame does not belong to what is to come.
                    self.restart();
                }
                return Err(fault);
            }
        }
    }

    /// What the interrupts have to tell.
    async fn event(&mut self) -> Result<Frame, Fault> {
        poll_fn(|context| {
            STATE.waker.register(context.waker());
            if let Some(fault) = STATE.take_fault() {
                return Poll::Ready(Err(fault));
            }
            match STATE.progress() {
                (number, _) if number == self.last => Poll::Pending,
                (number, restarts) => Poll::Ready(Ok(self.hand_out(number, restarts))),
            }
        })
        .await
    }

    fn hand_out(&mut self, number: u32, restarts: u32) -> Frame {
        let missed = number.wrapping_sub(self.last).wrapping_sub(1);
        self.last = number;
        Frame {
            number,
            restarts,
            missed,
        }
    }

    /// Drops a frame that may be under way and starts with the next one the sensor sends.
    pub fn restart(&mut self) {
        critical_section::with(|_| interrupt::restart());
    }
}

impl Drop for Capture {
    fn drop(&mut self) {
        interrupt::disable();
        hardware::stop();
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
    missed: u32,
}

impl Frame {
    /// Frames captured since boot, this one included.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Whole frames between this one and the one handed out before it.
    pub fn missed(&self) -> u32 {
        self.missed
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
        #[cfg(feature = "rig")]
        let hold = injection::Hold::of(self.number);
        let result = reader(bytes);
        #[cfg(feature = "rig")]
        if let Some(integrity) = hold.release() {
            return (result, integrity);
        }
        (result, self.integrity())
    }

    fn integrity(&self) -> Integrity {
        critical_section::with(|_| {
            let (newest, restarts) = STATE.progress();
            let stored = hardware::words_stored();
            let intact = match newest.wrapping_sub(self.number) {
                // The DMA fills the other buffer, unless its frame does not end there.
                0 => stored <= FRAME_WORDS,
                // This buffer is next: it is whole as long as the next frame has not begun, and
                // no beginning of it was thrown away.
                1 => restarts == self.restarts && stored == 0,
                _ => false,
            };
            if intact && !STATE.is_spoilt(self.number) {
                Integrity::Intact
            } else {
                Integrity::Torn
            }
        })
    }
}
