//! TIM1 to TIM14 as up-counters with output compare: time bases, alarms and clock outputs
//! (RM0090 §17 to §20).
//!
//! A timer is brought up to date only when somebody looks or an interrupt is due.

mod counter;

use super::interrupts::{self, Lines};
use super::map::Block;
use super::refusal::Refusal;
use super::timeline::NEVER;
use crate::core::Cycle;
use counter::{Counter, UPDATE};

mod register {
    pub const CR1: u32 = 0x00;
    pub const CR2: u32 = 0x04;
    pub const SMCR: u32 = 0x08;
    pub const DIER: u32 = 0x0c;
    pub const SR: u32 = 0x10;
    pub const EGR: u32 = 0x14;
    pub const CCMR1: u32 = 0x18;
    pub const CCMR2: u32 = 0x1c;
    pub const CCER: u32 = 0x20;
    pub const CNT: u32 = 0x24;
    pub const PSC: u32 = 0x28;
    pub const ARR: u32 = 0x2c;
    pub const RCR: u32 = 0x30;
    pub const CCR1: u32 = 0x34;
    pub const CCR4: u32 = 0x40;
    pub const BDTR: u32 = 0x44;
    pub const DMAR: u32 = 0x4c;
    pub const OR: u32 = 0x50;
}
use register::*;

/// CR1.
const ENABLE: u32 = 1 << 0;
const UPDATE_DISABLE: u32 = 1 << 1;
const UPDATE_BY_OVERFLOW_ONLY: u32 = 1 << 2;
const ONE_PULSE: u32 = 1 << 3;
const DOWN_OR_CENTRE: u32 = 7 << 4;
const ARR_PRELOAD: u32 = 1 << 7;
const CR1_WRITABLE: u32 = 0x38f;

/// SR and DIER: update, then compare 1 to 4.
const INTERRUPTS: u32 = 0x1f;

/// BDTR.MOE.
const MAIN_OUTPUT: u32 = 1 << 15;

/// One timer.
#[derive(Clone, Debug)]
pub struct Timer {
    number: u8,
    counter: Counter,
    cr1: u32,
    cr2: u32,
    dier: u32,
    sr: u32,
    ccmr: [u32; 2],
    ccer: u32,
    bdtr: u32,
}

impl Timer {
    /// The reset state of timer 1..=14.
    pub fn new(number: u8) -> Self {
        Self {
            number,
            counter: Counter::new(top(number), channels(number)),
            cr1: 0,
            cr2: 0,
            dier: 0,
            sr: 0,
            ccmr: [0; 2],
            ccer: 0,
            bdtr: 0,
        }
    }

    /// Back to the reset state; the clock keeps running.
    pub fn reset(&mut self) {
        self.counter.reset();
        let counter = self.counter.clone();
        *self = Self {
            counter,
            ..Self::new(self.number)
        };
    }

    /// From `now` on, one timer clock is `cycles` of HCLK; 0 stops the timer.
    pub fn set_clock(&mut self, now: Cycle, cycles: u64) {
        self.sync(now);
        self.counter.set_clock(now, cycles);
    }

    fn channels(&self) -> usize {
        channels(self.number)
    }

    fn has_main_output(&self) -> bool {
        matches!(self.number, 1 | 8)
    }

    /// Brings the counter and the flags to `now`.
    pub fn sync(&mut self, now: Cycle) {
        self.sr |= self.counter.sync(now);
    }

    /// True while a channel may toggle its pin.
    pub fn drives_pins(&self) -> bool {
        self.ccer != 0
    }

    /// The next cycle at which an enabled interrupt would rise or an output change its frequency;
    /// `sync` first.
    pub fn next(&self) -> Cycle {
        let wanted = self.dier & !self.sr & INTERRUPTS;
        if wanted == 0 && !self.drives_pins() {
            return NEVER;
        }
        self.counter.next(wanted)
    }

    /// Drives the timer's interrupt lines.
    pub fn drive(&self, lines: &mut Lines) {
        let active = self.sr & self.dier & INTERRUPTS;
        if active != 0 {
            let (update, compare) = interrupts::timer(self.number);
            lines.drive(update, active & UPDATE != 0);
            lines.drive(compare, active & !UPDATE != 0);
        }
    }

    /// What output `channel` (1..=4) puts on its pin, in hertz, from a timer clock of `clock` hertz;
    /// `None` while it does not toggle.
    pub fn output_hertz(&self, channel: u8, clock: f64) -> Option<f64> {
        let index = usize::from(channel.checked_sub(1)?);
        let enabled = self.ccer >> (4 * index) & 1 != 0;
        let driven = !self.has_main_output() || self.bdtr & MAIN_OUTPUT != 0;
        if index >= self.channels() || !enabled || !driven || !self.counter.counts() {
            return None;
        }
        let reload = self.counter.arr.active;
        let round = (f64::from(self.counter.psc.active) + 1.0) * (f64::from(reload) + 1.0);
        let compare = self.counter.ccr[index].active;
        match self.ccmr[index / 2] >> (8 * (index % 2) + 4) & 7 {
            // Toggle: two rounds make a period.
            3 if compare <= reload => Some(clock / round / 2.0),
            // PWM: neither always low nor always high.
            6 | 7 if (1..=reload).contains(&compare) => Some(clock / round),
            _ => None,
        }
    }

    /// Reads a register; `sync` first.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        self.exists(offset)?;
        Ok(match offset {
            CR1 => self.cr1 | u32::from(self.counter.enabled),
            CR2 => self.cr2,
            DIER => self.dier,
            SR => self.sr,
            CCMR1 | CCMR2 => self.ccmr[(offset - CCMR1) as usize / 4],
            CCER => self.ccer,
            CNT => self.counter.count,
            PSC => self.counter.psc.written,
            ARR => self.counter.arr.written,
            CCR1..=CCR4 => self.counter.ccr[(offset - CCR1) as usize / 4].written,
            BDTR => self.bdtr,
            // SMCR, RCR, DCR, DMAR and OR take only zeros; EGR reads as zero.
            _ => 0,
        })
    }

    /// Writes a register at `now`; `sync` first.
    pub fn write(&mut self, offset: u32, value: u32, now: Cycle) -> Result<(), Refusal> {
        self.exists(offset)?;
        let narrow = value & self.counter.top();
        match offset {
            CR1 => self.write_cr1(value, now)?,
            // Master mode and idle levels: nothing of the model listens to TRGO or outputs at rest.
            CR2 => self.cr2 = value & 0x7ffc,
            DIER if value & !INTERRUPTS == 0 => self.dier = value,
            DIER => return self.refuse("DMA, trigger and break requests", value),
            SR => self.sr &= value,
            EGR => self.generate(value, now)?,
            CCMR1 | CCMR2 => {
                if value & 0x0303 != 0 {
                    return self.refuse("input capture", value);
                }
                self.ccmr[(offset - CCMR1) as usize / 4] = value & 0xffff;
            }
            CCER => self.ccer = value & 0xffff,
            CNT => self.counter.count = narrow,
            PSC => self.counter.psc.write(value & 0xffff, true),
            ARR => {
                let preload = self.cr1 & ARR_PRELOAD != 0;
                self.counter.arr.write(narrow, preload);
            }
            CCR1..=CCR4 => {
                let index = (offset - CCR1) as usize / 4;
                let preload = self.ccmr[index / 2] >> (8 * (index % 2) + 3) & 1 != 0;
                self.counter.ccr[index].write(narrow, preload);
            }
            BDTR => self.bdtr = value & 0xffff,
            _ if value == 0 => {}
            SMCR => return self.refuse("slave mode", value),
            RCR => return self.refuse("repetition counter", value),
            OR => return self.refuse("input remapping", value),
            _ => return self.refuse("DMA burst", value),
        }
        Ok(())
    }

    fn write_cr1(&mut self, value: u32, now: Cycle) -> Result<(), Refusal> {
        if value & DOWN_OR_CENTRE != 0 {
            return self.refuse("counting down or centre-aligned", value);
        }
        // CEN lives in the counter, which may clear it.
        self.cr1 = value & CR1_WRITABLE & !ENABLE;
        self.counter.enable(value & ENABLE != 0, now);
        self.counter.update_disabled = value & UPDATE_DISABLE != 0;
        self.counter.one_pulse = value & ONE_PULSE != 0;
        Ok(())
    }

    fn generate(&mut self, value: u32, now: Cycle) -> Result<(), Refusal> {
        if value & !INTERRUPTS != 0 {
            return self.refuse("commutation, trigger and break events", value);
        }
        self.sr |= value & INTERRUPTS & !UPDATE;
        if value & UPDATE != 0 {
            self.counter.restart(now);
            if self.cr1 & (UPDATE_DISABLE | UPDATE_BY_OVERFLOW_ONLY) == 0 {
                self.sr |= UPDATE;
            }
        }
        Ok(())
    }

    fn exists(&self, offset: u32) -> Result<(), Refusal> {
        let exists = match offset {
            CR1 | CR2 | DIER | SR | EGR | CNT | PSC | ARR => true,
            SMCR | CCMR1 | CCER => self.channels() > 0,
            CCMR2 => self.channels() > 2,
            CCR1..=CCR4 => ((offset - CCR1) as usize / 4) < self.channels(),
            RCR | BDTR => self.has_main_output(),
            0x48 | DMAR => self.channels() == 4,
            OR => matches!(self.number, 2 | 5 | 11),
            _ => false,
        };
        if exists {
            return Ok(());
        }
        let base = match self.number {
            1 => 0x4001_0000,
            8 => 0x4001_0400,
            number @ 9..=11 => 0x4001_4000 + 0x400 * (u32::from(number) - 9),
            number @ 12..=14 => 0x4000_1800 + 0x400 * (u32::from(number) - 12),
            number => 0x4000_0000 + 0x400 * (u32::from(number) - 2),
        };
        Err(Refusal::UnmodelledRegister {
            block: Block::Timer(self.number),
            address: base + offset,
        })
    }

    fn refuse<T>(&self, what: &'static str, value: u32) -> Result<T, Refusal> {
        Err(Refusal::UnmodelledMode {
            block: Block::Timer(self.number),
            what,
            value,
        })
    }
}

/// Compare channels of timer `number`.
fn channels(number: u8) -> usize {
    match number {
        6 | 7 => 0,
        10 | 11 | 13 | 14 => 1,
        9 | 12 => 2,
        _ => 4,
    }
}

/// The largest value of timer `number`: TIM2 and TIM5 are 32 bits wide.
fn top(number: u8) -> u32 {
    match number {
        2 | 5 => u32::MAX,
        _ => 0xffff,
    }
}

#[cfg(test)]
mod tests;
