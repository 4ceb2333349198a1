//! The cycle counter of the debug unit (ARM DDI0403 §C1.8). Its comparators are not modelled.

use super::Cycle;

const CYCCNTENA: u32 = 1 << 0;
/// Four comparators: what the Cortex-M4 of an STM32F4 says.
const NUMCOMP_4: u32 = 4 << 28;
/// DEMCR.TRCENA
const TRCENA: u32 = 1 << 24;

/// DWT_CTRL, DWT_CYCCNT and the bit of DEMCR that switches them on.
#[derive(Clone, Debug, Default)]
pub(super) struct Dwt {
    demcr: u32,
    enabled: bool,
    /// What CYCCNT is ahead of the machine's cycles, or its value while it stands still.
    offset: u32,
}

impl Dwt {
    fn is_counting(&self) -> bool {
        self.enabled && self.demcr & TRCENA != 0
    }

    /// Changes what decides about counting, and keeps the count.
    fn keeping_count(&mut self, now: Cycle, change: impl FnOnce(&mut Self)) {
        let count = self.count(now);
        change(self);
        self.set_count(now, count);
    }

    /// DWT_CYCCNT
    pub fn count(&self, now: Cycle) -> u32 {
        if self.is_counting() {
            self.offset.wrapping_add(now as u32)
        } else {
            self.offset
        }
    }

    pub fn set_count(&mut self, now: Cycle, count: u32) {
        self.offset = count;
        if self.is_counting() {
            self.offset = count.wrapping_sub(now as u32);
        }
    }

    /// DWT_CTRL
    pub fn control(&self) -> u32 {
        NUMCOMP_4 | u32::from(self.enabled)
    }

    /// False: it asks for a counter or a sampler that is not modelled.
    pub fn set_control(&mut self, now: Cycle, value: u32) -> bool {
        self.keeping_count(now, |dwt| dwt.enabled = value & CYCCNTENA != 0);
        value & !(CYCCNTENA | 0xf << 28) == 0
    }

    pub fn demcr(&self) -> u32 {
        self.demcr
    }

    pub fn set_demcr(&mut self, now: Cycle, value: u32) {
        self.keeping_count(now, |dwt| dwt.demcr = value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cycle_counter_stands_still_until_trace_and_counter_are_enabled() {
        let mut dwt = Dwt::default();
        dwt.set_count(10, 0);
        dwt.set_demcr(20, TRCENA);
        assert_eq!(dwt.count(30), 0);
        assert!(dwt.set_control(40, CYCCNTENA));
        assert_eq!(dwt.count(45), 5);
        dwt.set_demcr(50, 0);
        assert_eq!(dwt.count(60), 10);
    }

    #[test]
    fn the_cycle_counter_wraps_after_32_bits() {
        let mut dwt = Dwt::default();
        dwt.set_demcr(0, TRCENA);
        dwt.set_control(0, CYCCNTENA);
        dwt.set_count(0, u32::MAX);
        assert_eq!(dwt.count(2), 1);
    }
}
