//! The wire to the autopilot: USART2, 8N1, DMA both ways.

use embassy_stm32::gpio::Pull;
use embassy_stm32::mode::Async;
use embassy_stm32::usart::{Config, ConfigError, RingBufferedUartRx, Uart, UartTx};
use static_cell::ConstStaticCell;

use crate::board::{Irqs, LinkPort};

/// What the published camera client of the Crazyflie sets. APB1's 42 MHz divided by 46 are 913 043
/// baud, 0.93 % too slow; ST's library on the Crazyflie, whose UART has the same clock, rounds to 45,
/// 1.27 % too fast. The 2.2 % between them are within the 3.3 % that either receiver tolerates (RM0090
/// §30.3.5).
const BAUD: u32 = 921_600;

/// Bytes that may wait in the receive ring: 5.5 ms at 92 kB/s. The receiver is one of the urgent tasks,
/// which wait for each other for some 0.1 ms.
const RING_BYTES: usize = 512;

static RING: ConstStaticCell<[u8; RING_BYTES]> = ConstStaticCell::new([0; RING_BYTES]);

/// Opens the port. Receives from then on, sends nothing by itself. To be called once.
///
/// # Errors
/// The UART's, where it cannot make the baud rate.
pub fn open(
    port: LinkPort,
) -> Result<(UartTx<'static, Async>, RingBufferedUartRx<'static>), ConfigError> {
    let mut config = Config::default();
    config.baudrate = BAUD;
    // The idle level: an autopilot that is not there is silent.
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
