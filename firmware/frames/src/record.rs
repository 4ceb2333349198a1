//! Records: a kind and a body under a check sum.

use crc::{CRC_32_ISO_HDLC, Crc, Table};
use heapless::Vec;

use crate::identity::Identity;
use crate::stuffing::{stuff, stuffed_len};

/// The most bytes of a frame's piece behind its header: one record in 24 is lost to headers and
/// stuffing, and a broken record costs 3 ms of the wire.
pub(crate) const PIECE_PAYLOAD_BYTES: usize = 1024;

/// Check sum and kind.
pub(crate) const HEAD_BYTES: usize = 5;

/// The most bytes of a record on the wire, delimiters included.
pub const MAX_RECORD_BYTES: usize =
    stuffed_len(HEAD_BYTES + crate::pieces::HEADER_BYTES + PIECE_PAYLOAD_BYTES);

/// The most bytes of a question or an answer on the wire, delimiters included.
pub const MAX_MESSAGE_BYTES: usize = stuffed_len(HEAD_BYTES + Identity::BYTES);

/// The piece of a frame as it goes on the wire.
pub type Encoded = Vec<u8, MAX_RECORD_BYTES>;

/// A question or an answer as it goes on the wire.
pub type Message = Vec<u8, MAX_MESSAGE_BYTES>;

/// The check sum of all records. It finds every burst of up to 32 bits and misses one in 4 billion of
/// other damages.
static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// Why a record is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damage {
    /// Cut, or its stuffing is wrong.
    Broken,
    /// The check sum does not match.
    Sum,
    /// It is whole, but of no kind that is known here, or of a wrong length.
    Unknown,
}

/// A check sum that grows.
pub(crate) type Digest = crc::Digest<'static, u32, Table<1>>;

/// A check sum of nothing yet.
pub(crate) const fn digest() -> Digest {
    CRC.digest()
}

/// The record of `kind` whose body is these parts.
pub(crate) fn seal<const N: usize>(kind: u8, parts: [&[u8]; 2]) -> Vec<u8, N> {
    let mut sum = digest();
    sum.update(&[kind]);
    for part in parts {
        sum.update(part);
    }
    let [first, second] = parts;
    let sum = sum.finalize().to_le_bytes();
    let mut encoded = Vec::new();
    stuff(&[&sum, &[kind], first, second], &mut encoded);
    encoded
}
