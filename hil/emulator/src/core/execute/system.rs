//! Special registers, interrupt masks and traps.

use super::super::instruction::Instruction;
use super::super::{Cause, Core};

impl Core {
    /// MRS
    #[inline(never)]
    pub(super) fn read_special(&mut self, i: Instruction) {
        match self.registers.special(i.immediate) {
            Some(value) => self.registers.r[usize::from(i.d & 15)] = value,
            None => self.fail(Cause::SpecialRegister(i.immediate as u8)),
        }
    }

    /// MSR
    #[inline(never)]
    pub(super) fn write_special(&mut self, i: Instruction) {
        let value = self.registers.r[usize::from(i.n & 15)];
        if self
            .registers
            .set_special(i.immediate, i.a, value)
            .is_none()
        {
            return self.fail(Cause::SpecialRegister(i.immediate as u8));
        }
        self.fpu_ready = false;
        self.exceptions_changed();
    }

    /// CPSIE and CPSID
    #[inline(never)]
    pub(super) fn change_masks(&mut self, i: Instruction) {
        const FAULTMASK: u32 = 1;
        const PRIMASK: u32 = 2;
        let disable = i.d != 0;
        let masks = &mut self.registers.masks;
        if i.immediate & PRIMASK != 0 {
            masks.primask = disable;
        }
        if i.immediate & FAULTMASK != 0 {
            masks.faultmask = disable;
        }
        if !disable {
            self.exceptions_changed();
        }
    }

    /// The quotient of a division by zero, where that is not a trap.
    #[cold]
    pub(super) fn divided_by_zero(&mut self) -> u32 {
        if self.scb.traps_division_by_zero() {
            self.fail(Cause::DivisionByZero);
        }
        0
    }
}
