//! A UART of the chip at a port, with the adapter between them: it passes bytes at the line's rate and
//! holds few, so that who sends faster has to wait.

use std::collections::VecDeque;

use crate::live::{News, Port};

use super::chip::Chip;

/// Bits of a character: start, eight, stop.
const BITS: u32 = 10;
/// Bytes that the adapter holds, at most, before it takes more.
const HELD_BYTES: usize = 4096;

/// One line.
pub struct SerialLine {
    usart: u8,
    port: Port,
    /// Characters in a millisecond.
    rate: usize,
    held: VecDeque<u8>,
}

impl SerialLine {
    /// The line of USART `usart`.
    pub fn new(usart: u8, port: Port, baud: u32) -> Self {
        Self {
            usart,
            port,
            rate: (baud / BITS).div_ceil(1_000) as usize,
            held: VecDeque::new(),
        }
    }

    /// Where it is met.
    pub fn place(&self) -> &str {
        self.port.place()
    }

    /// Moves a millisecond of what has come to the chip. For people: who came and went.
    pub fn feed(&mut self, chip: &mut Chip) -> Vec<String> {
        let mut news = Vec::new();
        if self.held.len() < HELD_BYTES {
            let mut received = Vec::new();
            news = self.port.poll(&mut received);
            self.held.extend(received);
        }
        let piece = self.held.len().min(self.rate);
        let bytes: Vec<u8> = self.held.drain(..piece).collect();
        chip.send(self.usart, &bytes);
        news.into_iter().map(in_words).collect()
    }

    /// Hands over what the chip has sent; like a wire, to nobody where nobody is there.
    pub fn hand_over(&mut self, chip: &mut Chip) {
        let bytes = chip.received(self.usart);
        if !bytes.is_empty() {
            let _ = self.port.send(&bytes);
        }
    }
}

fn in_words(news: News) -> String {
    match news {
        News::Came(peer) => format!("connected: {peer}"),
        News::Gone { peer, .. } => format!("peer lost: {peer}"),
        News::Note(text) => text,
    }
}
