//! DMA1 and DMA2: eight streams each, between a peripheral's data register and memory (RM0090 §10).
//!
//! A transfer takes no time and wins every arbitration; the FIFO is therefore always empty. What is
//! modelled is what software sees: counts, addresses, flags, double buffers and errors.

mod request;

pub use request::Request;

use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;
use crate::memory::{CCM, CCM_BYTES, Memory};

const ENABLE: u32 = 1 << 0;
const PERIPHERAL_FLOW: u32 = 1 << 5;
const PERIPHERAL_INCREMENT: u32 = 1 << 9;
const MEMORY_INCREMENT: u32 = 1 << 10;
const CIRCULAR: u32 = 1 << 8;
const DOUBLE_BUFFER: u32 = 1 << 18;
const CURRENT_TARGET: u32 = 1 << 19;
/// Bits of S_CR that take writes while the stream is enabled: EN, the interrupt enables and CIRC
/// (RM0090 §10.5.5).
const WRITABLE_WHILE_ENABLED: u32 = 0x0000_011f;
const CR_WRITABLE: u32 = 0x0fef_ffff;

/// Flags of one stream in ISR and IFCR.
const TRANSFER_ERROR: u32 = 1 << 3;
const HALF_TRANSFER: u32 = 1 << 4;
const TRANSFER_COMPLETE: u32 = 1 << 5;
const ALL_FLAGS: u32 = 0x3d;
/// Enable bits of S_CR, one below their flags: TEIE, HTIE, TCIE.
const INTERRUPT_ENABLES: u32 = 0x1c;
/// Where the flags of streams 0 to 3 (4 to 7) lie in LISR (HISR).
const FLAG_SHIFT: [u32; 4] = [0, 6, 16, 22];

/// S_FCR.FS: the FIFO is empty.
const FIFO_EMPTY: u32 = 4 << 3;
const FCR_RESET: u32 = 0x21;

/// One stream's registers.
#[derive(Clone, Copy, Debug)]
struct Stream {
    cr: u32,
    /// Items left.
    count: u32,
    /// Items programmed: what a circular stream reloads.
    programmed: u32,
    /// Bytes behind the current memory address.
    offset: u32,
    peripheral: u32,
    memory: [u32; 2],
    fcr: u32,
    flags: u32,
}

impl Stream {
    const RESET: Self = Self {
        cr: 0,
        count: 0,
        programmed: 0,
        offset: 0,
        peripheral: 0,
        memory: [0; 2],
        fcr: FCR_RESET,
        flags: 0,
    };

    fn enabled(&self) -> bool {
        self.cr & ENABLE != 0
    }

    fn channel(&self) -> u8 {
        (self.cr >> 25 & 7) as u8
    }

    fn sends(&self) -> bool {
        self.cr >> 6 & 3 == 1
    }

    /// PSIZE, in bytes.
    fn item_bytes(&self) -> u32 {
        1 << (self.cr >> 11 & 3).min(2)
    }

    fn current_target(&self) -> usize {
        (self.cr & CURRENT_TARGET != 0) as usize
    }

    fn address(&self) -> u32 {
        self.memory[self.current_target()].wrapping_add(self.offset)
    }

    fn interrupts(&self) -> bool {
        self.flags & (self.cr & INTERRUPT_ENABLES) << 1 != 0
    }

    /// The bus answered with an error: the stream stops (RM0090 §10.3.18).
    fn fail(&mut self) {
        self.cr &= !ENABLE;
        self.flags |= TRANSFER_ERROR;
    }

    /// Accounts for one item moved.
    fn count_down(&mut self) {
        if self.cr & MEMORY_INCREMENT != 0 {
            self.offset = self.offset.wrapping_add(self.item_bytes());
        }
        self.count -= 1;
        if self.count == self.programmed / 2 {
            self.flags |= HALF_TRANSFER;
        }
        if self.count > 0 {
            return;
        }
        self.flags |= TRANSFER_COMPLETE;
        self.offset = 0;
        if self.cr & DOUBLE_BUFFER != 0 {
            self.cr ^= CURRENT_TARGET;
            self.count = self.programmed;
        } else if self.cr & CIRCULAR != 0 {
            self.count = self.programmed;
        } else {
            self.cr &= !ENABLE;
        }
    }

    fn load(&self, memory: &Memory) -> Option<u32> {
        let address = reachable(self.address())?;
        match self.item_bytes() {
            1 => memory.read8(address).map(u32::from),
            2 => memory.read16(address).map(u32::from),
            _ => memory.read32(address),
        }
    }

    fn store(&self, memory: &mut Memory, value: u32) -> Option<()> {
        let address = reachable(self.address())?;
        match self.item_bytes() {
            1 => memory.write8(address, value as u8),
            2 => memory.write16(address, value as u16),
            _ => memory.write32(address, value),
        }
    }
}

/// The core-coupled memory is on the core's data bus alone (RM0090 §2.1, figure 5).
fn reachable(address: u32) -> Option<u32> {
    let outside = address.wrapping_sub(CCM) as usize >= CCM_BYTES;
    outside.then_some(address)
}

/// Both controllers.
#[derive(Clone, Debug)]
pub struct Dma {
    streams: [[Stream; 8]; 2],
}

impl Dma {
    /// The reset state.
    pub fn new() -> Self {
        Self {
            streams: [[Stream::RESET; 8]; 2],
        }
    }

    /// Resets controller 1 or 2.
    pub fn reset(&mut self, controller: u8) {
        self.streams[index(controller)] = [Stream::RESET; 8];
    }

    /// Moves one item from the requesting peripheral to memory. False: no enabled stream serves the
    /// request, or the bus refused.
    pub fn store(&mut self, memory: &mut Memory, request: Request, value: u32) -> bool {
        let Some(stream) = self.serving(request) else {
            return false;
        };
        let done = stream.store(memory, value).is_some();
        if done {
            stream.count_down();
        } else {
            stream.fail();
        }
        done
    }

    /// Moves one item from memory to the requesting peripheral; `None` as in [`store`](Self::store).
    pub fn load(&mut self, memory: &Memory, request: Request) -> Option<u32> {
        let stream = self.serving(request)?;
        let value = stream.load(memory);
        match value {
            Some(_) => stream.count_down(),
            None => stream.fail(),
        }
        value
    }

    /// Items left in the stream that serves `request`; `None` if none does.
    pub fn remaining(&mut self, request: Request) -> Option<u32> {
        self.serving(request).map(|stream| stream.count)
    }

    fn serving(&mut self, request: Request) -> Option<&mut Stream> {
        let slot = request.slots().iter().find(|slot| {
            let stream = &self.streams[index(slot.controller)][usize::from(slot.stream)];
            stream.enabled() && stream.channel() == slot.channel && stream.count > 0
        })?;
        Some(&mut self.streams[index(slot.controller)][usize::from(slot.stream)])
    }

    /// Drives the streams' interrupt lines.
    pub fn drive(&self, lines: &mut Lines) {
        for (controller, streams) in (1..).zip(&self.streams) {
            for (number, stream) in streams.iter().enumerate() {
                if stream.flags != 0 {
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
        let stream = &streams[number];
        Ok(match register {
            0x00 => stream.cr,
            0x04 => stream.count,
            0x08 => stream.peripheral,
            0x0c => stream.memory[0],
            0x10 => stream.memory[1],
            _ => stream.fcr | FIFO_EMPTY,
        })
    }

    /// Writes a register of controller 1 or 2.
    pub fn write(&mut self, controller: u8, offset: u32, value: u32) -> Result<(), Refusal> {
        let streams = &mut self.streams[index(controller)];
        match offset {
            0x00 | 0x04 => return Ok(()),
            0x08 | 0x0c => {
                for (stream, shift) in streams[offset as usize - 8..].iter_mut().zip(FLAG_SHIFT) {
                    stream.flags &= !(value >> shift & ALL_FLAGS);
                }
                return Ok(());
            }
            _ => {}
        }
        let (number, register) = stream_register(controller, offset)?;
        let stream = &mut streams[number];
        match register {
            0x00 => {
                let rises = !stream.enabled() && value & ENABLE != 0;
                stream.write_cr(value);
                if rises {
                    stream.check(controller, number)?;
                }
            }
            0x0c => stream.write_memory(0, value),
            0x10 => stream.write_memory(1, value),
            0x14 => stream.fcr = value & 0x87,
            // NDTR and PAR are read-only while the stream runs.
            _ if stream.enabled() => {}
            0x04 => stream.count = value & 0xffff,
            _ => stream.peripheral = value,
        }
        Ok(())
    }
}

impl Stream {
    fn write_cr(&mut self, value: u32) {
        let was_enabled = self.enabled();
        self.cr = if was_enabled {
            self.cr & !WRITABLE_WHILE_ENABLED | value & WRITABLE_WHILE_ENABLED
        } else {
            value & CR_WRITABLE
        };
        match (was_enabled, self.enabled()) {
            (false, true) => {
                self.programmed = self.count;
                self.offset = 0;
            }
            // The end of a stream is reported even if software ended it (RM0090 §10.3.14).
            (true, false) => self.flags |= TRANSFER_COMPLETE,
            _ => {}
        }
    }

    /// A running stream's target may be changed only if it is the other of two buffers
    /// (RM0090 §10.3.9).
    fn write_memory(&mut self, target: usize, value: u32) {
        let in_use =
            self.enabled() && (self.cr & DOUBLE_BUFFER == 0 || self.current_target() == target);
        if in_use {
            self.fail();
        } else {
            self.memory[target] = value;
        }
    }

    /// What a stream must satisfy when it is switched on, beyond what a driver can get right alone.
    fn check(&self, controller: u8, number: usize) -> Result<(), Refusal> {
        let refuse = |what| {
            Err(Refusal::UnmodelledMode {
                block: Block::Dma(controller),
                what,
                value: self.cr,
            })
        };
        if self.cr >> 6 & 3 > 1 {
            return refuse("memory-to-memory transfer");
        }
        if self.cr & (PERIPHERAL_FLOW | PERIPHERAL_INCREMENT) != 0 {
            return refuse("peripheral flow control or increment");
        }
        if self.memory.iter().any(|base| base % self.item_bytes() != 0) {
            return refuse("memory address not aligned to the item");
        }
        let stream = number as u8;
        let Some(request) = Request::at(controller, stream, self.channel()) else {
            return refuse("the request on this stream and channel");
        };
        if request.sends() != self.sends() {
            return refuse("a direction against the request's");
        }
        let data_register = request.data_register();
        if self.peripheral != data_register {
            return Err(Refusal::DmaAddress {
                controller,
                stream,
                peripheral_address: self.peripheral,
                data_register,
            });
        }
        Ok(())
    }
}

fn index(controller: u8) -> usize {
    usize::from(controller == 2)
}

fn flag_word(streams: &[Stream]) -> u32 {
    let flags = streams.iter().zip(FLAG_SHIFT);
    flags.fold(0, |word, (stream, shift)| word | stream.flags << shift)
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
