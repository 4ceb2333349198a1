//! A debug probe on the emulated chip: what the firmware logs.

use emulator::image::Image;
use emulator::machine::Machine;
use emulator::wiring::Wiring;

use super::firmware_log::{LogDecoder, LogTable};
use super::rtt::UpChannel;
use super::{BoardError, FirmwareLog};

/// Reads the log of an image while it runs. The firmware never waits for it: who reads too seldom
/// loses records (the buffer holds 1 KiB).
pub struct Probe<'f> {
    channel: UpChannel,
    decoder: LogDecoder<'f>,
    bytes: Vec<u8>,
}

impl<'f> Probe<'f> {
    /// A probe for an image with its log table.
    pub fn new(image: &Image, table: &'f LogTable) -> Result<Self, BoardError> {
        let channel = UpChannel::of(image).ok_or(BoardError::NoSymbol(UpChannel::SYMBOL))?;
        Ok(Self {
            channel,
            decoder: LogDecoder::new(table),
            bytes: Vec::new(),
        })
    }

    /// The chip was reset.
    pub fn restart(&mut self) {
        self.decoder.restart();
    }

    /// Appends what the firmware logged since the last call.
    pub fn read<W: Wiring>(
        &mut self,
        machine: &mut Machine<W>,
        into: &mut Vec<FirmwareLog>,
    ) -> Result<(), BoardError> {
        self.bytes.clear();
        self.channel.drain(machine.memory_mut(), &mut self.bytes);
        if self.bytes.is_empty() {
            return Ok(());
        }
        self.decoder.decode(&self.bytes, into)
    }
}
