//! What happened, counted. Every count only grows; the health task reports them.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::capture::Fault;

/// A count that any task or interrupt may raise.
#[derive(Default)]
pub struct Counter(AtomicU32);

impl Counter {
    const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// One more.
    pub fn count(&self) {
        self.count_many(1);
    }

    /// `events` more.
    pub fn count_many(&self, events: u32) {
        self.0.fetch_add(events, Ordering::Relaxed);
    }

    /// Replaces the count by one that is kept elsewhere.
    pub fn set(&self, events: u32) {
        self.0.store(events, Ordering::Relaxed);
    }

    /// The count since boot.
    pub fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// All counts of the board.
pub struct Counters {
    /// Whole frames that vision has used.
    pub frames: Counter,
    /// Whole frames that vision never saw, because a newer one was there first.
    pub frames_missed: Counter,
    /// Frames that the DMA began to overwrite while vision read them.
    pub frames_torn: Counter,
    /// Faults of the capture, by name: see [`Counters::capture`].
    capture: [Counter; Fault::ALL.len()],
    /// Failed dealings with the image sensor, each after the driver's own retries.
    pub sensor_faults: Counter,
    /// Link messages decoded.
    pub link_ok: Counter,
    /// Link frames refused: checksum, length, class or identity.
    pub link_bad: Counter,
    /// UART errors: noise, framing, overrun.
    pub uart_errors: Counter,
    /// Messages or frames that found vision's queue full.
    pub queue_full: Counter,
    /// Answers dropped, each whole, because the wire to the autopilot is behind.
    pub tx_dropped: Counter,
}

impl Counters {
    /// How often the capture met this fault.
    pub fn capture(&self, fault: Fault) -> &Counter {
        &self.capture[fault as usize]
    }
}

/// The counts of this board.
pub static COUNTERS: Counters = Counters {
    frames: Counter::new(),
    frames_missed: Counter::new(),
    frames_torn: Counter::new(),
    capture: [const { Counter::new() }; Fault::ALL.len()],
    sensor_faults: Counter::new(),
    link_ok: Counter::new(),
    link_bad: Counter::new(),
    uart_errors: Counter::new(),
    queue_full: Counter::new(),
    tx_dropped: Counter::new(),
};
