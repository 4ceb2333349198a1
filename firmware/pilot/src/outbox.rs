//! What goes out after one STATE: encoded frames, never more than the autopilot can take.

use heapless::Vec;

/// The autopilot's UART receive buffer holds 200 bytes; more than that in one 100 ms period would
/// be lost on its side (Crazyflie UART2, stream buffer of 200 bytes).
pub const PERIOD_BYTES: usize = 200;

/// Encoded frames that wait for the wire.
#[derive(Debug, Default)]
pub struct Outbox {
    bytes: Vec<u8, PERIOD_BYTES>,
}

impl Outbox {
    /// An empty outbox.
    pub const fn new() -> Self {
        Self { bytes: Vec::new() }
    }

    /// Appends one whole frame, or none of it where it does not fit: half a frame would spoil the
    /// one after it. The fullest answer, vector, correction, map and mode, takes 118 bytes.
    pub(crate) fn push(&mut self, frame: &[u8]) {
        let _ = self.bytes.extend_from_slice(frame);
    }

    /// The frames, back to back.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Forgets the frames: they are on the wire.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }
}
