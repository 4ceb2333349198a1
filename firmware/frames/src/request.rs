//! What the host asks for.

use crate::record::{Message, seal};

const IDENTIFY: u8 = 0x01;
const BEGIN: u8 = 0x02;
const END: u8 = 0x03;
const COUNT: u8 = 0x04;

/// What a host asks of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Who is there? Answered with [`crate::Reply::Identity`].
    Identify,
    /// Take frames from the wire from now on, and forget the numbers of those that came before.
    /// Answered with [`crate::Reply::Source`].
    Begin {
        /// How long a frame may be on its way, from its first piece to its last, and still be of use,
        /// milliseconds.
        fresh_ms: u16,
    },
    /// Take frames from the camera. Answered with [`crate::Reply::Source`].
    End,
    /// What has arrived so far? Answered with [`crate::Reply::Counts`].
    Count,
}

impl Request {
    /// Longest body, bytes.
    pub(crate) const MAX_BODY_BYTES: usize = 2;

    /// The bytes for the wire.
    pub fn encode(&self) -> Message {
        match self {
            Self::Identify => seal(IDENTIFY, [&[], &[]]),
            Self::Begin { fresh_ms } => seal(BEGIN, [&fresh_ms.to_le_bytes(), &[]]),
            Self::End => seal(END, [&[], &[]]),
            Self::Count => seal(COUNT, [&[], &[]]),
        }
    }

    pub(crate) fn decode(kind: u8, body: &[u8]) -> Option<Self> {
        match (kind, body) {
            (IDENTIFY, []) => Some(Self::Identify),
            (BEGIN, [low, high]) => Some(Self::Begin {
                fresh_ms: u16::from_le_bytes([*low, *high]),
            }),
            (END, []) => Some(Self::End),
            (COUNT, []) => Some(Self::Count),
            _ => None,
        }
    }
}
