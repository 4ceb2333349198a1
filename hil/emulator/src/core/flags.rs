//! The application status flags, and the arithmetic that sets them (ARM DDI0403 §A2.3.2, §A2.2.1).

/// For each condition code, a bit for each of the sixteen values of NZCV (N is bit 3).
const CONDITIONS: [u16; 16] = condition_table();

const fn condition_table() -> [u16; 16] {
    let mut table = [0; 16];
    let mut nzcv = 0;
    while nzcv < 16 {
        let (n, z, c, v) = (nzcv & 8 != 0, nzcv & 4 != 0, nzcv & 2 != 0, nzcv & 1 != 0);
        let even = [z, c, n, v, c && !z, n == v, n == v && !z, true];
        let mut code = 0;
        while code < 14 {
            if even[code / 2] != (code & 1 != 0) {
                table[code] |= 1 << nzcv;
            }
            code += 1;
        }
        table[14] |= 1 << nzcv;
        table[15] |= 1 << nzcv;
        nzcv += 1;
    }
    table
}

/// N, Z, C, V, Q and GE. N and Z are kept as the result they describe and computed when asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flags {
    /// N is its top bit.
    negative: u32,
    /// Z is set where this is zero.
    nonzero: u32,
    pub carry: bool,
    pub overflow: bool,
    /// Q: some saturating operation saturated.
    pub saturated: bool,
    /// GE\[3:0\] of the parallel additions.
    pub greater_equal: u32,
}

impl Flags {
    /// The bits of APSR that exist.
    pub const APSR: u32 = 0xf80f_0000;

    pub fn from_apsr(apsr: u32) -> Self {
        Self {
            negative: apsr,
            nonzero: u32::from(apsr & 1 << 30 == 0),
            carry: apsr & 1 << 29 != 0,
            overflow: apsr & 1 << 28 != 0,
            saturated: apsr & 1 << 27 != 0,
            greater_equal: apsr >> 16 & 15,
        }
    }

    pub fn to_apsr(self) -> u32 {
        self.nzcv() << 28 | u32::from(self.saturated) << 27 | self.greater_equal << 16
    }

    /// Sets N, Z, C and V to the top four bits of `apsr`.
    pub fn set_nzcv(&mut self, apsr: u32) {
        *self = Self {
            saturated: self.saturated,
            greater_equal: self.greater_equal,
            ..Self::from_apsr(apsr)
        };
    }

    #[inline(always)]
    fn nzcv(self) -> u32 {
        (self.negative >> 31) << 3
            | u32::from(self.nonzero == 0) << 2
            | u32::from(self.carry) << 1
            | u32::from(self.overflow)
    }

    /// Whether a condition code (0 EQ … 14 AL) holds.
    #[inline(always)]
    pub fn hold(self, condition: u8) -> bool {
        CONDITIONS[usize::from(condition & 15)] >> self.nzcv() & 1 != 0
    }

    #[inline(always)]
    pub fn set_nz(&mut self, result: u32) {
        self.negative = result;
        self.nonzero = result;
    }

    /// `a + b`, setting NZCV.
    #[inline(always)]
    pub fn add(&mut self, a: u32, b: u32) -> u32 {
        let (sum, carry) = a.overflowing_add(b);
        self.carry = carry;
        self.overflow = ((a ^ sum) & (b ^ sum)) >> 31 != 0;
        self.set_nz(sum);
        sum
    }

    /// `a - b`, setting NZCV. Carry means no borrow.
    #[inline(always)]
    pub fn subtract(&mut self, a: u32, b: u32) -> u32 {
        let difference = a.wrapping_sub(b);
        self.carry = a >= b;
        self.overflow = ((a ^ b) & (a ^ difference)) >> 31 != 0;
        self.set_nz(difference);
        difference
    }

    /// `a + b + C`, setting NZCV only on demand. `a - b - !C` is this with `!b`.
    #[inline(always)]
    pub fn add_with_carry(&mut self, a: u32, b: u32, set: bool) -> u32 {
        let wide = u64::from(a) + u64::from(b) + u64::from(self.carry);
        let sum = wide as u32;
        if set {
            self.carry = wide >> 32 != 0;
            self.overflow = ((a ^ sum) & (b ^ sum)) >> 31 != 0;
            self.set_nz(sum);
        }
        sum
    }

    /// Shifts by a register or a decoded amount of 0 to 255. Returns the result and the carry out.
    /// `kind`: 0 LSL, 1 LSR, 2 ASR, 3 ROR.
    #[inline]
    pub fn shift(&self, value: u32, kind: u32, amount: u32) -> (u32, bool) {
        let bit = |number: u32| value >> (number & 31) & 1 != 0;
        match (kind, amount) {
            (_, 0) => (value, self.carry),
            (0, 1..=31) => (value << amount, bit(32 - amount)),
            (0, 32) => (0, bit(0)),
            (1, 1..=31) => (value >> amount, bit(amount - 1)),
            (1, 32) => (0, bit(31)),
            (0 | 1, _) => (0, false),
            (2, 1..=31) => (((value as i32) >> amount) as u32, bit(amount - 1)),
            (2, _) => (((value as i32) >> 31) as u32, bit(31)),
            _ => (value.rotate_right(amount & 31), bit(amount.wrapping_sub(1))),
        }
    }

    /// Clamps to a range and remembers in Q whether it had to.
    pub fn saturate(&mut self, value: i64, low: i64, high: i64) -> u32 {
        let clamped = value.clamp(low, high);
        self.saturated |= clamped != value;
        clamped as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The condition field as the manual spells it out (DDI0403 table A7-1).
    fn passes(code: u8, apsr: u32) -> bool {
        let bit = |number: u32| apsr >> number & 1 != 0;
        let (n, z, c, v) = (bit(31), bit(30), bit(29), bit(28));
        match code {
            0 => z,
            1 => !z,
            2 => c,
            3 => !c,
            4 => n,
            5 => !n,
            6 => v,
            7 => !v,
            8 => c && !z,
            9 => !c || z,
            10 => n == v,
            11 => n != v,
            12 => !z && n == v,
            13 => z || n != v,
            _ => true,
        }
    }

    #[test]
    fn every_condition_follows_the_table_of_the_manual() {
        for nzcv in 0..16u32 {
            let flags = Flags::from_apsr(nzcv << 28);
            for code in 0..15 {
                assert_eq!(
                    flags.hold(code),
                    passes(code, nzcv << 28),
                    "{code} {nzcv:04b}"
                );
            }
        }
    }

    proptest! {
        #[test]
        fn the_status_register_survives_a_round_trip(apsr in any::<u32>()) {
            let apsr = apsr & Flags::APSR;
            prop_assert_eq!(Flags::from_apsr(apsr).to_apsr(), apsr);
        }

        #[test]
        fn a_subtraction_is_an_addition_of_the_complement_and_one(a in any::<u32>(), b in any::<u32>()) {
            let mut by_subtraction = Flags::from_apsr(0);
            let mut by_addition = Flags::from_apsr(1 << 29);
            let difference = by_subtraction.subtract(a, b);
            prop_assert_eq!(difference, by_addition.add_with_carry(a, !b, true));
            prop_assert_eq!(by_subtraction.to_apsr(), by_addition.to_apsr());
        }
    }
}
