//! The wire on which frames come in the camera's place: USART3, 8N1, DMA both ways.

use embassy_stm32::gpio::Pull;
use embassy_stm32::mode::Async;
use embassy_stm32::usart::{Config, ConfigError, RingBufferedUartRx, Uart, UartTx};
use static_cell::ConstStaticCell;

use crate::board::{Irqs, SerialPort};
use crate::identity::BAUD;

/// Bytes that may wait in the receive ring: 6.8 ms at 3 Mbaud. The task is urgent, and waits for nobody
/// longer than the link's take for a message.
const RING_BYTES: usize = 2048;

static RING: ConstStaticCell<[u8; RING_BYTES]> = ConstStaticCell::new([0; RING_BYTES]);

/// Both directions.
pub type Wire = (UartTx<'static, Async>, RingBufferedUartRx<'static>);

/// Opens the port. To be called once.
///
/// # Errors
/// The UART's, where it cannot make the baud rate.
pub fn open(port: SerialPort) -> Result<Wire, ConfigError> {
    let mut config = Config::default();
    config.baudrate = BAUD;
    // The idle level: a host that is not there is silent.
    config.rx_pull = Pull::Up;
    let uart = Uart::new(
        port.uart,
        port.rx,
        port.tx,
        port.tx_dma,
        port.rx_dma,
        Irqs,
        config,
    )?;
    let (tx, rx) = uart.split();
    Ok((tx, rx.into_ring_buffered(RING.take())))
}
