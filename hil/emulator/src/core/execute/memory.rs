//! Loads and stores: RAM at once, everything else by its address.

use super::super::bus::{Bus, Width};
use super::super::private_bus::is_private;
use super::super::{Cause, Core};
use crate::memory::{FLASH, FLASH_BYTES, Memory};

impl Core {
    #[inline(always)]
    pub(super) fn load8(&mut self, memory: &mut Memory, bus: &mut dyn Bus, address: u32) -> u32 {
        match memory.sram_at(address) {
            Some(bytes) => u8::from_le_bytes(bytes).into(),
            None => self.load_elsewhere(memory, bus, address, Width::Byte),
        }
    }

    #[inline(always)]
    pub(super) fn load16(&mut self, memory: &mut Memory, bus: &mut dyn Bus, address: u32) -> u32 {
        match memory.sram_at(address) {
            Some(bytes) => u16::from_le_bytes(bytes).into(),
            None => self.load_elsewhere(memory, bus, address, Width::Half),
        }
    }

    #[inline(always)]
    pub(super) fn load32(&mut self, memory: &mut Memory, bus: &mut dyn Bus, address: u32) -> u32 {
        match memory.sram_at(address) {
            Some(bytes) => u32::from_le_bytes(bytes),
            None => self.load_elsewhere(memory, bus, address, Width::Word),
        }
    }

    #[inline(always)]
    pub(super) fn store8(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        value: u32,
    ) {
        match memory.sram_at_mut(address) {
            Some(bytes) => *bytes = (value as u8).to_le_bytes(),
            None => self.store_elsewhere(memory, bus, address, Width::Byte, value & 0xff),
        }
    }

    #[inline(always)]
    pub(super) fn store16(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        value: u32,
    ) {
        match memory.sram_at_mut(address) {
            Some(bytes) => *bytes = (value as u16).to_le_bytes(),
            None => self.store_elsewhere(memory, bus, address, Width::Half, value & 0xffff),
        }
    }

    #[inline(always)]
    pub(super) fn store32(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        value: u32,
    ) {
        match memory.sram_at_mut(address) {
            Some(bytes) => *bytes = value.to_le_bytes(),
            None => self.store_elsewhere(memory, bus, address, Width::Word, value),
        }
    }

    /// A constant next to the code: mostly in flash.
    #[inline(always)]
    pub(super) fn load_literal(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
    ) -> u32 {
        self.load_elsewhere(memory, bus, address, Width::Word)
    }

    /// A load from anywhere but SRAM.
    #[inline(never)]
    fn load_elsewhere(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
    ) -> u32 {
        let plain = match width {
            Width::Byte => memory.read8(address).map(u32::from),
            Width::Half => memory.read16(address).map(u32::from),
            Width::Word => memory.read32(address),
        };
        if let Some(value) = plain {
            if (address.wrapping_sub(FLASH) as usize) < FLASH_BYTES {
                self.cycles += self.accelerator.read_constant(address);
            }
            return value;
        }
        match self.load_register(memory, bus, address, width) {
            Ok(value) => value,
            Err(cause) => {
                self.fail(cause);
                0
            }
        }
    }

    /// A store to anywhere but SRAM.
    #[inline(never)]
    fn store_elsewhere(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
        value: u32,
    ) {
        let plain = match width {
            Width::Byte => memory.write8(address, value as u8),
            Width::Half => memory.write16(address, value as u16),
            Width::Word => memory.write32(address, value),
        };
        if plain.is_some() {
            return;
        }
        if let Err(cause) = self.store_register(memory, bus, address, width, value) {
            self.fail(cause);
        }
    }

    /// A load from a peripheral, the core's own or another, or from a bit-band alias.
    fn load_register(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
    ) -> Result<u32, Cause> {
        check_alignment(address, width)?;
        let write = false;
        if is_private(address) {
            let value = self.read_private(address, width);
            return value.ok_or(Cause::CoreRegister { address, write });
        }
        if let Some(bit) = BitBand::at(address) {
            let word = self.load_band(memory, bus, bit.word)?;
            return Ok(word >> bit.number & 1);
        }
        self.horizon = 0;
        let fault = Cause::BusFault { address, write };
        let value = bus
            .read(memory, self.cycles, address, width)
            .or(Err(fault))?;
        self.cycles += bus.delay(self.cycles, address, write);
        Ok(match width {
            Width::Byte => value & 0xff,
            Width::Half => value & 0xffff,
            Width::Word => value,
        })
    }

    fn store_register(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), Cause> {
        check_alignment(address, width)?;
        if is_private(address) {
            return self.write_private(address, width, value);
        }
        if let Some(bit) = BitBand::at(address) {
            let word = self.load_band(memory, bus, bit.word)?;
            let changed = word & !(1 << bit.number) | (value & 1) << bit.number;
            return self.store_band(memory, bus, bit.word, changed);
        }
        self.horizon = 0;
        let write = true;
        let fault = Cause::BusFault { address, write };
        bus.write(memory, self.cycles, address, width, value)
            .or(Err(fault))?;
        self.cycles += bus.delay(self.cycles, address, write);
        Ok(())
    }

    fn load_band(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
    ) -> Result<u32, Cause> {
        match memory.read32(address) {
            Some(word) => Ok(word),
            None => self.load_register(memory, bus, address, Width::Word),
        }
    }

    fn store_band(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        word: u32,
    ) -> Result<(), Cause> {
        match memory.write32(address, word) {
            Some(()) => Ok(()),
            None => self.store_register(memory, bus, address, Width::Word, word),
        }
    }
}

/// Peripherals and exclusive accesses take no unaligned addresses.
pub(in crate::core) fn check_alignment(address: u32, width: Width) -> Result<(), Cause> {
    let mask = match width {
        Width::Byte => 0,
        Width::Half => 1,
        Width::Word => 3,
    };
    if address & mask != 0 {
        return Err(Cause::Unaligned(address));
    }
    Ok(())
}

/// A bit of the first MiB of SRAM or peripherals, addressed as a word of its own (§B3.1, table B3-1;
/// RM0090 §2.3.3).
struct BitBand {
    /// The word that holds the bit.
    word: u32,
    number: u32,
}

impl BitBand {
    fn at(alias: u32) -> Option<Self> {
        let base = match alias >> 25 {
            0x11 => 0x2000_0000,
            0x21 => 0x4000_0000,
            _ => return None,
        };
        let bit = alias % 0x0200_0000 / 4;
        Some(Self {
            word: base + bit / 32 * 4,
            number: bit % 32,
        })
    }
}
