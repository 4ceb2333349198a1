//! The interrupts of the interface and of its DMA stream, and what they share with the task.
//!
//! Every line and every frame is held against the count of words that the DMA has stored, so that
//! a frame that lost or won a single byte on its way is known for it while it is still coming, and
//! capture starts afresh with the next one.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_stm32::interrupt::typelevel::{DCMI, DMA2_STREAM1, Handler, Interrupt};
use embassy_sync::waitqueue::AtomicWaker;
use embassy_time::{Duration, Instant};
use sensor::tcm8230::GEOMETRY;

use super::buffers::{FRAME_WORDS, LINE_WORDS, buffer_of};
use super::fault::Fault;
use super::hardware;
use super::timing::LINE_GAP;
use super::watch::Pulse;

/// Lines of a frame.
const HEIGHT: u32 = GEOMETRY.height as u32;

/// Written by the interrupts and by [`restart`], read by everybody.
pub struct State {
    /// Whole frames since boot: the number of the newest.
    frames: AtomicU32,
    /// Times the stream was started.
    restarts: AtomicU32,
    /// Lines of the frame that is coming; all of them from its last line to the fall of VSYNC.
    lines: AtomicU32,
    /// Number of the last frame whose buffer was run over by a frame that did not end.
    spoilt: AtomicU32,
    /// Faults that nobody has been told of, a bit for each.
    faults: AtomicU32,
    /// Wakes the one task that waits for frames.
    pub waker: AtomicWaker,
}

/// The state of the one capture.
pub static STATE: State = State {
    frames: AtomicU32::new(0),
    restarts: AtomicU32::new(0),
    lines: AtomicU32::new(0),
    spoilt: AtomicU32::new(0),
    faults: AtomicU32::new(0),
    waker: AtomicWaker::new(),
};

impl State {
    /// The number of the newest whole frame, and how often the stream was started.
    pub fn progress(&self) -> (u32, u32) {
        (
            self.frames.load(Ordering::Acquire),
            self.restarts.load(Ordering::Relaxed),
        )
    }

    /// One more whole frame, which no interrupt brought; its number.
    #[cfg(feature = "rig")]
    pub fn count_frame(&self) -> u32 {
        self.frames.fetch_add(1, Ordering::Release).wrapping_add(1)
    }

    /// Whether the buffer of frame `number` was run over while it was the newest.
    pub fn is_spoilt(&self, number: u32) -> bool {
        self.spoilt.load(Ordering::Relaxed) == number
    }

    /// The next fault to tell of.
    pub fn take_fault(&self) -> Option<Fault> {
        let pending = self.faults.load(Ordering::Relaxed);
        let fault = Fault::ALL
            .into_iter()
            .find(|fault| pending & fault.bit() != 0)?;
        self.faults.fetch_and(!fault.bit(), Ordering::Relaxed);
        Some(fault)
    }
}

/// Serves the DCMI's interrupt.
pub struct InterruptHandler;

impl Handler<DCMI> for InterruptHandler {
    unsafe fn on_interrupt() {
        let now = Instant::now();
        let events = hardware::take_events();
        if events.overrun() {
            lose(if hardware::stream_runs() {
                Fault::Overrun
            } else {
                Fault::DmaError
            });
            return;
        }
        // The last line and the frame end together: of a frame that its line has condemned nothing
        // more is to be said.
        let stands = !events.line() || on_line(now);
        if events.frame() && stands {
            on_frame_end();
        }
        if events.sync() {
            Pulse::sync(now);
            STATE.lines.store(0, Ordering::Relaxed);
        }
    }
}

/// Serves the interrupt of the DMA stream, which has errors alone to tell of.
pub struct DmaInterruptHandler;

impl Handler<DMA2_STREAM1> for DmaInterruptHandler {
    unsafe fn on_interrupt() {
        if hardware::stream_failed() {
            lose(Fault::DmaError);
        }
    }
}

/// A line has ended, of a frame that is being captured or of another. False: the frame is lost.
fn on_line(now: Instant) -> bool {
    let since_last = Pulse::line(now);
    let words = hardware::words_taken();
    let line = STATE.lines.load(Ordering::Relaxed) + 1;
    let fault = if line > HEIGHT {
        // The frame before has been handed over whole; what goes on is another's.
        Some(Fault::NoVsync)
    } else if words == 0 {
        // Of a frame of which nothing is taken.
        None
    } else {
        STATE.lines.store(line, Ordering::Relaxed);
        fault_of_line(line, words, since_last)
    };
    fault.inspect(|fault| lose(*fault)).is_none()
}

/// What is wrong with a line of the frame that is coming.
fn fault_of_line(line: u32, words: u32, since_last: Duration) -> Option<Fault> {
    let expected = line * LINE_WORDS;
    if hardware::is_mid_line() {
        // The next line has begun before this one was looked at: the frame's end decides.
        None
    } else if words < expected {
        Some(Fault::ShortLine)
    } else if words > expected {
        Some(Fault::ExtraBytes)
    } else if line > 1 && since_last > LINE_GAP {
        Some(Fault::StoppedClock)
    } else {
        None
    }
}

/// The frame that was being captured has ended: with its last line, or with VSYNC before that.
fn on_frame_end() {
    match hardware::words_taken() {
        FRAME_WORDS => {
            hardware::begin_next_frame();
            STATE.lines.store(HEIGHT, Ordering::Relaxed);
            STATE.frames.fetch_add(1, Ordering::Release);
            STATE.waker.wake();
        }
        0 => lose(Fault::NoLines),
        words if words < FRAME_WORDS => lose(Fault::MissingLines),
        _ => lose(Fault::ExtraBytes),
    }
}

/// Gives the frame that is coming up, and says why.
fn lose(fault: Fault) {
    STATE.faults.fetch_or(fault.bit(), Ordering::Relaxed);
    restart();
    STATE.waker.wake();
}

/// Starts the stream for the frame after the newest whole one. The buffer of the newest is left
/// alone: somebody may be reading it. Not to be interrupted by the handlers.
pub fn restart() {
    let newest = STATE.frames.load(Ordering::Relaxed);
    if hardware::words_stored() > FRAME_WORDS {
        STATE.spoilt.store(newest, Ordering::Relaxed);
    }
    STATE.restarts.fetch_add(1, Ordering::Relaxed);
    STATE.lines.store(0, Ordering::Relaxed);
    hardware::start(buffer_of(newest.wrapping_add(1)));
}

/// Lets the interrupts through.
pub fn enable() {
    DCMI::unpend();
    DMA2_STREAM1::unpend();
    // SAFETY: the handlers are bound, and share only atomics, a critical section and the hardware
    // with the tasks.
    unsafe {
        DCMI::enable();
        DMA2_STREAM1::enable();
    }
}

/// Holds the interrupts back.
pub fn disable() {
    DCMI::disable();
    DMA2_STREAM1::disable();
}
