//! 32-bit multiplication and division (ARM DDI0403 §A5.3.16, §A5.3.17).

use super::super::instruction::{Instruction, Operation, PC};
use super::{Decoded, Refusal, Wide, general};
use Operation::*;

/// Multiplications with a result of 32 bits.
pub(super) fn multiply(opcode: &Wide) -> Decoded {
    let accumulator = opcode.t();
    let op2 = opcode.op2();
    general(&[opcode.d(), opcode.n(), opcode.m()])?;
    if op2 > 3 {
        return Err(Refusal::Undefined);
    }
    let exchanges_only = op2 < 2;
    let instruction = match opcode.first >> 4 & 7 {
        0 if op2 == 0 && accumulator == PC => Instruction::new(Mul),
        0 if op2 == 0 => Instruction::new(Mla),
        0 if op2 == 1 => {
            general(&[accumulator])?;
            Instruction::new(Mls)
        }
        1 => Instruction::new(SmlaHalves),
        2 if exchanges_only => Instruction::new(Smlad),
        3 if exchanges_only => Instruction::new(SmlaWide),
        4 if exchanges_only => Instruction::new(Smlsd),
        5 if exchanges_only => Instruction::new(Smmla),
        6 if exchanges_only => {
            general(&[accumulator])?;
            Instruction::new(Smmls)
        }
        7 if op2 == 0 => Instruction::new(Usada8),
        _ => return Err(Refusal::Undefined),
    };
    Ok(instruction
        .d(opcode.d())
        .n(opcode.n())
        .m(opcode.m())
        .a(accumulator)
        .immediate(op2))
}

/// Multiplications with a result of 64 bits, and divisions.
pub(super) fn long_multiply_or_divide(opcode: &Wide) -> Decoded {
    let (low, high) = (opcode.t(), opcode.d());
    general(&[high, opcode.n(), opcode.m()])?;
    let op2 = opcode.op2();
    let operation = match (opcode.first >> 4 & 7, op2) {
        (0, 0) => Smull,
        (1, 15) => Sdiv,
        (2, 0) => Umull,
        (3, 15) => Udiv,
        (4, 0) => Smlal,
        (4, 8..=11) => SmlalHalves,
        (4, 12 | 13) => Smlald,
        (5, 12 | 13) => Smlsld,
        (6, 0) => Umlal,
        (6, 6) => Umaal,
        _ => return Err(Refusal::Undefined),
    };
    let divides = matches!(operation, Sdiv | Udiv);
    if !divides && (low == PC || low == high) || divides && low != PC {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::new(operation)
        .d(high)
        .n(opcode.n())
        .m(opcode.m())
        .a(low)
        .immediate(op2 & 3))
}
