//! The memory map: which block answers at which address, how wide it may be written, and which
//! RCC bit clocks it (RM0090 §2.3 table 1, §7.3).

use core::fmt;

/// A block of the chip. Numbers are those of the manual: `Timer(3)` is TIM3, `Usart(4)` UART4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// TIM1..=TIM14.
    Timer(u8),
    /// USART1..=USART6 (4 and 5 are UARTs).
    Usart(u8),
    /// I2C1..=I2C3.
    I2c(u8),
    /// GPIO port, 0 is port A.
    Gpio(u8),
    /// DMA1 and DMA2.
    Dma(u8),
    /// Reset and clock control.
    Rcc,
    /// Power control.
    Power,
    /// Flash interface.
    Flash,
    /// System configuration.
    Syscfg,
    /// External interrupts.
    Exti,
    /// Camera interface.
    Dcmi,
    /// Independent watchdog.
    Watchdog,
    /// Debug support outside the core (DBGMCU).
    Debug,
    /// Factory-programmed device signature.
    Signature,
    /// A block of the chip that has no model.
    Other(&'static str),
}

impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Timer(n) => write!(f, "TIM{n}"),
            Self::Usart(n @ 4..=5) => write!(f, "UART{n}"),
            Self::Usart(n) => write!(f, "USART{n}"),
            Self::I2c(n) => write!(f, "I2C{n}"),
            Self::Gpio(port) => write!(f, "GPIO{}", char::from(b'A' + port)),
            Self::Dma(n) => write!(f, "DMA{n}"),
            Self::Rcc => f.write_str("RCC"),
            Self::Power => f.write_str("PWR"),
            Self::Flash => f.write_str("FLASH"),
            Self::Syscfg => f.write_str("SYSCFG"),
            Self::Exti => f.write_str("EXTI"),
            Self::Dcmi => f.write_str("DCMI"),
            Self::Watchdog => f.write_str("IWDG"),
            Self::Debug => f.write_str("DBGMCU"),
            Self::Signature => f.write_str("device signature"),
            Self::Other(name) => f.write_str(name),
        }
    }
}

/// What a write narrower than a word does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NarrowWrite {
    /// The AHB-to-APB bridge repeats the byte or half-word over the whole word (RM0090 §2.1.9).
    Repeated,
    /// The block takes byte lanes; the others keep their value.
    Lanes,
    /// "Have to be accessed by words" (RM0090 §10.5, §15.8).
    Refused,
}

/// An RCC enable or reset bit: the bus names the register pair, the number is the bit in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gate {
    /// RCC_AHB1ENR, RCC_AHB1RSTR.
    Ahb1(u8),
    /// RCC_AHB2ENR, RCC_AHB2RSTR.
    Ahb2(u8),
    /// RCC_APB1ENR, RCC_APB1RSTR.
    Apb1(u8),
    /// RCC_APB2ENR, RCC_APB2RSTR.
    Apb2(u8),
}

impl Block {
    /// How the block takes byte and half-word writes.
    pub fn narrow_write(self) -> NarrowWrite {
        match self {
            Self::Gpio(_) | Self::Rcc | Self::Flash | Self::Debug => NarrowWrite::Lanes,
            Self::Dma(_) | Self::Dcmi => NarrowWrite::Refused,
            _ => NarrowWrite::Repeated,
        }
    }

    /// The RCC bit that clocks and resets the block; `None` for those always on.
    pub fn gate(self) -> Option<Gate> {
        Some(match self {
            Self::Gpio(port) => Gate::Ahb1(port),
            Self::Dma(n) => Gate::Ahb1(20 + n),
            Self::Dcmi => Gate::Ahb2(0),
            Self::Timer(n @ 2..=7) => Gate::Apb1(n - 2),
            Self::Timer(n @ 12..=14) => Gate::Apb1(n - 6),
            Self::Usart(n @ 2..=5) => Gate::Apb1(15 + n),
            Self::I2c(n) => Gate::Apb1(20 + n),
            Self::Power => Gate::Apb1(28),
            Self::Timer(1) => Gate::Apb2(0),
            Self::Timer(8) => Gate::Apb2(1),
            Self::Usart(1) => Gate::Apb2(4),
            Self::Usart(6) => Gate::Apb2(5),
            Self::Syscfg => Gate::Apb2(14),
            Self::Timer(n @ 9..=11) => Gate::Apb2(7 + n),
            _ => return None,
        })
    }

    /// True for the blocks behind the faster bridge, APB2.
    pub fn on_apb2(self) -> bool {
        matches!(self.gate(), Some(Gate::Apb2(_)))
    }
}

/// The block at `address` and the byte offset in it.
pub fn decode(address: u32) -> Option<(Block, u32)> {
    let block = match address {
        0x1fff_7a10..=0x1fff_7a23 => return Some((Block::Signature, address - 0x1fff_7a10)),
        0x4000_0000..=0x5006_0bff => peripheral(address & !0x3ff)?,
        0xe004_2000..=0xe004_23ff => Block::Debug,
        _ => return None,
    };
    Some((block, address & 0x3ff))
}

fn peripheral(base: u32) -> Option<Block> {
    Some(match base {
        0x4000_0000..=0x4000_1400 => Block::Timer(2 + (base >> 10 & 7) as u8),
        0x4000_1800..=0x4000_2000 => Block::Timer(6 + (base >> 10 & 15) as u8),
        0x4000_2800 => Block::Other("RTC"),
        0x4000_2c00 => Block::Other("WWDG"),
        0x4000_3000 => Block::Watchdog,
        0x4000_3400..=0x4000_4000 => Block::Other("SPI2/SPI3/I2S"),
        0x4000_4400..=0x4000_5000 => Block::Usart(1 + (base >> 10 & 7) as u8),
        0x4000_5400..=0x4000_5c00 => Block::I2c((base >> 10 & 7) as u8 - 4),
        0x4000_6400..=0x4000_6800 => Block::Other("CAN"),
        0x4000_7000 => Block::Power,
        0x4000_7400 => Block::Other("DAC"),
        0x4001_0000 => Block::Timer(1),
        0x4001_0400 => Block::Timer(8),
        0x4001_1000 => Block::Usart(1),
        0x4001_1400 => Block::Usart(6),
        0x4001_2000 => Block::Other("ADC"),
        0x4001_2c00 => Block::Other("SDIO"),
        0x4001_3000 => Block::Other("SPI1"),
        0x4001_3800 => Block::Syscfg,
        0x4001_3c00 => Block::Exti,
        0x4001_4000..=0x4001_4800 => Block::Timer(9 + (base >> 10 & 3) as u8),
        0x4002_0000..=0x4002_2000 => Block::Gpio((base >> 10 & 15) as u8),
        0x4002_3000 => Block::Other("CRC"),
        0x4002_3800 => Block::Rcc,
        0x4002_3c00 => Block::Flash,
        0x4002_4000..=0x4002_4c00 => Block::Other("backup SRAM"),
        0x4002_6000 => Block::Dma(1),
        0x4002_6400 => Block::Dma(2),
        0x4002_8000..=0x4002_9000 => Block::Other("Ethernet"),
        0x4004_0000..=0x4007_fc00 => Block::Other("USB OTG HS"),
        0x5000_0000..=0x5003_fc00 => Block::Other("USB OTG FS"),
        0x5005_0000 => Block::Dcmi,
        0x5006_0800 => Block::Other("RNG"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_answer_at_the_addresses_of_the_manual() {
        for (address, block) in [
            (0x4000_0000, Block::Timer(2)),
            (0x4000_0400, Block::Timer(3)),
            (0x4000_1400, Block::Timer(7)),
            (0x4000_1800, Block::Timer(12)),
            (0x4000_2000, Block::Timer(14)),
            (0x4000_4400, Block::Usart(2)),
            (0x4000_5000, Block::Usart(5)),
            (0x4000_5400, Block::I2c(1)),
            (0x4000_5c00, Block::I2c(3)),
            (0x4001_4000, Block::Timer(9)),
            (0x4001_4800, Block::Timer(11)),
            (0x4002_0c00, Block::Gpio(3)),
            (0x4002_2000, Block::Gpio(8)),
            (0x4002_6400, Block::Dma(2)),
            (0x5005_0000, Block::Dcmi),
        ] {
            assert_eq!(decode(address + 8), Some((block, 8)), "{block}");
        }
        assert_eq!(decode(0x4002_3400), None);
    }

    #[test]
    fn gates_are_the_bits_of_the_rcc() {
        assert_eq!(Block::Timer(12).gate(), Some(Gate::Apb1(6)));
        assert_eq!(Block::Usart(2).gate(), Some(Gate::Apb1(17)));
        assert_eq!(Block::Usart(5).gate(), Some(Gate::Apb1(20)));
        assert_eq!(Block::I2c(2).gate(), Some(Gate::Apb1(22)));
        assert_eq!(Block::Timer(9).gate(), Some(Gate::Apb2(16)));
        assert_eq!(Block::Dma(2).gate(), Some(Gate::Ahb1(22)));
        assert_eq!(Block::Watchdog.gate(), None);
    }
}
