//! Which memory the next instruction is about to access: what a debugger's watchpoints ask before
//! each instruction, so that loads and stores themselves need not ask anything.

use super::Core;
use super::code_cache::fetch;
use super::instruction::{Guard, Instruction, Operation, PC, SP};
use crate::memory::Memory;

/// A load or a store of an instruction: one piece of memory, however many registers it moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Its lowest address.
    pub address: u32,
    /// Its bytes.
    pub bytes: u32,
    /// A store, not a load.
    pub write: bool,
}

impl Access {
    fn load(address: u32, bytes: u32) -> Option<Self> {
        let write = false;
        Some(Self {
            address,
            bytes,
            write,
        })
    }

    fn store(address: u32, bytes: u32) -> Option<Self> {
        let write = true;
        Some(Self {
            address,
            bytes,
            write,
        })
    }
}

impl Core {
    /// What the instruction at the program counter will load or store when it executes, if its
    /// condition lets it. Exception entry and return, and what DMA moves, are nobody's instructions.
    pub(crate) fn next_access(&mut self, memory: &Memory) -> Option<Access> {
        let pc = self.pc();
        let instruction = if self.code.decode_run(memory, pc) {
            self.code.at(self.code.locate(pc))
        } else {
            let mut block = self.registers.it_block;
            fetch(memory, pc, block.next())?
        };
        if self.is_skipped(instruction.guard) {
            return None;
        }
        self.access_of(instruction)
    }

    fn is_skipped(&self, guard: Guard) -> bool {
        guard.is_conditional() && !self.registers.flags.hold(guard.condition())
    }

    /// By the addressing of ARM DDI0403 §A7.7, in the operands of [`Operation`].
    fn access_of(&self, i: Instruction) -> Option<Access> {
        use Operation::*;
        let r = |number: u8| self.registers.r[usize::from(number & 15)];
        let offset = r(i.n).wrapping_add(i.immediate);
        let scaled = r(i.n).wrapping_add(r(i.m) << (i.immediate & 3));
        let indexed = if i.a & 1 != 0 { offset } else { r(i.n) };
        let table = if i.n == PC { i.immediate } else { r(i.n) };
        let listed = 4 * i.immediate.count_ones();
        let multiple = if i.a & 2 != 0 {
            r(i.n).wrapping_sub(listed)
        } else {
            r(i.n)
        };
        let floats = if i.a & 2 != 0 {
            r(i.n).wrapping_sub(i.immediate)
        } else {
            r(i.n)
        };
        match i.operation {
            LdrLiteral => Access::load(i.immediate, 4),
            LdrImm | Ldrex => Access::load(offset, 4),
            LdrhImm | LdrshImm | Ldrexh => Access::load(offset, 2),
            LdrbImm | LdrsbImm | Ldrexb => Access::load(offset, 1),
            StrImm => Access::store(offset, 4),
            StrhImm => Access::store(offset, 2),
            StrbImm => Access::store(offset, 1),
            Ldr | LdrPcRegister => Access::load(scaled, 4),
            Ldrh | Ldrsh => Access::load(scaled, 2),
            Ldrb | Ldrsb => Access::load(scaled, 1),
            Str => Access::store(scaled, 4),
            Strh => Access::store(scaled, 2),
            Strb => Access::store(scaled, 1),
            LdrIndexed | LdrPc => Access::load(indexed, 4),
            LdrhIndexed | LdrshIndexed => Access::load(indexed, 2),
            LdrbIndexed | LdrsbIndexed => Access::load(indexed, 1),
            StrIndexed => Access::store(indexed, 4),
            StrhIndexed => Access::store(indexed, 2),
            StrbIndexed => Access::store(indexed, 1),
            Ldrd => Access::load(indexed, 8),
            Strd => Access::store(indexed, 8),
            Ldm => Access::load(multiple, listed),
            Stm => Access::store(multiple, listed),
            Push => Access::store(r(SP).wrapping_sub(listed), listed),
            Pop => Access::load(r(SP), listed),
            Strex if self.exclusive => Access::store(offset, 4),
            Strexh if self.exclusive => Access::store(offset, 2),
            Strexb if self.exclusive => Access::store(offset, 1),
            Tbb => Access::load(table.wrapping_add(r(i.m)), 1),
            Tbh => Access::load(table.wrapping_add(r(i.m) << 1), 2),
            Vldr => Access::load(offset, 4),
            Vstr => Access::store(offset, 4),
            VldrDouble => Access::load(offset, 8),
            VstrDouble => Access::store(offset, 8),
            Vldm => Access::load(floats, 4 * u32::from(i.m)),
            Vstm => Access::store(floats, 4 * u32::from(i.m)),
            _ => None,
        }
    }
}
