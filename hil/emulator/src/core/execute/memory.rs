//! Loads and stores: RAM at once, everything else by its address.

use super::super::bus::{Bus, Width};
use super::super::instruction::{Instruction, PC, SP};
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
        if plain.is_none() {
            if let Err(cause) = self.store_register(memory, bus, address, width, value) {
                self.fail(cause);
            }
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
        bus.read(memory, self.cycles, address, width)
            .map(|value| match width {
                Width::Byte => value & 0xff,
                Width::Half => value & 0xffff,
                Width::Word => value,
            })
            .or(Err(fault))
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
        let fault = Cause::BusFault {
            address,
            write: true,
        };
        bus.write(memory, self.cycles, address, width, value)
            .or(Err(fault))
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

    /// LDM and its like need aligned addresses. False: the run has stopped.
    #[inline(always)]
    fn aligned(&mut self, address: u32) -> bool {
        if address & 3 != 0 {
            self.fail(Cause::Unaligned(address));
            return false;
        }
        true
    }

    #[inline(never)]
    pub(super) fn load_double(&mut self, memory: &mut Memory, bus: &mut dyn Bus, i: Instruction) {
        let (address, base) = self.double_address(i);
        if !self.aligned(address) {
            return;
        }
        let first = self.load32(memory, bus, address);
        let second = self.load32(memory, bus, address.wrapping_add(4));
        if i.a & 2 != 0 {
            self.registers.r[usize::from(i.n & 15)] = base;
        }
        self.registers.r[usize::from(i.d & 15)] = first;
        self.registers.r[usize::from(i.m & 15)] = second;
    }

    #[inline(never)]
    pub(super) fn store_double(&mut self, memory: &mut Memory, bus: &mut dyn Bus, i: Instruction) {
        let (address, base) = self.double_address(i);
        if !self.aligned(address) {
            return;
        }
        let first = self.registers.r[usize::from(i.d & 15)];
        let second = self.registers.r[usize::from(i.m & 15)];
        self.store32(memory, bus, address, first);
        self.store32(memory, bus, address.wrapping_add(4), second);
        if i.a & 2 != 0 {
            self.registers.r[usize::from(i.n & 15)] = base;
        }
    }

    /// The address of a double transfer and what would be written back.
    #[inline(always)]
    fn double_address(&self, i: Instruction) -> (u32, u32) {
        let base = self.registers.r[usize::from(i.n & 15)];
        let sum = base.wrapping_add(i.immediate);
        // Without write-back there is no post-indexing.
        if i.a & 1 != 0 {
            (sum, sum)
        } else {
            (base, sum)
        }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, memory: &mut Memory, bus: &mut dyn Bus, list: u32) {
        let sp = self.registers.r[usize::from(SP)].wrapping_sub(4 * list.count_ones());
        if self.aligned(sp) {
            self.store_list(memory, bus, list, sp);
            self.registers.r[usize::from(SP)] = sp;
        }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self, memory: &mut Memory, bus: &mut dyn Bus, list: u32) {
        let sp = self.registers.r[usize::from(SP)];
        if self.aligned(sp) {
            self.registers.r[usize::from(SP)] = sp.wrapping_add(4 * list.count_ones());
            self.load_list(memory, bus, list, sp);
        }
    }

    #[inline(never)]
    pub(super) fn load_multiple(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        i: Instruction,
    ) {
        let (address, base) = self.multiple_address(i);
        if !self.aligned(address) {
            return;
        }
        if i.a & 1 != 0 {
            self.registers.r[usize::from(i.n & 15)] = base;
        }
        self.load_list(memory, bus, i.immediate, address);
    }

    #[inline(never)]
    pub(super) fn store_multiple(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        i: Instruction,
    ) {
        let (address, base) = self.multiple_address(i);
        if !self.aligned(address) {
            return;
        }
        self.store_list(memory, bus, i.immediate, address);
        if i.a & 1 != 0 {
            self.registers.r[usize::from(i.n & 15)] = base;
        }
    }

    /// The lowest address of a multiple transfer and what would be written back.
    #[inline(always)]
    fn multiple_address(&self, i: Instruction) -> (u32, u32) {
        let base = self.registers.r[usize::from(i.n & 15)];
        let bytes = 4 * i.immediate.count_ones();
        if i.a & 2 != 0 {
            let lowest = base.wrapping_sub(bytes);
            (lowest, lowest)
        } else {
            (base, base.wrapping_add(bytes))
        }
    }

    /// Loads the registers of a list in order; the program counter, if in it, comes last.
    #[inline(always)]
    fn load_list(&mut self, memory: &mut Memory, bus: &mut dyn Bus, list: u32, mut address: u32) {
        let mut general = list & !(1 << PC);
        while general != 0 {
            let register = general.trailing_zeros();
            general &= general - 1;
            self.registers.r[register as usize & 15] = self.load32(memory, bus, address);
            address = address.wrapping_add(4);
        }
        if list & 1 << PC != 0 {
            let target = self.load32(memory, bus, address);
            self.branch_exchange(memory, target);
        }
    }

    #[inline(always)]
    fn store_list(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        mut list: u32,
        mut address: u32,
    ) {
        while list != 0 {
            let register = list.trailing_zeros();
            list &= list - 1;
            self.store32(
                memory,
                bus,
                address,
                self.registers.r[register as usize & 15],
            );
            address = address.wrapping_add(4);
        }
    }

    /// VLDM, VSTM, VPUSH, VPOP
    #[inline(never)]
    pub(super) fn float_multiple(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        i: Instruction,
    ) {
        let base = self.registers.r[usize::from(i.n & 15)];
        let (address, updated) = if i.a & 2 != 0 {
            let lowest = base.wrapping_sub(i.immediate);
            (lowest, lowest)
        } else {
            (base, base.wrapping_add(i.immediate))
        };
        if i.a & 1 != 0 {
            self.registers.r[usize::from(i.n & 15)] = updated;
        }
        if i.operation == super::super::instruction::Operation::Vldm {
            self.load_floats(memory, bus, address, i.d, i.m);
        } else {
            self.store_floats(memory, bus, address, i.d, i.m);
        }
    }

    /// Loads `count` S registers from `first` on.
    #[inline]
    pub(super) fn load_floats(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        mut address: u32,
        first: u8,
        count: u8,
    ) {
        if !self.aligned(address) {
            return;
        }
        for register in first..first + count {
            self.registers.s[usize::from(register & 31)] = self.load32(memory, bus, address);
            address = address.wrapping_add(4);
        }
    }

    /// Stores `count` S registers from `first` on.
    #[inline]
    pub(super) fn store_floats(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        mut address: u32,
        first: u8,
        count: u8,
    ) {
        if !self.aligned(address) {
            return;
        }
        for register in first..first + count {
            let value = self.registers.s[usize::from(register & 31)];
            self.store32(memory, bus, address, value);
            address = address.wrapping_add(4);
        }
    }

    /// LDREX. The monitor of a Cortex-M4 does not look at addresses (DDI0439 §3.9).
    #[inline(never)]
    pub(super) fn load_exclusive(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
    ) -> u32 {
        if let Err(cause) = check_alignment(address, width) {
            self.fail(cause);
            return 0;
        }
        self.exclusive = true;
        match width {
            Width::Byte => self.load8(memory, bus, address),
            Width::Half => self.load16(memory, bus, address),
            Width::Word => self.load32(memory, bus, address),
        }
    }

    /// STREX. Returns 0 where it stored, 1 where the monitor was open.
    #[inline(never)]
    pub(super) fn store_exclusive(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        i: Instruction,
        width: Width,
    ) -> u32 {
        let address = self.registers.r[usize::from(i.n & 15)].wrapping_add(i.immediate);
        let value = self.registers.r[usize::from(i.m & 15)];
        if let Err(cause) = check_alignment(address, width) {
            self.fail(cause);
            return 1;
        }
        if !std::mem::take(&mut self.exclusive) {
            return 1;
        }
        match width {
            Width::Byte => self.store8(memory, bus, address, value),
            Width::Half => self.store16(memory, bus, address, value),
            Width::Word => self.store32(memory, bus, address, value),
        }
        0
    }
}

/// Peripherals and exclusive accesses take no unaligned addresses.
fn check_alignment(address: u32, width: Width) -> Result<(), Cause> {
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
