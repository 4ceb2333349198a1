//! The piecewise map between the cycle counter and virtual time.
//!
//! HCLK changes while the firmware boots (16 MHz from the internal oscillator, then 168 MHz from
//! the PLL). Between two changes the map is one exact ratio, kept in integers:
//!
//! > nanos(c) = origin_ns + ⌊(c − origin_cycle) · 10⁹ / hertz⌋
//!
//! At a change the new origin is the whole nanosecond of the old map, so the map is monotone and
//! the same for every way of slicing a run.

use crate::core::Cycle;
use crate::time::Nanos;

const NANOS_PER_SECOND: u64 = 1_000_000_000;

/// A cycle that never comes.
pub const NEVER: Cycle = Cycle::MAX;

/// Maps cycles to nanoseconds and back, for one HCLK at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    origin_cycle: Cycle,
    origin: Nanos,
    hertz: u32,
}

impl Timeline {
    /// Power-on: cycle 0 is time 0 at `hertz`.
    pub fn new(hertz: u32) -> Self {
        Self {
            origin_cycle: 0,
            origin: Nanos(0),
            hertz: hertz.max(1),
        }
    }

    /// HCLK in hertz.
    pub fn hertz(&self) -> u32 {
        self.hertz
    }

    /// From cycle `now` on, HCLK runs at `hertz`.
    pub fn change(&mut self, now: Cycle, hertz: u32) {
        self.origin = self.nanos(now);
        self.origin_cycle = now;
        self.hertz = hertz.max(1);
    }

    /// The instant at which cycle `cycle` begins. `cycle` must not precede the last change; one
    /// that does maps to the instant of that change.
    pub fn nanos(&self, cycle: Cycle) -> Nanos {
        let hertz = u64::from(self.hertz);
        let cycles = cycle.saturating_sub(self.origin_cycle);
        let seconds = cycles / hertz;
        let rest = cycles % hertz * NANOS_PER_SECOND / hertz;
        Nanos(
            self.origin
                .0
                .saturating_add(seconds.saturating_mul(NANOS_PER_SECOND))
                .saturating_add(rest),
        )
    }

    /// The first cycle that begins at or after `instant`.
    pub fn cycle_at(&self, instant: Nanos) -> Cycle {
        let hertz = u64::from(self.hertz);
        let nanos = (instant - self.origin).0;
        let whole = (nanos / NANOS_PER_SECOND).saturating_mul(hertz);
        let rest = (nanos % NANOS_PER_SECOND * hertz).div_ceil(NANOS_PER_SECOND);
        self.origin_cycle.saturating_add(whole).saturating_add(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_16_mhz_two_cycles_are_125_nanoseconds() {
        let line = Timeline::new(16_000_000);
        assert_eq!(line.nanos(2), Nanos(125));
        assert_eq!(line.cycle_at(Nanos(125)), 2);
    }

    #[test]
    fn a_thousand_hours_at_168_mhz_are_exact() {
        let line = Timeline::new(168_000_000);
        let seconds = 3_600_000;
        assert_eq!(
            line.nanos(168_000_000 * seconds),
            Nanos(seconds * NANOS_PER_SECOND)
        );
        assert_eq!(
            line.cycle_at(Nanos(seconds * NANOS_PER_SECOND)),
            168_000_000 * seconds
        );
    }

    #[test]
    fn the_map_is_monotone_and_inverse_across_a_change_of_clock() {
        let mut line = Timeline::new(16_000_000);
        let mut previous = Nanos(0);
        for cycle in 0..2_000 {
            if cycle == 1_001 {
                line.change(cycle, 168_000_000);
            }
            let instant = line.nanos(cycle);
            assert!(instant >= previous, "cycle {cycle}");
            // Several cycles may share a nanosecond: the inverse is the first of them.
            if line.cycle_at(instant) != cycle {
                assert_eq!(line.nanos(line.cycle_at(instant)), instant);
            }
            previous = instant;
        }
        // 1001 cycles of 62.5 ns, then 999 - 1 of 125/21 ns.
        assert_eq!(line.nanos(1_999), Nanos(62_562 + 998 * 125 / 21));
    }

    #[test]
    fn the_cycle_of_an_instant_never_begins_before_it() {
        let mut line = Timeline::new(16_000_000);
        line.change(777, 168_000_000);
        for nanos in 48_562..52_000 {
            let cycle = line.cycle_at(Nanos(nanos));
            assert!(line.nanos(cycle) >= Nanos(nanos));
            assert!(cycle == 777 || line.nanos(cycle - 1) < Nanos(nanos));
        }
    }
}
