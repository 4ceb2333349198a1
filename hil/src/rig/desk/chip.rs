//! The chip with what is in its flash.

use emulator::machine::{Fault, Machine};
use emulator::soc::ResetCause;
use emulator::time::Nanos;
use emulator::wiring::Unwired;

use crate::board::BoardError;
use crate::board::emulated::Firmware;
use crate::board::rtt::UpChannel;

const MILLISECOND: Nanos = Nanos::from_millis(1);

/// An STM32F407 with nothing soldered to it.
pub struct Chip {
    machine: Machine<Unwired>,
    channel: UpChannel,
    clock: Nanos,
}

impl Chip {
    /// Flashes an image into a chip and switches it on.
    pub fn boot(elf: &[u8]) -> Result<Self, BoardError> {
        let firmware = Firmware::parse(elf)?;
        Ok(Self {
            machine: firmware.machine(Unwired)?,
            channel: firmware.log_channel()?,
            clock: Nanos(0),
        })
    }

    /// One millisecond.
    pub fn advance(&mut self) -> Result<(), Fault> {
        self.clock = self.clock + MILLISECOND;
        self.machine.run_until(self.clock)
    }

    /// The reset pin.
    pub fn reset(&mut self) {
        self.machine.reset(ResetCause::Pin);
    }

    /// Puts bytes on a receive line, at the line's rate from now on.
    pub fn send(&mut self, usart: u8, bytes: &[u8]) {
        self.machine.usart_send(usart, self.clock, bytes);
    }

    /// What came out of a transmit line since the last call.
    pub fn received(&mut self, usart: u8) -> Vec<u8> {
        let bytes = self.machine.usart_received(usart);
        bytes.into_iter().map(|(_, byte)| byte).collect()
    }

    /// What was logged since the last call.
    pub fn take_log(&mut self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.channel.drain(self.machine.memory_mut(), &mut bytes);
        bytes
    }

    /// What is in its memory; none where there is none.
    pub fn read(&self, address: u32, length: usize) -> Option<&[u8]> {
        self.machine.memory().bytes(address, length)
    }
}
