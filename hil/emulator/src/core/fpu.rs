//! Who owns the floating-point registers: access control and lazy stacking (ARM DDI0403 §B1.5.7,
//! §B3.2.20 to §B3.2.23).

use super::{Cause, Core, cycles};
use crate::memory::Memory;

/// CPACR: full access to coprocessors 10 and 11.
const FULL_ACCESS: u32 = 0xf << 20;
/// FPCCR
const ASPEN: u32 = 1 << 31;
const LSPEN: u32 = 1 << 30;
const LSPACT: u32 = 1 << 0;
/// FPSCR: alternative half precision, default NaN, flush to zero and rounding mode.
const MODES: u32 = 0x1f << 22;
/// FPSCR: the bits that exist.
const FPSCR: u32 = 0xf7c0_009f;
/// Words that a frame holds of the FPU: S0 to S15, FPSCR and one to keep the stack aligned.
const SAVED: usize = 16;

/// The registers that control the FPU.
#[derive(Clone, Debug)]
pub(super) struct FpuControl {
    cpacr: u32,
    /// ASPEN and LSPEN
    context: u32,
    /// FPCAR: where the interrupted context keeps room for its registers.
    address: u32,
    /// LSPACT: that room is not filled yet.
    save_pending: bool,
}

impl FpuControl {
    pub fn new() -> Self {
        Self {
            cpacr: 0,
            context: ASPEN | LSPEN,
            address: 0,
            save_pending: false,
        }
    }

    fn is_accessible(&self) -> bool {
        self.cpacr & FULL_ACCESS == FULL_ACCESS
    }

    pub fn cpacr(&self) -> u32 {
        self.cpacr
    }

    pub fn fpccr(&self) -> u32 {
        self.context | if self.save_pending { LSPACT } else { 0 }
    }

    pub fn fpcar(&self) -> u32 {
        self.address
    }

    /// Whether a floating-point mode is the only one that is modelled: IEEE 754, to nearest.
    pub fn models(fpscr: u32) -> bool {
        fpscr & MODES == 0
    }
}

impl Core {
    pub(super) fn write_cpacr(&mut self, value: u32) {
        self.fpu.cpacr = value & FULL_ACCESS;
        self.fpu_ready = false;
    }

    pub(super) fn write_fpccr(&mut self, value: u32) {
        self.fpu.context = value & (ASPEN | LSPEN);
        self.fpu.save_pending = value & LSPACT != 0;
        self.fpu_ready = false;
    }

    pub(super) fn write_fpcar(&mut self, value: u32) {
        self.fpu.address = value & !7;
    }

    /// VMSR
    pub(super) fn write_fpscr(&mut self, value: u32) {
        if !FpuControl::models(value) {
            return self.fail(Cause::FpuMode(value));
        }
        self.registers.fpscr = value & FPSCR;
    }

    /// Before the first floating-point instruction of a context: fills the frame of the interrupted
    /// one and claims the registers. Until something changes, [`fpu_ready`](Core::fpu_ready) tells
    /// that there is nothing to do. False: the run has stopped.
    #[cold]
    #[inline(never)]
    pub(super) fn prepare_fpu(&mut self, memory: &mut Memory) -> bool {
        if let Err(cause) = self.claim_float_registers(memory) {
            self.fail(cause);
            return false;
        }
        self.fpu_ready = true;
        true
    }

    fn claim_float_registers(&mut self, memory: &mut Memory) -> Result<(), Cause> {
        if !self.fpu.is_accessible() {
            return Err(Cause::FpuOff);
        }
        if std::mem::take(&mut self.fpu.save_pending) {
            self.save_float_registers(memory, self.fpu.address)?;
        }
        if self.fpu.context & ASPEN != 0 {
            self.registers.control.float_active = true;
        }
        Ok(())
    }

    /// On exception entry: the frame's room for the registers is at `address`.
    pub(super) fn stack_float_registers(
        &mut self,
        memory: &mut Memory,
        address: u32,
    ) -> Result<(), Cause> {
        if self.fpu.context & LSPEN == 0 {
            return self.save_float_registers(memory, address);
        }
        self.fpu.address = address;
        self.fpu.save_pending = true;
        Ok(())
    }

    /// On exception return: they are at `address`, unless nobody touched them.
    pub(super) fn unstack_float_registers(
        &mut self,
        memory: &Memory,
        address: u32,
    ) -> Result<(), Cause> {
        if std::mem::take(&mut self.fpu.save_pending) {
            return Ok(());
        }
        for register in 0..SAVED {
            self.registers.s[register] = read_frame(memory, word(address, register))?;
        }
        self.registers.fpscr = read_frame(memory, word(address, SAVED))? & FPSCR;
        self.cycles += cycles::FLOAT_FRAME;
        Ok(())
    }

    fn save_float_registers(&mut self, memory: &mut Memory, address: u32) -> Result<(), Cause> {
        let saved = &self.registers.s[..SAVED];
        for (at, value) in saved.iter().chain([&self.registers.fpscr]).enumerate() {
            write_frame(memory, word(address, at), *value)?;
        }
        self.cycles += cycles::FLOAT_FRAME;
        Ok(())
    }
}

fn word(address: u32, index: usize) -> u32 {
    address.wrapping_add(4 * index as u32)
}

/// Reads a word of an exception frame. Frames are in RAM or nowhere.
pub(super) fn read_frame(memory: &Memory, address: u32) -> Result<u32, Cause> {
    let write = false;
    memory
        .read32(address)
        .ok_or(Cause::BusFault { address, write })
}

/// Writes a word of an exception frame.
pub(super) fn write_frame(memory: &mut Memory, address: u32, value: u32) -> Result<(), Cause> {
    let write = true;
    memory
        .write32(address, value)
        .ok_or(Cause::BusFault { address, write })
}
