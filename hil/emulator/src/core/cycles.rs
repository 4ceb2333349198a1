//! What instructions cost in cycles, where it is not one (ARM DDI0439 §3.3).
//!
//! Left out: contention with DMA, the penalty of unaligned accesses, and what integer instructions do
//! while a floating-point division is under way.

/// Refilling the pipeline after a branch: 1 to 3 in the manual, depending on alignment and width of the
/// target and on whether the core could guess it. What decoders assume; see
/// [`CycleModel`](super::CycleModel).
pub(super) const REFILL: u8 = 2;

/// A taken branch: B, BL, BX, BLX.
pub(super) const BRANCH: u8 = 1 + REFILL;

/// A single load.
pub(super) const LOAD: u8 = 2;

/// A load right behind another load or store: their address phases overlap.
pub(super) const PIPELINED_LOAD: u8 = 1;

/// A single store: the write buffer takes it.
pub(super) const STORE: u8 = 1;

/// Loading the program counter from memory.
pub(super) const LOAD_PC: u8 = LOAD + REFILL;

/// A table branch: a load and a branch.
pub(super) const TABLE_BRANCH: u8 = LOAD + REFILL;

/// LDREX, STREX and their like.
pub(super) const EXCLUSIVE: u8 = 2;

/// Two words in one instruction: LDRD, STRD, VLDR.64, VSTR.64.
pub(super) const DOUBLE: u8 = 3;

/// VLDR and VSTR of one word.
pub(super) const FLOAT_TRANSFER: u8 = 2;

/// Chained and fused multiply-add in floating point.
pub(super) const FLOAT_MULTIPLY_ADD: u8 = 3;

/// The result of floating-point arithmetic, where the next instruction needs it (§7.2.3).
pub(super) const FLOAT_RESULT: u8 = 1;

/// VDIV and VSQRT.
pub(super) const FLOAT_DIVIDE: u8 = 14;

/// Entering an exception: stacking eight words and fetching the vector.
pub(super) const EXCEPTION_ENTRY: u64 = 12;

/// Returning from an exception: unstacking eight words.
pub(super) const EXCEPTION_RETURN: u64 = 10;

/// From one handler straight to the next, without unstacking and stacking.
pub(super) const TAIL_CHAIN: u64 = 6;

/// Saving or restoring S0 to S15 and FPSCR.
pub(super) const FLOAT_FRAME: u64 = 17;

/// Several words moved by one instruction: LDM, STM, PUSH, POP, VLDM, VSTM.
pub(super) const fn multiple(words: u32) -> u8 {
    1 + words as u8
}

/// The same where one of `words` goes to the program counter.
pub(super) const fn multiple_and_branch(words: u32) -> u8 {
    words as u8 + REFILL
}

/// SDIV and UDIV beyond their first cycle: 2 to 12 in all, early termination by the difference of
/// the operands' leading zeros.
pub(super) fn division(dividend: u32, divisor: u32) -> u64 {
    if divisor == 0 || dividend < divisor {
        return 1;
    }
    let quotient_bits = divisor.leading_zeros() - dividend.leading_zeros();
    u64::from((1 + quotient_bits / 3).min(11))
}
