//! The time base of a timer: prescaler, counter, reload and compare values.
//!
//! Between two looks its state is a pure function of the cycle counter.

use crate::core::Cycle;
use crate::soc::timeline::NEVER;

/// The update flag, as in SR and DIER.
pub const UPDATE: u32 = 1 << 0;

/// The flag of compare channel `index`, as in SR and DIER.
pub fn compare_flag(index: usize) -> u32 {
    2 << index
}

/// A register value and the shadow that works until the next update event.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shadowed {
    /// What software wrote and reads.
    pub written: u32,
    /// What works.
    pub active: u32,
}

impl Shadowed {
    /// Writes it; the value works at once unless it is preloaded.
    pub fn write(&mut self, value: u32, preload: bool) {
        self.written = value;
        if !preload {
            self.active = value;
        }
    }

    fn update(&mut self) {
        self.active = self.written;
    }

    fn differs(&self) -> bool {
        self.written != self.active
    }
}

/// An up-counter with up to four compare channels.
#[derive(Clone, Debug)]
pub struct Counter {
    /// HCLK cycles of one timer clock; 0 while the RCC gates it.
    clock_cycles: u64,
    /// CR1.CEN.
    pub enabled: bool,
    /// CR1.UDIS: no update events.
    pub update_disabled: bool,
    /// CR1.OPM: stops at the update event.
    pub one_pulse: bool,
    /// Prescaler, less one.
    pub psc: Shadowed,
    /// Reload: the last value of a round.
    pub arr: Shadowed,
    /// Compare values.
    pub ccr: [Shadowed; 4],
    /// The value at cycle `since`, when it had just changed to it.
    pub count: u32,
    since: Cycle,
    channels: usize,
    top: u32,
}

impl Counter {
    /// A counter at rest that can count to `top`, with so many channels.
    pub fn new(top: u32, channels: usize) -> Self {
        let mut counter = Self {
            clock_cycles: 0,
            enabled: false,
            update_disabled: false,
            one_pulse: false,
            psc: Shadowed::default(),
            arr: Shadowed::default(),
            ccr: [Shadowed::default(); 4],
            count: 0,
            since: 0,
            channels,
            top,
        };
        counter.arr.write(top, false);
        counter
    }

    /// Back to the reset state; the clock keeps running.
    pub fn reset(&mut self) {
        let clock_cycles = self.clock_cycles;
        *self = Self {
            clock_cycles,
            ..Self::new(self.top, self.channels)
        };
    }

    /// The largest value its registers hold.
    pub fn top(&self) -> u32 {
        self.top
    }

    /// From `now` on, one timer clock is `cycles` of HCLK; 0 stops the counter. `sync` first.
    pub fn set_clock(&mut self, now: Cycle, cycles: u64) {
        self.clock_cycles = cycles;
        self.since = now;
    }

    /// CR1.CEN was written at `now`; `sync` first.
    pub fn enable(&mut self, enabled: bool, now: Cycle) {
        if !self.enabled {
            self.since = now;
        }
        self.enabled = enabled;
    }

    /// EGR.UG at `now`: from zero, with an update event.
    pub fn restart(&mut self, now: Cycle) {
        self.count = 0;
        self.since = now;
        if !self.update_disabled {
            self.update();
        }
    }

    /// True while it runs. A counter whose reload is zero stands still (RM0090 §18.4.12).
    pub fn counts(&self) -> bool {
        self.enabled && self.clock_cycles != 0 && self.arr.active != 0
    }

    /// HCLK cycles of one count.
    fn period(&self) -> u64 {
        (u64::from(self.psc.active) + 1) * self.clock_cycles
    }

    /// Counts until the counter is next zero.
    fn to_zero(&self) -> u64 {
        let last = if self.count <= self.arr.active {
            self.arr.active
        } else {
            self.top
        };
        u64::from(last - self.count) + 1
    }

    /// Brings the counter to `now`. Returns the flags that rose on the way.
    pub fn sync(&mut self, now: Cycle) -> u32 {
        let mut flags = 0;
        while self.counts() {
            let counts = now.saturating_sub(self.since) / self.period();
            if counts == 0 {
                return flags;
            }
            let to_zero = self.to_zero();
            if counts < to_zero {
                return flags | self.pass(counts);
            }
            flags |= self.overflow(to_zero);
            self.skip_whole_rounds(now);
        }
        self.since = now;
        flags
    }

    /// Counts up without reaching zero.
    fn pass(&mut self, counts: u64) -> u32 {
        let from = self.count;
        self.since += counts * self.period();
        self.count += counts as u32;
        self.matching(|compare| (from + 1..=self.count).contains(&compare))
    }

    /// Counts `to_zero` times: through the rest of the round, to zero.
    fn overflow(&mut self, to_zero: u64) -> u32 {
        let at_reload = self.count <= self.arr.active;
        // Zero, and values beyond the reload, match at the overflow (RM0090 §18.4.5, CC1IF).
        let mut flags = self.matching(|compare| compare == 0 || compare > self.count);
        self.since += to_zero * self.period();
        self.count = 0;
        if at_reload && !self.update_disabled {
            flags |= UPDATE;
            self.update();
            self.enabled &= !self.one_pulse;
        }
        flags
    }

    fn matching(&self, matches: impl Fn(u32) -> bool) -> u32 {
        let channels = self.ccr[..self.channels].iter().enumerate();
        let matching = channels.filter(|(_, compare)| matches(compare.active));
        matching.fold(0, |flags, (index, _)| flags | compare_flag(index))
    }

    /// All rounds after an update are alike: leaves out those that change no flag any more.
    fn skip_whole_rounds(&mut self, now: Cycle) {
        if self.counts() {
            let round = self.period() * (u64::from(self.arr.active) + 1);
            let rounds = now.saturating_sub(self.since) / round;
            self.since += rounds.saturating_sub(2) * round;
        }
    }

    fn update(&mut self) {
        self.psc.update();
        self.arr.update();
        self.ccr.iter_mut().for_each(Shadowed::update);
    }

    fn shadows_wait(&self) -> bool {
        self.psc.differs() || self.arr.differs() || self.ccr.iter().any(Shadowed::differs)
    }

    /// The next cycle at which one of the `wanted` flags rises, or a preloaded value begins to work;
    /// `sync` first.
    pub fn next(&self, wanted: u32) -> Cycle {
        if !self.counts() {
            return NEVER;
        }
        let to_zero = self.to_zero();
        let mut counts = u64::MAX;
        if wanted & UPDATE != 0 || self.shadows_wait() {
            counts = to_zero;
        }
        for (index, compare) in self.ccr[..self.channels].iter().enumerate() {
            if wanted & compare_flag(index) != 0 {
                counts = counts.min(self.until_match(compare.active, to_zero));
            }
        }
        let cycles = counts.saturating_mul(self.period());
        self.since.saturating_add(cycles)
    }

    fn until_match(&self, compare: u32, to_zero: u64) -> u64 {
        let ahead = u64::from(compare.saturating_sub(self.count));
        if compare == 0 || ahead >= to_zero {
            to_zero
        } else if ahead == 0 {
            to_zero + u64::from(compare)
        } else {
            ahead
        }
    }
}
