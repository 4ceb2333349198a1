//! A frame in pieces: the host's end.

use heapless::Vec;

use crate::coding::{Coding, nibbles};
use crate::record::{Encoded, PIECE_PAYLOAD_BYTES, seal};
use crate::shape::Shape;

/// Number and offset.
pub(crate) const HEADER_BYTES: usize = 6;

const BYTES: u8 = 0x10;
const STEPS: u8 = 0x11;

/// What a piece's header says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The frame's number.
    pub number: u32,
    /// Where in the frame it begins, bytes.
    pub offset: u16,
}

impl Piece {
    pub(crate) fn encode(self) -> [u8; HEADER_BYTES] {
        let [a, b, c, d] = self.number.to_le_bytes();
        let [e, f] = self.offset.to_le_bytes();
        [a, b, c, d, e, f]
    }

    pub(crate) fn decode([a, b, c, d, e, f]: [u8; HEADER_BYTES]) -> Self {
        Self {
            number: u32::from_le_bytes([a, b, c, d]),
            offset: u16::from_le_bytes([e, f]),
        }
    }
}

/// The coding of the pieces of this kind; none where it is no piece.
pub(crate) fn coding_of(kind: u8) -> Option<Coding> {
    match kind {
        BYTES => Some(Coding::Bytes),
        STEPS => Some(Coding::Steps),
        _ => None,
    }
}

/// The records of one frame, in order.
///
/// ```
/// # use frames::{Pieces, Shape};
/// let shape = Shape { width: 128, height: 96, bytes_per_pixel: 2, luma_offset: 1 };
/// let frame = vec![0x80; shape.bytes()];
/// let wire: Vec<u8> = Pieces::of(7, &frame, &shape).flatten().collect();
/// assert!(wire.len() < shape.bytes() / 3);
/// ```
#[derive(Clone, Debug)]
pub struct Pieces<'f> {
    number: u32,
    frame: &'f [u8],
    coding: Coding,
    shape: Shape,
    at: usize,
}

impl<'f> Pieces<'f> {
    /// The records of `frame`, in the shortest coding that loses nothing. The frame should have
    /// [`Shape::bytes`], at most 64 KiB: a board takes no other.
    pub fn of(number: u32, frame: &'f [u8], shape: &Shape) -> Self {
        Self {
            number,
            frame,
            coding: Coding::of(frame, shape),
            shape: *shape,
            at: 0,
        }
    }

    fn bytes(&mut self, left: &[u8]) -> Payload {
        let bytes = left.get(..PIECE_PAYLOAD_BYTES).unwrap_or(left);
        self.at += bytes.len();
        bytes.iter().copied().collect()
    }

    /// As many whole pixels as there is room for.
    fn steps(&mut self, left: &[u8]) -> Payload {
        let size = usize::from(self.shape.bytes_per_pixel.max(1));
        let mut packed = Packed::new();
        let mut previous = 0;
        for pixel in left.chunks(size) {
            let luma = pixel.get(usize::from(self.shape.luma_offset));
            let luma = luma.copied().unwrap_or_default();
            let (nibbles, count) = nibbles(previous, luma);
            if !packed.push(nibbles.get(..count).unwrap_or_default()) {
                break;
            }
            previous = luma;
            self.at += pixel.len();
        }
        packed.finish()
    }
}

impl Iterator for Pieces<'_> {
    type Item = Encoded;

    fn next(&mut self) -> Option<Encoded> {
        let left = self.frame.get(self.at..).filter(|left| !left.is_empty())?;
        let header = Piece {
            number: self.number,
            offset: u16::try_from(self.at).ok()?,
        };
        let (kind, payload) = match self.coding {
            Coding::Bytes => (BYTES, self.bytes(left)),
            Coding::Steps => (STEPS, self.steps(left)),
        };
        Some(seal(kind, [&header.encode(), &payload]))
    }
}

/// What follows a piece's header.
type Payload = Vec<u8, PIECE_PAYLOAD_BYTES>;

/// Nibbles, two to a byte.
struct Packed {
    bytes: Payload,
    /// The upper nibble of the byte that is not full yet.
    odd: Option<u8>,
}

impl Packed {
    const fn new() -> Self {
        Self {
            bytes: Payload::new(),
            odd: None,
        }
    }

    /// Appends all of them, or none where there is no room. An odd nibble keeps its room.
    fn push(&mut self, nibbles: &[u8]) -> bool {
        let used = 2 * self.bytes.len() + usize::from(self.odd.is_some());
        if used + nibbles.len() > 2 * PIECE_PAYLOAD_BYTES {
            return false;
        }
        for nibble in nibbles {
            match self.odd.take() {
                None => self.odd = Some(*nibble),
                Some(upper) => {
                    let _ = self.bytes.push(upper << 4 | nibble);
                }
            }
        }
        true
    }

    fn finish(mut self) -> Payload {
        // The start of an escape that is never finished: no pixel.
        let padding = crate::coding::PADDING;
        if self.odd.is_some() {
            self.push(&[padding]);
        }
        self.bytes
    }
}
