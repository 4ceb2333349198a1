//! What a debugger reads and writes of a core that stands still (ARM DDI0403 §C1.6).

use super::bus::{Bus, Width};
use super::execute::check_alignment;
use super::instruction::PC;
use super::private_bus::is_private;
use super::{Core, FpuControl};
use crate::memory::Memory;

/// A special register that a debugger names, by its number in MRS (§B5.1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Special {
    /// The main stack pointer.
    Msp = 8,
    /// The process stack pointer.
    Psp = 9,
    /// PRIMASK.
    Primask = 16,
    /// BASEPRI.
    Basepri = 17,
    /// FAULTMASK.
    Faultmask = 19,
    /// CONTROL.
    Control = 20,
}

/// Of xPSR: the number of the exception, which only its entry and its return change.
const IPSR: u32 = 0x1ff;

impl Core {
    /// A special register.
    pub fn special(&mut self, register: Special) -> u32 {
        self.registers.special(register as u32).unwrap_or(0)
    }

    /// Sets a special register.
    pub fn set_special(&mut self, register: Special, value: u32) {
        // Unknown ones do not exist in the type.
        let _ = self.registers.set_special(register as u32, 0, value);
        self.exceptions_changed();
    }

    /// Sets APSR and EPSR; the exception that is being handled stays.
    pub fn set_xpsr(&mut self, value: u32) {
        let exception = self.registers.xpsr() & IPSR;
        self.registers.set_xpsr(value & !IPSR | exception);
    }

    /// Sets an S register's bits, 0 to 31; others do not exist.
    pub fn set_float_register(&mut self, number: u8, value: u32) {
        if let Some(register) = self.registers.s.get_mut(usize::from(number)) {
            *register = value;
        }
    }

    /// FPSCR.
    pub fn fpscr(&self) -> u32 {
        self.registers.fpscr
    }

    /// Sets FPSCR. False: it asks for a mode that is not modelled, and nothing has changed.
    pub fn set_fpscr(&mut self, value: u32) -> bool {
        let models = FpuControl::models(value);
        if models {
            self.write_fpscr(value);
        }
        models
    }

    /// Whether the core handles an exception: its number.
    pub fn exception(&self) -> u8 {
        self.registers.exception
    }

    /// The address of the next instruction.
    pub(crate) fn pc(&self) -> u32 {
        self.register(PC)
    }

    /// Reads a peripheral, the core's own or another, as a load would, without taking time. `None`:
    /// nothing answers.
    pub(crate) fn peek(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
    ) -> Option<u32> {
        check_alignment(address, width).ok()?;
        if is_private(address) {
            return self.read_private(address, width);
        }
        bus.read(memory, self.cycles, address, width).ok()
    }

    /// Writes a peripheral as a store would, without taking time. `None`: nothing answers, or the
    /// value is not modelled.
    pub(crate) fn poke(
        &mut self,
        memory: &mut Memory,
        bus: &mut dyn Bus,
        address: u32,
        width: Width,
        value: u32,
    ) -> Option<()> {
        check_alignment(address, width).ok()?;
        if is_private(address) {
            return self.write_private(address, width, value).ok();
        }
        bus.write(memory, self.cycles, address, width, value).ok()
    }

    /// The code in flash is no longer what it was.
    pub(crate) fn forget_code(&mut self) {
        self.code.clear();
    }
}
