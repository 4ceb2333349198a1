//! The interpreter: the loop that fetches, and what each operation does.
//!
//! The loop is the speed of the whole machine. It reads decoded instructions, keeps flags as results,
//! and looks at nothing else between two instructions than the cycle at which it has to stop.

mod dsp;
mod float;
mod memory;
mod multiple;
mod operations;
mod system;

pub(super) use memory::check_alignment;

use super::bus::{Bus, Cycle};
use super::code_cache::fetch;
use super::exceptions::Sleep;
use super::instruction::{Guard, Instruction, LR};
use super::{Cause, Core, Exit, Stop};
use crate::memory::Memory;

impl Core {
    /// Executes until the cycle counter reaches `until`, or for one of the reasons of [`Exit`].
    ///
    /// The bus is a trait object so that the interpreter is compiled once, in this crate.
    pub fn run(&mut self, memory: &mut Memory, bus: &mut dyn Bus, until: Cycle) -> Exit {
        let may_run = self.fault.is_none() && self.sleep == Sleep::Awake;
        self.horizon = if may_run { until } else { 0 };
        let mut pc = self.registers.pc;
        let mut next = pc;
        let mut place = self.code.locate(pc);
        let mut executed = 0;
        if self.cycles < self.horizon {
            self.reach_line(pc);
            // Whoever begins executes an instruction, however long it is fetched.
            self.horizon = self.horizon.max(self.cycles + 1);
        }
        while self.cycles < self.horizon {
            pc = next;
            let instruction = self.code.at(place);
            next = pc.wrapping_add(instruction.length.into());
            executed += 1;
            self.step(memory, bus, instruction, pc);
            if self.registers.pc == next {
                place += 1;
            } else {
                next = self.registers.pc;
                place = self.code.locate(next);
                self.reach_line(next);
            }
        }
        self.instructions = self.instructions.wrapping_add(executed);
        self.exit(pc, until)
    }

    /// Executes one instruction, for an observer who looks at each. What the core cannot go on
    /// without, or beyond, is said as by [`run`](Self::run).
    pub fn run_one(&mut self, memory: &mut Memory, bus: &mut dyn Bus) -> Exit {
        match self.run(memory, bus, self.cycles + 1) {
            Exit::Reached if self.horizon == 0 => Exit::Synchronise,
            exit => exit,
        }
    }

    /// The next instruction is fetched from `pc`. Behind a branch it is asked for each time, else only
    /// where a line begins.
    #[inline(always)]
    fn reach_line(&mut self, pc: u32) {
        if self.accelerator.changes_line(pc) {
            self.cycles += self.accelerator.enter_line(pc, self.cycles);
        }
    }

    /// Executes one instruction, the one at `pc`.
    #[inline(always)]
    fn step(&mut self, memory: &mut Memory, bus: &mut dyn Bus, instruction: Instruction, pc: u32) {
        self.registers.pc = pc.wrapping_add(instruction.length.into());
        if instruction.guard != Guard::NONE && !self.passes(memory, instruction.guard, pc) {
            self.cycles += 1;
            return;
        }
        self.cycles += Cycle::from(instruction.cycles);
        self.execute(memory, bus, instruction);
    }

    /// Where the interpreter comes upon undecoded code: decodes a run of flash. Code in RAM, or in
    /// flash by way of address 0, is decoded and executed one instruction at a time.
    #[cold]
    #[inline(never)]
    fn decode_more(&mut self, memory: &mut Memory, bus: &mut dyn Bus) {
        let pc = self.registers.pc - u32::from(Instruction::UNDECODED.length);
        self.registers.pc = pc;
        // It was counted as an instruction.
        self.instructions = self.instructions.wrapping_sub(1);
        if self.code.decode_run(memory, pc) {
            return;
        }
        match fetch(memory, pc, self.registers.it_block.next()) {
            Some(instruction) => {
                self.instructions = self.instructions.wrapping_add(1);
                self.reach_line(pc);
                self.step(memory, bus, instruction, pc);
            }
            None => self.fail(Cause::Fetch(pc)),
        }
    }

    /// Does what a guard asks for. False: the instruction does not execute.
    #[inline(always)]
    fn passes(&mut self, memory: &mut Memory, guard: Guard, pc: u32) -> bool {
        if guard.begins_line() {
            self.reach_line(pc);
        }
        if guard.is_traced() {
            self.reach_traced(pc);
        }
        if guard.is_conditional() && !self.registers.flags.hold(guard.condition()) {
            return false;
        }
        if guard.is_float() && !self.fpu_ready {
            return self.prepare_fpu(memory);
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
