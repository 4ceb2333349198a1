//! DMA1 and DMA2: eight streams each, between a peripheral's data register and memory (RM0090 §10).
//!
//! A transfer takes no time and wins every arbitration; the FIFO is therefore always empty. What is
//! modelled is what software sees: counts, addresses, flags, double buffers and errors.

mod request;
mod stream;

pub use request::Request;
use request::Slot;

use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;
use crate::core::Cycle;
use crate::memory::Memory;
use crate::trace::{Recorder, What};
use stream::Stream;

/// Where the flags of streams 0 to 3 (4 to 7) lie in LISR (HISR).
const FLAG_SHIFT: [u32; 4] = [0, 6, 16, 22];

/// Both controllers.
#[derive(Clone, Debug)]
pub struct Dma {
    streams: [[Stream; 8]; 2],
    /// The bus that a controller waits for is taken.
    stalled: [bool; 2],
    /// The present, for the trace.
    now: Cycle,
    pub(super) trace: Recorder,
}

impl Dma {
    /// The reset state.
    pub fn new() -> Self {
        Self {
            streams: [[Stream::RESET; 8]; 2],
            stalled: [false; 2],
            now: 0,
            trace: Recorder::default(),
        }
    }

    /// The bus refuses the transfer that stream `stream` of controller 1 or 2 has under way. A
    /// stream that is off has none.
    pub fn fail(&mut self, controller: u8, stream: u8) {
        if let Some(stream) = self.streams[index(controller)].get_mut(usize::from(stream)) {
            stream.refuse();
        }
    }

    /// Takes the bus away from controller 1 or 2, or gives it back. Requests wait; who gives the
    /// bus back lets their peripherals serve them.
    pub fn stall(&mut self, controller: u8, stalled: bool) {
        self.stalled[index(controller)] = stalled;
    }

    /// Resets both controllers and what is done to them from outside; the trace goes on.
    pub fn restart(&mut self) {
        let trace = core::mem::take(&mut self.trace);
        *self = Self {
            trace,
            ..Self::new()
        };
    }

    /// Resets controller 1 or 2; the bus is none of its business.
    pub fn reset(&mut self, controller: u8) {
        self.streams[index(controller)] = [Stream::RESET; 8];
    }

    /// Moves one item from the requesting peripheral to memory. False: no enabled stream serves the
    /// request, or the bus refused.
    pub fn store(&mut self, memory: &mut Memory, request: Request, value: u32) -> bool {
        let Some(slot) = self.serving(request) else {
            return false;
        };
        let stored = self.stream(slot).accept(memory, value);
        self.note_end(slot);
        stored
    }

    /// Moves whole words to memory as [`store`](Self::store) would, one after the other, as far as none
    /// of them raises a flag. Returns the bytes that were moved; with 0 of them `store` must do it.
    pub fn store_words(&mut self, memory: &mut Memory, request: Request, bytes: &[u8]) -> usize {
        let slot = self.serving(request);
        slot.map_or(0, |slot| self.stream(slot).accept_words(memory, bytes))
    }

    /// Moves one item from memory to the requesting peripheral; `None` as in [`store`](Self::store).
    pub fn load(&mut self, memory: &Memory, request: Request) -> Option<u32> {
        let slot = self.serving(request)?;
        let item = self.stream(slot).supply(memory);
        self.note_end(slot);
        item
    }

    /// Items left in the stream that serves `request`; `None` if none does.
    pub fn remaining(&mut self, request: Request) -> Option<u32> {
        let slot = self.serving(request)?;
        Some(self.stream(slot).remaining())
    }

    fn serving(&self, request: Request) -> Option<&'static Slot> {
        request.slots().iter().find(|slot| {
            let controller = index(slot.controller);
            !self.stalled[controller]
                && self.streams[controller][usize::from(slot.stream)].serves(slot.channel)
        })
    }

    fn stream(&mut self, slot: &Slot) -> &mut Stream {
        &mut self.streams[index(slot.controller)][usize::from(slot.stream)]
    }

    /// What is moved from now on is moved at this cycle.
    pub fn set_time(&mut self, now: Cycle) {
        self.now = now;
    }

    fn note_end(&mut self, slot: &Slot) {
        if self.stream(slot).is_between_transfers() {
            let (controller, stream) = (slot.controller, slot.stream);
            self.trace
                .note(self.now, What::DmaDone { controller, stream });
        }
    }

    /// Drives the streams' interrupt lines.
    pub fn drive(&self, lines: &mut Lines) {
        for (controller, streams) in (1..).zip(&self.streams) {
            for (number, stream) in streams.iter().enumerate() {
                if stream.flags() != 0 {
                    lines.drive(interrupts::dma(controller, number), stream.interrupts());
                }
            }
        }
    }

    /// Reads a register of controller 1 or 2.
    pub fn read(&self, controller: u8, offset: u32) -> Result<u32, Refusal> {
        let streams = &self.streams[index(controller)];
        if offset < 0x08 {
            return Ok(flag_word(&streams[offset as usize..][..4]));
        }
        if offset < 0x10 {
            return Ok(0);
        }
        let (number, register) = stream_register(controller, offset)?;
        Ok(streams[number].read(register))
    }

    /// Writes a register of controller 1 or 2.
    pub fn write(&mut self, controller: u8, offset: u32, value: u32) -> Result<(), Refusal> {
        let streams = &mut self.streams[index(controller)];
        match offset {
            0x00 | 0x04 => return Ok(()),
            0x08 | 0x0c => {
                for (stream, shift) in streams[offset as usize - 8..].iter_mut().zip(FLAG_SHIFT) {
                    stream.clear(value >> shift);
                }
                return Ok(());
            }
            _ => {}
        }
        let (number, register) = stream_register(controller, offset)?;
        streams[number].write(register, value, (controller, number as u8))
    }
}

fn index(controller: u8) -> usize {
    usize::from(controller == 2)
}

fn flag_word(streams: &[Stream]) -> u32 {
    let flags = streams.iter().zip(FLAG_SHIFT);
    flags.fold(0, |word, (stream, shift)| word | stream.flags() << shift)
}

/// Stream and register offset of a controller's offset.
fn stream_register(controller: u8, offset: u32) -> Result<(usize, u32), Refusal> {
    let behind = offset.wrapping_sub(0x10);
    if behind >= 8 * 0x18 {
        return Err(Refusal::UnmodelledRegister {
            block: Block::Dma(controller),
            address: 0x4002_6000 + (u32::from(controller) - 1) * 0x400 + offset,
        });
    }
    Ok(((behind / 0x18) as usize, behind % 0x18))
}

#[cfg(test)]
mod tests;
