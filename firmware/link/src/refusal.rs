//! What the parser drops, and why.

use crate::frame::ID_AT;
use crate::kind::Kind;

/// Why no frame of this link begins at a start byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    /// The length byte is below 8, the length of an empty frame.
    BadLength,
    /// The class is not `intermcu`.
    WrongClass,
    /// No message has this id.
    UnknownMessage,
    /// The length is not that of the message, or contradicts its array's length byte.
    WrongSize,
    /// The checksum does not match.
    BadChecksum,
    /// The sender stopped before the frame was complete ([`crate::Parser::give_up`]).
    CutShort,
}

impl Refusal {
    /// What was wrong, in a word or two: for logs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BadLength => "length",
            Self::WrongClass => "class",
            Self::UnknownMessage => "unknown message",
            Self::WrongSize => "size",
            Self::BadChecksum => "checksum",
            Self::CutShort => "cut short",
        }
    }
}

/// A start byte that no frame of this link follows: the rest of a broken frame, or noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Refused {
    /// What is wrong with the bytes that follow.
    pub why: Refusal,
    /// The message id that the header states; `None` where the header was cut short before it. It
    /// may be the broken byte itself.
    pub message_id: Option<u8>,
}

impl Refused {
    /// What is refused begins with these bytes.
    pub(crate) fn new(why: Refusal, bytes: &[u8]) -> Self {
        let message_id = bytes.get(ID_AT).copied();
        Self { why, message_id }
    }

    /// The name of the message that the header states ([`crate::Message::name`]); `"?"` where it
    /// states none, or an id that no message has.
    pub fn message_name(&self) -> &'static str {
        self.message_id.and_then(Kind::of).map_or("?", Kind::name)
    }
}
