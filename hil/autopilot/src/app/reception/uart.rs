//! The receiving side of the deck's UART: a small buffer and the receiver behind it.

use std::collections::VecDeque;

use link::{Counters, Message};

use super::dropped::{DropReason, Dropped};
use super::ledger::Ledger;
use super::receiver::{Found, NumberedByte, Receiver, Span};
use crate::app::quirks::Quirks;

/// Bytes that UART2's stream buffer holds.
const BUFFER_BYTES: usize = 200;

/// A message and where in the stream it stood.
#[derive(Debug, Clone, PartialEq)]
pub struct Heard {
    /// What it says.
    pub message: Message,
    /// Where it stood.
    pub span: Span,
}

/// The buffer and its receiver.
#[derive(Debug)]
pub struct Uart {
    /// Bytes that the buffer holds; `None`: as many as come.
    capacity: Option<usize>,
    buffer: VecDeque<NumberedByte>,
    receiver: Receiver,
    ledger: Ledger,
    arrived: u64,
    overflowed_bytes: u64,
}

impl Uart {
    /// An empty buffer.
    pub fn new(quirks: &Quirks) -> Self {
        Self {
            capacity: quirks.short_buffer.then_some(BUFFER_BYTES),
            buffer: VecDeque::with_capacity(BUFFER_BYTES),
            receiver: if quirks.published_receiver {
                Receiver::Published(Box::default())
            } else {
                Receiver::Strict(Box::default())
            },
            ledger: Ledger::default(),
            arrived: 0,
            overflowed_bytes: 0,
        }
    }

    /// Bytes arrive. What does not fit is lost: the newest.
    pub fn arrive(&mut self, now_ms: u64, bytes: &[u8]) {
        for byte in bytes {
            let byte = (self.arrived, *byte);
            let has_room = self.capacity.is_none_or(|room| self.buffer.len() < room);
            if has_room {
                self.buffer.push_back(byte);
            } else {
                self.overflowed_bytes += 1;
            }
            self.arrived += 1;
            self.ledger.arrive(now_ms, byte, has_room);
        }
    }

    /// Reads until a message is complete or the buffer is empty.
    pub fn read(&mut self, now_ms: u64) -> Option<Heard> {
        loop {
            let found = self.receiver.next(&mut self.buffer);
            let heard = match found {
                Some(Found::Refused(span, refused)) => {
                    self.ledger.refused(now_ms, span, refused);
                    continue;
                }
                Some(Found::Noise(span)) => {
                    self.ledger.noise(now_ms, span);
                    continue;
                }
                Some(Found::Message(span, message)) => {
                    self.ledger.found(now_ms, span);
                    let message = *message;
                    Some(Heard { message, span })
                }
                None => None,
            };
            let next = self.buffer.front().map_or(self.arrived, |next| next.0);
            let done = self.receiver.undecided().unwrap_or(next);
            self.ledger.read_to(now_ms, done);
            return heard;
        }
    }

    /// A message that was read is not going to be used.
    pub fn discard(&mut self, now_ms: u64, heard: &Heard, why: DropReason) {
        self.ledger
            .discarded(now_ms, heard.message.name(), heard.span, why);
    }

    /// Throws away what has not been read.
    pub fn clear(&mut self, now_ms: u64) {
        self.buffer.clear();
        self.ledger.abandon(now_ms);
    }

    /// Nobody is going to read what is here.
    pub fn abandon(&mut self, now_ms: u64) {
        self.ledger.abandon(now_ms);
    }

    /// What has been lost since the last call.
    pub fn take_dropped(&mut self) -> Vec<Dropped> {
        self.ledger.take()
    }

    /// Bytes lost for want of room.
    pub fn overflowed_bytes(&self) -> u64 {
        self.overflowed_bytes
    }

    /// What the receiver has seen.
    pub fn counters(&self) -> Counters {
        self.receiver.counters()
    }
}
