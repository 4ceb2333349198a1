//! The end-of-frame interrupt, and what it shares with the task.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_stm32::interrupt::typelevel::{DCMI, Handler, Interrupt};
use embassy_sync::waitqueue::AtomicWaker;

use super::buffers::buffer_of;
use super::hardware::{self, Event};
use crate::counters::COUNTERS;

/// Written by the interrupt and by [`restart`], read by everybody.
pub struct State {
    /// Whole frames since boot: the number of the newest.
    frames: AtomicU32,
    /// Times the stream was started.
    restarts: AtomicU32,
    /// Wakes the one task that waits for frames.
    pub waker: AtomicWaker,
}

/// The state of the one capture.
pub static STATE: State = State {
    frames: AtomicU32::new(0),
    restarts: AtomicU32::new(0),
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
}

/// Serves the DCMI's interrupt.
pub struct InterruptHandler;

impl Handler<DCMI> for InterruptHandler {
    unsafe fn on_interrupt() {
        let next = STATE.frames.load(Ordering::Relaxed).wrapping_add(1);
        match hardware::take_event() {
            Some(Event::FrameEnd) if hardware::has_filled(buffer_of(next)) => {
                STATE.frames.store(next, Ordering::Release);
                STATE.waker.wake();
            }
            Some(Event::FrameEnd) => {
                COUNTERS.frames_broken.count();
                restart();
            }
            Some(Event::Overrun) => {
                COUNTERS.overruns.count();
                restart();
            }
            None => {}
        }
    }
}

/// Starts the stream for the frame after the newest whole one. The buffer of the newest is left
/// alone: somebody may be reading it. Not to be interrupted by the handler.
pub fn restart() {
    let next = STATE.frames.load(Ordering::Relaxed).wrapping_add(1);
    STATE.restarts.fetch_add(1, Ordering::Relaxed);
    hardware::start(buffer_of(next));
}

/// Lets the interrupt through.
pub fn enable() {
    DCMI::unpend();
    // SAFETY: the handler is bound, and shares only atomics and the hardware with the tasks.
    unsafe { DCMI::enable() };
}
