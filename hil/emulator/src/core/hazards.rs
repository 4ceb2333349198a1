//! What an instruction costs because of the one before it.
//!
//! The code cache decodes straight runs, so that both are known then and the interpreter pays nothing.
//! A branch into the midst of a run finds the cost of falling into it.

use super::cycles;
use super::instruction::{Instruction, Operation};
use Operation::*;

/// The instruction before the one being decoded, as far as it matters.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Before {
    /// It was a single load or store, whose data phase overlaps with the next one's address phase.
    transfers: bool,
    /// The S register in which its result arrives a cycle late.
    late: Option<u8>,
}

impl Before {
    /// What `instruction` costs behind this one; it is the one before the next.
    pub fn cost(&mut self, instruction: &Instruction) -> u8 {
        let overlaps = self.transfers && instruction.is_pipelined_transfer();
        let stalls = self.late.is_some_and(|s| awaits(instruction, s));
        *self = Self {
            transfers: instruction.is_pipelined_transfer(),
            late: late_result(instruction),
        };
        match instruction.cycles {
            cycles::LOAD if overlaps => cycles::PIPELINED_LOAD,
            cost => cost + u8::from(stalls) * cycles::FLOAT_RESULT,
        }
    }
}

/// The result of floating-point arithmetic, a conversion included; moves, signs and comparisons are
/// done in time (ARM DDI0439 §7.2.3, notes to table 7-1).
fn late_result(instruction: &Instruction) -> Option<u8> {
    match instruction.operation {
        Vadd | Vsub | Vmul | Vnmul | Vdiv | Vsqrt => Some(instruction.d),
        operation if is_multiply_add(operation) => Some(instruction.d),
        VcvtFromSigned | VcvtFromUnsigned | VcvtToSigned | VcvtToUnsigned | VcvtrToSigned
        | VcvtrToUnsigned | VcvtFromHalf | VcvtToHalf | VcvtFromFixed | VcvtToFixed => {
            Some(instruction.d)
        }
        _ => None,
    }
}

fn is_multiply_add(operation: Operation) -> bool {
    matches!(
        operation,
        Vmla | Vmls | Vnmla | Vnmls | Vfma | Vfms | Vfnma | Vfnms
    )
}

/// Whether an instruction needs S register `s` at once. A multiply-add takes its addend a cycle later,
/// in time for the result before it (the same notes).
fn awaits(instruction: &Instruction, s: u8) -> bool {
    let Instruction {
        operation, d, n, m, ..
    } = *instruction;
    match operation {
        Vadd | Vsub | Vmul | Vnmul | Vdiv => n == s || m == s,
        operation if is_multiply_add(operation) => n == s || m == s,
        Vsqrt | Vabs | Vneg | Vmov => m == s,
        VcvtFromSigned | VcvtFromUnsigned | VcvtToSigned | VcvtToUnsigned | VcvtrToSigned
        | VcvtrToUnsigned | VcvtFromHalf | VcvtToHalf => m == s,
        Vcmp => d == s || m == s,
        VcmpZero | VcvtFromFixed | VcvtToFixed | Vstr => d == s,
        VstrDouble => s & !1 == d,
        Vstm => (d..d + m).contains(&s),
        VmovToCore => n == s,
        VmovPairToCore => s == m || s == m + 1,
        _ => false,
    }
}
