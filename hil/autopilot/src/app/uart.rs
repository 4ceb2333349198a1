//! The receiving side of the deck's UART: a small buffer that is read during a tenth of the time.

use link::{Counters, Message, Parser};

/// Bytes that UART2's stream buffer holds.
const BUFFER_BYTES: usize = 200;

/// Receive calls in each cycle of the app. Each waits about 1 ms for a message; here it is one call
/// in each millisecond.
const CALLS: u32 = 10;

/// The buffer, the parser behind it, and the window in which they are read.
///
/// The published app uses the generated C parser; this one differs from it only after corruption,
/// where it finds the frames that the other one swallows.
#[derive(Debug)]
pub struct Uart {
    buffer: Vec<u8>,
    parser: Parser,
    calls_left: u32,
    overflowed_bytes: u64,
    unused_messages: u32,
}

impl Uart {
    /// An empty buffer that is not being read.
    pub fn new() -> Self {
        Self {
            buffer: Vec::with_capacity(BUFFER_BYTES),
            parser: Parser::new(),
            calls_left: 0,
            overflowed_bytes: 0,
            unused_messages: 0,
        }
    }

    /// Bytes arrive. What does not fit is lost: the newest.
    pub fn arrive(&mut self, bytes: &[u8]) {
        let room = BUFFER_BYTES - self.buffer.len();
        let (kept, lost) = bytes.split_at(bytes.len().min(room));
        self.buffer.extend_from_slice(kept);
        self.overflowed_bytes += lost.len() as u64;
    }

    /// The app begins to read: for the next ten receive calls.
    pub fn open_window(&mut self) {
        self.calls_left = CALLS;
    }

    /// The app stops reading.
    pub fn close_window(&mut self) {
        self.calls_left = 0;
    }

    /// Whether the app is reading.
    pub fn window_is_open(&self) -> bool {
        self.calls_left > 0
    }

    /// One receive call: reads until a message is complete or the buffer is empty; does nothing
    /// outside the window.
    ///
    /// The app handles a message at the beginning of the next call, so what the last call of a
    /// window receives is never used: nine messages a cycle at most.
    pub fn receive(&mut self) -> Option<Message> {
        self.calls_left = self.calls_left.checked_sub(1)?;
        let message = self.read()?;
        if self.calls_left == 0 {
            self.unused_messages += 1;
            return None;
        }
        Some(message)
    }

    fn read(&mut self) -> Option<Message> {
        let mut unread = &self.buffer[..];
        let frame = self.parser.next_frame(&mut unread);
        let read = self.buffer.len() - unread.len();
        self.buffer.drain(..read);
        frame.map(|frame| frame.message)
    }

    /// Bytes lost for want of room.
    pub fn overflowed_bytes(&self) -> u64 {
        self.overflowed_bytes
    }

    /// Messages that the last call of a window received.
    pub fn unused_messages(&self) -> u32 {
        self.unused_messages
    }

    /// What the parser has seen.
    pub fn counters(&self) -> Counters {
        self.parser.counters()
    }
}

#[cfg(test)]
mod tests {
    use link::{Command, Message, State};

    use super::Uart;

    fn received_in_a_window(uart: &mut Uart) -> usize {
        uart.open_window();
        let mut count = 0;
        while uart.window_is_open() {
            count += usize::from(uart.receive().is_some());
        }
        count
    }

    #[test]
    fn a_full_buffer_keeps_the_oldest_200_bytes() {
        let state = Message::State(State::default()).encode();
        let mut uart = Uart::new();
        for _ in 0..8 {
            uart.arrive(&state);
        }
        assert_eq!(uart.overflowed_bytes(), 8 * 28 - 200);
        let count = received_in_a_window(&mut uart);
        assert_eq!(count, 7, "seven of 28 bytes fit whole");
    }

    #[test]
    fn nothing_is_read_outside_the_window() {
        let mut uart = Uart::new();
        uart.arrive(&Message::State(State::default()).encode());
        assert_eq!(uart.receive(), None);
        assert_eq!(received_in_a_window(&mut uart), 1);
    }

    #[test]
    fn of_ten_messages_in_a_window_nine_are_used_and_later_ones_wait() {
        let command = Message::Command(Command::default()).encode();
        let mut uart = Uart::new();
        for _ in 0..12 {
            uart.arrive(&command);
        }
        assert_eq!(received_in_a_window(&mut uart), 9);
        assert_eq!(uart.unused_messages(), 1);
        assert_eq!(received_in_a_window(&mut uart), 2);
    }
}
