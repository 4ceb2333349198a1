//! Registers that only store: the clock gates and block resets of every bus, and a few more.

use super::Effect;
use crate::soc::map::{Block, Gate};
use crate::soc::refusal::Refusal;

const AHB1RSTR: u32 = 0x10;
const AHB2RSTR: u32 = 0x14;
const APB1RSTR: u32 = 0x20;
const APB2RSTR: u32 = 0x24;
const AHB1ENR: u32 = 0x30;
const AHB2ENR: u32 = 0x34;
const APB1ENR: u32 = 0x40;
const APB2ENR: u32 = 0x44;
const PLLI2SCFGR: u32 = 0x84;
/// Reserved on an F407, the clock multiplexers of its larger sisters: drivers for the whole family
/// write its reset value.
const DCKCFGR: u32 = 0x8c;

/// Offset, reset value, writable bits. Low-power enables matter to a current meter alone; spread
/// spectrum moves edges by less than a cycle; no model hangs on PLLI2S.
const REGISTERS: [(u32, u32, u32); 18] = [
    (AHB1RSTR, 0, 0x2260_11ff),
    (AHB2RSTR, 0, 0x0000_00f1),
    (0x18, 0, 1),
    (APB1RSTR, 0, 0x36fe_c9ff),
    (APB2RSTR, 0, 0x0007_5933),
    (AHB1ENR, 0x0010_0000, 0x7e74_11ff),
    (AHB2ENR, 0, 0x0000_00f1),
    (0x38, 0, 1),
    (APB1ENR, 0, 0x36fe_c9ff),
    (APB2ENR, 0, 0x0007_5f33),
    (0x50, 0x7e67_91ff, 0x7e67_91ff),
    (0x54, 0x0000_00f1, 0x0000_00f1),
    (0x58, 1, 1),
    (0x60, 0x36fe_c9ff, 0x36fe_c9ff),
    (0x64, 0x0007_5f33, 0x0007_5f33),
    (0x80, 0, 0xcfff_ffff),
    (PLLI2SCFGR, 0x2400_3000, 0x7000_7fc0),
    (DCKCFGR, 0, 0),
];

/// The stored values.
#[derive(Clone, Debug)]
pub struct Gates([u32; REGISTERS.len()]);

impl Gates {
    /// The reset values.
    pub fn new() -> Self {
        Self(REGISTERS.map(|(_, reset, _)| reset))
    }

    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        index(offset).map(|index| self.0[index])
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<Effect, Refusal> {
        let index = index(offset)?;
        self.0[index] = value & REGISTERS[index].2;
        Ok(match offset {
            AHB1RSTR..=APB2RSTR => Effect::Reset,
            AHB1ENR..=APB2ENR => Effect::Clocks,
            _ => Effect::None,
        })
    }

    /// True while the clock of a block behind `gate` runs.
    pub fn enabled(&self, gate: Gate) -> bool {
        self.bit(gate, [AHB1ENR, AHB2ENR, APB1ENR, APB2ENR])
    }

    /// True while a block behind `gate` is held in reset.
    pub fn in_reset(&self, gate: Gate) -> bool {
        self.bit(gate, [AHB1RSTR, AHB2RSTR, APB1RSTR, APB2RSTR])
    }

    fn bit(&self, gate: Gate, registers: [u32; 4]) -> bool {
        let (bus, bit) = match gate {
            Gate::Ahb1(bit) => (0, bit),
            Gate::Ahb2(bit) => (1, bit),
            Gate::Apb1(bit) => (2, bit),
            Gate::Apb2(bit) => (3, bit),
        };
        self.read(registers[bus])
            .is_ok_and(|value| value >> bit & 1 != 0)
    }
}

fn index(offset: u32) -> Result<usize, Refusal> {
    REGISTERS
        .iter()
        .position(|&(register, ..)| register == offset)
        .ok_or(Refusal::UnmodelledRegister {
            block: Block::Rcc,
            address: 0x4002_3800 + offset,
        })
}
