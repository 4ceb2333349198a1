//! Two levels of urgency: the tasks that move bytes interrupt the one that thinks.
//!
//! Vision computes for milliseconds. The tasks of the camera and of the link run above it, in an
//! interrupt's context, so that frames and messages are taken, and queue for vision, in the order
//! in which they happen. Without that, the order in which the executor polls woken tasks would
//! decide whether a command meets the frame before it or the frame after it.

use embassy_executor::{InterruptExecutor, SendSpawner};
use embassy_stm32::interrupt::{self, InterruptExt, Priority};

/// Below every hardware interrupt (those are at the highest priority), above the thread.
const PRIORITY: Priority = Priority::P6;

static URGENT: InterruptExecutor = InterruptExecutor::new();

/// UART5's vector: the board has no use for that UART.
#[embassy_stm32::interrupt]
unsafe fn UART5() {
    // SAFETY: called from this handler alone, whose interrupt `start_urgent` lets through.
    unsafe { URGENT.on_interrupt() }
}

/// Starts the executor of the urgent tasks. To be called once.
pub fn start_urgent() -> SendSpawner {
    interrupt::UART5.set_priority(PRIORITY);
    URGENT.start(interrupt::UART5)
}
