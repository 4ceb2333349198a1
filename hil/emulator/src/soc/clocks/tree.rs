//! Frequencies: from the settings in the registers to HCLK and the buses.

use super::clock;
use crate::soc::map::Block;
use crate::soc::refusal::Refusal;

/// The internal oscillator, in hertz (DS8626 §5.3.8).
pub const HSI_HERTZ: u32 = 16_000_000;

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

/// What decides the frequencies.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// HSE in hertz.
    pub crystal: u32,
    /// RCC_PLLCFGR.
    pub pllcfgr: u32,
    /// RCC_CFGR.
    pub cfgr: u32,
}

impl Setting {
    /// Whether the PLL multiplies HSE, not HSI.
    pub fn pll_from_hse(self) -> bool {
        self.pllcfgr & 1 << 22 != 0
    }

    /// The PLL's main output in hertz. Refuses settings outside the data sheet.
    pub fn pll_hertz(self) -> Result<u64, Refusal> {
        let source = if self.pll_from_hse() {
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

    /// SYSCLK in hertz.
    pub fn system_hertz(self) -> Result<u64, Refusal> {
        match self.cfgr & 3 {
            0 => Ok(u64::from(HSI_HERTZ)),
            1 => Ok(u64::from(self.crystal)),
            _ => self.pll_hertz(),
        }
    }

    /// The clock tree as programmed. Refuses frequencies outside the data sheet.
    pub fn tree(self) -> Result<ClockTree, Refusal> {
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
}

/// RCC_CFGR.HPRE.
const AHB_DIVIDERS: [u64; 16] = [1, 1, 1, 1, 1, 1, 1, 1, 2, 4, 8, 16, 64, 128, 256, 512];
/// RCC_CFGR.PPRE1 and PPRE2.
const APB_DIVIDERS: [u64; 8] = [1, 1, 1, 1, 2, 4, 8, 16];
