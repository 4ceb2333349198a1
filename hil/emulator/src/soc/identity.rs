//! What the chip says about itself: DBGMCU and the device signature (RM0090 §38.6, §39).

use super::map::Block;
use super::refusal::Refusal;

/// DBGMCU_IDCODE: device 0x413, revision 0x1007 ("1" and "2").
const IDCODE: u32 = 0x1007_6413;
/// F_ID: kilobytes of flash.
const FLASH_KILOBYTES: u32 = 1024;
/// The unique identifier every emulated board has: ASCII, so that it is recognised in a log.
const UNIQUE_ID: [u32; 3] = [0x7565_6d65, 0x6574_616c, 0x3730_3464];

/// Debug support registers. What they freeze matters only while a debugger halts the core.
#[derive(Clone, Debug, Default)]
pub struct Debug {
    registers: [u32; 3],
}

impl Debug {
    /// Reads IDCODE, CR, APB1_FZ or APB2_FZ.
    pub fn read(&self, offset: u32) -> Result<u32, Refusal> {
        match offset {
            0 => Ok(IDCODE),
            4 | 8 | 12 => Ok(self.registers[offset as usize / 4 - 1]),
            _ => Err(unknown(offset)),
        }
    }

    /// Writes CR, APB1_FZ or APB2_FZ.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refusal> {
        match offset {
            4 | 8 | 12 => self.registers[offset as usize / 4 - 1] = value,
            _ => return Err(unknown(offset)),
        }
        Ok(())
    }
}

/// The device signature, `offset` bytes behind the first word of the unique identifier.
pub fn signature(offset: u32) -> u32 {
    match offset / 4 {
        word @ 0..=2 => UNIQUE_ID[word as usize],
        4 => FLASH_KILOBYTES << 16,
        _ => u32::MAX,
    }
}

fn unknown(offset: u32) -> Refusal {
    Refusal::UnmodelledRegister {
        block: Block::Debug,
        address: 0xe004_2000 + offset,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chip_is_an_f407_with_a_megabyte_of_flash() {
        assert_eq!(Debug::default().read(0).unwrap() & 0xfff, 0x413);
        // F_ID is the half-word at 0x1FFF_7A22.
        assert_eq!(signature(0x10) >> 16, 1024);
    }
}
