//! Who watches an emulated board in flight.

use emulator::machine::Step;
use emulator::trace::Event;

use super::BoardError;
use super::emulated::Emulated;

/// Somebody who watches the chip in flight, from outside: it does the same with and without.
pub trait Observer {
    /// The board has booted, and is about to fly.
    fn begin(&mut self, board: &Emulated) -> Result<Interest, BoardError>;

    /// What happened in a millisecond.
    fn events(&mut self, _events: &[Event]) {}

    /// An instruction was executed.
    fn step(&mut self, _step: Step) {}
}

/// How closely an observer looks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Interest {
    /// At events, calls of the functions at these addresses among them.
    Events(Vec<u32>),
    /// At every instruction: slow.
    Steps,
}
