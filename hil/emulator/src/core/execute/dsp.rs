//! The DSP extension: saturation, additions in lanes, multiplications of halves.

use super::super::Core;
use super::super::instruction::{Instruction, Operation, PC};
use super::operations::ones;

/// The signed low half.
fn bottom(value: u32) -> i64 {
    i64::from(value as i16)
}

/// The signed high half.
fn top(value: u32) -> i64 {
    i64::from(value as i32 >> 16)
}

/// One half or the other.
fn half(value: u32, is_top: bool) -> i64 {
    if is_top { top(value) } else { bottom(value) }
}

fn word(value: u32) -> i64 {
    i64::from(value as i32)
}

/// Two halves in a word.
fn halves(high: u32, low: u32) -> u32 {
    high << 16 | low & 0xffff
}

impl Core {
    fn r(&self, register: u8) -> u32 {
        self.registers.r[usize::from(register & 15)]
    }

    /// Executes an operation of the DSP extension.
    #[inline(never)]
    pub(super) fn execute_dsp(&mut self, i: Instruction) {
        use Operation::*;
        let (n, m) = (self.r(i.n), self.r(i.m));
        let result = match i.operation {
            Ssat | Usat | Ssat16 | Usat16 => self.saturate(i, n),
            Qadd => self.saturating_add(i.a, n, m),
            Parallel => self.parallel(i.a, i.immediate, n, m),
            Sel => {
                let flags = self.registers.flags.greater_equal;
                let chosen = (0..4).filter(|lane| flags >> lane & 1 != 0);
                let mask = chosen.fold(0, |mask, lane| mask | 0xff << (8 * lane));
                n & mask | m & !mask
            }
            Pkhbt => halves((m << (i.immediate & 31)) >> 16, n),
            Pkhtb => halves(n >> 16, (m as i32 >> (i.immediate & 31)) as u32),
            SmlalHalves | Smlald | Smlsld => return self.accumulate_long(i, n, m),
            Smmla | Smmls => self.multiply_top(i, n, m),
            Usada8 => {
                let lane = |value: u32, lane: u32| value >> (8 * lane) & 0xff;
                let differences = (0..4).map(|at| lane(n, at).abs_diff(lane(m, at)));
                self.addend(i).wrapping_add(differences.sum())
            }
            _ => self.accumulate(i, n, m),
        };
        self.registers.r[usize::from(i.d & 15)] = result;
    }

    /// UXTAB16 and SXTAB16
    #[inline(never)]
    pub(super) fn extend_halves(&mut self, i: Instruction) {
        let (n, m) = (self.r(i.n), self.r(i.m).rotate_right(i.immediate));
        let extended = |half: u32| match i.operation {
            Operation::Uxtab16 => half & 0xff,
            _ => half as i8 as u32,
        };
        let high = (n >> 16).wrapping_add(extended(m >> 16));
        let low = n.wrapping_add(extended(m));
        self.registers.r[usize::from(i.d & 15)] = halves(high, low);
    }

    /// Register a, where it is a register.
    fn addend(&self, i: Instruction) -> u32 {
        if i.a == PC { 0 } else { self.r(i.a) }
    }

    fn saturate(&mut self, i: Instruction, value: u32) -> u32 {
        let flags = &mut self.registers.flags;
        let limit = 1i64 << (i.a & 31);
        let unsigned = matches!(i.operation, Operation::Usat | Operation::Usat16);
        let low = if unsigned { 0 } else { -limit };
        let mut clamp = |value| flags.saturate(value, low, limit - 1);
        if matches!(i.operation, Operation::Ssat16 | Operation::Usat16) {
            let low_half = clamp(bottom(value));
            return halves(clamp(top(value)), low_half);
        }
        let amount = i.immediate >> 2 & 31;
        let arithmetic_right = i.immediate & 2 != 0;
        clamp(if arithmetic_right {
            word(value) >> amount
        } else {
            word(value << amount)
        })
    }

    /// QADD, QSUB, QDADD and QDSUB
    fn saturating_add(&mut self, kind: u8, n: u32, m: u32) -> u32 {
        let flags = &mut self.registers.flags;
        let mut clamp = |value| flags.saturate(value, i32::MIN.into(), i32::MAX.into());
        let n = if kind & 1 != 0 { clamp(2 * word(n)) } else { n };
        clamp(if kind & 2 != 0 {
            word(m) - word(n)
        } else {
            word(m) + word(n)
        })
    }

    /// Multiplications of halves with a result of 32 bits. Overflow sets Q and wraps.
    fn accumulate(&mut self, i: Instruction, n: u32, m: u32) -> u32 {
        let (n_top, m_top) = (i.immediate & 2 != 0, i.immediate & 1 != 0);
        let products = match i.operation {
            Operation::SmlaHalves => half(n, n_top) * half(m, m_top),
            Operation::SmlaWide => (word(n) * half(m, m_top)) >> 16,
            _ => dual(i, n, m),
        };
        let sum = products + word(self.addend(i));
        self.registers.flags.saturated |= i32::try_from(sum).is_err();
        sum as u32
    }

    /// SMLALxy, SMLALD, SMLSLD: to d and a.
    fn accumulate_long(&mut self, i: Instruction, n: u32, m: u32) {
        let product = match i.operation {
            Operation::SmlalHalves => half(n, i.immediate & 2 != 0) * half(m, i.immediate & 1 != 0),
            _ => dual(i, n, m),
        };
        let accumulator = (u64::from(self.r(i.d)) << 32 | u64::from(self.r(i.a))) as i64;
        let sum = accumulator.wrapping_add(product);
        self.registers.r[usize::from(i.a & 15)] = sum as u32;
        self.registers.r[usize::from(i.d & 15)] = (sum >> 32) as u32;
    }

    /// SMMLA, SMMLS: the top half of a long multiplication.
    fn multiply_top(&self, i: Instruction, n: u32, m: u32) -> u32 {
        let accumulator = u64::from(self.addend(i)) << 32;
        let product = (word(n) * word(m)) as u64;
        let sum = if i.operation == Operation::Smmls {
            accumulator.wrapping_sub(product)
        } else {
            accumulator.wrapping_add(product)
        };
        let rounding = u64::from(i.immediate & 1) << 31;
        (sum.wrapping_add(rounding) >> 32) as u32
    }

    /// Additions and subtractions of bytes or halves (§A7.4.3). `lanes` is op1, `kind` op2 of
    /// table A5-26: 0 signed, 1 saturating, 2 halving; 4 unsigned.
    fn parallel(&mut self, lanes: u8, kind: u32, n: u32, m: u32) -> u32 {
        let is_bytes = lanes & 3 == 0;
        let width = if is_bytes { 8 } else { 16 };
        let is_unsigned = kind & 4 != 0;
        let mut result = 0;
        let mut greater_equal = 0;
        for lane in 0..32 / width {
            let (other, subtracts) = match lanes {
                0 | 1 => (lane, false),
                4 | 5 => (lane, true),
                // ASX: exchange, add at the top, subtract at the bottom. SAX: the reverse.
                2 => (1 - lane, lane == 0),
                _ => (1 - lane, lane == 1),
            };
            let x = extract(n, lane, width, is_unsigned);
            let y = extract(m, other, width, is_unsigned);
            let value = if subtracts { x - y } else { x + y };
            let wrapped = match (kind & 3, is_unsigned) {
                (1, false) => value.clamp(-(1 << (width - 1)), (1 << (width - 1)) - 1),
                (1, true) => value.clamp(0, (1 << width) - 1),
                (2, _) => value >> 1,
                _ => value,
            };
            let is_greater_equal = match (is_unsigned, subtracts) {
                (true, false) => value >= 1 << width,
                _ => value >= 0,
            };
            if is_greater_equal {
                greater_equal |= if is_bytes { 1 << lane } else { 3 << (2 * lane) };
            }
            result |= (wrapped as u32 & ones(width as u8)) << (lane * width);
        }
        if kind & 3 == 0 {
            self.registers.flags.greater_equal = greater_equal;
        }
        result
    }
}

/// Two products of halves, added or subtracted; bit 0 of the immediate exchanges the halves of m.
fn dual(i: Instruction, n: u32, m: u32) -> i64 {
    let m = if i.immediate & 1 != 0 {
        m.rotate_right(16)
    } else {
        m
    };
    let (low, high) = (bottom(n) * bottom(m), top(n) * top(m));
    match i.operation {
        Operation::Smlsd | Operation::Smlsld => low - high,
        _ => low + high,
    }
}

/// A lane of a word, extended.
fn extract(value: u32, lane: u32, width: u32, is_unsigned: bool) -> i32 {
    let aligned = value << (32 - (lane + 1) * width);
    if is_unsigned {
        (aligned >> (32 - width)) as i32
    } else {
        aligned as i32 >> (32 - width)
    }
}
