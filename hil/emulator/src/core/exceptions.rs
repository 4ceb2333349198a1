//! Entering and leaving exceptions (ARM DDI0403 §B1.5.6 to §B1.5.8), and sleep.

use super::fpu::{read_frame, write_frame};
use super::instruction::{LR, SP};
use super::nvic::exception;
use super::{Cause, Core, Cycle, cycles};
use crate::memory::Memory;
use crate::trace::What;

/// R0 to R3, R12, LR, return address, xPSR.
const BASIC_FRAME: u32 = 0x20;
/// The same, S0 to S15, FPSCR and a word of padding.
const FLOAT_FRAME: u32 = 0x68;
/// In a stacked xPSR: a word was skipped to align the frame to 8 bytes.
const SKIPPED_WORD: u32 = 1 << 9;
/// The lowest value that a branch in a handler takes for an exception return.
const EXC_RETURN: u32 = 0xf000_0000;

/// EXC_RETURN (table B1-8): what to return to.
mod exc_return {
    /// To thread mode, not to another handler.
    pub const THREAD: u32 = 1 << 3;
    /// With a frame on the process stack.
    pub const PROCESS_STACK: u32 = 1 << 2;
    /// With a frame that has no room for floating-point registers.
    pub const BASIC_FRAME: u32 = 1 << 4;
    /// The bits that are always set.
    pub const BASE: u32 = 0xffff_ffe1;
}

/// Whether instructions execute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sleep {
    Awake,
    /// WFE
    ForEvent,
    /// WFI, or sleep-on-exit
    ForInterrupt,
}

impl Core {
    /// Drives one of the 82 interrupt inputs. A rising level makes it pending; a level that is still
    /// high when the handler returns makes it pending again. Cheap when nothing changed.
    pub fn set_interrupt_line(&mut self, irq: u8, level: bool) {
        if self.nvic.set_line(irq, level) && self.scb.sends_event_on_pend() {
            self.event = true;
        }
    }

    pub(super) fn pend(&mut self, exception: u8) {
        self.event |= self.scb.sends_event_on_pend() && !self.nvic.is_pending(exception);
        self.nvic.pend(exception);
    }

    /// Brings SysTick to the current cycle.
    pub(super) fn advance_systick(&mut self) {
        if self.systick.advance(self.cycles) {
            self.pend(exception::SYSTICK);
        }
    }

    /// When SysTick makes its exception pending next.
    pub fn next_systick(&self) -> Option<Cycle> {
        self.systick.next_exception()
    }

    /// Advances SysTick to now, then enters the highest pending exception that may preempt.
    /// A stacking fault is reported by the next [`run`](Self::run).
    pub fn take_pending_exceptions(&mut self, memory: &mut Memory) {
        self.advance_systick();
        if let Some(exception) = self.nvic.preempting(self.registers.masks) {
            let entered = self.enter(memory, exception);
            self.fault = self.fault.or(entered.err());
        }
    }

    fn enter(&mut self, memory: &mut Memory, exception: u8) -> Result<(), Cause> {
        self.trace
            .note(self.cycles, What::ExceptionEntered(exception));
        let link = self.push_frame(memory)?;
        self.cycles += cycles::EXCEPTION_ENTRY;
        self.begin_handler(memory, exception, link)
    }

    /// Stacks the interrupted context. Returns the EXC_RETURN that leads back to it.
    fn push_frame(&mut self, memory: &mut Memory) -> Result<u32, Cause> {
        let float = self.registers.control.float_active;
        let sp = self.registers.r[usize::from(SP)];
        let aligns = float || self.scb.aligns_stack();
        let (size, alignment) = match (float, aligns) {
            (true, _) => (FLOAT_FRAME, 8),
            (false, true) => (BASIC_FRAME, 8),
            (false, false) => (BASIC_FRAME, 4),
        };
        let frame = sp.wrapping_sub(size) & !(alignment - 1);
        let skipped = if aligns && sp & 4 != 0 {
            SKIPPED_WORD
        } else {
            0
        };
        let xpsr = self.registers.xpsr() | skipped;
        let [r0, r1, r2, r3, .., r12, _, lr, _] = self.registers.r;
        let words = [r0, r1, r2, r3, r12, lr, self.registers.pc, xpsr];
        for (at, value) in (0..).step_by(4).zip(words) {
            write_frame(memory, frame.wrapping_add(at), value)?;
        }
        if float {
            self.stack_float_registers(memory, frame.wrapping_add(BASIC_FRAME))?;
        }
        self.registers.r[usize::from(SP)] = frame;
        let mut link = exc_return::BASE;
        if !float {
            link |= exc_return::BASIC_FRAME;
        }
        if !self.registers.in_handler() {
            link |= exc_return::THREAD;
        }
        if self.registers.on_process_stack() {
            link |= exc_return::PROCESS_STACK;
        }
        Ok(link)
    }

    /// Starts a handler; the frame it returns to is stacked.
    fn begin_handler(&mut self, memory: &Memory, exception: u8, link: u32) -> Result<(), Cause> {
        self.nvic.activate(exception);
        self.registers.use_process_stack(false);
        self.registers.control.float_active = false;
        self.registers.it_block = Default::default();
        self.registers.exception = exception;
        self.registers.r[usize::from(LR)] = link;
        self.context_changed();
        self.sleep = Sleep::Awake;
        let vector = self.scb.vector(exception);
        let handler = read_frame(memory, vector)?;
        if handler & 1 == 0 {
            return Err(Cause::ArmState(handler));
        }
        self.registers.pc = handler & !1;
        Ok(())
    }

    /// What every entry and every return does.
    fn context_changed(&mut self) {
        self.event = true;
        self.exclusive = false;
        self.fpu_ready = false;
        self.accelerator.jump();
    }

    /// BX, POP and LDR to an address that is not an ordinary one: an exception return or a mistake.
    #[cold]
    #[inline(never)]
    pub(super) fn branch_to_unusual(&mut self, memory: &Memory, target: u32) {
        if target >= EXC_RETURN && self.registers.in_handler() {
            if let Err(cause) = self.return_from_exception(memory, target) {
                self.fail(cause);
            }
        } else if target & 1 == 0 {
            self.fail(Cause::ArmState(target));
        } else {
            self.registers.pc = target & !1;
        }
    }

    fn return_from_exception(&mut self, memory: &Memory, link: u32) -> Result<(), Cause> {
        let invalid = Cause::ExceptionReturn(link);
        let known = matches!(link & 0xf, 1 | 9 | 0xd) && link | 0x1e == u32::MAX;
        let returning = self.registers.exception;
        if !known || !self.nvic.deactivate(returning) {
            return Err(invalid);
        }
        let to_thread = link & exc_return::THREAD != 0;
        let to_base = self.nvic.depth() == 0;
        if to_thread != to_base && !(to_thread && self.scb.allows_early_thread()) {
            return Err(invalid);
        }
        if returning != exception::NMI {
            self.registers.masks.faultmask = false;
        }
        if let Some(next) = self.nvic.preempting(self.registers.masks) {
            self.trace
                .note(self.cycles, What::ExceptionReturned(returning));
            self.trace.note(self.cycles, What::ExceptionEntered(next));
            self.cycles += cycles::TAIL_CHAIN;
            return self.begin_handler(memory, next, link);
        }
        self.cycles += cycles::EXCEPTION_RETURN;
        self.pop_frame(memory, link)?;
        self.trace
            .note(self.cycles, What::ExceptionReturned(returning));
        if self.registers.in_handler() == to_thread {
            return Err(invalid);
        }
        self.context_changed();
        if to_base && self.scb.sleeps_on_exit() {
            self.fall_asleep(Sleep::ForInterrupt);
        }
        Ok(())
    }

    fn pop_frame(&mut self, memory: &Memory, link: u32) -> Result<(), Cause> {
        let float = link & exc_return::BASIC_FRAME == 0;
        let process_stack = link & exc_return::PROCESS_STACK != 0;
        self.registers.use_process_stack(process_stack);
        let frame = self.registers.r[usize::from(SP)];
        let mut words = [0; 8];
        for (at, word) in (0..).step_by(4).zip(&mut words) {
            *word = read_frame(memory, frame.wrapping_add(at))?;
        }
        let [r0, r1, r2, r3, r12, lr, pc, xpsr] = words;
        self.registers.r[..4].copy_from_slice(&[r0, r1, r2, r3]);
        self.registers.r[12] = r12;
        self.registers.r[usize::from(LR)] = lr;
        self.registers.pc = pc & !1;
        self.registers.set_xpsr(xpsr);
        let mut size = BASIC_FRAME;
        if float {
            self.unstack_float_registers(memory, frame.wrapping_add(BASIC_FRAME))?;
            size = FLOAT_FRAME;
        }
        self.registers.control.float_active = float;
        let skipped = xpsr & SKIPPED_WORD != 0 && (float || self.scb.aligns_stack());
        let sp = frame.wrapping_add(size) | if skipped { 4 } else { 0 };
        self.registers.r[usize::from(SP)] = sp;
        Ok(())
    }

    pub(super) fn fall_asleep(&mut self, sleep: Sleep) {
        self.sleep = sleep;
        self.horizon = 0;
    }

    /// Asleep in WFE or WFI.
    pub fn is_sleeping(&self) -> bool {
        self.sleep != Sleep::Awake
    }

    /// Wakes if there is a reason to: the event register (WFE), or a pending interrupt that only
    /// PRIMASK holds back (WFI). True: awake.
    pub fn try_wake(&mut self) -> bool {
        let wakes = match self.sleep {
            Sleep::Awake => true,
            Sleep::ForEvent => std::mem::take(&mut self.event),
            Sleep::ForInterrupt => {
                let mut masks = self.registers.masks;
                masks.primask = false;
                self.nvic.preempting(masks).is_some()
            }
        };
        if wakes {
            self.sleep = Sleep::Awake;
        }
        wakes
    }

    /// Lets time pass while asleep. Never goes back.
    pub fn advance_to(&mut self, cycle: Cycle) {
        let cycle = self.cycles.max(cycle);
        self.trace.note_sleep(self.cycles, cycle);
        self.cycles = cycle;
    }

    /// SVC: its exception has to be taken right behind it.
    pub(super) fn supervisor_call(&mut self, number: u8) {
        if !self
            .nvic
            .can_preempt(exception::SVCALL, self.registers.masks)
        {
            return self.fail(Cause::MaskedSvc(number));
        }
        self.pend(exception::SVCALL);
        self.horizon = 0;
    }

    /// After masks, priorities or pending bits changed: stops the run where an exception is due.
    pub(super) fn exceptions_changed(&mut self) {
        if self.nvic.preempting(self.registers.masks).is_some() {
            self.horizon = 0;
        }
    }
}
