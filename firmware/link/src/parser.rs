//! From received bytes to frames, whatever else is on the wire.

use heapless::Vec;

use crate::frame::{Frame, MAX_FRAME_LEN, Refusal, START, judge};

/// How often each thing happened since the parser was made. Saturating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counters {
    /// Frames delivered.
    pub frames_ok: u32,
    /// Bytes that belonged to no delivered frame.
    pub bytes_skipped: u32,
    /// Start bytes refused for [`Refusal::BadLength`].
    pub bad_length: u32,
    /// Start bytes refused for [`Refusal::WrongClass`].
    pub wrong_class: u32,
    /// Start bytes refused for [`Refusal::UnknownMessage`].
    pub unknown_message: u32,
    /// Start bytes refused for [`Refusal::WrongSize`].
    pub wrong_size: u32,
    /// Start bytes refused for [`Refusal::BadChecksum`].
    pub bad_checksum: u32,
    /// Frames that the sender began and did not end ([`Parser::give_up`]).
    pub cut_short: u32,
}

impl Counters {
    fn refuse(&mut self, refusal: Refusal) {
        let counter = match refusal {
            Refusal::BadLength => &mut self.bad_length,
            Refusal::WrongClass => &mut self.wrong_class,
            Refusal::UnknownMessage => &mut self.unknown_message,
            Refusal::WrongSize => &mut self.wrong_size,
            Refusal::BadChecksum => &mut self.bad_checksum,
        };
        *counter = counter.saturating_add(1);
    }

    fn skip(&mut self, bytes: usize) {
        let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
        self.bytes_skipped = self.bytes_skipped.saturating_add(bytes);
    }
}

/// The receiving end of the link.
///
/// Strict: a frame is delivered only if class, length, array length and checksum all agree.
/// Resynchronising: where they do not, the search goes on at the byte after the refused start byte,
/// so no good frame is lost behind, or inside, a broken one. (The generated C receiver of pprzlink
/// continues after the bytes that the broken frame claimed.)
///
/// Every byte is in the end either part of a delivered frame or counted as skipped. The work per
/// received byte is bounded: each start byte is refused once and summed over at most once.
#[derive(Debug, Default)]
pub struct Parser {
    /// Empty, or a start byte and what came after it while it can still become a frame.
    held: Vec<u8, MAX_FRAME_LEN>,
    counters: Counters,
}

impl Parser {
    /// A parser that has seen nothing.
    pub const fn new() -> Self {
        Self {
            held: Vec::new(),
            counters: Counters {
                frames_ok: 0,
                bytes_skipped: 0,
                bad_length: 0,
                wrong_class: 0,
                unknown_message: 0,
                wrong_size: 0,
                bad_checksum: 0,
                cut_short: 0,
            },
        }
    }

    /// Takes received bytes until they complete a frame.
    ///
    /// `bytes` is moved past what was taken: call again until `None`, then all of it has been taken.
    pub fn next_frame(&mut self, bytes: &mut &[u8]) -> Option<Frame> {
        loop {
            if let Some(frame) = self.settle() {
                return Some(frame);
            }
            let (byte, rest) = bytes.split_first()?;
            *bytes = rest;
            if self.held.is_empty() && *byte != START {
                self.counters.skip(1);
            } else if self.held.push(*byte).is_err() {
                debug_assert!(false, "255 held bytes are a frame or are refused");
                self.drop_start();
            }
        }
    }

    /// All frames that `bytes` complete. Drop the iterator early and the bytes left are lost; where
    /// that matters, use [`Self::next_frame`].
    pub fn frames<'a>(&'a mut self, mut bytes: &'a [u8]) -> impl Iterator<Item = Frame> + 'a {
        core::iter::from_fn(move || self.next_frame(&mut bytes))
    }

    /// Says that the sender has stopped in the middle of a frame, if it has begun one: for a wire
    /// that has been silent for longer than a frame may pause.
    ///
    /// The next call of [`Self::next_frame`] looks for good frames behind the unfinished one.
    pub fn give_up(&mut self) {
        if !self.held.is_empty() {
            self.counters.cut_short = self.counters.cut_short.saturating_add(1);
            self.drop_start();
        }
    }

    /// How many bytes of a frame that is not complete yet are held.
    pub fn held(&self) -> usize {
        self.held.len()
    }

    /// What has been received so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Looks for a frame in what is held, until there is one or more bytes are needed.
    fn settle(&mut self) -> Option<Frame> {
        while !self.held.is_empty() {
            match judge(&self.held) {
                Ok(None) => break,
                Ok(Some((frame, len))) => {
                    self.counters.frames_ok = self.counters.frames_ok.saturating_add(1);
                    self.drop_front(len);
                    self.seek();
                    return Some(frame);
                }
                Err(refusal) => {
                    self.counters.refuse(refusal);
                    self.drop_start();
                }
            }
        }
        None
    }

    /// Skips the held start byte and what follows it up to the next one.
    fn drop_start(&mut self) {
        self.drop_front(1);
        self.counters.skip(1);
        self.seek();
    }

    /// Skips held bytes up to the first start byte.
    fn seek(&mut self) {
        let start = self.held.iter().position(|byte| *byte == START);
        let unframed = start.unwrap_or(self.held.len());
        self.drop_front(unframed);
        self.counters.skip(unframed);
    }

    fn drop_front(&mut self, len: usize) {
        let rest = self.held.get(len..).unwrap_or_default();
        self.held = Vec::from_slice(rest).unwrap_or_default();
    }
}
