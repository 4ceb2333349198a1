//! What is assumed of the emulated chip's time.

use core::fmt;

use emulator::core::CycleModel;
use emulator::soc::FlashAssumption;

/// What the firmware programs for 168 MHz (RM0090 table 10).
const PROGRAMMED_WAIT_STATES: u8 = 5;

/// The assumptions that can be changed. [`fmt::Display`] tells all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TimingModel {
    /// How fetches and loads meet the flash, as far as it is not what the firmware programs.
    pub flash: FlashAssumption,
    /// What the core's manual leaves open.
    pub core: CycleModel,
}

impl fmt::Display for TimingModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let accelerator = if self.flash.without_accelerator {
            "flash without its accelerator"
        } else {
            "flash accelerator of RM0090 3.4.2"
        };
        write!(
            f,
            "Cortex-M4 manual (DDI0439 3.3), branch refill of {}, {accelerator} with {} wait states, bridges of 2 bus \
             clocks; DMA never keeps the core waiting",
            self.core.branch_refill(),
            self.flash.wait_states.unwrap_or(PROGRAMMED_WAIT_STATES)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_assumed_is_told_in_full() {
        let told = TimingModel::default().to_string();
        assert!(told.contains("branch refill of 2"), "{told}");
        assert!(
            told.contains("accelerator of RM0090 3.4.2 with 5 wait states"),
            "{told}"
        );
        let model = TimingModel {
            flash: FlashAssumption {
                wait_states: Some(7),
                without_accelerator: true,
            },
            core: CycleModel::default().with_branch_refill(3).expect("1 to 3"),
        };
        let told = model.to_string();
        assert!(told.contains("branch refill of 3"), "{told}");
        assert!(
            told.contains("without its accelerator with 7 wait states"),
            "{told}"
        );
    }
}
