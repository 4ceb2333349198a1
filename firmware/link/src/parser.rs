//! From received bytes to frames, whatever else is on the wire.

use heapless::Vec;

use crate::frame::{Frame, ID_AT, MAX_FRAME_LEN, START, judge};
use crate::refusal::{Refusal, Refused};

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
    /// Start bytes refused for [`Refusal::CutShort`].
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
            Refusal::CutShort => &mut self.cut_short,
        };
        *counter = counter.saturating_add(1);
    }

    fn skip(&mut self, bytes: usize) {
        let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
        self.bytes_skipped = self.bytes_skipped.saturating_add(bytes);
    }
}

/// What the parser found: every start byte that is not inside a frame makes one of the two.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put frames on, and nobody stores events"
)]
pub enum Event {
    /// A frame that is whole and right.
    Frame(Frame),
    /// A start byte that none follows.
    Refused(Refused),
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
    /// Whether no more bytes will come to what is held.
    ended: bool,
    counters: Counters,
}

impl Parser {
    /// A parser that has seen nothing.
    pub const fn new() -> Self {
        Self {
            held: Vec::new(),
            ended: false,
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

    /// Takes received bytes until they complete a frame or prove that none begins at a start byte.
    ///
    /// `bytes` is moved past what was taken: call again until `None`, then all of it has been taken.
    pub fn next_event(&mut self, bytes: &mut &[u8]) -> Option<Event> {
        loop {
            if let Some(event) = self.settle() {
                return Some(event);
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

    /// Takes received bytes until they complete a frame: [`Self::next_event`] for whom what was
    /// dropped does not matter.
    pub fn next_frame(&mut self, bytes: &mut &[u8]) -> Option<Frame> {
        loop {
            if let Event::Frame(frame) = self.next_event(bytes)? {
                return Some(frame);
            }
        }
    }

    /// All frames that `bytes` complete. Drop the iterator early and the bytes left are lost; where
    /// that matters, use [`Self::next_frame`].
    pub fn frames<'a>(&'a mut self, mut bytes: &'a [u8]) -> impl Iterator<Item = Frame> + 'a {
        core::iter::from_fn(move || self.next_frame(&mut bytes))
    }

    /// Says that the sender has stopped, and that what is held will not be completed: for a wire
    /// that has been silent for longer than a frame may pause.
    ///
    /// The next calls of [`Self::next_event`], which need no new bytes for that, refuse the frame
    /// that was begun and deliver good ones behind its start byte, until nothing is held.
    pub fn give_up(&mut self) {
        self.ended = !self.held.is_empty();
    }

    /// How many bytes of a frame that is not complete yet are held.
    pub fn held(&self) -> usize {
        self.held.len()
    }

    /// What has been received so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Decides about the held start byte; `None` if there is none or more bytes are needed.
    fn settle(&mut self) -> Option<Event> {
        if self.held.is_empty() {
            self.ended = false;
            return None;
        }
        let why = match judge(&self.held) {
            Ok(Some((frame, len))) => {
                self.counters.frames_ok = self.counters.frames_ok.saturating_add(1);
                self.drop_front(len);
                self.seek();
                return Some(Event::Frame(frame));
            }
            Ok(None) if self.ended => Refusal::CutShort,
            Ok(None) => return None,
            Err(refusal) => refusal,
        };
        let message_id = match why {
            // Refused, in most cases, before the id is there: then in all, so that what is reported
            // does not depend on how the stream was cut.
            Refusal::BadLength | Refusal::WrongClass => None,
            _ => self.held.get(ID_AT).copied(),
        };
        self.counters.refuse(why);
        self.drop_start();
        Some(Event::Refused(Refused { why, message_id }))
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

#[cfg(test)]
mod tests {
    use super::{Counters, Event, Parser};
    use crate::Mode;
    use crate::frame::Encoded;
    use crate::message::{Command, Message, State, Vector};
    use crate::refusal::{Refusal, Refused};

    fn follow() -> Encoded {
        let command = Mode::Follow.byte();
        Message::Command(Command {
            command,
            ..Command::default()
        })
        .encode()
    }

    /// Counters after `bytes`, in front of a good command of 10 bytes.
    fn counted(bytes: &[u8]) -> Counters {
        let mut parser = Parser::new();
        assert_eq!(parser.frames(bytes).count(), 0);
        assert_eq!(parser.frames(&follow()).count(), 1, "the command is found");
        parser.counters()
    }

    /// A vector whose byte at `offset` has become `value`.
    fn vector_with(offset: usize, value: u8) -> Encoded {
        let mut bytes = Message::Vector(Vector::default()).encode();
        bytes[offset] = value;
        bytes
    }

    #[test]
    fn each_reason_to_refuse_a_frame_has_its_counter() {
        let one_of_29 = Counters {
            frames_ok: 1,
            bytes_skipped: 29,
            ..Counters::default()
        };
        let expected = |reason: fn(&mut Counters)| {
            let mut counters = one_of_29;
            reason(&mut counters);
            counters
        };
        let bad_length = expected(|c| c.bad_length = 1);
        let wrong_class = expected(|c| c.wrong_class = 1);
        let unknown_message = expected(|c| c.unknown_message = 1);
        let wrong_size = expected(|c| c.wrong_size = 1);
        let bad_checksum = expected(|c| c.bad_checksum = 1);
        assert_eq!(counted(&vector_with(1, 7)), bad_length);
        assert_eq!(counted(&vector_with(4, 4)), wrong_class);
        assert_eq!(counted(&vector_with(5, 16)), unknown_message);
        assert_eq!(counted(&vector_with(1, 30)), wrong_size);
        assert_eq!(counted(&vector_with(20, 1)), bad_checksum);
    }

    #[test]
    fn every_refusal_says_what_was_wrong_and_with_which_message() {
        let refused = |offset, value| {
            let bytes = vector_with(offset, value);
            let mut parser = Parser::new();
            match parser.next_event(&mut &bytes[..]) {
                Some(Event::Refused(refused)) => (refused.message_name(), refused.why.name()),
                event => panic!("{event:?}"),
            }
        };
        assert_eq!(refused(1, 7), ("?", "length"));
        assert_eq!(refused(4, 4), ("?", "class"));
        assert_eq!(refused(5, 16), ("?", "unknown message"));
        assert_eq!(refused(1, 30), ("VECTOR", "size"));
        assert_eq!(refused(20, 1), ("VECTOR", "checksum"));
        assert_eq!(
            refused(5, 10),
            ("STATE", "size"),
            "the id is the broken byte"
        );
    }

    #[test]
    fn a_start_byte_that_claims_255_bytes_does_not_hold_up_a_command() {
        // Header of no message of this link: it is refused with its fifth byte.
        let mut parser = Parser::new();
        assert_eq!(parser.frames(&[0x99, 0xff]).count(), 0);
        assert_eq!(parser.frames(&follow()).count(), 1);
    }

    #[test]
    fn a_command_behind_a_cut_state_comes_out_when_the_wire_falls_silent() {
        let state = Message::State(State::default()).encode();
        let mut parser = Parser::new();
        assert_eq!(parser.frames(&state[..12]).count(), 0);
        assert_eq!(parser.frames(&follow()).count(), 0, "it may be the state");
        parser.give_up();
        let cut = Refused {
            why: Refusal::CutShort,
            message_id: Some(10),
        };
        assert_eq!(parser.next_event(&mut &[][..]), Some(Event::Refused(cut)));
        assert_eq!(cut.message_name(), "STATE");
        assert_eq!(parser.frames(&[]).count(), 1);
        assert_eq!(parser.counters().cut_short, 1);
        assert_eq!(parser.counters().bytes_skipped, 12);
    }

    #[test]
    fn what_is_not_asked_for_stays_with_the_caller() {
        let mut two = follow();
        two.extend(follow());
        let mut parser = Parser::new();
        let mut bytes = &two[..];
        assert!(parser.next_frame(&mut bytes).is_some());
        assert_eq!(bytes, &follow()[..]);
    }
}
