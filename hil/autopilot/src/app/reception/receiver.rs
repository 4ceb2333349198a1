//! From the bytes that the app reads to messages, with their place in the stream.

use std::collections::VecDeque;

use link::{Counters, Event, Message, Parser, Refusal, Refused};

use super::published_receiver::{PublishedReceiver, Reception, Wait};

/// A byte and its number in all that has arrived, lost bytes included.
pub type NumberedByte = (u64, u8);

/// Part of what has arrived, by the numbers of its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// The first byte.
    pub start: u64,
    /// The byte behind the last.
    pub end: u64,
}

/// What stood in the bytes.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// A message.
    Message(Span, Box<Message>),
    /// Bytes from a start byte on that are none.
    Refused(Span, Refused),
    /// Bytes outside any frame, behind a message: without a start byte nothing is seen of a frame.
    Noise(Span),
}

/// What finds messages.
#[derive(Debug)]
pub enum Receiver {
    /// As the real app does.
    Published(Box<Published>),
    /// Strictly, and searching again where it failed.
    Strict(Box<Strict>),
}

impl Receiver {
    /// Takes bytes until something is found; `None` once all are taken.
    pub fn next(&mut self, bytes: &mut VecDeque<NumberedByte>) -> Option<Found> {
        match self {
            Self::Published(receiver) => receiver.next(bytes),
            Self::Strict(receiver) => receiver.next(bytes),
        }
    }

    /// Number of the first byte taken that may still become part of a message, though it has been
    /// passed over: only a receiver that searches again has one.
    pub fn undecided(&self) -> Option<u64> {
        match self {
            Self::Published(_) => None,
            Self::Strict(receiver) => receiver.held.front().copied(),
        }
    }

    /// What it has seen.
    pub fn counters(&self) -> Counters {
        match self {
            Self::Published(receiver) => receiver.receiver.counters(),
            Self::Strict(receiver) => receiver.parser.counters(),
        }
    }
}

/// Bytes outside any frame. Those right behind bytes that were refused are their rest, and not told
/// of again.
#[derive(Debug, Default)]
struct Noise {
    run: Option<Span>,
    is_rest: bool,
}

impl Noise {
    fn extend(&mut self, number: u64) {
        if !self.is_rest {
            let start = self.run.map_or(number, |run| run.start);
            let end = number + 1;
            self.run = Some(Span { start, end });
        }
    }

    /// A start byte has come: the noise in front of it, if there was any.
    fn end(&mut self) -> Option<Found> {
        self.run.take().map(Found::Noise)
    }

    /// Something has been found: noise begins afresh behind it.
    fn follow(&mut self, found: &Found) {
        self.is_rest = matches!(found, Found::Refused(..));
    }
}

/// The published receiver, with the place of the frame that it is in.
#[derive(Debug, Default)]
pub struct Published {
    receiver: PublishedReceiver,
    /// Number of the start byte.
    start: u64,
    noise: Noise,
}

impl Published {
    fn next(&mut self, bytes: &mut VecDeque<NumberedByte>) -> Option<Found> {
        while let Some((number, byte)) = bytes.pop_front() {
            let between = self.receiver.wait() == Wait::Start;
            let reception = self.receiver.push(byte);
            let end = number + 1;
            let start = self.start;
            if let Some(reception) = reception {
                let found = found(Span { start, end }, reception);
                self.noise.follow(&found);
                return Some(found);
            }
            if !between {
                continue;
            }
            if self.receiver.wait() == Wait::Start {
                self.noise.extend(number);
            } else {
                self.start = number;
                if let Some(noise) = self.noise.end() {
                    return Some(noise);
                }
            }
        }
        None
    }
}

fn found(span: Span, reception: Reception<'_>) -> Found {
    let (why, frame) = match reception {
        Reception::Frame(frame) => match frame.message() {
            Some(message) => return Found::Message(span, Box::new(message)),
            None => (Refusal::UnknownMessage, frame),
        },
        Reception::BadChecksum(frame) => (Refusal::BadChecksum, frame),
    };
    let message_id = Some(frame.id());
    Found::Refused(span, Refused { why, message_id })
}

/// The strict parser, with the place of what it holds.
#[derive(Debug, Default)]
pub struct Strict {
    parser: Parser,
    /// Numbers of the bytes that the parser holds: from a start byte on.
    held: VecDeque<u64>,
    noise: Noise,
}

impl Strict {
    /// As [`Receiver::next`].
    pub fn next(&mut self, bytes: &mut VecDeque<NumberedByte>) -> Option<Found> {
        if let Some(found) = self.settle() {
            return Some(found);
        }
        while let Some((number, byte)) = bytes.pop_front() {
            self.held.push_back(number);
            if let Some(event) = self.parser.next_event(&mut &[byte][..]) {
                return self.found(event);
            }
            if self.parser.held() == 0 {
                self.held.clear();
                self.noise.extend(number);
            } else if let Some(noise) = self.noise.end() {
                return Some(noise);
            }
        }
        None
    }

    /// What the parser makes of what it holds.
    fn settle(&mut self) -> Option<Found> {
        let event = self.parser.next_event(&mut &[][..])?;
        self.found(event)
    }

    /// An event, with its place: it begins with the first byte held.
    fn found(&mut self, event: Event) -> Option<Found> {
        let decided = self.held.len() - self.parser.held();
        let len = match &event {
            Event::Frame(frame) => frame.encode().len(),
            Event::Refused(_) => decided,
        };
        let start = *self.held.front()?;
        let end = *self.held.get(len.checked_sub(1)?)? + 1;
        self.held.drain(..decided);
        let span = Span { start, end };
        let found = match event {
            Event::Frame(frame) => Found::Message(span, Box::new(frame.message)),
            Event::Refused(refused) => Found::Refused(span, refused),
        };
        self.noise.follow(&found);
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use link::{Command, Message, Refusal};

    use super::{Found, Receiver, Span};

    /// What is found in a stream: the spans of messages, and of the rest with the reason.
    fn found(mut receiver: Receiver, stream: &[u8]) -> Vec<(Span, &'static str)> {
        let mut bytes: VecDeque<_> = (0..).zip(stream.iter().copied()).collect();
        let next = || receiver.next(&mut bytes);
        std::iter::from_fn(next)
            .map(|found| match found {
                Found::Message(span, message) => (span, message.name()),
                Found::Refused(span, refused) => (span, refused.why.name()),
                Found::Noise(span) => (span, "noise"),
            })
            .collect()
    }

    fn span(start: u64, end: u64) -> Span {
        Span { start, end }
    }

    fn receivers() -> [Receiver; 2] {
        [
            Receiver::Published(Box::default()),
            Receiver::Strict(Box::default()),
        ]
    }

    fn follow() -> Vec<u8> {
        let command = 0x12;
        let args = link::Command::default().args;
        Message::Command(Command { command, args })
            .encode()
            .to_vec()
    }

    #[test]
    fn messages_and_what_lies_between_them_have_their_places() {
        let mut broken = follow();
        broken[6] ^= 1;
        let mut headless = follow();
        headless[0] = 0;
        let stream = [follow(), headless, follow(), broken, vec![7, 7], follow()].concat();
        let expected = [
            (span(0, 10), "COMMAND"),
            (span(10, 20), "noise"),
            (span(20, 30), "COMMAND"),
            // The first sum is found wrong, or all of it; its rest is not told of again.
            (span(30, 39), Refusal::BadChecksum.name()),
            (span(42, 52), "COMMAND"),
        ];
        let [published, strict] = receivers();
        assert_eq!(found(published, &stream), expected);
        let strict = found(strict, &stream);
        assert_eq!(strict[..3], expected[..3]);
        assert_eq!(strict[3], (span(30, 40), Refusal::BadChecksum.name()));
        assert_eq!(strict[4..], expected[4..]);
    }

    #[test]
    fn behind_a_false_start_the_published_receiver_loses_what_the_strict_one_finds() {
        // Claims 12 bytes: itself, its length and the next ten.
        let stream = [vec![0x99, 12], follow(), follow()].concat();
        let [published, strict] = receivers();
        let last = (span(12, 22), "COMMAND");
        assert_eq!(
            found(published, &stream),
            [(span(0, 11), Refusal::BadChecksum.name()), last]
        );
        let strict = found(strict, &stream);
        assert_eq!(strict[1..], [(span(2, 12), "COMMAND"), last]);
    }
}
