//! What the board answers.

use heapless::Vec;

use crate::identity::Identity;
use crate::record::{Damage, HEAD_BYTES, Message, digest, seal};
use crate::stuffing::{Unstuffed, Unstuffer};
use crate::verdict::{Counts, Source, Verdict};

const IDENTITY: u8 = 0x81;
const SOURCE: u8 = 0x82;
const VERDICT: u8 = 0x83;
const COUNTS: u8 = 0x84;

/// Longest answer behind the check sum and the kind.
const MAX_BODY_BYTES: usize = Identity::BYTES;

/// What the board says to the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reply {
    /// What it is.
    Identity(Identity),
    /// Where it takes frames from, from now on.
    Source(Source),
    /// What became of a frame.
    Verdict {
        /// The frame's number.
        number: u32,
        /// What became of it.
        verdict: Verdict,
        /// The shutter that the firmware wants now, lines.
        shutter_lines: u16,
        /// The gain that it wants now, 1 = 0 dB.
        gain: f32,
    },
    /// What has arrived so far.
    Counts(Counts),
}

impl Reply {
    /// The bytes for the wire.
    pub fn encode(&self) -> Message {
        match self {
            Self::Identity(identity) => seal(IDENTITY, [&identity.encode(), &[]]),
            Self::Source(source) => seal(SOURCE, [&[*source as u8], &[]]),
            Self::Verdict {
                number,
                verdict,
                shutter_lines,
                gain,
            } => {
                let [a, b, c, d] = number.to_le_bytes();
                let [e, f] = shutter_lines.to_le_bytes();
                let head = [a, b, c, d, *verdict as u8, e, f];
                seal(VERDICT, [&head, &gain.to_le_bytes()])
            }
            Self::Counts(counts) => {
                let body = counts.to_array().map(u32::to_le_bytes);
                seal(COUNTS, [body.as_flattened(), &[]])
            }
        }
    }

    fn decode(kind: u8, body: &[u8]) -> Option<Self> {
        Some(match kind {
            IDENTITY => Self::Identity(Identity::decode(body.try_into().ok()?)?),
            SOURCE => match body {
                [source] => Self::Source(Source::of(*source)?),
                _ => return None,
            },
            VERDICT => Self::verdict(body.try_into().ok()?)?,
            COUNTS => {
                let (words, []) = body.as_chunks() else {
                    return None;
                };
                let words: &[[u8; 4]; 6] = words.try_into().ok()?;
                Self::Counts(Counts::of(words.map(u32::from_le_bytes)))
            }
            _ => return None,
        })
    }

    fn verdict([a, b, c, d, verdict, e, f, g, h, i, j]: [u8; 11]) -> Option<Self> {
        Some(Self::Verdict {
            number: u32::from_le_bytes([a, b, c, d]),
            verdict: Verdict::of(verdict)?,
            shutter_lines: u16::from_le_bytes([e, f]),
            gain: f32::from_le_bytes([g, h, i, j]),
        })
    }
}

/// The host's receiving end: bytes to answers.
#[derive(Clone, Debug)]
pub struct Replies {
    unstuffer: Unstuffer,
    record: Vec<u8, { HEAD_BYTES + MAX_BODY_BYTES }>,
    /// More bytes came than any answer has.
    too_long: bool,
}

impl Default for Replies {
    fn default() -> Self {
        Self::new()
    }
}

impl Replies {
    /// A reader that has seen nothing.
    pub const fn new() -> Self {
        Self {
            unstuffer: Unstuffer::new(),
            record: Vec::new(),
            too_long: false,
        }
    }

    /// Takes received bytes until they complete an answer, or prove that a record is none. `bytes` is
    /// moved past what was taken: call again until `None`.
    pub fn next_reply(&mut self, bytes: &mut &[u8]) -> Option<Result<Reply, Damage>> {
        while let [byte, rest @ ..] = *bytes {
            *bytes = rest;
            match self.unstuffer.push(*byte) {
                Unstuffed::Nothing => {}
                Unstuffed::Byte(byte) => self.too_long |= self.record.push(byte).is_err(),
                Unstuffed::End { whole } => {
                    let reply = self.finish(whole);
                    self.record.clear();
                    self.too_long = false;
                    if reply.is_some() {
                        return reply;
                    }
                }
            }
        }
        None
    }

    /// The record, unless it is empty: two delimiters in a row.
    fn finish(&self, whole: bool) -> Option<Result<Reply, Damage>> {
        if self.record.is_empty() && whole {
            return None;
        }
        let ([a, b, c, d, kind], body) = match self.record.split_first_chunk() {
            Some(parts) if whole && !self.too_long => parts,
            _ => return Some(Err(Damage::Broken)),
        };
        let mut sum = digest();
        sum.update(&[*kind]);
        sum.update(body);
        if sum.finalize() != u32::from_le_bytes([*a, *b, *c, *d]) {
            return Some(Err(Damage::Sum));
        }
        Some(Reply::decode(*kind, body).ok_or(Damage::Unknown))
    }
}
