//! The system control block (ARM DDI0403 §B3.2): where the vectors are, how the core sleeps and
//! stacks.

use super::nvic::exception;
use super::{Cause, Core};

const SCR_SLEEPONEXIT: u32 = 1 << 1;
const SCR_SLEEPDEEP: u32 = 1 << 2;
const SCR_SEVONPEND: u32 = 1 << 4;
const CCR_NONBASETHRDENA: u32 = 1 << 0;
const CCR_USERSETMPEND: u32 = 1 << 1;
const CCR_DIV_0_TRP: u32 = 1 << 4;
const CCR_BFHFNMIGN: u32 = 1 << 8;
const CCR_STKALIGN: u32 = 1 << 9;
/// SHCSR: which faults have handlers of their own. Kept, although no fault is ever taken.
const SHCSR_ENABLES: u32 = 7 << 16;
/// AIRCR: without this key a write has no effect.
const VECTKEY: u32 = 0x05fa;
const VECTKEYSTAT: u32 = 0xfa05;
const AIRCR_SYSRESETREQ: u32 = 1 << 2;

/// The registers of the block that are nothing but settings.
#[derive(Clone, Debug)]
pub(super) struct SystemControl {
    vtor: u32,
    scr: u32,
    ccr: u32,
    pub shcsr: u32,
    pub actlr: u32,
}

impl SystemControl {
    pub fn new() -> Self {
        Self {
            vtor: 0,
            scr: 0,
            ccr: CCR_STKALIGN,
            shcsr: 0,
            actlr: 0,
        }
    }

    /// The address of an exception's vector.
    pub fn vector(&self, exception: u8) -> u32 {
        self.vtor.wrapping_add(4 * u32::from(exception))
    }

    pub fn sleeps_on_exit(&self) -> bool {
        self.scr & SCR_SLEEPONEXIT != 0
    }

    pub fn sends_event_on_pend(&self) -> bool {
        self.scr & SCR_SEVONPEND != 0
    }

    /// A handler may return to thread mode although others are active.
    pub fn allows_early_thread(&self) -> bool {
        self.ccr & CCR_NONBASETHRDENA != 0
    }

    /// Exception frames are aligned to 8 bytes.
    pub fn aligns_stack(&self) -> bool {
        self.ccr & CCR_STKALIGN != 0
    }

    pub fn traps_division_by_zero(&self) -> bool {
        self.ccr & CCR_DIV_0_TRP != 0
    }

    pub fn vtor(&self) -> u32 {
        self.vtor
    }

    /// STM32F4 tables are aligned to 512 bytes (PM0214 §4.4.4).
    pub fn set_vtor(&mut self, value: u32) {
        self.vtor = value & 0x3fff_fe00;
    }

    pub fn scr(&self) -> u32 {
        self.scr
    }

    /// False: deep sleep, which stops the clocks, is not modelled.
    pub fn set_scr(&mut self, value: u32) -> bool {
        self.scr = value & (SCR_SLEEPONEXIT | SCR_SEVONPEND);
        value & SCR_SLEEPDEEP == 0
    }

    pub fn ccr(&self) -> u32 {
        self.ccr
    }

    /// False: it asks for traps that are not modelled.
    pub fn set_ccr(&mut self, value: u32) -> bool {
        const MODELLED: u32 =
            CCR_NONBASETHRDENA | CCR_USERSETMPEND | CCR_DIV_0_TRP | CCR_BFHFNMIGN | CCR_STKALIGN;
        self.ccr = value & MODELLED;
        value & !MODELLED == 0
    }

    /// False: it changes the state of faults.
    pub fn set_shcsr(&mut self, value: u32) -> bool {
        self.shcsr = value & SHCSR_ENABLES;
        value & !SHCSR_ENABLES == 0
    }
}

impl Core {
    /// ICSR
    pub(super) fn interrupt_control_state(&self) -> u32 {
        let bit = |pending: bool, number: u32| u32::from(pending) << number;
        let next = self.nvic.highest_pending().unwrap_or(0);
        u32::from(self.registers.exception)
            | bit(self.nvic.depth() == 1, 11)
            | u32::from(next) << 12
            | bit(self.nvic.interrupt_pending(), 22)
            | bit(self.nvic.is_pending(exception::SYSTICK), 26)
            | bit(self.nvic.is_pending(exception::PENDSV), 28)
            | bit(self.nvic.is_pending(exception::NMI), 31)
    }

    /// ICSR
    pub(super) fn write_interrupt_control_state(&mut self, value: u32) {
        let changes = [
            (31, exception::NMI, true),
            (28, exception::PENDSV, true),
            (27, exception::PENDSV, false),
            (26, exception::SYSTICK, true),
            (25, exception::SYSTICK, false),
        ];
        for (bit, exception, pend) in changes {
            if value >> bit & 1 == 0 {
                continue;
            }
            if pend {
                self.pend(exception);
            } else {
                self.nvic.unpend(exception);
            }
        }
    }

    /// AIRCR
    pub(super) fn reset_control(&self) -> u32 {
        VECTKEYSTAT << 16 | self.nvic.priority_group << 8
    }

    /// AIRCR
    pub(super) fn write_reset_control(&mut self, value: u32) -> Result<(), Cause> {
        if value >> 16 != VECTKEY {
            return Ok(());
        }
        self.nvic.priority_group = value >> 8 & 7;
        if value & AIRCR_SYSRESETREQ != 0 {
            return Err(Cause::ResetRequested);
        }
        Ok(())
    }
}
