//! What a block may reach while it acts.

use super::dma::Dma;
use super::timeline::Timeline;
use crate::core::Cycle;
use crate::memory::Memory;
use crate::time::Nanos;

/// The surroundings of a block at one instant.
pub struct Reach<'a, W> {
    /// The instant.
    pub now: Cycle,
    /// Its relation to virtual time.
    pub time: &'a Timeline,
    /// Where DMA reads and writes.
    pub memory: &'a mut Memory,
    /// The streams that may serve a request.
    pub dma: &'a mut Dma,
    /// The devices around the chip.
    pub wiring: &'a mut W,
}

impl<W> Reach<'_, W> {
    /// The instant in virtual time.
    pub fn nanos(&self) -> Nanos {
        self.time.nanos(self.now)
    }
}

/// The surroundings of a block of `$soc` while that block is borrowed.
macro_rules! reach {
    ($soc:ident, $memory:expr, $now:expr) => {
        &mut $crate::soc::reach::Reach {
            now: $now,
            time: &$soc.time,
            memory: $memory,
            dma: &mut $soc.dma,
            wiring: &mut $soc.wiring,
        }
    };
}
pub(super) use reach;
