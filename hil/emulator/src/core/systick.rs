//! SysTick, the 24-bit down-counter of the core (ARM DDI0403 §B3.3).

use super::Cycle;

const ENABLE: u32 = 1 << 0;
const TICKINT: u32 = 1 << 1;
const CLKSOURCE: u32 = 1 << 2;
const COUNTFLAG: u32 = 1 << 16;
const COUNTER: u32 = 0xff_ffff;
/// The external reference clock of an STM32F4 is HCLK / 8 (RM0090 §7.2).
const REFERENCE_DIVISOR: u64 = 8;

/// The counter. It is not stepped: while it runs, it is known by the cycle of its next zero.
#[derive(Clone, Debug, Default)]
pub(super) struct SysTick {
    /// ENABLE, TICKINT and CLKSOURCE.
    control: u32,
    count_flag: bool,
    reload: u32,
    /// The value while it stands still.
    held: u32,
    /// When a running counter gets to zero next; `None` where it stays there.
    next_zero: Option<Cycle>,
}

impl SysTick {
    fn divisor(&self) -> u64 {
        if self.control & CLKSOURCE != 0 {
            1
        } else {
            REFERENCE_DIVISOR
        }
    }

    fn is_running(&self) -> bool {
        self.control & ENABLE != 0
    }

    /// Cycles from one zero to the next: the reload takes a tick.
    fn period(&self) -> Option<u64> {
        let ticks = u64::from(self.reload) + 1;
        (self.reload != 0).then_some(ticks * self.divisor())
    }

    /// When the next exception is due.
    pub fn next_exception(&self) -> Option<Cycle> {
        self.next_zero
            .filter(|_| self.is_running() && self.control & TICKINT != 0)
    }

    /// Lets the counter run until `now`. True: its exception became pending.
    pub fn advance(&mut self, now: Cycle) -> bool {
        let Some(zero) = self
            .next_zero
            .filter(|zero| self.is_running() && *zero <= now)
        else {
            return false;
        };
        self.count_flag = true;
        self.next_zero = self.period().map(|period| {
            let missed = (now - zero) / period;
            zero + (missed + 1) * period
        });
        self.control & TICKINT != 0
    }

    fn value(&self, now: Cycle) -> u32 {
        if !self.is_running() {
            return self.held;
        }
        let left = self.next_zero.map_or(0, |zero| zero.saturating_sub(now));
        let ticks = left.div_ceil(self.divisor());
        // The tick at zero itself, before the reload.
        if ticks > u64::from(self.reload) {
            0
        } else {
            ticks as u32
        }
    }

    /// Starts counting down from a value, or from the reload value where that is zero.
    fn start(&mut self, now: Cycle, value: u32) {
        self.next_zero = match value {
            0 => self.period().map(|period| now + period),
            value => Some(now + u64::from(value) * self.divisor()),
        };
    }

    /// CSR. Reading clears COUNTFLAG.
    pub fn read_control(&mut self) -> u32 {
        let flag = if std::mem::take(&mut self.count_flag) {
            COUNTFLAG
        } else {
            0
        };
        self.control | flag
    }

    pub fn write_control(&mut self, now: Cycle, value: u32) {
        self.held = self.value(now);
        self.control = value & (ENABLE | TICKINT | CLKSOURCE);
        if self.is_running() {
            self.start(now, self.held);
        }
    }

    /// RVR
    pub fn reload(&self) -> u32 {
        self.reload
    }

    /// RVR. A running counter takes the new value when it gets to zero.
    pub fn write_reload(&mut self, now: Cycle, value: u32) {
        self.reload = value & COUNTER;
        if self.is_running() && self.next_zero.is_none() {
            self.start(now, 0);
        }
    }

    /// CVR
    pub fn current(&self, now: Cycle) -> u32 {
        self.value(now)
    }

    /// CVR. Any write clears it and COUNTFLAG.
    pub fn clear_current(&mut self, now: Cycle) {
        self.count_flag = false;
        self.held = 0;
        if self.is_running() {
            self.start(now, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn running(reload: u32, control: u32) -> SysTick {
        let mut systick = SysTick::default();
        systick.write_reload(0, reload);
        systick.clear_current(0);
        systick.write_control(0, control);
        systick
    }

    #[test]
    fn the_first_zero_comes_after_reload_plus_one_ticks_and_then_periodically() {
        let mut systick = running(99, ENABLE | TICKINT | CLKSOURCE);
        assert_eq!(systick.next_exception(), Some(100));
        assert!(!systick.advance(99));
        assert!(systick.advance(100));
        assert!(!systick.advance(100));
        assert_eq!(systick.next_exception(), Some(200));
    }

    #[test]
    fn it_counts_down_from_the_reload_value_to_zero() {
        let mut systick = running(3, ENABLE | CLKSOURCE);
        let mut seen = Vec::new();
        for now in 1..=6 {
            systick.advance(now);
            seen.push(systick.current(now));
        }
        assert_eq!(seen, [3, 2, 1, 0, 3, 2]);
    }

    #[test]
    fn reading_the_control_register_clears_the_count_flag() {
        let mut systick = running(9, ENABLE | CLKSOURCE);
        systick.advance(10);
        assert_eq!(systick.read_control(), COUNTFLAG | CLKSOURCE | ENABLE);
        assert_eq!(systick.read_control(), CLKSOURCE | ENABLE);
    }

    #[test]
    fn the_reference_clock_is_eight_times_slower() {
        assert_eq!(running(9, ENABLE | TICKINT).next_exception(), Some(80));
    }

    #[test]
    fn without_tickint_no_exception_is_due() {
        let mut systick = running(9, ENABLE | CLKSOURCE);
        assert_eq!(systick.next_exception(), None);
        assert!(!systick.advance(10));
    }

    #[test]
    fn a_stopped_counter_keeps_its_value_and_goes_on_from_there() {
        let mut systick = running(99, ENABLE | TICKINT | CLKSOURCE);
        systick.write_control(40, TICKINT | CLKSOURCE);
        assert_eq!(systick.current(1000), 60);
        systick.write_control(1000, ENABLE | TICKINT | CLKSOURCE);
        assert_eq!(systick.next_exception(), Some(1060));
    }

    #[test]
    fn a_long_sleep_over_many_periods_leaves_one_pending_exception() {
        let mut systick = running(9, ENABLE | TICKINT | CLKSOURCE);
        assert!(systick.advance(10_000_000_005));
        assert_eq!(systick.next_exception(), Some(10_000_000_010));
    }
}
