//! From Thumb-2 and FPv4-SP encodings to [`Instruction`]s (ARM DDI0403 §A5).

mod control;
mod data_processing;
mod float;
mod load_store;
mod multiply;
mod narrow;

use super::instruction::{Instruction, Operation, PC};

/// Why an encoding is not an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// It has no meaning.
    Undefined,
    /// The architecture leaves its effect open.
    Unpredictable,
}

type Decoded = Result<Instruction, Refusal>;

/// Where an instruction lies with respect to an IT block, as far as decoding depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Outside: 16-bit arithmetic sets the flags.
    Plain,
    /// Inside, under this condition: 16-bit arithmetic leaves the flags alone.
    InItBlock(u8),
}

/// Whether a first halfword begins a 32-bit instruction.
fn is_wide(first: u16) -> bool {
    first >> 11 >= 0b11101
}

/// Decodes the instruction at `address`. `second` is looked at only where `first` asks for it.
pub(super) fn decode(address: u32, first: u16, second: u16, place: Place) -> Instruction {
    let pc = address.wrapping_add(4);
    let (decoded, opcode, length) = if is_wide(first) {
        let opcode = Wide {
            pc,
            first: first.into(),
            second: second.into(),
        };
        (wide(&opcode), opcode.bits(), 4)
    } else {
        let in_it_block = place != Place::Plain;
        let decoded = narrow::decode(pc, first.into(), in_it_block);
        (decoded, first.into(), 2)
    };
    let refused = |operation| Instruction::new(operation).immediate(opcode);
    let instruction = match decoded.and_then(|instruction| placed(instruction, place)) {
        Ok(instruction) => instruction,
        Err(Refusal::Undefined) => refused(Operation::Undefined),
        Err(Refusal::Unpredictable) => refused(Operation::Unpredictable),
    };
    Instruction {
        length,
        ..instruction
    }
}

/// Puts the condition of an IT block on an instruction that may stand in one.
fn placed(instruction: Instruction, place: Place) -> Decoded {
    use Operation::{Bkpt, Cbnz, Cbz, It};
    match place {
        Place::Plain => Ok(instruction),
        Place::InItBlock(_) if instruction.guard.is_conditional() => Err(Refusal::Unpredictable),
        Place::InItBlock(condition) => match instruction.operation {
            It | Cbz | Cbnz => Err(Refusal::Unpredictable),
            Bkpt => Ok(instruction),
            _ => Ok(instruction.on_condition(condition)),
        },
    }
}

/// A 32-bit encoding and the fields that many of its formats share.
struct Wide {
    /// The program counter as the instruction reads it: its address plus 4.
    pc: u32,
    first: u32,
    second: u32,
}

impl Wide {
    fn bits(&self) -> u32 {
        self.first << 16 | self.second
    }

    /// The base of pc-relative addresses.
    fn literal_base(&self) -> u32 {
        self.pc & !3
    }

    /// Rn
    fn n(&self) -> u8 {
        (self.first & 15) as u8
    }

    /// Rt, RdLo or Ra
    fn t(&self) -> u8 {
        (self.second >> 12 & 15) as u8
    }

    /// Rd, RdHi or Rt2
    fn d(&self) -> u8 {
        (self.second >> 8 & 15) as u8
    }

    /// Rm
    fn m(&self) -> u8 {
        (self.second & 15) as u8
    }

    /// Bit 4 of the first half: S, or L of loads.
    fn bit4(&self) -> bool {
        self.first & 0x10 != 0
    }

    /// imm3:imm2, a shift amount or a bit number.
    fn shift_amount(&self) -> u32 {
        self.second >> 10 & 0x1c | self.second >> 6 & 3
    }

    /// Bits 7 to 4 of the second half.
    fn op2(&self) -> u32 {
        self.second >> 4 & 15
    }
}

/// Refuses the program counter where a general register is needed.
fn general(registers: &[u8]) -> Result<(), Refusal> {
    if registers.contains(&PC) {
        return Err(Refusal::Unpredictable);
    }
    Ok(())
}

/// Table A5-9 and its sub-tables.
fn wide(opcode: &Wide) -> Decoded {
    let first = opcode.first;
    match (first >> 11 & 3, first >> 9 & 3) {
        (1, 0) if first & 0x40 == 0 => load_store::multiple(opcode),
        (1, 0) => load_store::dual_or_exclusive(opcode),
        (1, 1) => data_processing::shifted_register(opcode),
        (1, _) => float::decode(opcode),
        (2, _) if opcode.second & 0x8000 != 0 => control::decode(opcode),
        (2, 0 | 2) => data_processing::modified_immediate(opcode),
        (2, _) => data_processing::plain_immediate(opcode),
        (3, 0) => load_store::single(opcode),
        (3, 1) if first & 0x100 == 0 => data_processing::register(opcode),
        (3, 1) if first & 0x80 == 0 => multiply::multiply(opcode),
        (3, 1) => multiply::long_multiply_or_divide(opcode),
        _ => Err(Refusal::Undefined),
    }
}

#[cfg(test)]
mod tests;
