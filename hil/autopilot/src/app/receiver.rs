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
}

/// What finds messages.
#[derive(Debug)]
pub enum Receiver {
    /// As the real app does.
    Published(Published),
    /// Strictly, and searching again where it failed.
    Strict(Strict),
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

/// The published receiver, with the place of the frame that it is in.
#[derive(Debug, Default)]
pub struct Published {
    receiver: PublishedReceiver,
    /// Number of the start byte; `None` between frames.
    start: Option<u64>,
}

impl Published {
    fn next(&mut self, bytes: &mut VecDeque<NumberedByte>) -> Option<Found> {
        while let Some((number, byte)) = bytes.pop_front() {
            let start = *self.start.get_or_insert(number);
            let found = self.receiver.push(byte).map(|reception| {
                let end = number + 1;
                found(Span { start, end }, reception)
            });
            if self.receiver.wait() == Wait::Start {
                self.start = None;
            }
            if found.is_some() {
                return found;
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
    /// The bytes that the parser holds: from a start byte on.
    held: VecDeque<u64>,
}

impl Strict {
    /// As [`Receiver::next`].
    pub fn next(&mut self, bytes: &mut VecDeque<NumberedByte>) -> Option<Found> {
        if let Some(found) = self.settle(&[]) {
            return Some(found);
        }
        while let Some((number, byte)) = bytes.pop_front() {
            self.held.push_back(number);
            if let Some(found) = self.settle(&[byte]) {
                return Some(found);
            }
        }
        None
    }

    /// What the parser makes of the next byte, or, without one, of what it holds.
    fn settle(&mut self, mut byte: &[u8]) -> Option<Found> {
        let event = self.parser.next_event(&mut byte);
        let len = match &event {
            Some(Event::Frame(frame)) => frame.encode().len(),
            _ => self.held.len() - self.parser.held(),
        };
        let span = self.held.front().map(|start| Span {
            start: *start,
            end: self
                .held
                .get(len.saturating_sub(1))
                .map_or(*start, |last| last + 1),
        });
        self.held.drain(..self.held.len() - self.parser.held());
        match (event?, span?) {
            (Event::Frame(frame), span) => Some(Found::Message(span, Box::new(frame.message))),
            (Event::Refused(refused), span) => Some(Found::Refused(span, refused)),
        }
    }
}
