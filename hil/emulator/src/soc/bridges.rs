//! The bridges from the core's bus to the two slower peripheral buses: how long an access takes.

use super::clocks::ClockTree;
use crate::core::Cycle;

/// Clocks of a peripheral bus that a transfer takes: setup and access (AMBA APB, ARM IHI 0024 §3).
const TRANSFER_CLOCKS: u64 = 2;

/// When each bridge is free again.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bridges {
    apb1: Cycle,
    apb2: Cycle,
}

impl Bridges {
    /// Cycles that an access at `now` keeps the core, beyond those of one to RAM.
    ///
    /// A transfer begins with a clock of its bus, once the one before is over. A load waits for its
    /// end. A store is taken by the core's write buffer, and only the next access to that bus waits.
    /// What is on the core's own bus (AHB: GPIO, DMA, RCC, DCMI) answers at once.
    pub fn delay(&mut self, tree: &ClockTree, now: Cycle, address: u32, write: bool) -> Cycle {
        // RM0090 §2.3, table 1.
        let (free, clock) = match address {
            0x4000_0000..0x4001_0000 => (&mut self.apb1, tree.pclk1_cycles),
            0x4001_0000..0x4002_0000 => (&mut self.apb2, tree.pclk2_cycles),
            _ => return 0,
        };
        let begins = now.max(*free).next_multiple_of(clock);
        *free = begins + TRANSFER_CLOCKS * clock;
        if write { begins - now } else { *free - now }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TREE: ClockTree = ClockTree {
        hclk: 168_000_000,
        pclk1_cycles: 4,
        pclk2_cycles: 2,
    };
    const TIM2: u32 = 0x4000_0000;
    const USART1: u32 = 0x4001_1000;
    const GPIOA: u32 = 0x4002_0000;

    #[test]
    fn a_load_waits_for_the_bus_clock_and_two_of_its_periods() {
        let mut bridges = Bridges::default();
        assert_eq!(bridges.delay(&TREE, 101, TIM2, false), 3 + 8);
        assert_eq!(bridges.delay(&TREE, 200, USART1, false), 4);
        assert_eq!(bridges.delay(&TREE, 300, GPIOA, false), 0);
    }

    #[test]
    fn a_store_is_buffered_and_the_next_access_to_its_bus_waits() {
        let mut bridges = Bridges::default();
        assert_eq!(bridges.delay(&TREE, 100, TIM2, true), 0);
        assert_eq!(bridges.delay(&TREE, 101, USART1, false), 1 + 4);
        assert_eq!(bridges.delay(&TREE, 102, TIM2, false), 6 + 8);
    }

    #[test]
    fn a_bus_as_fast_as_the_core_takes_two_cycles() {
        assert_eq!(
            Bridges::default().delay(&ClockTree::RESET, 7, TIM2, false),
            2
        );
    }
}
