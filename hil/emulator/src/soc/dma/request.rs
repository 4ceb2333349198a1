//! Which peripheral asks on which stream and channel (RM0090 §10.3.3, tables 42 and 43).

/// A peripheral's request line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// USART 1..=6 has received.
    UsartReceive(u8),
    /// USART 1..=6 can send.
    UsartSend(u8),
    /// I2C 1..=3 has received.
    I2cReceive(u8),
    /// I2C 1..=3 can send.
    I2cSend(u8),
    /// The camera interface has a word.
    Dcmi,
}

/// A place where a request can be served.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// 1 or 2.
    pub controller: u8,
    /// 0..=7.
    pub stream: u8,
    /// S_CR.CHSEL.
    pub channel: u8,
}

const fn slot(controller: u8, stream: u8, channel: u8) -> Slot {
    Slot {
        controller,
        stream,
        channel,
    }
}

const ALL: [Request; 19] = [
    Request::UsartReceive(1),
    Request::UsartReceive(2),
    Request::UsartReceive(3),
    Request::UsartReceive(4),
    Request::UsartReceive(5),
    Request::UsartReceive(6),
    Request::UsartSend(1),
    Request::UsartSend(2),
    Request::UsartSend(3),
    Request::UsartSend(4),
    Request::UsartSend(5),
    Request::UsartSend(6),
    Request::I2cReceive(1),
    Request::I2cReceive(2),
    Request::I2cReceive(3),
    Request::I2cSend(1),
    Request::I2cSend(2),
    Request::I2cSend(3),
    Request::Dcmi,
];

impl Request {
    /// Where the request can be served.
    pub fn slots(self) -> &'static [Slot] {
        match self {
            Self::UsartReceive(1) => const { &[slot(2, 2, 4), slot(2, 5, 4)] },
            Self::UsartReceive(2) => const { &[slot(1, 5, 4)] },
            Self::UsartReceive(3) => const { &[slot(1, 1, 4)] },
            Self::UsartReceive(4) => const { &[slot(1, 2, 4)] },
            Self::UsartReceive(5) => const { &[slot(1, 0, 4)] },
            Self::UsartReceive(_) => const { &[slot(2, 1, 5), slot(2, 2, 5)] },
            Self::UsartSend(1) => const { &[slot(2, 7, 4)] },
            Self::UsartSend(2) => const { &[slot(1, 6, 4)] },
            Self::UsartSend(3) => const { &[slot(1, 3, 4), slot(1, 4, 7)] },
            Self::UsartSend(4) => const { &[slot(1, 4, 4)] },
            Self::UsartSend(5) => const { &[slot(1, 7, 4)] },
            Self::UsartSend(_) => const { &[slot(2, 6, 5), slot(2, 7, 5)] },
            Self::I2cReceive(1) => const { &[slot(1, 0, 1), slot(1, 5, 1)] },
            Self::I2cReceive(2) => const { &[slot(1, 2, 7), slot(1, 3, 7)] },
            Self::I2cReceive(_) => const { &[slot(1, 2, 3)] },
            Self::I2cSend(1) => const { &[slot(1, 6, 1), slot(1, 7, 1)] },
            Self::I2cSend(2) => const { &[slot(1, 7, 7)] },
            Self::I2cSend(_) => const { &[slot(1, 4, 3)] },
            Self::Dcmi => const { &[slot(2, 1, 1), slot(2, 7, 1)] },
        }
    }

    /// The request that a stream and channel serve, if this model has it.
    pub fn at(controller: u8, stream: u8, channel: u8) -> Option<Self> {
        let wanted = slot(controller, stream, channel);
        ALL.into_iter()
            .find(|request| request.slots().contains(&wanted))
    }

    /// The register a stream must point at to serve the request.
    pub fn data_register(self) -> u32 {
        match self {
            Self::UsartReceive(number) | Self::UsartSend(number) => {
                let base = match number {
                    1 => 0x4001_1000,
                    6 => 0x4001_1400,
                    _ => 0x4000_4000 + 0x400 * (u32::from(number) - 1),
                };
                base + 0x04
            }
            Self::I2cReceive(number) | Self::I2cSend(number) => {
                0x4000_5000 + 0x400 * u32::from(number) + 0x10
            }
            Self::Dcmi => 0x5005_0028,
        }
    }

    /// True from memory to the peripheral.
    pub fn sends(self) -> bool {
        matches!(self, Self::UsartSend(_) | Self::I2cSend(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_registers_are_those_of_the_blocks() {
        use crate::soc::map::{Block, decode};
        for request in ALL {
            let (block, offset) = decode(request.data_register()).unwrap();
            let expected = match request {
                Request::UsartReceive(n) | Request::UsartSend(n) => (Block::Usart(n), 0x04),
                Request::I2cReceive(n) | Request::I2cSend(n) => (Block::I2c(n), 0x10),
                Request::Dcmi => (Block::Dcmi, 0x28),
            };
            assert_eq!((block, offset), expected, "{request:?}");
        }
    }

    #[test]
    fn no_stream_and_channel_serves_two_requests() {
        for request in ALL {
            for slot in request.slots() {
                let found = Request::at(slot.controller, slot.stream, slot.channel);
                assert_eq!(found, Some(request));
            }
        }
    }
}
