//! The registers a program sees (ARM DDI0403 §B1.4).

use super::code_cache::ItBlock;
use super::flags::Flags;
use super::instruction::SP;
use super::nvic::Masks;

/// CONTROL. Privilege is stored, but nothing is denied to unprivileged code.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Control {
    unprivileged: bool,
    process_stack: bool,
    /// FPCA: the current context uses the FPU, so its frames must hold the registers of it.
    pub float_active: bool,
}

/// General, floating-point and status registers.
#[derive(Clone, Debug)]
pub(super) struct Registers {
    /// R0 to R14 of the current context. The last is always zero: see [`PC`](super::instruction::PC).
    pub r: [u32; 16],
    /// S0 to S31
    pub s: [u32; 32],
    /// Address of the next instruction.
    pub pc: u32,
    pub flags: Flags,
    pub fpscr: u32,
    /// Only of code outside flash; the code cache unfolds the IT blocks of the flash.
    pub it_block: ItBlock,
    /// IPSR: the exception number, 0 in thread mode.
    pub exception: u8,
    pub masks: Masks,
    pub control: Control,
    /// The stack pointer not in use: of the process in handlers, and so on.
    other_sp: u32,
}

impl Registers {
    /// After reset: the main stack at `sp`, about to execute at `pc`.
    pub fn at_reset(sp: u32, pc: u32) -> Self {
        let mut r = [0; 16];
        r[usize::from(SP)] = sp & !3;
        r[14] = u32::MAX;
        Self {
            r,
            s: [0; 32],
            pc: pc & !1,
            flags: Flags::from_apsr(0),
            fpscr: 0,
            it_block: ItBlock::default(),
            exception: 0,
            masks: Masks::default(),
            control: Control::default(),
            other_sp: 0,
        }
    }

    /// APSR, IPSR and EPSR together.
    pub fn xpsr(&self) -> u32 {
        const THUMB: u32 = 1 << 24;
        self.flags.to_apsr() | self.it_block.to_xpsr() | THUMB | u32::from(self.exception)
    }

    pub fn set_xpsr(&mut self, xpsr: u32) {
        self.flags = Flags::from_apsr(xpsr);
        self.it_block = ItBlock::from_xpsr(xpsr);
        self.exception = xpsr as u8;
    }

    /// Whether an exception handler executes.
    pub fn in_handler(&self) -> bool {
        self.exception != 0
    }

    /// Whether R13 is the process stack pointer.
    pub fn on_process_stack(&self) -> bool {
        self.control.process_stack
    }

    /// Makes R13 the process (or the main) stack pointer.
    pub fn use_process_stack(&mut self, process: bool) {
        if self.control.process_stack != process {
            self.control.process_stack = process;
            std::mem::swap(&mut self.r[usize::from(SP)], &mut self.other_sp);
        }
    }

    fn stack_pointer(&mut self, process: bool) -> &mut u32 {
        if self.control.process_stack == process {
            &mut self.r[usize::from(SP)]
        } else {
            &mut self.other_sp
        }
    }

    /// MRS by the number of the special register (§B5.1.1); `None` where there is none.
    pub fn special(&mut self, number: u32) -> Option<u32> {
        let exception = u32::from(self.exception);
        Some(match number {
            0 | 2 => self.flags.to_apsr(),
            1 | 3 => self.flags.to_apsr() | exception,
            5 | 7 => exception,
            6 => 0,
            8 => *self.stack_pointer(false),
            9 => *self.stack_pointer(true),
            16 => self.masks.primask.into(),
            17 | 18 => self.masks.basepri.into(),
            19 => self.masks.faultmask.into(),
            20 => {
                u32::from(self.control.unprivileged)
                    | u32::from(self.control.process_stack) << 1
                    | u32::from(self.control.float_active) << 2
            }
            _ => return None,
        })
    }

    /// MSR. `mask` selects the halves of APSR. `None` where there is no such register.
    pub fn set_special(&mut self, number: u32, mask: u8, value: u32) -> Option<()> {
        match number {
            0..=3 => {
                let halves = [0, 0x000f_0000, 0xf800_0000, Flags::APSR];
                let written = halves[usize::from(mask & 3)];
                self.flags = Flags::from_apsr(self.flags.to_apsr() & !written | value & written);
            }
            5..=7 => {}
            8 => *self.stack_pointer(false) = value & !3,
            9 => *self.stack_pointer(true) = value & !3,
            16 => self.masks.primask = value & 1 != 0,
            17 => self.masks.basepri = value as u8 & 0xf0,
            18 => {
                let new = value as u8 & 0xf0;
                let current = self.masks.basepri;
                if new != 0 && (new < current || current == 0) {
                    self.masks.basepri = new;
                }
            }
            19 => self.masks.faultmask = value & 1 != 0,
            20 => {
                self.control.unprivileged = value & 1 != 0;
                self.control.float_active = value & 4 != 0;
                if !self.in_handler() {
                    self.use_process_stack(value & 2 != 0);
                }
            }
            _ => return None,
        }
        Some(())
    }
}
