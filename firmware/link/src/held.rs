//! The bytes of a frame that comes in pieces.

/// Places in the ring: as many as a `u8` tells apart, so that no index can be out of bounds.
const PLACES: usize = 1 << u8::BITS;

/// A queue of at most 255 bytes that lie in one piece.
///
/// Each byte is written to two places, a ring's length apart: from the place of the oldest byte on
/// all that are held follow one another, and none is ever moved.
#[derive(Debug)]
pub(crate) struct Held {
    bytes: [u8; 2 * PLACES],
    /// The place of the oldest byte.
    first: u8,
    len: u8,
}

impl Held {
    pub(crate) const fn new() -> Self {
        Self {
            bytes: [0; 2 * PLACES],
            first: 0,
            len: 0,
        }
    }

    pub(crate) const fn len(&self) -> u8 {
        self.len
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The bytes, the oldest first.
    pub(crate) fn bytes(&self) -> &[u8] {
        let first = usize::from(self.first);
        &self.bytes[first..first + usize::from(self.len)]
    }

    /// Takes bytes from the front of `source` until it holds `len` (at most 255), or `source` is empty.
    pub(crate) fn fill(&mut self, len: u8, source: &mut &[u8]) {
        let missing = usize::from(len.saturating_sub(self.len));
        let (taken, rest) = source.split_at(missing.min(source.len()));
        *source = rest;
        for byte in taken {
            let place = usize::from(self.first.wrapping_add(self.len));
            self.bytes[place] = *byte;
            self.bytes[place + PLACES] = *byte;
            self.len = self.len.wrapping_add(1);
        }
    }

    /// Forgets the oldest bytes.
    pub(crate) const fn drop_front(&mut self, len: u8) {
        self.first = self.first.wrapping_add(len);
        self.len = self.len.saturating_sub(len);
    }
}
