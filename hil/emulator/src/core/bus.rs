//! The seam between the core and the peripherals around it.

use crate::memory::Memory;

/// Core clock cycles since power-on: the only clock of the machine.
pub type Cycle = u64;

/// How much of the data bus an access uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Width {
    /// 8 bits.
    Byte,
    /// 16 bits.
    Half,
    /// 32 bits.
    Word,
}

impl Width {
    /// In bytes.
    pub fn bytes(self) -> usize {
        match self {
            Self::Byte => 1,
            Self::Half => 2,
            Self::Word => 4,
        }
    }
}

/// Nothing answers at this address. The run stops there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BusFault;

/// Everything outside the plain memories and the core's own peripherals (0xE000_0000 to
/// 0xE000_FFFF). The debug unit of the chip, DBGMCU at 0xE004_2000, is on this bus.
///
/// Bit-band aliases never get here: they arrive as word accesses to the word that holds the bit.
pub trait Bus {
    /// Reads `width` bits. The value is right-aligned; bits above `width` are ignored.
    fn read(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
    ) -> Result<u32, BusFault>;

    /// Writes the low `width` bits of `value`; the bits above are zero.
    fn write(
        &mut self,
        memory: &mut Memory,
        now: Cycle,
        address: u32,
        width: Width,
        value: u32,
    ) -> Result<(), BusFault>;

    /// Cycles that the access which was just made at `now` keeps the core waiting, beyond those of
    /// one to RAM.
    fn delay(&mut self, _now: Cycle, _address: u32, _write: bool) -> Cycle {
        0
    }
}
