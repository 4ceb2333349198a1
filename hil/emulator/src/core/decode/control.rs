//! 32-bit branches, hints and system instructions (ARM DDI0403 §A5.3.4).

use super::super::cycles;
use super::super::instruction::{Instruction, Operation};
use super::{Decoded, Refusal, Wide, general};
use Operation::*;

/// Branches and miscellaneous control.
pub(super) fn decode(opcode: &Wide) -> Decoded {
    match opcode.second & 0x5000 {
        0x1000 => Ok(branch(opcode, B)),
        0x5000 => Ok(branch(opcode, Bl)),
        0 if opcode.first >> 7 & 7 == 7 => miscellaneous(opcode),
        0 => Ok(conditional_branch(opcode)),
        _ => Err(Refusal::Undefined),
    }
}

/// B and BL.
fn branch(opcode: &Wide, operation: Operation) -> Instruction {
    let sign = opcode.first >> 10 & 1;
    // I1 = NOT(J1 EOR S), I2 likewise.
    let i1 = !(opcode.second >> 13 ^ sign) & 1;
    let i2 = !(opcode.second >> 11 ^ sign) & 1;
    let offset = sign << 24
        | i1 << 23
        | i2 << 22
        | (opcode.first & 0x3ff) << 12
        | (opcode.second & 0x7ff) << 1;
    jump(opcode, operation, offset, 25)
}

fn conditional_branch(opcode: &Wide) -> Instruction {
    let offset = (opcode.first >> 10 & 1) << 20
        | (opcode.second >> 11 & 1) << 19
        | (opcode.second >> 13 & 1) << 18
        | (opcode.first & 0x3f) << 12
        | (opcode.second & 0x7ff) << 1;
    jump(opcode, B, offset, 21).on_condition((opcode.first >> 6 & 15) as u8)
}

fn jump(opcode: &Wide, operation: Operation, offset: u32, width: u32) -> Instruction {
    let unused = 32 - width;
    let offset = ((offset << unused) as i32 >> unused) as u32;
    Instruction::new(operation)
        .immediate(opcode.pc.wrapping_add(offset))
        .cycles(cycles::BRANCH)
}

fn miscellaneous(opcode: &Wide) -> Decoded {
    match opcode.first >> 4 & 0x7f {
        0b011_1000 | 0b011_1001 => {
            general(&[opcode.n()])?;
            Ok(Instruction::new(Msr)
                .n(opcode.n())
                .a((opcode.second >> 10 & 3) as u8)
                .immediate(opcode.second & 0xff))
        }
        0b011_1010 if opcode.second & 0x700 == 0 => Ok(hint(opcode.second & 0xff)),
        0b011_1011 => barrier(opcode),
        0b011_1110 | 0b011_1111 => {
            general(&[opcode.d()])?;
            Ok(Instruction::new(Mrs)
                .d(opcode.d())
                .immediate(opcode.second & 0xff))
        }
        _ => Err(Refusal::Undefined),
    }
}

fn hint(number: u32) -> Instruction {
    Instruction::new(match number {
        2 => Wfe,
        3 => Wfi,
        4 => Sev,
        _ => Nop,
    })
}

/// CLREX, and the barriers: the interpreter has nothing they could wait for.
fn barrier(opcode: &Wide) -> Decoded {
    match opcode.op2() {
        2 => Ok(Instruction::new(Clrex)),
        4..=6 => Ok(Instruction::new(Nop)),
        _ => Err(Refusal::Undefined),
    }
}
