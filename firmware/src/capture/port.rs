//! What the capture needs of the chip.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{AfType, Flex, Pin, Pull};
use embassy_stm32::peripherals::{DCMI, DMA2_CH1};

/// The alternate function of every DCMI pin (DS8626 table 9).
const DCMI_FUNCTION: u8 = 13;

/// The parallel camera bus: the interface and the DMA stream that empties it. Owned so that nobody
/// else drives them; the capture speaks to their registers.
pub struct Port {
    _owned: (Peri<'static, DCMI>, Peri<'static, DMA2_CH1>),
    _pins: [Flex<'static>; 11],
}

impl Port {
    /// The bus on eight data pins, VSYNC, HSYNC and PIXCLK, each made with [`pin`].
    pub fn new(
        dcmi: Peri<'static, DCMI>,
        dma: Peri<'static, DMA2_CH1>,
        pins: [Flex<'static>; 11],
    ) -> Self {
        Self {
            _owned: (dcmi, dma),
            _pins: pins,
        }
    }
}

/// A pin of the bus. Pulled down, to the level at which the syncs say "no data": a camera that is
/// not there, or not powered, is silent instead of noisy.
pub fn pin(pin: Peri<'static, impl Pin>) -> Flex<'static> {
    let mut pin = Flex::new(pin);
    pin.set_as_af_unchecked(DCMI_FUNCTION, AfType::input(Pull::Down));
    pin
}
