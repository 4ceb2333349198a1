//! Transfers of several words, and exclusive ones.

use super::super::bus::{Bus, Width};
use super::super::instruction::{Instruction, Operation, PC, SP};
use super::super::{Cause, Core};
use super::memory::check_alignment;
use crate::memory::Memory;

impl Core {
    /// LDM and its like need aligned addresses. False: the run has stopped.
    #[inline(always)]
    pub(super) fn aligned(&mut self, address: u32) -> bool {
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
    pub(super) fn load_multiple(&mut self, memory: &mut Memory, bus: &mut dyn Bus, i: Instruction) {
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
        if i.operation == Operation::Vldm {
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
