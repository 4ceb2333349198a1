//! The 16-bit encodings (ARM DDI0403 §A5.2).

use super::super::cycles;
use super::super::instruction::{Instruction, Operation, PC, SP, flag_effect};
use super::{Decoded, Refusal};
use Operation::*;

/// Decodes a 16-bit instruction that reads the program counter as `pc`.
pub(super) fn decode(pc: u32, bits: u32, in_it_block: bool) -> Decoded {
    let flags = !in_it_block;
    match bits >> 10 {
        0b000000..=0b001111 => Ok(shift_add_move(bits, flags)),
        0b010000 => Ok(data_processing(bits, flags)),
        0b010001 => special(pc, bits),
        0b010010 | 0b010011 => Ok(Instruction::new(LdrLiteral)
            .d(low(bits, 8))
            .immediate((pc & !3).wrapping_add(word_offset(bits)))
            .cycles(cycles::LOAD)),
        0b010100..=0b100111 => Ok(load_store(bits)),
        0b101000 | 0b101001 => Ok(Instruction::new(MovImm)
            .d(low(bits, 8))
            .immediate((pc & !3).wrapping_add(word_offset(bits)))),
        0b101010 | 0b101011 => Ok(Instruction::new(AddImm)
            .d(low(bits, 8))
            .n(SP)
            .immediate(word_offset(bits))),
        0b101100..=0b101111 => miscellaneous(pc, bits),
        0b110000..=0b110011 => multiple(bits),
        0b110100..=0b110111 => conditional_branch(pc, bits),
        0b111000 | 0b111001 => Ok(branch(pc, sign_extend(bits & 0x7ff, 11))),
        _ => Err(Refusal::Undefined),
    }
}

/// The low register in the three bits from `shift` on.
fn low(bits: u32, shift: u32) -> u8 {
    (bits >> shift & 7) as u8
}

fn word_offset(bits: u32) -> u32 {
    (bits & 0xff) * 4
}

/// A signed count of halfwords, as a byte offset.
fn sign_extend(value: u32, width: u32) -> u32 {
    let unused = 32 - width;
    (((value << unused) as i32) >> unused << 1) as u32
}

fn branch(pc: u32, offset: u32) -> Instruction {
    Instruction::new(B)
        .immediate(pc.wrapping_add(offset))
        .cycles(cycles::BRANCH)
}

/// One of two operations, by whether flags are set.
fn either(flags: bool, setting: Operation, plain: Operation) -> Instruction {
    Instruction::new(if flags { setting } else { plain })
}

/// §A5.2.1: shift by immediate, add, subtract, move, compare.
fn shift_add_move(bits: u32, flags: bool) -> Instruction {
    let amount = bits >> 6 & 31;
    let right_shift = if amount == 0 { 32 } else { amount };
    let (d, m) = (low(bits, 0), low(bits, 3));
    let byte = bits & 0xff;
    let wide_d = low(bits, 8);
    match bits >> 9 {
        0b0000..=0b0011 if amount == 0 => either(flags, Movs, Mov).d(d).m(m),
        0b0000..=0b0011 => either(flags, LslsImm, LslImm).d(d).m(m).immediate(amount),
        0b0100..=0b0111 => either(flags, LsrsImm, LsrImm)
            .d(d)
            .m(m)
            .immediate(right_shift),
        0b1000..=0b1011 => either(flags, AsrsImm, AsrImm)
            .d(d)
            .m(m)
            .immediate(right_shift),
        0b1100 => either(flags, Adds, Add).d(d).n(m).m(low(bits, 6)),
        0b1101 => either(flags, Subs, Sub).d(d).n(m).m(low(bits, 6)),
        0b1110 => either(flags, AddsImm, AddImm)
            .d(d)
            .n(m)
            .immediate(bits >> 6 & 7),
        0b1111 => either(flags, SubsImm, SubImm)
            .d(d)
            .n(m)
            .immediate(bits >> 6 & 7),
        0b10000..=0b10011 => either(flags, MovsImm, MovImm)
            .d(wide_d)
            .a(flag_effect::SET)
            .immediate(byte),
        0b10100..=0b10111 => Instruction::new(CmpImm).n(wide_d).immediate(byte),
        0b11000..=0b11011 => either(flags, AddsImm, AddImm)
            .d(wide_d)
            .n(wide_d)
            .immediate(byte),
        _ => either(flags, SubsImm, SubImm)
            .d(wide_d)
            .n(wide_d)
            .immediate(byte),
    }
}

/// §A5.2.2: two low registers.
fn data_processing(bits: u32, flags: bool) -> Instruction {
    let (d, m) = (low(bits, 0), low(bits, 3));
    let s = u8::from(flags);
    let instruction = match bits >> 6 & 15 {
        0 => either(flags, Ands, And),
        1 => either(flags, Eors, Eor),
        2 => Instruction::new(Lsl).a(s),
        3 => Instruction::new(Lsr).a(s),
        4 => Instruction::new(Asr).a(s),
        5 => Instruction::new(Adc).a(s),
        6 => Instruction::new(Sbc).a(s),
        7 => Instruction::new(Ror).a(s),
        8 => Instruction::new(Tst),
        9 => return either(flags, RsbsImm, RsbImm).d(d).n(m),
        10 => Instruction::new(Cmp),
        11 => Instruction::new(Cmn),
        12 => either(flags, Orrs, Orr),
        13 => either(flags, Muls, Mul),
        14 => either(flags, Bics, Bic),
        _ => either(flags, Mvns, Mvn),
    };
    instruction.d(d).n(d).m(m)
}

/// §A5.2.3: registers of both halves, and branches to a register.
fn special(pc: u32, bits: u32) -> Decoded {
    let d = (bits & 7 | bits >> 4 & 8) as u8;
    let m = (bits >> 3 & 15) as u8;
    let instruction = match bits >> 8 & 3 {
        0 if d == PC && m == PC => return Err(Refusal::Unpredictable),
        0 if d == PC => Instruction::new(AddPc)
            .m(m)
            .immediate(pc)
            .cycles(cycles::BRANCH),
        0 if m == PC => Instruction::new(AddImm).d(d).n(d).immediate(pc),
        0 => Instruction::new(Add).d(d).n(d).m(m),
        1 if d == PC || m == PC => return Err(Refusal::Unpredictable),
        1 => Instruction::new(Cmp).n(d).m(m),
        2 if d == PC && m == PC => branch(pc, 0),
        2 if d == PC => Instruction::new(MovPc).m(m).cycles(cycles::BRANCH),
        2 if m == PC => Instruction::new(MovImm).d(d).immediate(pc),
        2 => Instruction::new(Mov).d(d).m(m),
        _ if m == PC => return Err(Refusal::Unpredictable),
        _ if bits & 0x80 == 0 => Instruction::new(Bx).m(m).cycles(cycles::BRANCH),
        _ => Instruction::new(Blx)
            .m(m)
            .immediate(pc.wrapping_sub(2) | 1)
            .cycles(cycles::BRANCH),
    };
    Ok(instruction)
}

/// §A5.2.4: a single load or store.
fn load_store(bits: u32) -> Instruction {
    let (d, n) = (low(bits, 0), low(bits, 3));
    let (operation, scale) = match bits >> 11 {
        0b01010 | 0b01011 => {
            let by_register = [Str, Strh, Strb, Ldrsb, Ldr, Ldrh, Ldrb, Ldrsh];
            let operation = by_register[(bits >> 9 & 7) as usize];
            return transfer(operation).d(d).n(n).m(low(bits, 6));
        }
        0b10010 => {
            return transfer(StrImm)
                .d(low(bits, 8))
                .n(SP)
                .immediate(word_offset(bits));
        }
        0b10011 => {
            return transfer(LdrImm)
                .d(low(bits, 8))
                .n(SP)
                .immediate(word_offset(bits));
        }
        0b01100 => (StrImm, 4),
        0b01101 => (LdrImm, 4),
        0b01110 => (StrbImm, 1),
        0b01111 => (LdrbImm, 1),
        0b10000 => (StrhImm, 2),
        _ => (LdrhImm, 2),
    };
    let offset = (bits >> 6 & 31) * scale;
    transfer(operation).d(d).n(n).immediate(offset)
}

/// A single transfer with its cost.
fn transfer(operation: Operation) -> Instruction {
    let stores = matches!(operation, Str | Strh | Strb | StrImm | StrhImm | StrbImm);
    Instruction::new(operation).cycles(if stores { cycles::STORE } else { cycles::LOAD })
}

/// §A5.2.5
fn miscellaneous(pc: u32, bits: u32) -> Decoded {
    let (d, m) = (low(bits, 0), low(bits, 3));
    let instruction = match bits >> 8 & 15 {
        0 => {
            let operation = if bits & 0x80 == 0 { AddImm } else { SubImm };
            Instruction::new(operation)
                .d(SP)
                .n(SP)
                .immediate((bits & 0x7f) * 4)
        }
        1 | 3 | 9 | 11 => {
            let offset = (bits >> 3 & 31) << 1 | (bits >> 9 & 1) << 6;
            Instruction::new(if bits & 0x800 == 0 { Cbz } else { Cbnz })
                .n(low(bits, 0))
                .immediate(pc.wrapping_add(offset))
        }
        2 => {
            let extension = [Sxtah, Sxtab, Uxtah, Uxtab][(bits >> 6 & 3) as usize];
            Instruction::new(extension).d(d).m(m)
        }
        4 | 5 => return push(bits & 0xff | (bits & 0x100) << 6),
        6 if bits & 0xec == 0x60 => Instruction::new(Cps)
            .d((bits >> 4 & 1) as u8)
            .immediate(bits & 3),
        10 => match bits >> 6 & 3 {
            0 => Instruction::new(Rev).d(d).m(m),
            1 => Instruction::new(Rev16).d(d).m(m),
            3 => Instruction::new(Revsh).d(d).m(m),
            _ => return Err(Refusal::Undefined),
        },
        12 | 13 => return pop(bits & 0xff | (bits & 0x100) << 7),
        14 => Instruction::new(Bkpt).immediate(bits & 0xff),
        15 => return it_or_hint(bits),
        _ => return Err(Refusal::Undefined),
    };
    Ok(instruction)
}

/// PUSH of a list that may hold LR.
pub(super) fn push(list: u32) -> Decoded {
    if list == 0 {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::new(Push)
        .immediate(list)
        .cycles(cycles::multiple(list.count_ones())))
}

/// POP of a list that may hold PC.
pub(super) fn pop(list: u32) -> Decoded {
    if list == 0 {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::new(Pop)
        .immediate(list)
        .cycles(load_multiple_cycles(list)))
}

/// What it costs to load this list.
pub(super) fn load_multiple_cycles(list: u32) -> u8 {
    if list & 1 << PC != 0 {
        cycles::multiple_and_branch(list.count_ones())
    } else {
        cycles::multiple(list.count_ones())
    }
}

fn it_or_hint(bits: u32) -> Decoded {
    if bits & 15 == 0 {
        return Ok(Instruction::new(match bits >> 4 & 15 {
            2 => Wfe,
            3 => Wfi,
            4 => Sev,
            _ => Nop,
        }));
    }
    let condition = bits >> 4 & 15;
    // "Always" has no opposite, so it takes a mask of one bit: nothing but "then"s.
    if condition == 15 || condition == 14 && (bits & 15).count_ones() != 1 {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::new(It).immediate(bits & 0xff))
}

/// STM and LDM with write-back.
fn multiple(bits: u32) -> Decoded {
    let (n, list) = (low(bits, 8), bits & 0xff);
    if list == 0 {
        return Err(Refusal::Unpredictable);
    }
    let load = bits & 0x800 != 0;
    let writes_back = !load || list >> n & 1 == 0;
    Ok(Instruction::new(if load { Ldm } else { Stm })
        .n(n)
        .a(writes_back.into())
        .immediate(list)
        .cycles(cycles::multiple(list.count_ones())))
}

/// §A5.2.6: conditional branch, SVC.
fn conditional_branch(pc: u32, bits: u32) -> Decoded {
    match bits >> 8 & 15 {
        14 => Err(Refusal::Undefined),
        15 => Ok(Instruction::new(Svc).immediate(bits & 0xff)),
        condition => {
            let offset = sign_extend(bits & 0xff, 8);
            Ok(branch(pc, offset).on_condition(condition as u8))
        }
    }
}
