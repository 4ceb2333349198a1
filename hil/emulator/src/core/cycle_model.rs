//! What can be said of the model's time from outside.

use super::cycles;

/// What the manuals leave open of how long instructions take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleModel {
    branch_refill: u8,
}

impl CycleModel {
    /// Cycles of refilling the pipeline after a taken branch: the manual says 1 to 3, depending on the
    /// target (ARM DDI0439 §3.3.1, "P"); 2 unless it is set. None for anything else.
    #[must_use]
    pub fn with_branch_refill(self, cycles: u8) -> Option<Self> {
        (1..=3).contains(&cycles).then_some(Self {
            branch_refill: cycles,
        })
    }

    /// Cycles of refilling the pipeline after a taken branch.
    pub fn branch_refill(self) -> u8 {
        self.branch_refill
    }
}

impl Default for CycleModel {
    fn default() -> Self {
        Self {
            branch_refill: cycles::REFILL,
        }
    }
}
