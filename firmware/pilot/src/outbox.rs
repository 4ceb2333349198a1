//! What goes out after one STATE: encoded frames, never more than the autopilot can take.

use heapless::Vec;

/// The autopilot's UART receive buffer holds 200 bytes; more than that in one 100 ms period would
/// be lost on its side (Crazyflie UART2, stream buffer of 200 bytes).
pub const PERIOD_BYTES: usize = 200;

/// Encoded frames that wait for the wire.
#[derive(Debug, Default)]
pub struct Outbox {
    bytes: Vec<u8, PERIOD_BYTES>,
    dropped: u32,
}

impl Outbox {
    /// An empty outbox.
    pub const fn new() -> Self {
        Self {
            bytes: Vec::new(),
            dropped: 0,
        }
    }

    /// Appends one whole frame, or drops it whole and counts it.
    pub fn push(&mut self, frame: &[u8]) {
        if self.bytes.extend_from_slice(frame).is_err() {
            self.dropped = self.dropped.saturating_add(1);
        }
    }

    /// The frames, back to back.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Forgets the frames (they are on the wire); the count of dropped ones stays.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    /// Frames that did not fit, since the start.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }
}
