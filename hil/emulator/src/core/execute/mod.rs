//! The interpreter: the loop that fetches, and what each operation does.
//!
//! The loop is the speed of the whole machine. It reads decoded instructions, keeps flags as results,
//! and looks at nothing else between two instructions than the cycle at which it has to stop.

mod dsp;
mod float;
mod memory;
mod operations;
mod system;

use super::bus::{Bus, Cycle};
use super::code_cache::fetch;
use super::exceptions::Sleep;
use super::instruction::{Guard, Instruction};
use super::{Cause, Core, Exit, Stop};
use crate::core::instruction::LR;
use crate::memory::Memory;

impl Core {
    /// Executes until the cycle counter reaches `until`, or for one of the reasons of [`Exit`].
    ///
    /// The bus is a trait object so that the interpreter is compiled once, in this crate.
    pub fn run(&mut self, memory: &mut Memory, bus: &mut dyn Bus, until: Cycle) -> Exit {
        let may_run = self.fault.is_none() && self.sleep == Sleep::Awake;
        self.horizon = if may_run { until } else { 0 };
        let mut pc = self.registers.pc;
        while self.cycles < self.horizon {
            pc = self.registers.pc;
            if self.accelerator.changes_line(pc) {
                self.cycles += self.accelerator.enter_line(pc, self.cycles);
            }
            let Some(instruction) = self
                .code
                .get(pc)
                .or_else(|| self.fetch_outside_flash(memory, pc))
            else {
                self.fail(Cause::Fetch(pc));
                break;
            };
            self.instructions += 1;
            let next = pc.wrapping_add(instruction.length.into());
            if instruction.guard != Guard::NONE && !self.passes(memory, instruction.guard, pc) {
                self.cycles += 1;
                self.registers.pc = next;
                continue;
            }
            self.cycles += Cycle::from(instruction.cycles);
            self.registers.pc = next;
            self.execute(memory, bus, instruction);
        }
        self.exit(pc, until)
    }

    /// Code in RAM, or in flash by way of address 0, is decoded every time.
    #[cold]
    #[inline(never)]
    fn fetch_outside_flash(&mut self, memory: &Memory, pc: u32) -> Option<Instruction> {
        fetch(memory, pc, self.registers.it_block.next())
    }

    /// Does what a guard asks for. False: the instruction does not execute.
    #[inline(always)]
    fn passes(&mut self, memory: &mut Memory, guard: Guard, pc: u32) -> bool {
        if guard.is_traced() {
            self.reach_traced(pc);
        }
        if !self.registers.flags.hold(guard.condition()) {
            return false;
        }
        if guard.is_float() && !self.fpu_ready {
            if let Err(cause) = self.prepare_fpu(memory) {
                self.fail(cause);
                return false;
            }
        }
        true
    }

    fn exit(&mut self, pc: u32, until: Cycle) -> Exit {
        if let Some(cause) = self.fault.take() {
            self.registers.pc = pc;
            let lr = self.registers.r[usize::from(LR)];
            return Exit::Stopped(Stop { pc, lr, cause });
        }
        if self.is_sleeping() {
            return Exit::Asleep;
        }
        if self.cycles >= until {
            return Exit::Reached;
        }
        Exit::Synchronise
    }
}
