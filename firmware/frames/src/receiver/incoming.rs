//! The record that is coming: its check sum, and its first bytes.

use heapless::Vec;

use crate::pieces::HEADER_BYTES;
use crate::record::{Damage, Digest, HEAD_BYTES, digest};
use crate::request::Request;

/// The check sum alone.
const SUM_BYTES: usize = 4;

/// What must be kept of a record: all of a request, of a piece what comes before its payload.
const KEPT_BYTES: usize = HEAD_BYTES + HEADER_BYTES;

const _: () = assert!(Request::MAX_BODY_BYTES <= HEADER_BYTES);

/// A whole and right record.
pub(super) struct Record<'r> {
    pub(super) kind: u8,
    /// None where it was longer than what is kept.
    pub(super) body: Option<&'r [u8]>,
}

/// The record that is coming.
pub(super) struct Incoming {
    kept: Vec<u8, KEPT_BYTES>,
    /// More came than is kept.
    longer: bool,
    sum: Digest,
}

impl core::fmt::Debug for Incoming {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Incoming")
            .field("kept", &self.kept)
            .field("longer", &self.longer)
            .finish_non_exhaustive()
    }
}

impl Incoming {
    /// Before the first byte.
    pub(super) const fn new() -> Self {
        Self {
            kept: Vec::new(),
            longer: false,
            sum: digest(),
        }
    }

    /// Takes a byte and keeps it if it is one of the first.
    pub(super) fn push(&mut self, byte: u8) {
        if self.kept.len() >= SUM_BYTES {
            self.sum.update(&[byte]);
        }
        self.longer |= self.kept.push(byte).is_err();
    }

    /// Takes a byte that is kept elsewhere.
    pub(super) fn sum(&mut self, byte: u8) {
        self.sum.update(&[byte]);
    }

    /// Kind and header of a piece, when just these are there.
    pub(super) fn piece_header(&self) -> Option<(u8, [u8; HEADER_BYTES])> {
        if self.longer {
            return None;
        }
        Some((*self.kept.get(SUM_BYTES)?, self.header()?))
    }

    /// The bytes that are a piece's header if this is a piece.
    pub(super) fn header(&self) -> Option<[u8; HEADER_BYTES]> {
        self.kept.get(HEAD_BYTES..)?.first_chunk().copied()
    }

    /// The record; none where there is none between two delimiters.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn finish(&self, whole: bool) -> Result<Option<Record<'_>>, Damage> {
        if self.kept.is_empty() && whole {
            return Ok(None);
        }
        let (&[a, b, c, d, kind], body) = match self.kept.split_first_chunk() {
            Some(parts) if whole => parts,
            _ => return Err(Damage::Broken),
        };
        if self.sum.clone().finalize() != u32::from_le_bytes([a, b, c, d]) {
            return Err(Damage::Sum);
        }
        Ok(Some(Record {
            kind,
            body: (!self.longer).then_some(body),
        }))
    }
}
