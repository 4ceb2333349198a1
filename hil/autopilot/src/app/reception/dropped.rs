//! What the app loses of what the camera sends.

use std::fmt;

use link::Refusal;

/// A frame, or a run of bytes that was none, which arrived at the app and was never used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dropped {
    /// When it was certain that it would not be used, ms.
    pub at_ms: u64,
    /// The message's name ([`Message::name`](link::Message::name)); `"?"` where the bytes do not say.
    pub message: &'static str,
    /// Its length, bytes.
    pub bytes: usize,
    /// Why.
    pub why: DropReason,
}

/// Why a frame was never used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DropReason {
    /// It is broken, or no frame of this link.
    Refused(Refusal),
    /// No start byte stood in front of it.
    NoStart,
    /// The receive buffer was full when it, or a part of it, arrived.
    BufferFull,
    /// It was the message of the last receive call of a cycle.
    TenthMessage,
    /// It lay within the length that a broken frame in front of it claimed.
    Swallowed,
    /// Nobody read it: the app was landing, or threw away what had come on the ground.
    NotRead,
}

impl fmt::Display for DropReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => write!(f, "refused: {}", refusal.name()),
            Self::NoStart => f.write_str("no start byte"),
            Self::BufferFull => f.write_str("the receive buffer was full"),
            Self::TenthMessage => f.write_str("tenth message of a cycle"),
            Self::Swallowed => f.write_str("swallowed by a broken frame"),
            Self::NotRead => f.write_str("not read"),
        }
    }
}
