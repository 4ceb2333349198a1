//! The private peripheral bus: addresses of the core's own registers (ARM DDI0403 §B3.1).

use super::bus::Width;
use super::dwt::Dwt;
use super::nvic::{WORDS, exception};
use super::{Cause, Core};

/// The first register; the bus is 64 KiB.
const PRIVATE_BUS: u32 = 0xe000_0000;

/// Offsets from [`PRIVATE_BUS`].
mod offset {
    pub const DWT_CTRL: u32 = 0x1000;
    pub const DWT_CYCCNT: u32 = 0x1004;
    /// The debug unit's write lock: open, whatever is written.
    pub const DWT_LAR: u32 = 0x1fb0;
    pub const DWT_LSR: u32 = 0x1fb4;
    pub const ICTR: u32 = 0xe004;
    pub const ACTLR: u32 = 0xe008;
    pub const SYST_CSR: u32 = 0xe010;
    pub const SYST_RVR: u32 = 0xe014;
    pub const SYST_CVR: u32 = 0xe018;
    pub const SYST_CALIB: u32 = 0xe01c;
    pub const NVIC_ISER: u32 = 0xe100;
    pub const NVIC_ICER: u32 = 0xe180;
    pub const NVIC_ISPR: u32 = 0xe200;
    pub const NVIC_ICPR: u32 = 0xe280;
    pub const NVIC_IABR: u32 = 0xe300;
    pub const NVIC_IPR: u32 = 0xe400;
    pub const NVIC_IPR_END: u32 = NVIC_IPR + 32 * super::WORDS as u32 - 1;
    pub const CPUID: u32 = 0xed00;
    pub const ICSR: u32 = 0xed04;
    pub const VTOR: u32 = 0xed08;
    pub const AIRCR: u32 = 0xed0c;
    pub const SCR: u32 = 0xed10;
    pub const CCR: u32 = 0xed14;
    pub const SHPR: u32 = 0xed18;
    pub const SHPR_END: u32 = SHPR + 11;
    pub const SHCSR: u32 = 0xed24;
    /// CFSR, HFSR, DFSR, MMFAR, BFAR and AFSR: no fault is ever recorded.
    pub const FAULT_STATUS: u32 = 0xed28;
    pub const FAULT_STATUS_END: u32 = 0xed3f;
    pub const CPACR: u32 = 0xed88;
    pub const MPU_TYPE: u32 = 0xed90;
    pub const MPU_CTRL: u32 = 0xed94;
    pub const DHCSR: u32 = 0xedf0;
    pub const DEMCR: u32 = 0xedfc;
    pub const STIR: u32 = 0xef00;
    pub const FPCCR: u32 = 0xef34;
    pub const FPCAR: u32 = 0xef38;
    pub const FPDSCR: u32 = 0xef3c;
    pub const MVFR0: u32 = 0xef40;
    pub const MVFR1: u32 = 0xef44;
}
use offset::*;

/// Cortex-M4 r0p1.
const CPUID_VALUE: u32 = 0x410f_c241;
/// 18 750 ticks, inexact: 1 ms of HCLK / 8 at 150 MHz (RM0090 §12.1.2).
const SYST_CALIB_VALUE: u32 = 0x4000_493e;
/// Eight regions, none of which can be switched on here.
const MPU_TYPE_VALUE: u32 = 0x800;
/// Single precision with division and square root; sixteen double registers.
const MVFR0_VALUE: u32 = 0x1011_0021;
/// Fused multiply-add, half-precision conversion, default NaN and flush to zero.
const MVFR1_VALUE: u32 = 0x1100_0011;
/// The exception whose priority is in the first byte of SHPR.
const SHPR_FIRST: u32 = 4;

/// Whether an address belongs to the private bus.
#[inline]
pub(super) fn is_private(address: u32) -> bool {
    address >> 16 == PRIVATE_BUS >> 16
}

/// The number of a word in a bank of [`WORDS`] registers, if the offset is in it.
fn bank(offset: u32, first: u32) -> Option<usize> {
    let word = (offset.wrapping_sub(first) / 4) as usize;
    (word < WORDS).then_some(word)
}

impl Core {
    /// Reads a register of the core. Only those with byte-wide fields may be read in parts.
    pub(super) fn read_private(&mut self, address: u32, width: Width) -> Option<u32> {
        let shift = address % 4 * 8;
        let word = self.read_private_word((address % 0x1_0000) & !3)? >> shift;
        Some(match width {
            Width::Byte => word & 0xff,
            Width::Half => word & 0xffff,
            Width::Word => word,
        })
    }

    fn read_private_word(&mut self, offset: u32) -> Option<u32> {
        Some(match offset {
            DWT_CTRL => self.dwt.control(),
            DWT_CYCCNT => self.dwt.count(self.cycles),
            ICTR => WORDS as u32 - 1,
            ACTLR => self.scb.actlr,
            SYST_CSR => {
                self.advance_systick();
                self.exceptions_changed();
                self.systick.read_control()
            }
            SYST_RVR => self.systick.reload(),
            SYST_CVR => {
                self.advance_systick();
                self.exceptions_changed();
                self.systick.current(self.cycles)
            }
            SYST_CALIB => SYST_CALIB_VALUE,
            NVIC_ISER..=NVIC_IPR_END => return self.read_nvic(offset),
            CPUID => CPUID_VALUE,
            ICSR => self.interrupt_control_state(),
            VTOR => self.scb.vtor(),
            AIRCR => self.reset_control(),
            SCR => self.scb.scr(),
            CCR => self.scb.ccr(),
            SHPR..=SHPR_END => return self.priorities(offset - SHPR + SHPR_FIRST),
            SHCSR => self.scb.shcsr,
            FAULT_STATUS..=FAULT_STATUS_END => 0,
            CPACR => self.fpu.cpacr(),
            MPU_TYPE => MPU_TYPE_VALUE,
            DWT_LSR | MPU_CTRL | DHCSR | FPDSCR => 0,
            DEMCR => self.dwt.demcr(),
            FPCCR => self.fpu.fpccr(),
            FPCAR => self.fpu.fpcar(),
            MVFR0 => MVFR0_VALUE,
            MVFR1 => MVFR1_VALUE,
            _ => return None,
        })
    }

    fn read_nvic(&self, offset: u32) -> Option<u32> {
        if let NVIC_IPR..=NVIC_IPR_END = offset {
            let first = u32::from(exception::FIRST_INTERRUPT);
            return self.priorities(offset - NVIC_IPR + first);
        }
        let nvic = &self.nvic;
        if let Some(word) = bank(offset, NVIC_ISER).or(bank(offset, NVIC_ICER)) {
            return Some(nvic.enabled[word]);
        }
        if let Some(word) = bank(offset, NVIC_ISPR).or(bank(offset, NVIC_ICPR)) {
            return Some(nvic.pending_word(word));
        }
        bank(offset, NVIC_IABR).map(|word| nvic.active_word(word))
    }

    /// Four priorities in a word.
    fn priorities(&self, first: u32) -> Option<u32> {
        let mut bytes = [0; 4];
        for (exception, byte) in (first as usize..).zip(&mut bytes) {
            *byte = self.nvic.priority(exception)?;
        }
        Some(u32::from_le_bytes(bytes))
    }

    /// Writes a register of the core, and stops the run where that has an effect on the schedule.
    pub(super) fn write_private(
        &mut self,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), Cause> {
        let offset = address % 0x1_0000;
        let bytes = match width {
            Width::Byte => 1,
            Width::Half => 2,
            Width::Word => 4,
        };
        let priorities = match offset {
            NVIC_IPR..=NVIC_IPR_END => {
                Some(offset - NVIC_IPR + u32::from(exception::FIRST_INTERRUPT))
            }
            SHPR..=SHPR_END => Some(offset - SHPR + SHPR_FIRST),
            _ => None,
        };
        if let Some(first) = priorities {
            let values = value.to_le_bytes().into_iter().take(bytes);
            for (exception, priority) in (first as usize..).zip(values) {
                self.nvic.set_priority(exception, priority);
            }
        } else if width != Width::Word || !self.write_private_word(offset, value)? {
            let write = true;
            return Err(Cause::CoreRegister { address, write });
        }
        self.horizon = 0;
        Ok(())
    }

    /// False: no such register, or a value that is not modelled.
    fn write_private_word(&mut self, offset: u32, value: u32) -> Result<bool, Cause> {
        match offset {
            DWT_CTRL => return Ok(self.dwt.set_control(self.cycles, value)),
            DWT_CYCCNT => Dwt::set_count(&mut self.dwt, self.cycles, value),
            ACTLR => self.scb.actlr = value,
            SYST_CSR | SYST_RVR | SYST_CVR => {
                self.advance_systick();
                match offset {
                    SYST_CSR => self.systick.write_control(self.cycles, value),
                    SYST_RVR => self.systick.write_reload(self.cycles, value),
                    _ => self.systick.clear_current(self.cycles),
                }
            }
            NVIC_ISER..NVIC_IABR => return Ok(self.write_nvic(offset, value).is_some()),
            ICSR => self.write_interrupt_control_state(value),
            VTOR => self.scb.set_vtor(value),
            AIRCR => self.write_reset_control(value)?,
            SCR => return Ok(self.scb.set_scr(value)),
            CCR => return Ok(self.scb.set_ccr(value)),
            SHCSR => return Ok(self.scb.set_shcsr(value)),
            DWT_LAR | FAULT_STATUS..=FAULT_STATUS_END => {}
            CPACR => self.write_cpacr(value),
            MPU_CTRL | FPDSCR => return Ok(value == 0),
            DEMCR => self.dwt.set_demcr(self.cycles, value),
            STIR => {
                let irq = value & 0x1ff;
                let Some(word) = bank(irq / 32 * 4, 0) else {
                    return Ok(false);
                };
                self.nvic.set_pending(word, 1 << (irq % 32));
            }
            FPCCR => self.write_fpccr(value),
            FPCAR => self.write_fpcar(value),
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn write_nvic(&mut self, offset: u32, bits: u32) -> Option<()> {
        if let Some(word) = bank(offset, NVIC_ISER) {
            self.nvic.enable(word, bits);
        } else if let Some(word) = bank(offset, NVIC_ICER) {
            self.nvic.disable(word, bits);
        } else if let Some(word) = bank(offset, NVIC_ISPR) {
            self.nvic.set_pending(word, bits);
        } else {
            let word = bank(offset, NVIC_ICPR)?;
            self.nvic.clear_pending(word, bits);
        }
        Some(())
    }
}
