//! What a rig image has besides.

use embassy_stm32::Peri;
use embassy_stm32::peripherals::{DMA1_CH1, DMA1_CH3, PD8, PD9, USART3};

/// The wire to the host that sends frames in the camera's place.
pub struct SerialPort {
    /// The UART.
    pub uart: Peri<'static, USART3>,
    /// To the host.
    pub tx: Peri<'static, PD8>,
    /// From the host.
    pub rx: Peri<'static, PD9>,
    /// Transmit stream.
    pub tx_dma: Peri<'static, DMA1_CH3>,
    /// Receive stream.
    pub rx_dma: Peri<'static, DMA1_CH1>,
}
