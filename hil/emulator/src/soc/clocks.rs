//! RCC: oscillators, PLL, bus prescalers, clock gates, resets and clock outputs (RM0090 §7).

mod gates;
mod source;
mod tree;

pub use tree::ClockTree;

use super::map::{Block, Gate};
use super::refusal::Refusal;
use crate::time::Nanos;
use gates::Gates;
use source::{HSE_STARTUP, HSI_STARTUP, LSE_STARTUP, LSI_STARTUP, PLL_STARTUP, Source};
use tree::{HSI_HERTZ, Setting};

const CR: u32 = 0x00;
const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;
const CIR: u32 = 0x0c;
const BDCR: u32 = 0x70;
const CSR: u32 = 0x74;

/// The low-speed external crystal every board uses, in hertz.
const LSE_HERTZ: u32 = 32_768;

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
    gates: Gates,
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
            gates: Gates::new(),
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
            CIR => 0,
            BDCR => self.bdcr | self.lse.bits(now, 0),
            CSR => self.reset_flags | self.lsi.bits(now, 0),
            _ => self.gates.read(offset)?,
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
            _ => self.gates.write(offset, value),
        }
    }

    fn write_cr(&mut self, value: u32, now: Nanos) -> Result<Effect, Refusal> {
        let system = self.cfgr & 3;
        let pll_was_on = self.pll.on;
        let from_hse = self.setting().pll_from_hse();
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
            self.setting().pll_hertz()?;
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
            0 => self.setting().system_hertz().ok(),
            1 => None,
            2 => self.hse.ready(now).then_some(self.crystal.into()),
            _ => self.running_pll(now),
        };
        Some(hertz? as f64 / mco_divider(self.cfgr >> 27))
    }

    fn setting(&self) -> Setting {
        Setting {
            crystal: self.crystal,
            pllcfgr: self.pllcfgr,
            cfgr: self.cfgr,
        }
    }

    /// The clock tree as programmed. Refuses frequencies outside the data sheet.
    pub fn tree(&self) -> Result<ClockTree, Refusal> {
        self.setting().tree()
    }

    fn running_pll(&self, now: Nanos) -> Option<u64> {
        self.pll
            .ready(now)
            .then(|| self.setting().pll_hertz().ok())?
    }

    /// True while the clock of a block behind `gate` runs.
    pub fn enabled(&self, gate: Gate) -> bool {
        self.gates.enabled(gate)
    }

    /// True while a block behind `gate` is held in reset.
    pub fn in_reset(&self, gate: Gate) -> bool {
        self.gates.in_reset(gate)
    }
}

/// RCC_CFGR.MCOxPRE.
fn mco_divider(field: u32) -> f64 {
    match field & 7 {
        field @ 4..=7 => f64::from(field - 2),
        _ => 1.0,
    }
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
mod tests;
