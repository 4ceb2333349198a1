//! Messages on the link's wires, with the cycles at which they begin and end there.

use std::collections::VecDeque;

use emulator::core::Cycle;
use emulator::trace::{Event, SerialWire, What};
use link::{Message, Parser};

/// The longest frame of the link.
const LONGEST_BYTES: usize = 255;

/// A message on a wire.
#[derive(Clone, Debug)]
pub struct Heard {
    /// Which wire, as the chip sees it.
    pub wire: SerialWire,
    /// What it says.
    pub message: Message,
    /// The start bit of its first byte.
    pub began: Cycle,
    /// The stop bit of its last.
    pub ended: Cycle,
}

/// Both wires of one USART.
#[derive(Debug)]
pub struct Wires {
    usart: u8,
    received: Direction,
    sent: Direction,
}

#[derive(Debug)]
struct Direction {
    parser: Parser,
    /// When the latest bytes began.
    starts: VecDeque<Cycle>,
}

impl Wires {
    /// The wires of USART `usart`, 1 to 6.
    pub fn new(usart: u8) -> Self {
        let direction = || Direction {
            parser: Parser::new(),
            starts: VecDeque::new(),
        };
        Self {
            usart,
            received: direction(),
            sent: direction(),
        }
    }

    /// The message that is whole with this event.
    pub fn hear(&mut self, event: &Event) -> Option<Heard> {
        let What::Byte {
            usart,
            wire,
            byte,
            ends,
        } = event.what
        else {
            return None;
        };
        if usart != self.usart {
            return None;
        }
        let direction = match wire {
            SerialWire::Receive => &mut self.received,
            SerialWire::Transmit => &mut self.sent,
        };
        let message = direction.hear(event.at, byte)?;
        let bytes = message.encode().len();
        let first = direction.starts.len().saturating_sub(bytes);
        Some(Heard {
            wire,
            began: direction.starts.get(first).copied().unwrap_or(event.at),
            ended: ends,
            message,
        })
    }
}

impl Direction {
    fn hear(&mut self, began: Cycle, byte: u8) -> Option<Message> {
        self.starts.push_back(began);
        if self.starts.len() > LONGEST_BYTES {
            self.starts.pop_front();
        }
        let mut bytes = &[byte][..];
        let mut whole = None;
        while let Some(event) = self.parser.next_event(&mut bytes) {
            if let link::Event::Frame(frame) = event {
                whole = Some(frame.message);
            }
        }
        whole
    }
}
