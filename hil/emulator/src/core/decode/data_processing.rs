//! 32-bit data processing (ARM DDI0403 §A5.3.1, §A5.3.3, §A5.3.11 to §A5.3.15).

use super::super::instruction::{Instruction, Operation, PC, flag_effect};
use super::{Decoded, Refusal, Wide, general};
use Operation::*;

/// What a data-processing opcode means: those that write no register have their own entries.
enum Function {
    And,
    Tst,
    Bic,
    /// Or MOV, where n is 15.
    Orr,
    /// Or MVN, where n is 15.
    Orn,
    Eor,
    Teq,
    Pkh,
    Add,
    Cmn,
    Adc,
    Sbc,
    Sub,
    Cmp,
    Rsb,
}

/// The operation field shared by the immediate and the shifted-register formats (table A5-10).
fn function(opcode: &Wide) -> Result<Function, Refusal> {
    let compares = opcode.d() == PC && opcode.bit4();
    let function = match opcode.first >> 5 & 15 {
        0 if compares => Function::Tst,
        0 => Function::And,
        1 => Function::Bic,
        2 => Function::Orr,
        3 => Function::Orn,
        4 if compares => Function::Teq,
        4 => Function::Eor,
        6 => Function::Pkh,
        8 if compares => Function::Cmn,
        8 => Function::Add,
        10 => Function::Adc,
        11 => Function::Sbc,
        13 if compares => Function::Cmp,
        13 => Function::Sub,
        14 => Function::Rsb,
        _ => return Err(Refusal::Undefined),
    };
    match function {
        Function::Tst | Function::Teq | Function::Cmn | Function::Cmp => general(&[opcode.n()])?,
        Function::Orr | Function::Orn => general(&[opcode.d()])?,
        _ => general(&[opcode.d(), opcode.n()])?,
    }
    Ok(function)
}

/// ThumbExpandImm_C (§A5.3.2): the constant, and its `flag_effect` on C.
fn expand(opcode: &Wide) -> (u32, u8) {
    let byte = opcode.second & 0xff;
    let control = opcode.first >> 7 & 8 | opcode.second >> 12 & 7;
    match control {
        0 => (byte, 0),
        1 => (byte << 16 | byte, 0),
        2 => (byte << 24 | byte << 8, 0),
        3 => (byte * 0x0101_0101, 0),
        _ => {
            let value = (byte | 0x80).rotate_right(control << 1 | byte >> 7);
            let carry_one = (value >> 31) as u8 * flag_effect::CARRY_ONE;
            (value, flag_effect::CARRY | carry_one)
        }
    }
}

/// Data processing with a modified immediate.
pub(super) fn modified_immediate(opcode: &Wide) -> Decoded {
    let (value, carry) = expand(opcode);
    let sets = opcode.bit4();
    let logical = if sets { flag_effect::SET | carry } else { 0 };
    let either = |setting, plain| Instruction::new(if sets { setting } else { plain });
    let instruction = match function(opcode)? {
        Function::And => Instruction::new(AndImm).a(logical),
        Function::Tst => Instruction::new(TstImm).a(logical),
        Function::Bic => Instruction::new(BicImm).a(logical),
        Function::Orr if opcode.n() == PC => either(MovsImm, MovImm).a(logical),
        Function::Orr => Instruction::new(OrrImm).a(logical),
        Function::Orn => Instruction::new(OrnImm).a(logical),
        Function::Eor => Instruction::new(EorImm).a(logical),
        Function::Teq => Instruction::new(TeqImm).a(logical),
        Function::Add => either(AddsImm, AddImm),
        Function::Cmn => Instruction::new(CmnImm),
        Function::Adc => Instruction::new(AdcImm).a(sets.into()),
        Function::Sbc => Instruction::new(SbcImm).a(sets.into()),
        Function::Sub => either(SubsImm, SubImm),
        Function::Cmp => Instruction::new(CmpImm),
        Function::Rsb => either(RsbsImm, RsbImm),
        Function::Pkh => return Err(Refusal::Undefined),
    };
    Ok(instruction.d(opcode.d()).n(opcode.n()).immediate(value))
}

/// Data processing with a register shifted by a constant.
pub(super) fn shifted_register(opcode: &Wide) -> Decoded {
    if opcode.second & 0x8000 != 0 {
        return Err(Refusal::Unpredictable);
    }
    general(&[opcode.m()])?;
    let function = function(opcode)?;
    let (kind, amount) = shift(opcode);
    let unshifted = kind == 0 && amount == 0;
    let instruction = match function {
        Function::Pkh => return pack(opcode),
        Function::Orr if opcode.n() == PC && kind < 3 => moved(opcode, kind, amount),
        _ if unshifted => unshifted_register(&function, opcode),
        _ => with_shift(&function, opcode).immediate(kind | amount << 2),
    };
    let operands = instruction.d(opcode.d()).m(opcode.m());
    Ok(operands.n(opcode.n()))
}

/// DecodeImmShift (§A7.4.2): 0 LSL, 1 LSR, 2 ASR, 3 ROR, and the amount. ROR by 0 is RRX.
fn shift(opcode: &Wide) -> (u32, u32) {
    let kind = opcode.second >> 4 & 3;
    match (kind, opcode.shift_amount()) {
        (1 | 2, 0) => (kind, 32),
        (_, amount) => (kind, amount),
    }
}

/// MOV, LSL, LSR and ASR by a constant.
fn moved(opcode: &Wide, kind: u32, amount: u32) -> Instruction {
    let (setting, plain) = match kind {
        0 if amount == 0 => (Movs, Mov),
        0 => (LslsImm, LslImm),
        1 => (LsrsImm, LsrImm),
        _ => (AsrsImm, AsrImm),
    };
    Instruction::new(if opcode.bit4() { setting } else { plain }).immediate(amount)
}

fn unshifted_register(function: &Function, opcode: &Wide) -> Instruction {
    let sets = opcode.bit4();
    let either = |setting, plain| Instruction::new(if sets { setting } else { plain });
    match function {
        Function::And => either(Ands, And),
        Function::Tst => Instruction::new(Tst),
        Function::Bic => either(Bics, Bic),
        Function::Orr => either(Orrs, Orr),
        Function::Orn if opcode.n() == PC => either(Mvns, Mvn),
        Function::Eor => either(Eors, Eor),
        Function::Add => either(Adds, Add),
        Function::Cmn => Instruction::new(Cmn),
        Function::Adc => Instruction::new(Adc).a(sets.into()),
        Function::Sbc => Instruction::new(Sbc).a(sets.into()),
        Function::Sub => either(Subs, Sub),
        Function::Cmp => Instruction::new(Cmp),
        Function::Orn | Function::Teq | Function::Rsb | Function::Pkh => {
            with_shift(function, opcode)
        }
    }
}

fn with_shift(function: &Function, opcode: &Wide) -> Instruction {
    let operation = match function {
        Function::And => AndShifted,
        Function::Tst => TstShifted,
        Function::Bic => BicShifted,
        Function::Orr => OrrShifted,
        Function::Orn | Function::Pkh => OrnShifted,
        Function::Eor => EorShifted,
        Function::Teq => TeqShifted,
        Function::Add => AddShifted,
        Function::Cmn => CmnShifted,
        Function::Adc => AdcShifted,
        Function::Sbc => SbcShifted,
        Function::Sub => SubShifted,
        Function::Cmp => CmpShifted,
        Function::Rsb => RsbShifted,
    };
    Instruction::new(operation).a(opcode.bit4().into())
}

/// PKHBT and PKHTB.
fn pack(opcode: &Wide) -> Decoded {
    if opcode.bit4() || opcode.second & 0x10 != 0 {
        return Err(Refusal::Undefined);
    }
    let amount = opcode.shift_amount();
    let top_from_n = opcode.second & 0x20 != 0;
    let instruction = if top_from_n {
        // An arithmetic shift by 0 stands for 32.
        Instruction::new(Pkhtb).immediate(if amount == 0 { 31 } else { amount })
    } else {
        Instruction::new(Pkhbt).immediate(amount)
    };
    Ok(instruction.d(opcode.d()).n(opcode.n()).m(opcode.m()))
}

/// Plain binary immediates: wide ADD, SUB, MOV, MOVT, bit fields and saturation.
pub(super) fn plain_immediate(opcode: &Wide) -> Decoded {
    let (d, n) = (opcode.d(), opcode.n());
    general(&[d])?;
    let immediate = opcode.first << 1 & 0x800 | opcode.second >> 4 & 0x700 | opcode.second & 0xff;
    let long = u32::from(n) << 12 | immediate;
    let literal = opcode.literal_base();
    let instruction = match opcode.first >> 4 & 31 {
        0b00000 if n == PC => Instruction::new(MovImm).immediate(literal.wrapping_add(immediate)),
        0b00000 => Instruction::new(AddImm).n(n).immediate(immediate),
        0b01010 if n == PC => Instruction::new(MovImm).immediate(literal.wrapping_sub(immediate)),
        0b01010 => Instruction::new(SubImm).n(n).immediate(immediate),
        0b00100 => Instruction::new(MovImm).immediate(long),
        0b01100 => Instruction::new(MovTop).immediate(long),
        16.. if opcode.first & 0x400 == 0 => bit_field(opcode)?,
        _ => return Err(Refusal::Undefined),
    };
    Ok(instruction.d(d))
}

fn bit_field(opcode: &Wide) -> Decoded {
    let n = opcode.n();
    let lowest = opcode.shift_amount();
    let last = opcode.second & 31;
    let extraction = |operation| {
        general(&[n])?;
        if lowest + last > 31 {
            return Err(Refusal::Unpredictable);
        }
        Ok(Instruction::new(operation)
            .a(last as u8 + 1)
            .immediate(lowest))
    };
    let kind = opcode.first >> 4 & 15;
    let shift = lowest << 2 | kind & 2;
    let saturation = |both, halves| {
        general(&[n])?;
        let by_halves = kind & 2 != 0 && lowest == 0;
        let operation = if by_halves { halves } else { both };
        Ok(Instruction::new(operation).a(last as u8).immediate(shift))
    };
    let instruction = match kind {
        0b0000 | 0b0010 => saturation(Ssat, Ssat16)?,
        0b1000 | 0b1010 => saturation(Usat, Usat16)?,
        0b0100 => extraction(Sbfx)?,
        0b1100 => extraction(Ubfx)?,
        0b0110 if last < lowest => return Err(Refusal::Unpredictable),
        0b0110 => {
            let width = last - lowest + 1;
            Instruction::new(Bfi).a(width as u8).immediate(lowest)
        }
        _ => return Err(Refusal::Undefined),
    };
    Ok(instruction.n(n))
}

/// Shifts by a register, extensions, parallel additions and the miscellaneous ones.
pub(super) fn register(opcode: &Wide) -> Decoded {
    if opcode.t() != 15 {
        return Err(Refusal::Undefined);
    }
    let (op1, op2) = (opcode.first >> 4 & 15, opcode.op2());
    general(&[opcode.d(), opcode.m()])?;
    let instruction = match (op1, op2) {
        (0..=7, 0) => {
            general(&[opcode.n()])?;
            let shift = [Lsl, Lsr, Asr, Ror][(op1 >> 1) as usize];
            Instruction::new(shift).a(op1 as u8 & 1)
        }
        (0..=5, 8..=15) => {
            let extension = [Sxtah, Uxtah, Sxtab16, Uxtab16, Sxtab, Uxtab][op1 as usize];
            Instruction::new(extension).immediate((op2 & 3) * 8)
        }
        (8..=14, 0..=7) => parallel(opcode, op1 & 7, op2)?,
        (8..=11, 8..=11) => miscellaneous(opcode, op1 & 3, op2 & 3)?,
        _ => return Err(Refusal::Undefined),
    };
    Ok(instruction.d(opcode.d()).n(opcode.n()).m(opcode.m()))
}

/// §A5.3.13, §A5.3.14: additions and subtractions of halves and bytes.
fn parallel(opcode: &Wide, op1: u32, op2: u32) -> Decoded {
    general(&[opcode.n()])?;
    if matches!(op1, 3 | 7) || op2 & 3 == 3 {
        return Err(Refusal::Undefined);
    }
    Ok(Instruction::new(Parallel).a(op1 as u8).immediate(op2))
}

/// §A5.3.15
fn miscellaneous(opcode: &Wide, op1: u32, op2: u32) -> Decoded {
    general(&[opcode.n()])?;
    // One-operand instructions hold their operand twice.
    if matches!(op1, 1 | 3) && opcode.n() != opcode.m() {
        return Err(Refusal::Unpredictable);
    }
    Ok(match (op1, op2) {
        (0, _) => Instruction::new(Qadd).a(op2 as u8),
        (1, 0) => Instruction::new(Rev),
        (1, 1) => Instruction::new(Rev16),
        (1, 2) => Instruction::new(Rbit),
        (1, _) => Instruction::new(Revsh),
        (2, 0) => Instruction::new(Sel),
        (3, 0) => Instruction::new(Clz),
        _ => return Err(Refusal::Undefined),
    })
}
