//! 32-bit loads and stores (ARM DDI0403 §A5.3.5 to §A5.3.10).

use super::super::cycles;
use super::super::instruction::{Instruction, Operation, PC, SP};
use super::{Decoded, Refusal, Wide, general, narrow};
use Operation::*;

/// LDM, STM, PUSH, POP.
pub(super) fn multiple(opcode: &Wide) -> Decoded {
    let (n, list, load) = (opcode.n(), opcode.second, opcode.bit4());
    let writes_back = opcode.first & 0x20 != 0;
    let decrements = match opcode.first >> 7 & 3 {
        1 => false,
        2 => true,
        _ => return Err(Refusal::Undefined),
    };
    let holds = |register: u8| list & 1 << register != 0;
    if n == PC || list.count_ones() < 2 || holds(SP) || (writes_back && holds(n)) {
        return Err(Refusal::Unpredictable);
    }
    if load && list & 0xc000 == 0xc000 || !load && holds(PC) {
        return Err(Refusal::Unpredictable);
    }
    if n == SP && writes_back && load != decrements {
        return if load {
            narrow::pop(list)
        } else {
            narrow::push(list)
        };
    }
    let cost = if load {
        narrow::load_multiple_cycles(list)
    } else {
        cycles::multiple(list.count_ones())
    };
    Ok(Instruction::new(if load { Ldm } else { Stm })
        .n(n)
        .a(u8::from(writes_back) | u8::from(decrements) << 1)
        .immediate(list)
        .cycles(cost))
}

/// LDRD, STRD, LDREX, STREX and the table branches.
pub(super) fn dual_or_exclusive(opcode: &Wide) -> Decoded {
    match (opcode.first >> 7 & 3, opcode.first >> 4 & 3) {
        (0, 0) => store_exclusive(opcode, Strex, opcode.d()),
        (0, 1) => load_exclusive(opcode, Ldrex),
        (1, 0) => match opcode.op2() {
            4 => store_exclusive(opcode, Strexb, opcode.m()),
            5 => store_exclusive(opcode, Strexh, opcode.m()),
            _ => Err(Refusal::Undefined),
        },
        (1, 1) => match opcode.op2() {
            0 => table_branch(opcode, Tbb),
            1 => table_branch(opcode, Tbh),
            4 => load_exclusive(opcode, Ldrexb),
            5 => load_exclusive(opcode, Ldrexh),
            _ => Err(Refusal::Undefined),
        },
        _ => dual(opcode),
    }
}

/// The offset of the exclusive word accesses; the narrower ones have none.
fn exclusive_offset(opcode: &Wide, operation: Operation) -> u32 {
    match operation {
        Ldrex | Strex => (opcode.second & 0xff) * 4,
        _ => 0,
    }
}

fn load_exclusive(opcode: &Wide, operation: Operation) -> Decoded {
    general(&[opcode.t(), opcode.n()])?;
    Ok(Instruction::new(operation)
        .d(opcode.t())
        .n(opcode.n())
        .immediate(exclusive_offset(opcode, operation))
        .cycles(cycles::EXCLUSIVE))
}

fn store_exclusive(opcode: &Wide, operation: Operation, status: u8) -> Decoded {
    general(&[opcode.t(), opcode.n(), status])?;
    if status == opcode.t() || status == opcode.n() {
        return Err(Refusal::Unpredictable);
    }
    Ok(Instruction::new(operation)
        .d(status)
        .n(opcode.n())
        .m(opcode.t())
        .immediate(exclusive_offset(opcode, operation))
        .cycles(cycles::EXCLUSIVE))
}

/// TBB and TBH; `immediate` is the program counter, the table's base where n is 15.
fn table_branch(opcode: &Wide, operation: Operation) -> Decoded {
    general(&[opcode.m()])?;
    Ok(Instruction::new(operation)
        .n(opcode.n())
        .m(opcode.m())
        .immediate(opcode.pc)
        .cycles(cycles::TABLE_BRANCH))
}

fn dual(opcode: &Wide) -> Decoded {
    let (first, second, n) = (opcode.t(), opcode.d(), opcode.n());
    let (index, add) = (opcode.first & 0x100 != 0, opcode.first & 0x80 != 0);
    let writes_back = opcode.first & 0x20 != 0;
    let load = opcode.bit4();
    general(&[first, second])?;
    if load && first == second || writes_back && (n == first || n == second || n == PC) {
        return Err(Refusal::Unpredictable);
    }
    let mut offset = signed(add, (opcode.second & 0xff) * 4);
    if n == PC {
        if !load {
            return Err(Refusal::Unpredictable);
        }
        offset = opcode.literal_base().wrapping_add(offset);
    }
    Ok(Instruction::new(if load { Ldrd } else { Strd })
        .d(first)
        .m(second)
        .n(n)
        .a(u8::from(index) | u8::from(writes_back) << 1)
        .immediate(offset)
        .cycles(cycles::DOUBLE))
}

fn signed(add: bool, offset: u32) -> u32 {
    if add { offset } else { offset.wrapping_neg() }
}

/// The three addressing forms of one transfer.
struct Transfer {
    offset: Operation,
    register: Operation,
    indexed: Operation,
}

/// The transfer that the size, sign and load bits stand for.
fn transfer(opcode: &Wide) -> Result<Transfer, Refusal> {
    let sign_extends = opcode.first & 0x100 != 0;
    let (offset, register, indexed) = match (opcode.bit4(), sign_extends, opcode.first >> 5 & 3) {
        (false, false, 0) => (StrbImm, Strb, StrbIndexed),
        (false, false, 1) => (StrhImm, Strh, StrhIndexed),
        (false, false, 2) => (StrImm, Str, StrIndexed),
        (true, false, 0) => (LdrbImm, Ldrb, LdrbIndexed),
        (true, false, 1) => (LdrhImm, Ldrh, LdrhIndexed),
        (true, false, 2) => (LdrImm, Ldr, LdrIndexed),
        (true, true, 0) => (LdrsbImm, Ldrsb, LdrsbIndexed),
        (true, true, 1) => (LdrshImm, Ldrsh, LdrshIndexed),
        _ => return Err(Refusal::Undefined),
    };
    Ok(Transfer {
        offset,
        register,
        indexed,
    })
}

/// A single load or store.
pub(super) fn single(opcode: &Wide) -> Decoded {
    let Transfer {
        offset,
        register,
        indexed,
    } = transfer(opcode)?;
    let (t, n, load) = (opcode.t(), opcode.n(), opcode.bit4());
    if t == PC {
        return match offset {
            LdrImm => load_pc(opcode),
            // PLD and PLI: hints that the Cortex-M4 ignores.
            _ if load => Ok(Instruction::new(Nop)),
            _ => Err(Refusal::Unpredictable),
        };
    }
    let cost = if load { cycles::LOAD } else { cycles::STORE };
    let instruction = match addressing(opcode)? {
        Addressing::Literal(address) if offset == LdrImm => {
            Instruction::new(LdrLiteral).immediate(address)
        }
        Addressing::Literal(_) if !load => return Err(Refusal::Undefined),
        // Register 15 as a base reads as zero.
        Addressing::Literal(address) => Instruction::new(offset).n(PC).immediate(address),
        Addressing::Offset(by) => Instruction::new(offset).n(n).immediate(by),
        Addressing::Register(shift) => {
            general(&[opcode.m()])?;
            Instruction::new(register)
                .n(n)
                .m(opcode.m())
                .immediate(shift)
        }
        Addressing::Indexed { .. } if n == t => return Err(Refusal::Unpredictable),
        Addressing::Indexed { by, before } => Instruction::new(indexed)
            .n(n)
            .a(before.into())
            .immediate(by),
    };
    Ok(instruction.d(t).cycles(cost))
}

enum Addressing {
    /// An address in the code.
    Literal(u32),
    /// n + offset
    Offset(u32),
    /// n + (m << shift)
    Register(u32),
    /// n, and n + `by` is written back; `before`: that sum is the address.
    Indexed { by: u32, before: bool },
}

fn addressing(opcode: &Wide) -> Result<Addressing, Refusal> {
    let (long, second) = (opcode.second & 0xfff, opcode.second);
    let add_long = opcode.first & 0x80 != 0;
    if opcode.n() == PC {
        let offset = signed(add_long, long);
        return Ok(Addressing::Literal(
            opcode.literal_base().wrapping_add(offset),
        ));
    }
    if add_long {
        return Ok(Addressing::Offset(long));
    }
    if second & 0x800 == 0 {
        return match second & 0x7c0 {
            0 => Ok(Addressing::Register(second >> 4 & 3)),
            _ => Err(Refusal::Undefined),
        };
    }
    let by = signed(second & 0x200 != 0, second & 0xff);
    match (second & 0x400 != 0, second & 0x100 != 0) {
        (true, false) => Ok(Addressing::Offset(by)),
        (false, false) => Err(Refusal::Undefined),
        (before, true) => Ok(Addressing::Indexed { by, before }),
    }
}

/// LDR to the program counter.
fn load_pc(opcode: &Wide) -> Decoded {
    let instruction = match addressing(opcode)? {
        Addressing::Literal(address) => Instruction::new(LdrPc).a(1).immediate(address),
        Addressing::Offset(by) => Instruction::new(LdrPc).n(opcode.n()).a(1).immediate(by),
        Addressing::Register(shift) => {
            general(&[opcode.m()])?;
            Instruction::new(LdrPcRegister)
                .n(opcode.n())
                .m(opcode.m())
                .immediate(shift)
        }
        Addressing::Indexed { by, before } => Instruction::new(LdrPc)
            .n(opcode.n())
            .a(u8::from(before) | 2)
            .immediate(by),
    };
    Ok(instruction.cycles(cycles::LOAD_PC))
}
