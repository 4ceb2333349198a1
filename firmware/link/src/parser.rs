//! From received bytes to frames, whatever else is on the wire.

use crate::counters::Counters;
use crate::frame::{Claim, Frame, Judged, MIN_FRAME_LEN, START, judge};
use crate::held::Held;
use crate::refusal::{Refusal, Refused};

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
/// Every byte is in the end either part of a delivered frame or counted as skipped. The parser
/// does not allocate, nor panic, and its work is bounded: each start byte is refused once, its claim
/// summed over once.
///
/// Frames are read where the caller has them; only of one that the end of the caller's bytes cuts,
/// the beginning is held. So give it bytes in pieces as large as they come.
///
/// A frame is 264 bytes to move. What makes one is not inlined, so that it is made where the caller
/// wants it, and so that the loops around it fit into the instruction cache (1 KB on an STM32F4).
#[derive(Debug)]
pub struct Parser {
    /// Empty, or a start byte and what came after it while it can still become a frame.
    held: Held,
    /// With how many bytes held more can be said.
    wanted: u8,
    /// Whether no more bytes will come to what is held.
    ended: bool,
    counters: Counters,
}

impl Default for Parser {
    fn default() -> Self {
        Self::new()
    }
}

impl Parser {
    /// A parser that has seen nothing.
    pub const fn new() -> Self {
        Self {
            held: Held::new(),
            wanted: 0,
            ended: false,
            counters: Counters::NONE,
        }
    }

    /// Takes received bytes until they complete a frame or prove that none begins at a start byte.
    ///
    /// `bytes` is moved past what was taken: call again until `None`, then all of it has been taken.
    #[inline(never)]
    pub fn next_event(&mut self, bytes: &mut &[u8]) -> Option<Event> {
        if self.held.is_empty() {
            self.next_in_place(bytes)
        } else {
            self.next_held(bytes)
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
        usize::from(self.held.len())
    }

    /// What has been received so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Looks for an event in bytes before which nothing is held.
    #[inline(never)]
    fn next_in_place(&mut self, bytes: &mut &[u8]) -> Option<Event> {
        let start = bytes.iter().position(|byte| *byte == START);
        let (unframed, framed) = bytes.split_at(start.unwrap_or(bytes.len()));
        self.counters.skip(unframed.len());
        *bytes = framed;
        if framed.is_empty() {
            return None;
        }
        match judge(framed) {
            Ok(Judged::Whole(claim)) => {
                *bytes = framed.get(usize::from(claim.len())..).unwrap_or_default();
                Some(Event::Frame(self.deliver(claim, framed)))
            }
            Ok(Judged::Part(wanted)) => {
                self.wanted = wanted;
                self.held.fill(wanted, bytes);
                None
            }
            Err(why) => {
                *bytes = framed.get(1..).unwrap_or_default();
                self.counters.refuse(why);
                Some(Event::Refused(Refused::new(why, framed)))
            }
        }
    }

    /// Looks for an event in what is held and as many bytes behind it as that takes.
    fn next_held(&mut self, bytes: &mut &[u8]) -> Option<Event> {
        loop {
            if !self.ended {
                self.held.fill(self.wanted, bytes);
                if self.held.len() < self.wanted {
                    return None;
                }
            }
            match judge(self.held.bytes()) {
                Ok(Judged::Whole(claim)) => return Some(Event::Frame(self.deliver_held(claim))),
                Ok(Judged::Part(wanted)) if !self.ended => self.wanted = wanted,
                Ok(Judged::Part(_)) => {
                    return Some(Event::Refused(self.refuse_held(Refusal::CutShort)));
                }
                Err(why) => return Some(Event::Refused(self.refuse_held(why))),
            }
        }
    }

    /// A frame that `bytes` begin with.
    #[inline(never)]
    fn deliver(&mut self, claim: Claim, bytes: &[u8]) -> Frame {
        self.counters.deliver();
        claim.frame(bytes)
    }

    /// The frame that is held.
    #[inline(never)]
    fn deliver_held(&mut self, claim: Claim) -> Frame {
        let frame = claim.frame(self.held.bytes());
        self.counters.deliver();
        self.drop_held(claim.len());
        frame
    }

    /// Refuses the start byte that is held.
    #[inline(never)]
    fn refuse_held(&mut self, why: Refusal) -> Refused {
        let refused = Refused::new(why, self.held.bytes());
        self.counters.refuse(why);
        self.drop_held(1);
        refused
    }

    /// Drops bytes from the front of what is held, and skips the following up to a start byte.
    fn drop_held(&mut self, len: u8) {
        self.held.drop_front(len);
        let mut held = self.held.bytes().iter();
        let start = held.position(|byte| *byte == START);
        let unframed = start.unwrap_or(self.held.bytes().len());
        self.counters.skip(unframed);
        self.held.drop_front(unframed as u8);
        self.wanted = MIN_FRAME_LEN as u8;
        self.ended &= !self.held.is_empty();
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
        assert_eq!(refused(1, 7), ("VECTOR", "length"));
        assert_eq!(refused(4, 4), ("VECTOR", "class"));
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
