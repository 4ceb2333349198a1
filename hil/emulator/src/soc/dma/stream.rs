//! One stream: its registers, and an item moved.

use super::request::Request;
use crate::memory::{CCM, CCM_BYTES, Memory};
use crate::soc::map::Block;
use crate::soc::refusal::Refusal;

const CR: u32 = 0x00;
const NDTR: u32 = 0x04;
const PAR: u32 = 0x08;
const M0AR: u32 = 0x0c;
const M1AR: u32 = 0x10;
const FCR: u32 = 0x14;

/// CR.
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
/// Bytes of the longest item.
const WORD: u32 = 4;
/// S_FCR.FS: the FIFO is empty.
const FIFO_EMPTY: u32 = 4 << 3;
const FCR_RESET: u32 = 0x21;
/// FTH, DMDIS and FEIE.
const FCR_WRITABLE: u32 = 0x87;

/// One stream's registers.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    cr: u32,
    /// Items left (NDTR).
    count: u32,
    /// Items programmed: what a circular stream reloads.
    programmed: u32,
    /// Bytes behind the current memory address.
    offset: u32,
    peripheral: u32,
    memory: [u32; 2],
    fcr: u32,
    /// Its flags in ISR, at the places of stream 0.
    flags: u32,
}

impl Stream {
    /// The reset state.
    pub const RESET: Self = Self {
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

    /// True if the stream is ready to serve the requests of `channel`.
    pub fn serves(&self, channel: u8) -> bool {
        self.enabled() && self.channel() == channel && self.count > 0
    }

    /// Items left.
    pub fn remaining(&self) -> u32 {
        self.count
    }

    /// Whether the item that was moved last was the last of its transfer.
    pub fn is_between_transfers(&self) -> bool {
        self.count == 0 || self.count == self.programmed
    }

    /// Moves one item to memory. False: the bus refused, and the stream stopped.
    pub fn accept(&mut self, memory: &mut Memory, item: u32) -> bool {
        let done = self.store(memory, item).is_some();
        self.account(done);
        done
    }

    /// Moves whole words of `bytes` to memory as [`accept`](Self::accept) would, up to the one before
    /// which a flag rises or the bus may refuse. Returns the bytes that were moved.
    pub fn accept_words(&mut self, memory: &mut Memory, bytes: &[u8]) -> usize {
        if self.item_bytes() != WORD || self.cr & MEMORY_INCREMENT == 0 {
            return 0;
        }
        let half = self.programmed / 2;
        let to_flag = if self.count > half {
            self.count - half
        } else {
            self.count
        };
        let words = (bytes.len() as u32 / WORD).min(to_flag.saturating_sub(1));
        let moved = (words * WORD) as usize;
        let Some(room) = memory.sram_mut(self.address(), moved) else {
            return 0;
        };
        room.copy_from_slice(&bytes[..moved]);
        self.offset = self.offset.wrapping_add(words * WORD);
        self.count -= words;
        moved
    }

    /// Moves one item from memory. `None`: the bus refused, and the stream stopped.
    pub fn supply(&mut self, memory: &Memory) -> Option<u32> {
        let item = self.load(memory);
        self.account(item.is_some());
        item
    }

    /// The bus refuses the transfer that is under way, if any is.
    pub fn refuse(&mut self) {
        if self.enabled() {
            self.fail();
        }
    }

    /// The stream's flags in ISR.
    pub fn flags(&self) -> u32 {
        self.flags
    }

    /// Clears flags as IFCR does.
    pub fn clear(&mut self, flags: u32) {
        self.flags &= !(flags & ALL_FLAGS);
    }

    /// The level of the stream's interrupt line.
    pub fn interrupts(&self) -> bool {
        self.flags & (self.cr & INTERRUPT_ENABLES) << 1 != 0
    }

    /// Reads the register at `offset` of the stream's own.
    pub fn read(&self, offset: u32) -> u32 {
        match offset {
            CR => self.cr,
            NDTR => self.count,
            PAR => self.peripheral,
            M0AR => self.memory[0],
            M1AR => self.memory[1],
            _ => self.fcr | FIFO_EMPTY,
        }
    }

    /// Writes the register at `offset` of the stream's own. `slot` is the place of the stream.
    pub fn write(&mut self, offset: u32, value: u32, slot: (u8, u8)) -> Result<(), Refusal> {
        match offset {
            CR => {
                let rises = !self.enabled() && value & ENABLE != 0;
                self.write_cr(value);
                if rises {
                    self.check(slot)?;
                }
            }
            M0AR => self.write_memory(0, value),
            M1AR => self.write_memory(1, value),
            FCR => self.fcr = value & FCR_WRITABLE,
            // NDTR and PAR are read-only while the stream runs.
            _ if self.enabled() => {}
            NDTR => self.count = value & 0xffff,
            _ => self.peripheral = value,
        }
        Ok(())
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

    /// The bus answered with an error: the stream stops (RM0090 §10.3.18).
    fn fail(&mut self) {
        self.cr &= !ENABLE;
        self.flags |= TRANSFER_ERROR;
    }

    fn account(&mut self, moved: bool) {
        if moved {
            self.count_down();
        } else {
            self.fail();
        }
    }

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
    fn check(&self, (controller, stream): (u8, u8)) -> Result<(), Refusal> {
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

/// The core-coupled memory is on the core's data bus alone (RM0090 §2.1, figure 5).
fn reachable(address: u32) -> Option<u32> {
    let outside = address.wrapping_sub(CCM) as usize >= CCM_BYTES;
    outside.then_some(address)
}
