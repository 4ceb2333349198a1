//! The part of the app's cycle that reads: ten receive calls, each of which waits about 1 ms for a
//! message; here it is one call in each millisecond.
//!
//! ```text
//! ten times: handle the variable -> receive into the variable
//! ```
//!
//! A message is handled one call after the one that received it. That order is behind most of the
//! app's peculiarities.

use link::{Command, Message};

use super::dropped::{DropReason, Dropped};
use super::uart::{Heard, Uart};
use crate::app::quirks::Quirks;

/// Receive calls in each cycle.
const CALLS: u32 = 10;

/// What the loop hands to the handlers.
#[derive(Debug, Clone, PartialEq)]
pub enum Delivery {
    /// A message that has come.
    New(Heard),
    /// A message that has been handled before, or has never come: what the variable happens to hold.
    Stale(Message),
}

/// The message variable.
#[derive(Debug, Clone, PartialEq, Default)]
enum Variable {
    /// Nothing with a meaning.
    #[default]
    Undefined,
    /// A message that has not been handled yet.
    Filled(Heard),
    /// What has been handled, or is there by accident.
    Leftover(Message),
}

/// The loop over the receive calls, and the buffer that it reads.
#[derive(Debug)]
pub struct ReceiveLoop {
    quirks: Quirks,
    uart: Uart,
    variable: Variable,
    calls_left: u32,
    deliveries: Vec<Delivery>,
    repeats: u32,
    unused_messages: u32,
}

impl ReceiveLoop {
    /// A loop that is not running, on an empty buffer.
    pub fn new(quirks: Quirks) -> Self {
        Self {
            quirks,
            uart: Uart::new(&quirks),
            variable: Variable::Undefined,
            calls_left: 0,
            deliveries: Vec::new(),
            repeats: 0,
            unused_messages: 0,
        }
    }

    /// The buffer.
    pub fn uart(&mut self) -> &mut Uart {
        &mut self.uart
    }

    /// As [`Self::uart`], to look at.
    pub fn counted(&self) -> &Uart {
        &self.uart
    }

    /// The loop begins: ten calls follow. `sent` is the command that this cycle has sent.
    pub fn begin(&mut self, now_ms: u64, sent: Option<&Command>) {
        if let Some(command) = sent.filter(|_| self.quirks.self_acknowledge) {
            self.lose(now_ms);
            self.variable = Variable::Leftover(Message::Command(command.clone()));
        } else if !self.quirks.stack_leftovers {
            self.variable = Variable::Undefined;
        }
        self.calls_left = CALLS;
    }

    /// Whether the loop is running.
    pub fn is_running(&self) -> bool {
        self.calls_left > 0
    }

    /// One pass of the loop; does nothing unless it is running.
    pub fn call(&mut self, now_ms: u64) {
        let Some(calls_left) = self.calls_left.checked_sub(1) else {
            return;
        };
        let is_first = self.calls_left == CALLS;
        self.calls_left = calls_left;
        self.deliver(is_first);
        if let Some(heard) = self.uart.read(now_ms) {
            self.variable = Variable::Filled(heard);
        }
        if calls_left == 0 {
            self.end(now_ms);
        }
    }

    /// The loop is left: nothing that it has read will be handled.
    pub fn abort(&mut self, now_ms: u64) {
        self.calls_left = 0;
        for delivery in std::mem::take(&mut self.deliveries) {
            if let Delivery::New(heard) = delivery {
                self.uart.discard(now_ms, &heard, DropReason::NotRead);
            }
        }
        if let Variable::Filled(heard) = std::mem::take(&mut self.variable) {
            self.uart.discard(now_ms, &heard, DropReason::NotRead);
        }
    }

    /// What the calls since the last time have delivered, in order.
    pub fn take(&mut self) -> Vec<Delivery> {
        std::mem::take(&mut self.deliveries)
    }

    /// What has been lost since the last call.
    pub fn take_dropped(&mut self) -> Vec<Dropped> {
        self.uart.take_dropped()
    }

    /// Times that a message was handled that had not just come.
    pub fn repeats(&self) -> u32 {
        self.repeats
    }

    /// Messages that the last call of a cycle received and nobody used.
    pub fn unused_messages(&self) -> u32 {
        self.unused_messages
    }

    /// Hands over what the variable holds. Before the first receive call that is an accident.
    fn deliver(&mut self, is_first: bool) {
        match std::mem::take(&mut self.variable) {
            Variable::Filled(heard) => {
                self.variable = Variable::Leftover(heard.message.clone());
                self.deliveries.push(Delivery::New(heard));
            }
            Variable::Leftover(message) => {
                if is_first || self.quirks.repeats_last_message {
                    self.repeats += 1;
                    self.deliveries.push(Delivery::Stale(message.clone()));
                }
                self.variable = Variable::Leftover(message);
            }
            Variable::Undefined => {}
        }
    }

    /// After the last call.
    fn end(&mut self, now_ms: u64) {
        let is_new = matches!(self.variable, Variable::Filled(_));
        if is_new && !self.quirks.drops_tenth_message {
            self.deliver(false);
        } else if !self.quirks.stack_leftovers {
            self.lose(now_ms);
        }
    }

    /// The variable is overwritten: a message in it that nobody has handled is lost.
    fn lose(&mut self, now_ms: u64) {
        if let Variable::Filled(heard) = std::mem::take(&mut self.variable) {
            self.unused_messages += 1;
            self.uart.discard(now_ms, &heard, DropReason::TenthMessage);
        }
    }
}

#[cfg(test)]
mod tests {
    use link::{Command, Message, State};

    use super::{Delivery, ReceiveLoop};
    use crate::app::quirks::Quirks;
    use crate::app::reception::dropped::DropReason;

    fn command(byte: u8) -> Message {
        Message::Command(Command {
            command: byte,
            ..Command::default()
        })
    }

    /// The command bytes that a whole cycle delivers: new ones as they are, stale ones as `None`.
    fn cycle(receive: &mut ReceiveLoop, sent: Option<u8>) -> Vec<Option<u8>> {
        let sent = sent.map(|byte| Command {
            command: byte,
            ..Command::default()
        });
        receive.begin(0, sent.as_ref());
        while receive.is_running() {
            receive.call(0);
        }
        let deliveries = receive.take().into_iter();
        deliveries
            .map(|delivery| match delivery {
                Delivery::New(heard) => match heard.message {
                    Message::Command(command) => Some(command.command),
                    other => panic!("{other:?}"),
                },
                Delivery::Stale(_) => None,
            })
            .collect()
    }

    fn with(quirks: Quirks, arrived: impl IntoIterator<Item = u8>) -> ReceiveLoop {
        let mut receive = ReceiveLoop::new(quirks);
        for byte in arrived {
            receive.uart().arrive(0, &command(byte).encode());
        }
        receive
    }

    fn new(bytes: impl IntoIterator<Item = u8>) -> Vec<Option<u8>> {
        bytes.into_iter().map(Some).collect()
    }

    #[test]
    fn a_full_buffer_keeps_the_oldest_200_bytes() {
        let state = Message::State(State::default()).encode();
        let mut receive = ReceiveLoop::new(Quirks::PUBLISHED);
        for _ in 0..8 {
            receive.uart().arrive(0, &state);
        }
        assert_eq!(receive.counted().overflowed_bytes(), 8 * 28 - 200);
        receive.begin(0, None);
        while receive.is_running() {
            receive.call(0);
        }
        let delivered = receive.take();
        let news = delivered
            .iter()
            .filter(|delivery| matches!(delivery, Delivery::New(_)));
        assert_eq!(news.count(), 7, "seven of 28 bytes fit whole");
    }

    #[test]
    fn nothing_is_read_outside_the_loop() {
        let mut receive = with(Quirks::NONE, [1]);
        receive.call(0);
        assert_eq!(receive.take(), []);
        assert_eq!(cycle(&mut receive, None), new([1]));
    }

    #[test]
    fn of_ten_messages_in_a_cycle_nine_are_used_and_later_ones_wait() {
        let quirks = Quirks {
            drops_tenth_message: true,
            ..Quirks::NONE
        };
        let mut receive = with(quirks, 0..12);
        assert_eq!(cycle(&mut receive, None), new(0..9));
        assert_eq!(receive.unused_messages(), 1);
        let dropped = receive.take_dropped();
        assert_eq!(dropped.len(), 1);
        assert_eq!(dropped[0].why, DropReason::TenthMessage);
        assert_eq!((dropped[0].message, dropped[0].bytes), ("COMMAND", 10));
        assert_eq!(cycle(&mut receive, None), new([10, 11]));
    }

    #[test]
    fn without_the_quirk_the_tenth_message_is_used_too() {
        let mut receive = with(Quirks::NONE, 0..12);
        assert_eq!(cycle(&mut receive, None), new(0..10));
        assert_eq!(receive.unused_messages(), 0);
    }

    #[test]
    fn the_last_message_is_repeated_until_the_calls_are_used_up() {
        let quirks = Quirks {
            repeats_last_message: true,
            ..Quirks::NONE
        };
        let mut receive = with(quirks, [1, 2]);
        let mut expected = new([1, 2]);
        // Ten times the variable is handled: once before the first call, when it is undefined.
        expected.extend([None; 7]);
        assert_eq!(cycle(&mut receive, None), expected);
        assert_eq!(cycle(&mut with(Quirks::NONE, [1, 2]), None), new([1, 2]));
    }

    #[test]
    fn a_command_that_was_sent_is_what_the_first_pass_handles() {
        let quirks = Quirks {
            self_acknowledge: true,
            ..Quirks::NONE
        };
        let mut receive = with(quirks, [1]);
        assert_eq!(cycle(&mut receive, Some(7)), [None, Some(1)]);
        let mut other_build = with(Quirks::NONE, [1]);
        assert_eq!(cycle(&mut other_build, Some(7)), new([1]));
    }

    #[test]
    fn a_leftover_is_handled_first_and_saves_the_tenth_message_unless_a_command_is_sent() {
        let quirks = Quirks {
            stack_leftovers: true,
            drops_tenth_message: true,
            self_acknowledge: true,
            ..Quirks::NONE
        };
        let mut receive = with(quirks, 0..11);
        assert_eq!(cycle(&mut receive, None), new(0..9));
        assert_eq!(cycle(&mut receive, None), new([9, 10]));
        assert_eq!(cycle(&mut receive, None), [None], "the eleventh, again");
        let mut receive = with(quirks, 0..11);
        cycle(&mut receive, None);
        assert_eq!(cycle(&mut receive, Some(7)), [None, Some(10)]);
        assert_eq!(receive.unused_messages(), 1);
    }
}
