//! Flash, decoded once, in straight runs.
//!
//! The instructions of a run lie one behind the other, so that the interpreter gets from one to the
//! next without looking anything up; only a branch needs to find its place. Behind each run is a
//! sentinel that sends the interpreter to look again.

use super::cycles;
use super::decode::{Place, decode};
use super::flash_accelerator::line_of;
use super::hazards::Before;
use super::instruction::{Instruction, Operation};
use crate::memory::{FLASH, FLASH_BYTES, Memory};

/// Where decoding a run stops at the latest.
const LONGEST_RUN: usize = 64;
/// Where the sentinel is that stands for all that is not decoded.
const NOWHERE: usize = 0;

/// The decoded instructions of the flash.
pub(super) struct CodeCache {
    /// Runs of instructions, each with an undecoded one at its end.
    instructions: Vec<Instruction>,
    /// For each halfword of the flash, where its instruction is in `instructions`.
    places: Vec<u32>,
    /// First instructions of functions whose calls are recorded, and the places they return to.
    traced: Vec<u32>,
    /// Cycles of a pipeline refill.
    refill: u8,
}

impl CodeCache {
    pub fn new() -> Self {
        Self {
            instructions: vec![Instruction::UNDECODED],
            places: vec![0; FLASH_BYTES / 2],
            traced: Vec::new(),
            refill: cycles::REFILL,
        }
    }

    /// Forgets everything but what is traced, and what a refill costs.
    pub fn clear(&mut self) {
        let traced = std::mem::take(&mut self.traced);
        *self = Self {
            traced,
            refill: self.refill,
            ..Self::new()
        };
    }

    /// What refilling the pipeline costs, cycles.
    #[inline(always)]
    pub fn refill(&self) -> u8 {
        self.refill
    }

    /// What refilling the pipeline costs from now on.
    pub fn set_refill(&mut self, refill: u8) {
        self.refill = refill;
        self.clear();
    }

    /// Where the instruction at `pc` is, or a sentinel.
    #[inline(always)]
    pub fn locate(&self, pc: u32) -> usize {
        let place = self.places.get(index(pc));
        place.map_or(NOWHERE, |place| *place as usize)
    }

    /// The instruction at a place: one that was located, or the next one of its run.
    ///
    /// Its operands come as one word: a quicker way than to copy the whole to the stack and to read it
    /// back from there byte by byte.
    #[inline(always)]
    pub fn at(&self, place: usize) -> Instruction {
        let instruction = self.instructions[place];
        let Instruction { d, n, m, a, .. } = instruction;
        let [d, n, m, a] = u32::from_le_bytes([d, n, m, a]).to_le_bytes();
        Instruction {
            d,
            n,
            m,
            a,
            ..instruction
        }
    }

    /// Marks the instruction at `pc` for the call tracer.
    pub fn trace(&mut self, pc: u32) {
        if self.traced.contains(&pc) {
            return;
        }
        self.traced.push(pc);
        let place = self.locate(pc);
        if place != NOWHERE {
            let instruction = &mut self.instructions[place];
            instruction.guard = instruction.guard.with_trace();
        }
    }

    /// Decodes from `pc` on until the code leaves for good. This puts the conditions of IT blocks on
    /// the instructions inside, so that the interpreter never sees an IT block of the flash, and
    /// gives each instruction its cost behind the one before. False: `pc` is not in flash.
    #[cold]
    #[inline(never)]
    pub fn decode_run(&mut self, memory: &Memory, pc: u32) -> bool {
        if self.locate(pc) != NOWHERE {
            return true;
        }
        let mut address = pc;
        let mut block = ItBlock::default();
        let mut before = Before::default();
        let mut line = u32::MAX;
        for count in 0.. {
            let inside = block.is_open();
            if !inside && (count >= LONGEST_RUN || self.locate(address) != NOWHERE) {
                break;
            }
            let Some(place) = self.places.get_mut(index(address)) else {
                break;
            };
            let Some(mut instruction) = fetch(memory, address, block.next()) else {
                break;
            };
            if instruction.operation == Operation::It {
                block = ItBlock::new(instruction.immediate);
                instruction.operation = Operation::Nop;
            }
            instruction.cycles = before.cost(&instruction);
            if instruction.refills() {
                instruction.cycles = instruction.cycles - cycles::REFILL + self.refill;
            }
            if line_of(address) != line {
                line = line_of(address);
                instruction.guard = instruction.guard.at_line();
            }
            if self.traced.contains(&address) {
                instruction.guard = instruction.guard.with_trace();
            }
            *place = self.instructions.len() as u32;
            self.instructions.push(instruction);
            if instruction.ends_a_run() && !block.is_open() {
                break;
            }
            address = address.wrapping_add(instruction.length.into());
        }
        self.instructions.push(Instruction::UNDECODED);
        self.locate(pc) != NOWHERE
    }
}

fn index(pc: u32) -> usize {
    (pc.wrapping_sub(FLASH) >> 1) as usize
}

/// Decodes one instruction from any memory.
pub(super) fn fetch(memory: &Memory, address: u32, place: Place) -> Option<Instruction> {
    let first = memory.read16(address)?;
    let second = memory.read16(address.wrapping_add(2)).unwrap_or(0);
    Some(decode(address, first, second, place))
}

/// ITSTATE: the condition of the next instruction and the mask of those to come (§A7.3.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ItBlock(u8);

impl ItBlock {
    /// As IT sets it: the first condition and the mask.
    pub fn new(state: u32) -> Self {
        Self(state as u8)
    }

    /// IT outside flash.
    pub fn open(&mut self, state: u32) {
        *self = Self::new(state);
    }

    pub fn is_open(self) -> bool {
        self.0 & 15 != 0
    }

    /// The place of the next instruction, and a step past it.
    pub fn next(&mut self) -> Place {
        if !self.is_open() {
            return Place::Plain;
        }
        let condition = self.0 >> 4;
        self.0 = if self.0 & 7 == 0 {
            0
        } else {
            self.0 & 0xe0 | self.0 << 1 & 0x1f
        };
        Place::InItBlock(condition)
    }

    /// ITSTATE in the bits it has in xPSR.
    pub fn to_xpsr(self) -> u32 {
        u32::from(self.0 & 3) << 25 | u32::from(self.0 >> 2) << 10
    }

    /// The inverse of [`to_xpsr`](Self::to_xpsr).
    pub fn from_xpsr(xpsr: u32) -> Self {
        Self((xpsr >> 25 & 3 | xpsr >> 8 & 0xfc) as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_it_block_hands_out_then_and_else_in_the_order_of_its_mask() {
        // ITTE NE: condition 1, mask 0b1010: bit 0 of the conditions to come, and a terminating one.
        let mut block = ItBlock::new(0x1a);
        assert_eq!(block.next(), Place::InItBlock(1));
        assert_eq!(block.next(), Place::InItBlock(1));
        assert_eq!(block.next(), Place::InItBlock(0));
        assert_eq!(block.next(), Place::Plain);
    }

    #[test]
    fn the_state_of_a_block_survives_the_status_register() {
        for state in 0..=255 {
            let block = ItBlock::new(state);
            assert_eq!(ItBlock::from_xpsr(block.to_xpsr()), block);
        }
    }
}
