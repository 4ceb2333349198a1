//! What each operation does, on a page (ARM DDI0403 §A7.7).

use super::super::bus::{Bus, Width};
use super::super::exceptions::Sleep;
use super::super::instruction::{Instruction, LR, Operation, flag_effect};
use super::super::{Cause, Core, cycles};
use super::float;
use crate::memory::Memory;

impl Core {
    /// Executes an instruction whose guard let it pass. Its cycles are counted, and the program
    /// counter is behind it.
    #[inline(always)]
    pub(super) fn execute(&mut self, memory: &mut Memory, bus: &mut dyn Bus, i: Instruction) {
        /// The core register that a field of the instruction names.
        macro_rules! r {
            ($field:ident) => {
                self.registers.r[usize::from(i.$field & 15)]
            };
        }
        /// The S register that a field of the instruction names.
        macro_rules! s {
            ($field:ident) => {
                self.registers.s[usize::from(i.$field & 31)]
            };
        }
        macro_rules! flags {
            () => {
                self.registers.flags
            };
        }
        macro_rules! load {
            (u8, $address:expr) => {
                self.load8(memory, bus, $address)
            };
            (i8, $address:expr) => {
                self.load8(memory, bus, $address) as i8 as u32
            };
            (u16, $address:expr) => {
                self.load16(memory, bus, $address)
            };
            (i16, $address:expr) => {
                self.load16(memory, bus, $address) as i16 as u32
            };
            (u32, $address:expr) => {
                self.load32(memory, bus, $address)
            };
        }
        /// n + immediate
        macro_rules! offset {
            () => {
                r!(n).wrapping_add(i.immediate)
            };
        }
        /// n + (m << immediate)
        macro_rules! scaled {
            () => {
                r!(n).wrapping_add(r!(m) << (i.immediate & 3))
            };
        }
        /// n, or n + immediate for pre-indexed addressing.
        macro_rules! indexed {
            () => {
                if i.a & 1 != 0 { offset!() } else { r!(n) }
            };
        }
        /// A load that updates its base.
        macro_rules! load_indexed {
            ($kind:ident) => {{
                let (address, base) = (indexed!(), offset!());
                let value = load!($kind, address);
                r!(n) = base;
                r!(d) = value;
            }};
        }
        /// A store that updates its base.
        macro_rules! store_indexed {
            ($store:ident) => {{
                let (address, base, value) = (indexed!(), offset!(), r!(d));
                r!(n) = base;
                self.$store(memory, bus, address, value);
            }};
        }
        /// A logical operation with a shifted register; n = 15 reads as zero.
        macro_rules! logical_shifted {
            ($operation:expr) => {{
                let (operand, carry) = self.shifted(i);
                let result: u32 = $operation(r!(n), operand);
                if i.a != 0 {
                    flags!().set_nz(result);
                    flags!().carry = carry;
                }
                result
            }};
        }
        /// A shift by a register.
        macro_rules! shift {
            ($kind:expr) => {{
                let (result, carry) = flags!().shift(r!(n), $kind, r!(m) & 0xff);
                r!(d) = result;
                if i.a != 0 {
                    flags!().set_nz(result);
                    flags!().carry = carry;
                }
            }};
        }
        macro_rules! product {
            ($signed:ident, $wide:ident) => {
                (r!(n) as $signed as $wide * r!(m) as $signed as $wide) as u64
            };
        }
        macro_rules! accumulator {
            () => {
                u64::from(r!(d)) << 32 | u64::from(r!(a))
            };
        }
        /// A 64-bit result: high half to d, low half to a.
        macro_rules! long {
            ($value:expr) => {{
                let value: u64 = $value;
                r!(a) = value as u32;
                r!(d) = (value >> 32) as u32;
            }};
        }
        match i.operation {
            Operation::Nop => {}
            Operation::It => self.registers.it_block.open(i.immediate),

            Operation::MovImm => r!(d) = i.immediate,
            Operation::MovsImm => r!(d) = self.logical(i.a, i.immediate),
            Operation::MovTop => r!(d) = r!(d) & 0xffff | i.immediate << 16,
            Operation::AddImm => r!(d) = offset!(),
            Operation::AddsImm => r!(d) = flags!().add(r!(n), i.immediate),
            Operation::SubImm => r!(d) = r!(n).wrapping_sub(i.immediate),
            Operation::SubsImm => r!(d) = flags!().subtract(r!(n), i.immediate),
            Operation::RsbImm => r!(d) = i.immediate.wrapping_sub(r!(n)),
            Operation::RsbsImm => r!(d) = flags!().subtract(i.immediate, r!(n)),
            Operation::AdcImm => r!(d) = flags!().add_with_carry(r!(n), i.immediate, i.a != 0),
            Operation::SbcImm => r!(d) = flags!().add_with_carry(r!(n), !i.immediate, i.a != 0),
            Operation::CmpImm => _ = flags!().subtract(r!(n), i.immediate),
            Operation::CmnImm => _ = flags!().add(r!(n), i.immediate),
            Operation::AndImm => r!(d) = self.logical(i.a, r!(n) & i.immediate),
            Operation::OrrImm => r!(d) = self.logical(i.a, r!(n) | i.immediate),
            Operation::EorImm => r!(d) = self.logical(i.a, r!(n) ^ i.immediate),
            Operation::BicImm => r!(d) = self.logical(i.a, r!(n) & !i.immediate),
            Operation::OrnImm => r!(d) = self.logical(i.a, r!(n) | !i.immediate),
            Operation::TstImm => _ = self.logical(i.a, r!(n) & i.immediate),
            Operation::TeqImm => _ = self.logical(i.a, r!(n) ^ i.immediate),

            Operation::Mov => r!(d) = r!(m),
            Operation::Movs => r!(d) = self.logical(flag_effect::SET, r!(m)),
            Operation::Add => r!(d) = r!(n).wrapping_add(r!(m)),
            Operation::Adds => r!(d) = flags!().add(r!(n), r!(m)),
            Operation::Sub => r!(d) = r!(n).wrapping_sub(r!(m)),
            Operation::Subs => r!(d) = flags!().subtract(r!(n), r!(m)),
            Operation::Adc => r!(d) = flags!().add_with_carry(r!(n), r!(m), i.a != 0),
            Operation::Sbc => r!(d) = flags!().add_with_carry(r!(n), !r!(m), i.a != 0),
            Operation::Cmp => _ = flags!().subtract(r!(n), r!(m)),
            Operation::Cmn => _ = flags!().add(r!(n), r!(m)),
            Operation::And => r!(d) = r!(n) & r!(m),
            Operation::Ands => r!(d) = self.logical(flag_effect::SET, r!(n) & r!(m)),
            Operation::Orr => r!(d) = r!(n) | r!(m),
            Operation::Orrs => r!(d) = self.logical(flag_effect::SET, r!(n) | r!(m)),
            Operation::Eor => r!(d) = r!(n) ^ r!(m),
            Operation::Eors => r!(d) = self.logical(flag_effect::SET, r!(n) ^ r!(m)),
            Operation::Bic => r!(d) = r!(n) & !r!(m),
            Operation::Bics => r!(d) = self.logical(flag_effect::SET, r!(n) & !r!(m)),
            Operation::Mvn => r!(d) = !r!(m),
            Operation::Mvns => r!(d) = self.logical(flag_effect::SET, !r!(m)),
            Operation::Tst => _ = self.logical(flag_effect::SET, r!(n) & r!(m)),

            Operation::AddShifted => {
                let (operand, _) = self.shifted(i);
                r!(d) = if i.a != 0 {
                    flags!().add(r!(n), operand)
                } else {
                    r!(n).wrapping_add(operand)
                };
            }
            Operation::SubShifted => {
                let (operand, _) = self.shifted(i);
                r!(d) = if i.a != 0 {
                    flags!().subtract(r!(n), operand)
                } else {
                    r!(n).wrapping_sub(operand)
                };
            }
            Operation::RsbShifted => {
                let (operand, _) = self.shifted(i);
                r!(d) = if i.a != 0 {
                    flags!().subtract(operand, r!(n))
                } else {
                    operand.wrapping_sub(r!(n))
                };
            }
            Operation::AdcShifted => {
                let (operand, _) = self.shifted(i);
                r!(d) = flags!().add_with_carry(r!(n), operand, i.a != 0);
            }
            Operation::SbcShifted => {
                let (operand, _) = self.shifted(i);
                r!(d) = flags!().add_with_carry(r!(n), !operand, i.a != 0);
            }
            Operation::CmpShifted => {
                let (operand, _) = self.shifted(i);
                flags!().subtract(r!(n), operand);
            }
            Operation::CmnShifted => {
                let (operand, _) = self.shifted(i);
                flags!().add(r!(n), operand);
            }
            Operation::AndShifted => r!(d) = logical_shifted!(|a, b| a & b),
            Operation::OrrShifted => r!(d) = logical_shifted!(|a, b| a | b),
            Operation::EorShifted => r!(d) = logical_shifted!(|a, b| a ^ b),
            Operation::BicShifted => r!(d) = logical_shifted!(|a, b: u32| a & !b),
            Operation::OrnShifted => r!(d) = logical_shifted!(|a, b: u32| a | !b),
            Operation::TstShifted => _ = logical_shifted!(|a, b| a & b),
            Operation::TeqShifted => _ = logical_shifted!(|a, b| a ^ b),

            Operation::LslImm => r!(d) = r!(m) << (i.immediate & 31),
            Operation::LsrImm => r!(d) = (u64::from(r!(m)) >> i.immediate) as u32,
            Operation::AsrImm => r!(d) = (i64::from(r!(m) as i32) >> i.immediate) as u32,
            Operation::LslsImm => {
                let value = r!(m);
                flags!().carry = value >> (32 - i.immediate) & 1 != 0;
                r!(d) = self.logical(flag_effect::SET, value << (i.immediate & 31));
            }
            Operation::LsrsImm => {
                let value = u64::from(r!(m));
                flags!().carry = value >> (i.immediate - 1) & 1 != 0;
                r!(d) = self.logical(flag_effect::SET, (value >> i.immediate) as u32);
            }
            Operation::AsrsImm => {
                let value = i64::from(r!(m) as i32);
                flags!().carry = value >> (i.immediate - 1) & 1 != 0;
                r!(d) = self.logical(flag_effect::SET, (value >> i.immediate) as u32);
            }
            Operation::Lsl => shift!(0),
            Operation::Lsr => shift!(1),
            Operation::Asr => shift!(2),
            Operation::Ror => shift!(3),

            Operation::Mul => r!(d) = r!(n).wrapping_mul(r!(m)),
            Operation::Muls => r!(d) = self.logical(flag_effect::SET, r!(n).wrapping_mul(r!(m))),
            Operation::Mla => r!(d) = r!(n).wrapping_mul(r!(m)).wrapping_add(r!(a)),
            Operation::Mls => r!(d) = r!(a).wrapping_sub(r!(n).wrapping_mul(r!(m))),
            Operation::Umull => long!(product!(u32, u64)),
            Operation::Smull => long!(product!(i32, i64)),
            Operation::Umlal => long!(product!(u32, u64).wrapping_add(accumulator!())),
            Operation::Smlal => long!(product!(i32, i64).wrapping_add(accumulator!())),
            Operation::Umaal => long!(product!(u32, u64) + u64::from(r!(d)) + u64::from(r!(a))),
            Operation::Udiv => {
                let (dividend, divisor) = (r!(n), r!(m));
                r!(d) = dividend
                    .checked_div(divisor)
                    .unwrap_or_else(|| self.divided_by_zero());
                self.cycles += cycles::division(dividend, divisor);
            }
            Operation::Sdiv => {
                let (dividend, divisor) = (r!(n) as i32, r!(m) as i32);
                r!(d) = if divisor == 0 {
                    self.divided_by_zero()
                } else {
                    dividend.wrapping_div(divisor) as u32
                };
                self.cycles += cycles::division(dividend.unsigned_abs(), divisor.unsigned_abs());
            }

            Operation::Uxtab => r!(d) = r!(n).wrapping_add(rotated(i, r!(m)) & 0xff),
            Operation::Uxtah => r!(d) = r!(n).wrapping_add(rotated(i, r!(m)) & 0xffff),
            Operation::Sxtab => r!(d) = r!(n).wrapping_add(rotated(i, r!(m)) as i8 as u32),
            Operation::Sxtah => r!(d) = r!(n).wrapping_add(rotated(i, r!(m)) as i16 as u32),
            Operation::Uxtab16 | Operation::Sxtab16 => self.extend_halves(i),
            Operation::Ubfx => r!(d) = r!(n) >> (i.immediate & 31) & ones(i.a),
            Operation::Sbfx => {
                let unused = 32 - u32::from(i.a);
                let top = r!(n) << (unused.wrapping_sub(i.immediate) & 31);
                r!(d) = (top as i32 >> (unused & 31)) as u32;
            }
            Operation::Bfi => {
                let field = ones(i.a) << (i.immediate & 31);
                r!(d) = r!(d) & !field | r!(n) << (i.immediate & 31) & field;
            }
            Operation::Clz => r!(d) = r!(m).leading_zeros(),
            Operation::Rbit => r!(d) = r!(m).reverse_bits(),
            Operation::Rev => r!(d) = r!(m).swap_bytes(),
            Operation::Rev16 => r!(d) = r!(m).swap_bytes().rotate_right(16),
            Operation::Revsh => r!(d) = (r!(m) as u16).swap_bytes() as i16 as u32,

            Operation::Ssat
            | Operation::Usat
            | Operation::Ssat16
            | Operation::Usat16
            | Operation::Qadd
            | Operation::Parallel
            | Operation::Sel
            | Operation::Pkhbt
            | Operation::Pkhtb
            | Operation::SmlaHalves
            | Operation::SmlaWide
            | Operation::Smlad
            | Operation::Smlsd
            | Operation::Smmla
            | Operation::Smmls
            | Operation::Usada8
            | Operation::SmlalHalves
            | Operation::Smlald
            | Operation::Smlsld => self.execute_dsp(i),

            Operation::LdrLiteral => r!(d) = self.load_literal(memory, bus, i.immediate),
            Operation::LdrImm => r!(d) = load!(u32, offset!()),
            Operation::StrImm => self.store32(memory, bus, offset!(), r!(d)),
            Operation::LdrbImm => r!(d) = load!(u8, offset!()),
            Operation::StrbImm => self.store8(memory, bus, offset!(), r!(d)),
            Operation::LdrhImm => r!(d) = load!(u16, offset!()),
            Operation::StrhImm => self.store16(memory, bus, offset!(), r!(d)),
            Operation::LdrsbImm => r!(d) = load!(i8, offset!()),
            Operation::LdrshImm => r!(d) = load!(i16, offset!()),
            Operation::Ldr => r!(d) = load!(u32, scaled!()),
            Operation::Str => self.store32(memory, bus, scaled!(), r!(d)),
            Operation::Ldrb => r!(d) = load!(u8, scaled!()),
            Operation::Strb => self.store8(memory, bus, scaled!(), r!(d)),
            Operation::Ldrh => r!(d) = load!(u16, scaled!()),
            Operation::Strh => self.store16(memory, bus, scaled!(), r!(d)),
            Operation::Ldrsb => r!(d) = load!(i8, scaled!()),
            Operation::Ldrsh => r!(d) = load!(i16, scaled!()),
            Operation::LdrIndexed => load_indexed!(u32),
            Operation::LdrbIndexed => load_indexed!(u8),
            Operation::LdrhIndexed => load_indexed!(u16),
            Operation::LdrsbIndexed => load_indexed!(i8),
            Operation::LdrshIndexed => load_indexed!(i16),
            Operation::StrIndexed => store_indexed!(store32),
            Operation::StrbIndexed => store_indexed!(store8),
            Operation::StrhIndexed => store_indexed!(store16),
            Operation::Ldrd => self.load_double(memory, bus, i),
            Operation::Strd => self.store_double(memory, bus, i),
            Operation::Ldm => self.load_multiple(memory, bus, i),
            Operation::Stm => self.store_multiple(memory, bus, i),
            Operation::Push => self.push(memory, bus, i.immediate),
            Operation::Pop => self.pop(memory, bus, i.immediate),
            Operation::LdrPc => {
                let (address, base) = (indexed!(), offset!());
                let target = load!(u32, address);
                if i.a & 2 != 0 {
                    r!(n) = base;
                }
                self.branch_exchange(memory, target);
            }
            Operation::LdrPcRegister => {
                let target = load!(u32, scaled!());
                self.branch_exchange(memory, target);
            }
            Operation::Ldrex => r!(d) = self.load_exclusive(memory, bus, offset!(), Width::Word),
            Operation::Ldrexb => r!(d) = self.load_exclusive(memory, bus, offset!(), Width::Byte),
            Operation::Ldrexh => r!(d) = self.load_exclusive(memory, bus, offset!(), Width::Half),
            Operation::Strex => r!(d) = self.store_exclusive(memory, bus, i, Width::Word),
            Operation::Strexb => r!(d) = self.store_exclusive(memory, bus, i, Width::Byte),
            Operation::Strexh => r!(d) = self.store_exclusive(memory, bus, i, Width::Half),
            Operation::Clrex => self.exclusive = false,

            Operation::B => self.registers.pc = i.immediate,
            Operation::Bl => {
                self.registers.r[usize::from(LR)] = self.registers.pc | 1;
                self.registers.pc = i.immediate;
            }
            Operation::Bx => self.branch_exchange(memory, r!(m)),
            Operation::Blx => {
                let target = r!(m);
                self.registers.r[usize::from(LR)] = i.immediate;
                if target & 1 == 0 {
                    self.fail(Cause::ArmState(target));
                }
                self.registers.pc = target & !1;
            }
            Operation::MovPc => self.registers.pc = r!(m) & !1,
            Operation::AddPc => self.registers.pc = i.immediate.wrapping_add(r!(m)) & !1,
            Operation::Cbz => self.branch_if(r!(n) == 0, i.immediate),
            Operation::Cbnz => self.branch_if(r!(n) != 0, i.immediate),
            Operation::Tbb => {
                let entry = self.load8(memory, bus, table(i, r!(n)).wrapping_add(r!(m)));
                self.registers.pc = i.immediate.wrapping_add(2 * entry);
            }
            Operation::Tbh => {
                let entry = self.load16(memory, bus, table(i, r!(n)).wrapping_add(r!(m) << 1));
                self.registers.pc = i.immediate.wrapping_add(2 * entry);
            }

            Operation::Vldr => {
                let address = offset!();
                if self.aligned(address) {
                    s!(d) = load!(u32, address);
                }
            }
            Operation::Vstr => {
                let address = offset!();
                if self.aligned(address) {
                    self.store32(memory, bus, address, s!(d));
                }
            }
            Operation::VldrDouble => self.load_floats(memory, bus, offset!(), i.d, 2),
            Operation::VstrDouble => self.store_floats(memory, bus, offset!(), i.d, 2),
            Operation::Vldm | Operation::Vstm => self.float_multiple(memory, bus, i),
            Operation::Vmov => s!(d) = s!(m),
            Operation::VmovImm => s!(d) = i.immediate,
            Operation::Vadd => s!(d) = float::add(s!(n), s!(m)),
            Operation::Vsub => s!(d) = float::subtract(s!(n), s!(m)),
            Operation::Vmul => s!(d) = float::multiply(s!(n), s!(m)),
            Operation::Vnmul => s!(d) = float::negate(float::multiply(s!(n), s!(m))),
            Operation::Vmla => s!(d) = float::add(s!(d), float::multiply(s!(n), s!(m))),
            Operation::Vmls => {
                s!(d) = float::add(s!(d), float::negate(float::multiply(s!(n), s!(m))));
            }
            Operation::Vnmla => {
                let product = float::negate(float::multiply(s!(n), s!(m)));
                s!(d) = float::add(float::negate(s!(d)), product);
            }
            Operation::Vnmls => {
                s!(d) = float::add(float::negate(s!(d)), float::multiply(s!(n), s!(m)));
            }
            Operation::Vfma => s!(d) = float::fused(s!(d), s!(n), s!(m)),
            Operation::Vfms => s!(d) = float::fused(s!(d), float::negate(s!(n)), s!(m)),
            Operation::Vfnma => {
                s!(d) = float::fused(float::negate(s!(d)), float::negate(s!(n)), s!(m));
            }
            Operation::Vfnms => s!(d) = float::fused(float::negate(s!(d)), s!(n), s!(m)),
            Operation::Vdiv => s!(d) = float::divide(s!(n), s!(m)),
            Operation::Vsqrt => s!(d) = float::square_root(s!(m)),
            Operation::Vabs => s!(d) = s!(m) & !float::SIGN,
            Operation::Vneg => s!(d) = float::negate(s!(m)),
            Operation::Vcmp => self.compare_floats(s!(d), s!(m)),
            Operation::VcmpZero => self.compare_floats(s!(d), 0),
            Operation::VcvtFromSigned => s!(d) = (s!(m) as i32 as f32).to_bits(),
            Operation::VcvtFromUnsigned => s!(d) = (s!(m) as f32).to_bits(),
            Operation::VcvtToSigned => s!(d) = f32::from_bits(s!(m)) as i32 as u32,
            Operation::VcvtToUnsigned => s!(d) = f32::from_bits(s!(m)) as u32,
            Operation::VcvtrToSigned => {
                s!(d) = f32::from_bits(s!(m)).round_ties_even() as i32 as u32;
            }
            Operation::VcvtrToUnsigned => {
                s!(d) = f32::from_bits(s!(m)).round_ties_even() as u32;
            }
            Operation::VcvtFromHalf => s!(d) = float::from_half((s!(m) >> half_shift(i)) as u16),
            Operation::VcvtToHalf => {
                let half = u32::from(float::to_half(s!(m))) << half_shift(i);
                s!(d) = s!(d) & !(0xffff << half_shift(i)) | half;
            }
            Operation::VcvtFromFixed => s!(d) = float::from_fixed(s!(d), i.a, i.immediate),
            Operation::VcvtToFixed => s!(d) = float::to_fixed(s!(d), i.a, i.immediate),
            Operation::VmovToCore => r!(d) = s!(n),
            Operation::VmovFromCore => s!(n) = r!(d),
            Operation::VmovPairToCore => {
                r!(d) = s!(m);
                r!(n) = self.registers.s[usize::from((i.m + 1) & 31)];
            }
            Operation::VmovPairFromCore => {
                s!(m) = r!(d);
                self.registers.s[usize::from((i.m + 1) & 31)] = r!(n);
            }
            Operation::Vmrs => r!(d) = self.registers.fpscr,
            Operation::VmrsFlags => flags!().set_nzcv(self.registers.fpscr),
            Operation::Vmsr => self.write_fpscr(r!(d)),

            Operation::Mrs => self.read_special(i),
            Operation::Msr => self.write_special(i),
            Operation::Cps => self.change_masks(i),
            Operation::Bkpt => self.fail(Cause::Breakpoint(i.immediate as u8)),
            Operation::Svc => self.supervisor_call(i.immediate as u8),
            Operation::Wfe if self.event => self.event = false,
            Operation::Wfe => self.fall_asleep(Sleep::ForEvent),
            Operation::Wfi => self.fall_asleep(Sleep::ForInterrupt),
            Operation::Sev => self.event = true,

            Operation::Undecoded => self.decode_more(memory, bus),
            Operation::Undefined => self.fail(Cause::UndefinedInstruction(i.immediate)),
            Operation::Unpredictable => self.fail(Cause::Unpredictable(i.immediate)),
        }
    }

    /// Sets the flags that a logical operation asks for, and passes its result on.
    #[inline(always)]
    fn logical(&mut self, effect: u8, result: u32) -> u32 {
        let flags = &mut self.registers.flags;
        if effect & flag_effect::SET != 0 {
            flags.set_nz(result);
            if effect & flag_effect::CARRY != 0 {
                flags.carry = effect & flag_effect::CARRY_ONE != 0;
            }
        }
        result
    }

    /// Register m shifted as the immediate says, and the carry out.
    #[inline(always)]
    fn shifted(&self, i: Instruction) -> (u32, bool) {
        const ROTATE_WITH_EXTEND: u32 = 3;
        let value = self.registers.r[usize::from(i.m & 15)];
        let flags = &self.registers.flags;
        if i.immediate == ROTATE_WITH_EXTEND {
            return (value >> 1 | u32::from(flags.carry) << 31, value & 1 != 0);
        }
        flags.shift(value, i.immediate & 3, i.immediate >> 2)
    }

    /// BX, POP and LDR to the program counter.
    #[inline(always)]
    pub(super) fn branch_exchange(&mut self, memory: &Memory, target: u32) {
        if target & 1 == 0 || target >> 28 == 0xf {
            return self.branch_to_unusual(memory, target);
        }
        self.registers.pc = target & !1;
    }

    #[inline(always)]
    fn branch_if(&mut self, taken: bool, target: u32) {
        if taken {
            self.registers.pc = target;
            self.cycles += u64::from(self.code.refill());
        }
    }
}

/// The operand of an extension.
#[inline(always)]
fn rotated(i: Instruction, value: u32) -> u32 {
    value.rotate_right(i.immediate)
}

/// The base of a branch table: behind the instruction where n is 15.
#[inline(always)]
fn table(i: Instruction, n: u32) -> u32 {
    if i.n == super::super::instruction::PC {
        i.immediate
    } else {
        n
    }
}

/// A mask of `width` ones, 1 to 32.
#[inline(always)]
pub(super) fn ones(width: u8) -> u32 {
    u32::MAX >> ((32 - u32::from(width)) & 31)
}

/// Which half of an S register holds a half-precision number.
#[inline(always)]
fn half_shift(i: Instruction) -> u32 {
    u32::from(i.a & 1) * 16
}
