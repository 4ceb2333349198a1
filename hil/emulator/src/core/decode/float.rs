//! The floating-point extension, FPv4-SP (ARM DDI0403 §A6).

use super::super::cycles;
use super::super::instruction::{Instruction, Operation, PC};
use super::{Decoded, Refusal, Wide, general};
use Operation::*;

/// Coprocessors 10 and 11. All others do not exist.
pub(super) fn decode(opcode: &Wide) -> Decoded {
    if opcode.second & 0xe00 != 0xa00 {
        return Err(Refusal::Undefined);
    }
    match (opcode.first & 0x300, opcode.second & 0x10 != 0) {
        (0x200, false) => data_processing(opcode),
        (0x200, true) => transfer_word(opcode),
        (0x300, _) => Err(Refusal::Undefined),
        _ if opcode.first & 0x1e0 == 0x040 => transfer_pair(opcode),
        _ => load_store(opcode),
    }
}

impl Wide {
    /// Coprocessor 11: double precision, of which only moves and loads exist.
    fn is_double(&self) -> bool {
        self.second & 0x100 != 0
    }

    /// Sd
    fn sd(&self) -> u8 {
        (self.second >> 11 & 0x1e | self.first >> 6 & 1) as u8
    }

    /// Sn
    fn sn(&self) -> u8 {
        (self.first << 1 & 0x1e | self.second >> 7 & 1) as u8
    }

    /// Sm
    fn sm(&self) -> u8 {
        (self.second << 1 & 0x1e | self.second >> 5 & 1) as u8
    }
}

/// The S register in the low half of a D register: "number" in four bits, "high" the fifth.
/// D16 to D31 do not exist here.
fn double(number: u32, high: bool) -> Result<u8, Refusal> {
    if high {
        return Err(Refusal::Undefined);
    }
    Ok((number as u8 & 15) << 1)
}

/// The register that a load or store begins with.
fn first_register(opcode: &Wide) -> Result<u8, Refusal> {
    if opcode.is_double() {
        double(opcode.second >> 12, opcode.first & 0x40 != 0)
    } else {
        Ok(opcode.sd())
    }
}

/// VLDR, VSTR, VLDM, VSTM (§A6.5).
fn load_store(opcode: &Wide) -> Decoded {
    let (index, add) = (opcode.first & 0x100 != 0, opcode.first & 0x80 != 0);
    let writes_back = opcode.first & 0x20 != 0;
    let bytes = (opcode.second & 0xff) * 4;
    if index && !writes_back {
        return single(opcode, if add { bytes } else { bytes.wrapping_neg() });
    }
    // Increment after (with or without write-back) or decrement before (always with).
    if index == add {
        return Err(Refusal::Undefined);
    }
    let d = first_register(opcode)?;
    let mut words = opcode.second & 0xff;
    if opcode.is_double() {
        words &= !1; // an odd count is FLDMX, whose last word is not a register
    }
    if words == 0 || u32::from(d) + words > 32 || opcode.n() == PC {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::float(if opcode.bit4() { Vldm } else { Vstm })
        .d(d)
        .n(opcode.n())
        .m(words as u8)
        .a(u8::from(writes_back) | u8::from(index) << 1)
        .immediate(bytes)
        .cycles(cycles::multiple(words)))
}

fn single(opcode: &Wide, offset: u32) -> Decoded {
    let (operation, cost) = match (opcode.is_double(), opcode.bit4()) {
        (false, true) => (Vldr, cycles::FLOAT_TRANSFER),
        (false, false) => (Vstr, cycles::FLOAT_TRANSFER),
        (true, true) => (VldrDouble, cycles::DOUBLE),
        (true, false) => (VstrDouble, cycles::DOUBLE),
    };
    let literal = opcode.n() == PC;
    if literal && !opcode.bit4() {
        return Err(Refusal::Unpredictable);
    }
    // Register 15 as a base reads as zero.
    let base = if literal { opcode.literal_base() } else { 0 };
    Ok(Instruction::float(operation)
        .d(first_register(opcode)?)
        .n(opcode.n())
        .immediate(base.wrapping_add(offset))
        .cycles(cost))
}

/// VMOV between two core registers and two S registers or a D register (§A6.7).
fn transfer_pair(opcode: &Wide) -> Decoded {
    if opcode.second & 0xd0 != 0x10 {
        return Err(Refusal::Undefined);
    }
    let (first, second) = (opcode.t(), opcode.n());
    general(&[first, second])?;
    let m = if opcode.is_double() {
        double(opcode.second, opcode.second & 0x20 != 0)?
    } else {
        opcode.sm()
    };
    let to_core = opcode.bit4();
    if m == 31 || to_core && first == second {
        return Err(Refusal::Unpredictable);
    }
    let operation = if to_core {
        VmovPairToCore
    } else {
        VmovPairFromCore
    };
    Ok(Instruction::float(operation).d(first).n(second).m(m))
}

/// VMOV of one word, VMRS and VMSR (§A6.6).
fn transfer_word(opcode: &Wide) -> Decoded {
    let (t, to_core) = (opcode.t(), opcode.bit4());
    let operation = if to_core { VmovToCore } else { VmovFromCore };
    let kind = opcode.first >> 5 & 7;
    let instruction = match (opcode.is_double(), kind) {
        (false, 0) => Instruction::float(operation).n(opcode.sn()),
        (true, 0 | 1) if opcode.second & 0x60 == 0 => {
            let low = double(opcode.first, opcode.second & 0x80 != 0)?;
            Instruction::float(operation).n(low + kind as u8)
        }
        (false, 7) if opcode.n() != 1 => return Err(Refusal::Undefined),
        (false, 7) if to_core && t == PC => return Ok(Instruction::float(VmrsFlags)),
        (false, 7) if to_core => Instruction::float(Vmrs),
        (false, 7) => Instruction::float(Vmsr),
        _ => return Err(Refusal::Undefined),
    };
    general(&[t])?;
    Ok(instruction.d(t))
}

/// Arithmetic (§A6.4).
fn data_processing(opcode: &Wide) -> Decoded {
    if opcode.is_double() {
        return Err(Refusal::Undefined);
    }
    let op = opcode.second & 0x40 != 0;
    let either = |set, clear, cost| Ok(arithmetic(opcode, if op { set } else { clear }, cost));
    match opcode.first >> 5 & 4 | opcode.first >> 4 & 3 {
        0 => either(Vmls, Vmla, cycles::FLOAT_MULTIPLY_ADD),
        1 => either(Vnmla, Vnmls, cycles::FLOAT_MULTIPLY_ADD),
        2 => either(Vnmul, Vmul, 1),
        3 => either(Vsub, Vadd, 1),
        4 if op => Err(Refusal::Undefined),
        4 => Ok(arithmetic(opcode, Vdiv, cycles::FLOAT_DIVIDE)),
        5 => either(Vfnma, Vfnms, cycles::FLOAT_MULTIPLY_ADD),
        6 => either(Vfms, Vfma, cycles::FLOAT_MULTIPLY_ADD),
        _ if op => one_operand(opcode),
        _ => Ok(Instruction::float(VmovImm)
            .d(opcode.sd())
            .immediate(expand(opcode.first << 4 & 0xf0 | opcode.second & 15))),
    }
}

fn arithmetic(opcode: &Wide, operation: Operation, cost: u8) -> Instruction {
    Instruction::float(operation)
        .d(opcode.sd())
        .n(opcode.sn())
        .m(opcode.sm())
        .cycles(cost)
}

/// VFPExpandImm (§A6.4.1): sign, three bits of exponent, four bits of mantissa.
fn expand(byte: u32) -> u32 {
    let exponent = if byte & 0x40 != 0 { 0x1f } else { 0x20 };
    (byte >> 7) << 31 | exponent << 25 | (byte & 0x3f) << 19
}

/// Those with one operand, and the conversions (table A6-4).
fn one_operand(opcode: &Wide) -> Decoded {
    let top = opcode.second & 0x80 != 0;
    let either = |set, clear| Ok(arithmetic(opcode, if top { set } else { clear }, 1));
    match opcode.first & 15 {
        0 => either(Vabs, Vmov),
        1 if top => Ok(arithmetic(opcode, Vsqrt, cycles::FLOAT_DIVIDE)),
        1 => either(Vneg, Vneg),
        2 => Ok(arithmetic(opcode, VcvtFromHalf, 1).a(top.into())),
        3 => Ok(arithmetic(opcode, VcvtToHalf, 1).a(top.into())),
        4 => either(Vcmp, Vcmp),
        5 if opcode.second & 0x2f == 0 => either(VcmpZero, VcmpZero),
        8 => either(VcvtFromSigned, VcvtFromUnsigned),
        10 | 11 => fixed_point(opcode, VcvtFromFixed),
        12 => either(VcvtToUnsigned, VcvtrToUnsigned),
        13 => either(VcvtToSigned, VcvtrToSigned),
        14 | 15 => fixed_point(opcode, VcvtToFixed),
        _ => Err(Refusal::Undefined),
    }
}

/// Conversions in place between floating and fixed point of 16 or 32 bits.
fn fixed_point(opcode: &Wide, operation: Operation) -> Decoded {
    let unsigned = opcode.first & 1 != 0;
    let long = opcode.second & 0x80 != 0;
    let integer_bits = opcode.second << 1 & 0x1e | opcode.second >> 5 & 1;
    let size = if long { 32 } else { 16 };
    let fraction_bits = u32::checked_sub(size, integer_bits).ok_or(Refusal::Unpredictable)?;
    Ok(Instruction::float(operation)
        .d(opcode.sd())
        .a(u8::from(unsigned) | u8::from(long) << 1)
        .immediate(fraction_bits))
}
