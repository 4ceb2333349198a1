//! RCC: oscillators, PLL, bus prescalers, clock gates, resets and clock outputs (RM0090 §7).

use super::map::{Block, Gate};
use super::refusal::Refusal;
use crate::time::Nanos;

/// The internal oscillator, in hertz (DS8626 §5.3.8).
const HSI_HERTZ: u32 = 16_000_000;
/// The low-speed external crystal every board uses, in hertz.
const LSE_HERTZ: u32 = 32_768;

/// Start-up times, typical of DS8626 §5.3.8 to §5.3.10: HSI 2.2 µs, HSE 2 ms, PLL lock at most
/// 200 µs at a VCO of 192 MHz, LSI 15 µs, LSE 2 s.
const HSI_STARTUP: Nanos = Nanos(2_200);
const HSE_STARTUP: Nanos = Nanos(2_000_000);
const PLL_STARTUP: Nanos = Nanos(200_000);
const LSI_STARTUP: Nanos = Nanos(15_000);
const LSE_STARTUP: Nanos = Nanos(2_000_000_000);

/// Limits of DS8626 table 14 and §5.3.10, in hertz.
const MAX_HCLK: u64 = 168_000_000;
const MAX_PCLK1: u64 = 42_000_000;
const MAX_PCLK2: u64 = 84_000_000;
const PLL_INPUT: core::ops::RangeInclusive<u64> = 950_000..=2_100_000;
const PLL_VCO: core::ops::RangeInclusive<u64> = 100_000_000..=432_000_000;

/// HCLK and its integer relations to the two peripheral buses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockTree {
    /// Core, memories, AHB, DMA: in hertz.
    pub hclk: u32,
    /// HCLK cycles in one PCLK1 cycle.
    pub pclk1_cycles: u64,
    /// HCLK cycles in one PCLK2 cycle.
    pub pclk2_cycles: u64,
}

impl ClockTree {
    /// After reset: everything on the internal oscillator.
    pub const RESET: Self = Self {
        hclk: HSI_HERTZ,
        pclk1_cycles: 1,
        pclk2_cycles: 1,
    };

    /// HCLK cycles in one bus clock cycle of `block`.
    pub fn bus_cycles(&self, block: Block) -> u64 {
        if block.on_apb2() {
            self.pclk2_cycles
        } else {
            self.pclk1_cycles
        }
    }

    /// HCLK cycles in one clock of timer `block`: timers run at twice a divided bus clock
    /// (RM0090 §7.2, figure 21).
    pub fn timer_cycles(&self, block: Block) -> u64 {
        self.bus_cycles(block).div_ceil(2)
    }
}

/// What reset the chip. Software reads it in RCC_CSR (RM0090 §7.3.21).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// The NRST pin.
    Pin,
    /// AIRCR.SYSRESETREQ.
    Software,
    /// The independent watchdog.
    Watchdog,
}

impl ResetCause {
    /// The flags it leaves. Every internal reset pulls NRST as well (RM0090 §7.1.1).
    fn flags(self) -> u32 {
        let own = match self {
            Self::Pin => 0,
            Self::Software => 1 << 28,
            Self::Watchdog => 1 << 29,
        };
        own | 1 << 26
    }
}

/// What the rest of the chip must do after a register was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    None,
    /// The clock tree or a clock output may have changed.
    Clocks,
    /// Blocks whose reset bit is now set must be reset: see [`Rcc::in_reset`].
    Reset,
}

/// An oscillator or PLL: on, and when it is ready.
#[derive(Clone, Copy, Debug, Default)]
struct Source {
    on: bool,
    ready_at: Nanos,
}

impl Source {
    fn switch(&mut self, on: bool, now: Nanos, startup: Nanos) {
        if on && !self.on {
            self.ready_at = now + startup;
        }
        self.on = on;
    }

    fn ready(&self, now: Nanos) -> bool {
        self.on && now >= self.ready_at
    }

    /// The ON bit and, one above it, the RDY bit.
    fn bits(&self, now: Nanos, on_bit: u32) -> u32 {
        (u32::from(self.on) | u32::from(self.ready(now)) << 1) << on_bit
    }
}

mod register {
    pub const CR: u32 = 0x00;
    pub const PLLCFGR: u32 = 0x04;
    pub const CFGR: u32 = 0x08;
    pub const CIR: u32 = 0x0c;
    pub const AHB1RSTR: u32 = 0x10;
    pub const AHB2RSTR: u32 = 0x14;
    pub const APB1RSTR: u32 = 0x20;
    pub const APB2RSTR: u32 = 0x24;
    pub const AHB1ENR: u32 = 0x30;
    pub const AHB2ENR: u32 = 0x34;
    pub const APB1ENR: u32 = 0x40;
    pub const APB2ENR: u32 = 0x44;
    pub const BDCR: u32 = 0x70;
    pub const CSR: u32 = 0x74;
    pub const PLLI2SCFGR: u32 = 0x84;
    /// Reserved on an F407, the clock multiplexers of its larger sisters: drivers for the whole
    /// family write their reset value to it.
    pub const DCKCFGR: u32 = 0x8c;
}
use register::*;

/// Registers that only store: offset, reset value, writable bits. Low-power enables matter to a
/// current meter alone; spread spectrum moves edges by less than a cycle.
const PLAIN: [(u32, u32, u32); 17] = [
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
];

/// RCC_CSR after power-on: brown-out, pin and power-on reset flags (RM0090 §7.3.21).
const POWER_ON_FLAGS: u32 = 0x0e00_0000;

/// Reset and clock control.
#[derive(Clone, Debug)]
pub struct Rcc {
    crystal: u32,
    hsi: Source,
    hse: Source,
    pll: Source,
    plli2s: Source,
    lsi: Source,
    lse: Source,
    /// Bits of CR that only store: trim, calibration, bypass, clock security.
    cr: u32,
    pllcfgr: u32,
    cfgr: u32,
    bdcr: u32,
    reset_flags: u32,
    plain: [u32; PLAIN.len()],
}

impl Rcc {
    /// Power-on reset, with a crystal of `crystal` hertz on OSC_IN.
    pub fn new(crystal: u32) -> Self {
        Self {
            crystal,
            hsi: Source {
                on: true,
                ready_at: Nanos(0),
            },
            hse: Source::default(),
            pll: Source::default(),
            plli2s: Source::default(),
            lsi: Source::default(),
            lse: Source::default(),
            cr: 0x80,
            pllcfgr: 0x2400_3010,
            cfgr: 0,
            bdcr: 0,
            reset_flags: POWER_ON_FLAGS,
            plain: PLAIN.map(|(_, reset, _)| reset),
        }
    }

    /// A system reset: the reset flags and the backup domain keep what they hold.
    pub fn reset(&mut self, cause: ResetCause) {
        *self = Self {
            reset_flags: self.reset_flags | cause.flags(),
            bdcr: self.bdcr,
            lse: self.lse,
            ..Self::new(self.crystal)
        };
    }

    /// Reads a register at `now`.
    pub fn read(&self, offset: u32, now: Nanos) -> Result<u32, Refusal> {
        Ok(match offset {
            CR => {
                self.cr
                    | self.hsi.bits(now, 0)
                    | self.hse.bits(now, 16)
                    | self.pll.bits(now, 24)
                    | self.plli2s.bits(now, 26)
            }
            PLLCFGR => self.pllcfgr,
            CFGR => self.cfgr | (self.cfgr & 3) << 2,
            CIR | DCKCFGR => 0,
            BDCR => self.bdcr | self.lse.bits(now, 0),
            CSR => self.reset_flags | self.lsi.bits(now, 0),
            _ => self.plain[plain_index(offset)?],
        })
    }

    /// Writes a register at `now`.
    pub fn write(&mut self, offset: u32, value: u32, now: Nanos) -> Result<Effect, Refusal> {
        match offset {
            CR => self.write_cr(value, now),
            PLLCFGR => {
                if self.pll.on && value != self.pllcfgr {
                    return Err(clock("PLLCFGR was written while the PLL is on"));
                }
                self.pllcfgr = value & 0x0f43_7fff | 0x2000_0000;
                Ok(Effect::None)
            }
            CFGR => self.write_cfgr(value, now),
            CIR => {
                if value & 0x3f00 != 0 {
                    return Err(unmodelled("clock ready interrupts", value));
                }
                Ok(Effect::None)
            }
            DCKCFGR if value == 0 => Ok(Effect::None),
            BDCR => {
                self.write_bdcr(value, now);
                Ok(Effect::None)
            }
            CSR => {
                self.lsi.switch(value & 1 != 0, now, LSI_STARTUP);
                if value & 1 << 24 != 0 {
                    self.reset_flags = 0;
                }
                Ok(Effect::None)
            }
            _ => {
                let index = plain_index(offset)?;
                self.plain[index] = value & PLAIN[index].2;
                Ok(match offset {
                    AHB1RSTR..=APB2RSTR => Effect::Reset,
                    AHB1ENR..=APB2ENR => Effect::Clocks,
                    _ => Effect::None,
                })
            }
        }
    }

    fn write_cr(&mut self, value: u32, now: Nanos) -> Result<Effect, Refusal> {
        let system = self.cfgr & 3;
        let pll_was_on = self.pll.on;
        let from_hse = self.pllcfgr & 1 << 22 != 0;
        self.cr = value & 0x000c_00f8;
        self.pll
            .switch(value & 1 << 24 != 0 || system == 2, now, PLL_STARTUP);
        self.plli2s.switch(value & 1 << 26 != 0, now, PLL_STARTUP);
        // A source in use cannot be switched off (RM0090 §7.3.1).
        let hsi_used = system == 0 || system == 2 && !from_hse;
        let hse_used = system == 1 || system == 2 && from_hse;
        self.hsi
            .switch(value & 1 != 0 || hsi_used, now, HSI_STARTUP);
        self.hse
            .switch(value & 1 << 16 != 0 || hse_used, now, HSE_STARTUP);
        if self.pll.on && !pll_was_on {
            let source = if from_hse { &self.hse } else { &self.hsi };
            if !source.ready(now) {
                return Err(clock("the PLL was switched on before its source is ready"));
            }
            self.pll_hertz()?;
        }
        Ok(Effect::Clocks)
    }

    fn write_cfgr(&mut self, value: u32, now: Nanos) -> Result<Effect, Refusal> {
        let ready = match value & 3 {
            0 => self.hsi.ready(now),
            1 => self.hse.ready(now),
            2 => self.pll.ready(now),
            _ => return Err(clock("CFGR.SW selects nothing")),
        };
        if !ready {
            return Err(clock("the system clock was switched to a source not ready"));
        }
        self.cfgr = value & 0xfffe_fcf3;
        self.tree()?;
        Ok(Effect::Clocks)
    }

    fn write_bdcr(&mut self, value: u32, now: Nanos) {
        if value & 1 << 16 != 0 {
            self.bdcr = 1 << 16;
            self.lse.switch(false, now, LSE_STARTUP);
        } else {
            self.bdcr = value & 0x0000_8304;
            self.lse.switch(value & 1 != 0, now, LSE_STARTUP);
        }
    }

    fn pll_hertz(&self) -> Result<u64, Refusal> {
        let source = if self.pllcfgr & 1 << 22 != 0 {
            self.crystal
        } else {
            HSI_HERTZ
        };
        let m = u64::from(self.pllcfgr & 0x3f);
        let n = u64::from(self.pllcfgr >> 6 & 0x1ff);
        let p = 2 * (u64::from(self.pllcfgr >> 16 & 3) + 1);
        if m < 2 || !(50..=432).contains(&n) {
            return Err(clock("PLLM below 2 or PLLN outside 50..=432"));
        }
        let source = u64::from(source);
        if !PLL_INPUT.contains(&(source / m)) {
            return Err(clock("the PLL's input is outside 0.95 to 2.1 MHz"));
        }
        if !PLL_VCO.contains(&(source * n / m)) {
            return Err(clock("the PLL's VCO is outside 100 to 432 MHz"));
        }
        Ok(source * n / m / p)
    }

    fn system_hertz(&self) -> Result<u64, Refusal> {
        match self.cfgr & 3 {
            0 => Ok(u64::from(HSI_HERTZ)),
            1 => Ok(u64::from(self.crystal)),
            _ => self.pll_hertz(),
        }
    }

    /// The clock tree as programmed. Refuses frequencies outside the data sheet.
    pub fn tree(&self) -> Result<ClockTree, Refusal> {
        let hclk = self.system_hertz()? / AHB_DIVIDERS[(self.cfgr >> 4 & 15) as usize];
        let pclk1_cycles = APB_DIVIDERS[(self.cfgr >> 10 & 7) as usize];
        let pclk2_cycles = APB_DIVIDERS[(self.cfgr >> 13 & 7) as usize];
        if !(1..=MAX_HCLK).contains(&hclk) {
            return Err(clock("HCLK is outside 1 Hz to 168 MHz"));
        }
        if hclk / pclk1_cycles > MAX_PCLK1 {
            return Err(clock("PCLK1 is above 42 MHz"));
        }
        if hclk / pclk2_cycles > MAX_PCLK2 {
            return Err(clock("PCLK2 is above 84 MHz"));
        }
        Ok(ClockTree {
            hclk: hclk as u32,
            pclk1_cycles,
            pclk2_cycles,
        })
    }

    /// MCO1's frequency in hertz; `None` while its source is off.
    pub fn mco1_hertz(&self, now: Nanos) -> Option<f64> {
        let hertz = match self.cfgr >> 21 & 3 {
            0 => self.hsi.ready(now).then_some(HSI_HERTZ.into()),
            1 => self.lse.ready(now).then_some(LSE_HERTZ.into()),
            2 => self.hse.ready(now).then_some(self.crystal.into()),
            _ => self.running_pll(now),
        };
        Some(hertz? as f64 / mco_divider(self.cfgr >> 24))
    }

    /// MCO2's frequency in hertz; `None` while its source is off (PLLI2S feeds no model).
    pub fn mco2_hertz(&self, now: Nanos) -> Option<f64> {
        let hertz = match self.cfgr >> 30 {
            0 => self.system_hertz().ok(),
            1 => None,
            2 => self.hse.ready(now).then_some(self.crystal.into()),
            _ => self.running_pll(now),
        };
        Some(hertz? as f64 / mco_divider(self.cfgr >> 27))
    }

    fn running_pll(&self, now: Nanos) -> Option<u64> {
        self.pll.ready(now).then(|| self.pll_hertz().ok())?
    }

    /// True while the clock of a block behind `gate` runs.
    pub fn enabled(&self, gate: Gate) -> bool {
        self.gate_bit(gate, [AHB1ENR, AHB2ENR, APB1ENR, APB2ENR])
    }

    /// True while a block behind `gate` is held in reset.
    pub fn in_reset(&self, gate: Gate) -> bool {
        self.gate_bit(gate, [AHB1RSTR, AHB2RSTR, APB1RSTR, APB2RSTR])
    }

    fn gate_bit(&self, gate: Gate, registers: [u32; 4]) -> bool {
        let (bus, bit) = match gate {
            Gate::Ahb1(bit) => (0, bit),
            Gate::Ahb2(bit) => (1, bit),
            Gate::Apb1(bit) => (2, bit),
            Gate::Apb2(bit) => (3, bit),
        };
        plain_index(registers[bus]).is_ok_and(|index| self.plain[index] >> bit & 1 != 0)
    }
}

/// RCC_CFGR.HPRE.
const AHB_DIVIDERS: [u64; 16] = [1, 1, 1, 1, 1, 1, 1, 1, 2, 4, 8, 16, 64, 128, 256, 512];
/// RCC_CFGR.PPRE1 and PPRE2.
const APB_DIVIDERS: [u64; 8] = [1, 1, 1, 1, 2, 4, 8, 16];

/// RCC_CFGR.MCOxPRE.
fn mco_divider(field: u32) -> f64 {
    match field & 7 {
        field @ 4..=7 => f64::from(field - 2),
        _ => 1.0,
    }
}

fn plain_index(offset: u32) -> Result<usize, Refusal> {
    PLAIN
        .iter()
        .position(|&(register, ..)| register == offset)
        .ok_or(Refusal::UnmodelledRegister {
            block: Block::Rcc,
            address: 0x4002_3800 + offset,
        })
}

fn clock(what: &'static str) -> Refusal {
    Refusal::Clock { what }
}

fn unmodelled(what: &'static str, value: u32) -> Refusal {
    Refusal::UnmodelledMode {
        block: Block::Rcc,
        what,
        value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 8 MHz / 4 × 168 / 2, APB1 ÷4, APB2 ÷2: the set-up of an F407 at full speed.
    fn at_full_speed() -> Rcc {
        let mut rcc = Rcc::new(8_000_000);
        rcc.write(CR, 0x0001_0083, Nanos(0)).unwrap();
        rcc.write(PLLCFGR, 1 << 22 | 168 << 6 | 4 | 7 << 24, Nanos(0))
            .unwrap();
        rcc.write(CR, 0x0101_0083, Nanos::from_millis(2)).unwrap();
        rcc.write(CFGR, 2 | 5 << 10 | 4 << 13, Nanos::from_millis(3))
            .unwrap();
        rcc
    }

    #[test]
    fn the_chip_starts_on_the_16_mhz_internal_oscillator() {
        let rcc = Rcc::new(8_000_000);
        assert_eq!(rcc.tree(), Ok(ClockTree::RESET));
        assert_eq!(rcc.read(CR, Nanos(0)).unwrap(), 0x83);
        assert_eq!(rcc.read(CFGR, Nanos(0)).unwrap(), 0);
    }

    #[test]
    fn an_8_mhz_crystal_makes_168_mhz_with_buses_at_42_and_84() {
        let tree = at_full_speed().tree().unwrap();
        assert_eq!(tree.hclk, 168_000_000);
        assert_eq!(u64::from(tree.hclk) / tree.pclk1_cycles, 42_000_000);
        assert_eq!(u64::from(tree.hclk) / tree.pclk2_cycles, 84_000_000);
    }

    #[test]
    fn timers_run_at_twice_a_divided_bus_clock() {
        let tree = at_full_speed().tree().unwrap();
        assert_eq!(168 / tree.timer_cycles(Block::Timer(3)), 84);
        assert_eq!(168 / tree.timer_cycles(Block::Timer(1)), 168);
        let undivided = Rcc::new(8_000_000).tree().unwrap();
        assert_eq!(undivided.timer_cycles(Block::Timer(3)), 1);
    }

    #[test]
    fn the_crystal_is_ready_two_milliseconds_after_it_was_switched_on() {
        let mut rcc = Rcc::new(8_000_000);
        rcc.write(CR, 0x0001_0083, Nanos(500)).unwrap();
        let ready = |rcc: &Rcc, at| rcc.read(CR, Nanos(at)).unwrap() & 1 << 17 != 0;
        assert!(!ready(&rcc, 2_000_499));
        assert!(ready(&rcc, 2_000_500));
    }

    #[test]
    fn switching_to_a_source_that_is_not_ready_is_refused() {
        let mut rcc = Rcc::new(8_000_000);
        assert!(matches!(
            rcc.write(CFGR, 1, Nanos(0)),
            Err(Refusal::Clock { .. })
        ));
    }

    #[test]
    fn a_pll_outside_the_data_sheet_is_refused() {
        let mut rcc = Rcc::new(8_000_000);
        rcc.write(PLLCFGR, 168 << 6 | 2, Nanos(0)).unwrap();
        assert!(matches!(
            rcc.write(CR, 0x0100_0083, Nanos(0)),
            Err(Refusal::Clock { .. })
        ));
    }

    #[test]
    fn rmvf_clears_the_power_on_reset_flags() {
        let mut rcc = Rcc::new(8_000_000);
        assert_eq!(rcc.read(CSR, Nanos(0)).unwrap(), 0x0e00_0000);
        rcc.write(CSR, 1 << 24, Nanos(0)).unwrap();
        assert_eq!(rcc.read(CSR, Nanos(0)).unwrap(), 0);
    }

    #[test]
    fn mco1_divides_its_source_by_up_to_five() {
        let mut rcc = at_full_speed();
        let base = 2 | 5 << 10 | 4 << 13;
        let now = Nanos::from_millis(4);
        assert_eq!(rcc.mco1_hertz(now), Some(16e6));
        rcc.write(CFGR, base | 3 << 21 | 7 << 24, now).unwrap();
        assert_eq!(rcc.mco1_hertz(now), Some(33.6e6));
    }

    #[test]
    fn an_unknown_register_is_refused_with_its_address() {
        assert_eq!(
            Rcc::new(8_000_000).read(0x90, Nanos(0)),
            Err(Refusal::UnmodelledRegister {
                block: Block::Rcc,
                address: 0x4002_3890
            })
        );
    }
}
