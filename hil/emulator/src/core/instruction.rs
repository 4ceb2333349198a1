//! The decoded form of an instruction: what the interpreter executes and the code cache keeps.

/// What to do. The operands are the fields of [`Instruction`]; `d`, `n`, `m` are the registers that
/// the manual calls Rd (or Rt), Rn and Rm. Names follow the manual; a trailing `s` sets flags.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub(super) enum Operation {
    /// The end of what is decoded, and all that is not: see [`Instruction::UNDECODED`].
    Undecoded,
    /// No such instruction; `immediate` is its encoding.
    Undefined,
    /// An encoding the architecture leaves open; `immediate` is it.
    Unpredictable,
    Nop,
    /// `immediate`: the first condition and the mask.
    It,

    // ---- Data processing, immediate. Logical ones: `a` is a `flag_effect`; ADC, SBC: `a` is S.
    MovImm,
    MovsImm,
    MovTop,
    AddImm,
    AddsImm,
    SubImm,
    SubsImm,
    RsbImm,
    RsbsImm,
    AdcImm,
    SbcImm,
    CmpImm,
    CmnImm,
    AndImm,
    OrrImm,
    EorImm,
    BicImm,
    OrnImm,
    TstImm,
    TeqImm,

    // ---- Data processing, register. ADC, SBC: `a` is S.
    Mov,
    Movs,
    Add,
    Adds,
    Sub,
    Subs,
    Adc,
    Sbc,
    Cmp,
    Cmn,
    And,
    Ands,
    Orr,
    Orrs,
    Eor,
    Eors,
    Bic,
    Bics,
    Mvn,
    Mvns,
    Tst,

    // ---- Data processing, shifted register: `immediate` = kind | amount << 2, `a` is S.
    AddShifted,
    SubShifted,
    RsbShifted,
    AdcShifted,
    SbcShifted,
    CmpShifted,
    CmnShifted,
    AndShifted,
    OrrShifted,
    EorShifted,
    BicShifted,
    OrnShifted,
    TstShifted,
    TeqShifted,

    // ---- Shifts, by `immediate` or by register m. By register: `a` is S.
    LslImm,
    LslsImm,
    LsrImm,
    LsrsImm,
    AsrImm,
    AsrsImm,
    Lsl,
    Lsr,
    Asr,
    Ror,

    // ---- Multiplication and division; `a` is the accumulator or the low half of the result.
    Mul,
    Muls,
    Mla,
    Mls,
    Umull,
    Smull,
    Umlal,
    Smlal,
    Umaal,
    Udiv,
    Sdiv,

    // ---- Bits. Extensions: rotation in `immediate`, addend in n (15: none).
    Uxtab,
    Uxtah,
    Uxtab16,
    Sxtab,
    Sxtah,
    Sxtab16,
    /// Lowest bit in `immediate`, width in `a`.
    Ubfx,
    Sbfx,
    /// BFI, and with n = 15 BFC.
    Bfi,
    Clz,
    Rbit,
    Rev,
    Rev16,
    Revsh,

    // ---- DSP extension
    /// Saturates to bit `a`; `immediate` = kind of shift | amount << 2.
    Ssat,
    Usat,
    Ssat16,
    Usat16,
    /// `a`: 1 doubles, 2 subtracts.
    Qadd,
    /// `a`: lanes and direction (op1); `immediate`: signedness and overflow (op2).
    Parallel,
    Sel,
    Pkhbt,
    Pkhtb,
    /// Multiplications of halves; `immediate`: bit 0 top half of m (or exchange), bit 1 top of n.
    SmlaHalves,
    SmlaWide,
    Smlad,
    Smlsd,
    /// `immediate`: 1 rounds.
    Smmla,
    Smmls,
    Usada8,
    SmlalHalves,
    Smlald,
    Smlsld,

    // ---- Loads and stores
    /// From the address `immediate`.
    LdrLiteral,
    /// n + `immediate`
    LdrImm,
    StrImm,
    LdrbImm,
    StrbImm,
    LdrhImm,
    StrhImm,
    LdrsbImm,
    LdrshImm,
    /// n + (m << `immediate`)
    Ldr,
    Str,
    Ldrb,
    Strb,
    Ldrh,
    Strh,
    Ldrsb,
    Ldrsh,
    /// n and n + `immediate`; `a`: 1 uses the sum as the address (pre-indexed), else n.
    LdrIndexed,
    StrIndexed,
    LdrbIndexed,
    StrbIndexed,
    LdrhIndexed,
    StrhIndexed,
    LdrsbIndexed,
    LdrshIndexed,
    /// d and m; n + `immediate`; `a`: 1 the sum is the address, 2 it is written back.
    Ldrd,
    Strd,
    /// Registers in `immediate`; `a`: 1 writes back, 2 decrements before.
    Ldm,
    Stm,
    Push,
    Pop,
    /// As the indexed loads, with 2 in `a` for write-back.
    LdrPc,
    /// As `Ldr`.
    LdrPcRegister,
    /// d = status, n + `immediate`; m = the value.
    Ldrex,
    Ldrexb,
    Ldrexh,
    Strex,
    Strexb,
    Strexh,
    Clrex,

    // ---- Branches; `immediate` is the target, of BLX the return address
    B,
    Bl,
    Bx,
    Blx,
    /// MOV PC, m
    MovPc,
    /// ADD PC, m; `immediate` is the program counter as the instruction reads it.
    AddPc,
    Cbz,
    Cbnz,
    Tbb,
    Tbh,

    // ---- Floating point; d, n, m are S registers, for doubles the lower of the pair
    Vldr,
    Vstr,
    VldrDouble,
    VstrDouble,
    /// `m` words from d; `a`: 1 writes back, 2 decrements before.
    Vldm,
    Vstm,
    Vmov,
    VmovImm,
    Vadd,
    Vsub,
    Vmul,
    Vnmul,
    Vmla,
    Vmls,
    Vnmla,
    Vnmls,
    Vfma,
    Vfms,
    Vfnma,
    Vfnms,
    Vdiv,
    Vsqrt,
    Vabs,
    Vneg,
    Vcmp,
    VcmpZero,
    /// To floating point from a signed and an unsigned integer.
    VcvtFromSigned,
    VcvtFromUnsigned,
    /// To an integer, towards zero.
    VcvtToSigned,
    VcvtToUnsigned,
    /// To an integer, to nearest.
    VcvtrToSigned,
    VcvtrToUnsigned,
    /// Between half and single; `a`: 1 the top half.
    VcvtFromHalf,
    VcvtToHalf,
    /// Between fixed and floating point: `immediate` fraction bits; `a`: 1 unsigned, 2 of 32 bits.
    VcvtFromFixed,
    VcvtToFixed,
    /// Core register d, S register n.
    VmovToCore,
    VmovFromCore,
    /// Core registers d and n, S registers m and m + 1.
    VmovPairToCore,
    VmovPairFromCore,
    Vmrs,
    /// VMRS APSR_nzcv, FPSCR
    VmrsFlags,
    Vmsr,

    // ---- System
    /// Special register in `immediate`.
    Mrs,
    Msr,
    /// `d`: disable; `immediate`: 1 FAULTMASK, 2 PRIMASK.
    Cps,
    Bkpt,
    Svc,
    Wfe,
    Wfi,
    Sev,
}

/// What has to be looked at before an instruction may execute. One comparison tells that most
/// instructions need nothing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Guard(u8);

impl Guard {
    /// Executes always.
    pub const NONE: Self = Self(ALWAYS);
    const FLOAT: u8 = 0x10;
    const TRACED: u8 = 0x20;
    const LINE: u8 = 0x40;

    pub const fn on_condition(self, condition: u8) -> Self {
        Self(self.0 & 0xf0 | condition & 15)
    }

    pub const fn with_float(self) -> Self {
        Self(self.0 | Self::FLOAT)
    }

    pub const fn with_trace(self) -> Self {
        Self(self.0 | Self::TRACED)
    }

    pub const fn at_line(self) -> Self {
        Self(self.0 | Self::LINE)
    }

    /// The condition code; 14 is "always".
    #[inline(always)]
    pub const fn condition(self) -> u8 {
        self.0 & 15
    }

    #[inline(always)]
    pub const fn is_conditional(self) -> bool {
        self.condition() != ALWAYS
    }

    /// Needs the FPU.
    #[inline(always)]
    pub const fn is_float(self) -> bool {
        self.0 & Self::FLOAT != 0
    }

    /// It is the first in its line of flash.
    #[inline(always)]
    pub const fn begins_line(self) -> bool {
        self.0 & Self::LINE != 0
    }

    /// The call tracer wants to know when this executes.
    #[inline(always)]
    pub const fn is_traced(self) -> bool {
        self.0 & Self::TRACED != 0
    }
}

const ALWAYS: u8 = 14;

/// The number of the program counter in an encoding. As an operand of a decoded instruction it is
/// "no register": it reads as zero, since decoders make pc-relative operands absolute.
pub(super) const PC: u8 = 15;
/// The number of the link register.
pub(super) const LR: u8 = 14;
/// The number of the stack pointer.
pub(super) const SP: u8 = 13;

/// A decoded instruction. Small, because the busy part of the code cache should fit the host's.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Instruction {
    pub operation: Operation,
    pub guard: Guard,
    /// Bytes: 2 or 4.
    pub length: u8,
    /// What it costs, but for what depends on its operands.
    pub cycles: u8,
    pub d: u8,
    pub n: u8,
    pub m: u8,
    /// A fourth operand: an accumulator, a second destination or a variant.
    pub a: u8,
    pub immediate: u32,
}

impl Instruction {
    /// Makes the interpreter decode, or find, what is at the program counter. It takes no time, and
    /// its odd length keeps it from ever being behind itself.
    pub const UNDECODED: Self = Self {
        operation: Operation::Undecoded,
        guard: Guard::NONE,
        length: 1,
        cycles: 0,
        d: PC,
        n: PC,
        m: PC,
        a: 0,
        immediate: 0,
    };

    /// One cycle, no operands.
    pub const fn new(operation: Operation) -> Self {
        Self {
            operation,
            cycles: 1,
            ..Self::UNDECODED
        }
    }

    /// A floating-point instruction of one cycle.
    pub const fn float(operation: Operation) -> Self {
        Self {
            guard: Guard::NONE.with_float(),
            ..Self::new(operation)
        }
    }

    pub const fn d(self, d: u8) -> Self {
        Self { d, ..self }
    }

    pub const fn n(self, n: u8) -> Self {
        Self { n, ..self }
    }

    pub const fn m(self, m: u8) -> Self {
        Self { m, ..self }
    }

    pub const fn a(self, a: u8) -> Self {
        Self { a, ..self }
    }

    pub const fn immediate(self, immediate: u32) -> Self {
        Self { immediate, ..self }
    }

    pub const fn cycles(self, cycles: u8) -> Self {
        Self { cycles, ..self }
    }

    pub const fn on_condition(self, condition: u8) -> Self {
        Self {
            guard: self.guard.on_condition(condition),
            ..self
        }
    }

    /// A single load or store of a core register, which the pipeline can overlap with the next one.
    pub fn is_pipelined_transfer(&self) -> bool {
        let number = self.operation as u8;
        (Operation::LdrLiteral as u8..=Operation::LdrshIndexed as u8).contains(&number)
    }

    /// Whether its cost holds a refill of the pipeline.
    pub fn refills(&self) -> bool {
        use Operation::*;
        match self.operation {
            B | Bl | Bx | Blx | MovPc | AddPc | Tbb | Tbh | LdrPc | LdrPcRegister => true,
            Pop | Ldm => self.immediate & 1 << PC != 0,
            _ => false,
        }
    }

    /// Whether the instruction behind this one is never reached by falling through.
    pub fn ends_a_run(&self) -> bool {
        use Operation::*;
        let stops = matches!(
            self.operation,
            Undefined | Unpredictable | Svc | Bkpt | Wfe | Wfi
        );
        (stops || self.refills()) && !self.guard.is_conditional()
    }
}

/// The `a` of logical instructions with an immediate: whether they set N and Z, and what C becomes.
pub(super) mod flag_effect {
    /// Sets N and Z.
    pub const SET: u8 = 1;
    /// Sets C as well…
    pub const CARRY: u8 = 2;
    /// …to one.
    pub const CARRY_ONE: u8 = 4;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decoded_instruction_takes_twelve_bytes() {
        assert_eq!(size_of::<Instruction>(), 12);
    }
}
