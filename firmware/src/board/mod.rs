//! The pin map: which peripheral, pin and DMA stream does what. Nothing else names a pin.
//!
//! | | peripheral | pins | DMA |
//! |---|---|---|---|
//! | camera | DCMI | D0 to D7: PC6 to PC9, PC11, PB6, PB8, PB9; VSYNC PB7, HSYNC PA4, PIXCLK PA6 | DMA2 stream 1 |
//! | its control | I2C2 | PB10, PB11; RESET PD2; EXTCLK as the board has it | DMA1 streams 7 and 2 |
//! | autopilot | USART2 | PA2, PA3 | DMA1 streams 6 and 5 |
//! | frames over serial, in a rig image | USART3 | PD8, PD9 | DMA1 streams 3 and 1 |
//!
//! DCMI, I2C and clock stand on the pins of TU Delft's stereo board (STM32F405), and, but for the
//! clock, of published STM32F4DISCOVERY camera wirings; USART2 stays free for the autopilot. Of
//! USART3's other pins, PC10 and PC11, the second is D4. What differs between the boards is in
//! `pins`: one of two files, by cargo feature.
//!
//! The UARTs and I2C2 use DMA1: DMA2 must not serve an APB2 peripheral while it moves pixels (data
//! corruption, errata sheet ES0182).

#[cfg(not(any(feature = "board-flight", feature = "board-discovery")))]
compile_error!("no board: choose board-flight or board-discovery");
#[cfg(all(feature = "board-flight", feature = "board-discovery"))]
compile_error!("two boards: choose board-flight or board-discovery (--no-default-features)");

#[cfg_attr(feature = "board-flight", path = "flight.rs")]
#[cfg_attr(not(feature = "board-flight"), path = "discovery.rs")]
pub mod pins;
#[cfg(feature = "rig")]
mod rig;

use embassy_stm32::peripherals::{
    DMA1_CH2, DMA1_CH5, DMA1_CH6, DMA1_CH7, I2C2, IWDG, PA2, PA3, PB10, PB11, PD2, USART2,
};
use embassy_stm32::{Peri, Peripherals, bind_interrupts, dma, i2c, usart};

use crate::capture;
#[cfg(feature = "rig")]
pub use rig::SerialPort;

bind_interrupts!(
    /// Interrupt vectors and who serves them.
    pub struct Irqs {
        DCMI => capture::InterruptHandler;
        DMA2_STREAM1 => capture::DmaInterruptHandler;
        I2C2_EV => i2c::EventInterruptHandler<I2C2>;
        I2C2_ER => i2c::ErrorInterruptHandler<I2C2>;
        USART2 => usart::InterruptHandler<USART2>;
        DMA1_STREAM2 => dma::InterruptHandler<DMA1_CH2>;
        DMA1_STREAM5 => dma::InterruptHandler<DMA1_CH5>;
        DMA1_STREAM6 => dma::InterruptHandler<DMA1_CH6>;
        DMA1_STREAM7 => dma::InterruptHandler<DMA1_CH7>;
        #[cfg(feature = "rig")]
        USART3 => usart::InterruptHandler<embassy_stm32::peripherals::USART3>;
        #[cfg(feature = "rig")]
        DMA1_STREAM1 => dma::InterruptHandler<embassy_stm32::peripherals::DMA1_CH1>;
        #[cfg(feature = "rig")]
        DMA1_STREAM3 => dma::InterruptHandler<embassy_stm32::peripherals::DMA1_CH3>;
    }
);

/// The image sensor's clock, reset and I2C.
pub struct SensorPort {
    /// Makes EXTCLK.
    pub clock: pins::ClockSource,
    /// RESET, active low.
    pub reset: Peri<'static, PD2>,
    /// The control bus.
    pub bus: SensorBus,
}

/// The image sensor's control bus. Its pull-ups, to the sensor's 2.8 V, are on the board: a pull-up
/// or push from the processor's 3.3 V would harm the sensor.
pub struct SensorBus {
    /// The bus controller.
    pub i2c: Peri<'static, I2C2>,
    /// I2C clock.
    pub scl: Peri<'static, PB10>,
    /// I2C data.
    pub sda: Peri<'static, PB11>,
    /// I2C transmit stream.
    pub tx_dma: Peri<'static, DMA1_CH7>,
    /// I2C receive stream.
    pub rx_dma: Peri<'static, DMA1_CH2>,
}

/// The wire to the autopilot.
pub struct LinkPort {
    /// The UART.
    pub uart: Peri<'static, USART2>,
    /// To the autopilot.
    pub tx: Peri<'static, PA2>,
    /// From the autopilot.
    pub rx: Peri<'static, PA3>,
    /// Transmit stream.
    pub tx_dma: Peri<'static, DMA1_CH6>,
    /// Receive stream.
    pub rx_dma: Peri<'static, DMA1_CH5>,
}

/// The whole board, in the parts its tasks own.
pub struct Board {
    /// For the camera task.
    pub camera: capture::Port,
    /// For the exposure task.
    pub sensor: SensorPort,
    /// For the link tasks.
    pub link: LinkPort,
    /// For the task that takes frames over serial.
    #[cfg(feature = "rig")]
    pub serial: SerialPort,
    /// For the health task.
    pub watchdog: Peri<'static, IWDG>,
}

impl Board {
    /// Deals out the chip.
    pub fn new(p: Peripherals) -> Self {
        let pins = [
            capture::pin(p.PC6),  // D0
            capture::pin(p.PC7),  // D1
            capture::pin(p.PC8),  // D2
            capture::pin(p.PC9),  // D3
            capture::pin(p.PC11), // D4
            capture::pin(p.PB6),  // D5
            capture::pin(p.PB8),  // D6
            capture::pin(p.PB9),  // D7
            capture::pin(p.PB7),  // VSYNC
            capture::pin(p.PA4),  // HSYNC
            capture::pin(p.PA6),  // PIXCLK
        ];
        Self {
            camera: capture::Port::new(p.DCMI, p.DMA2_CH1, pins),
            sensor: SensorPort {
                clock: pins::own!(p),
                reset: p.PD2,
                bus: SensorBus {
                    i2c: p.I2C2,
                    scl: p.PB10,
                    sda: p.PB11,
                    tx_dma: p.DMA1_CH7,
                    rx_dma: p.DMA1_CH2,
                },
            },
            link: LinkPort {
                uart: p.USART2,
                tx: p.PA2,
                rx: p.PA3,
                tx_dma: p.DMA1_CH6,
                rx_dma: p.DMA1_CH5,
            },
            #[cfg(feature = "rig")]
            serial: SerialPort {
                uart: p.USART3,
                tx: p.PD8,
                rx: p.PD9,
                tx_dma: p.DMA1_CH3,
                rx_dma: p.DMA1_CH1,
            },
            watchdog: p.IWDG,
        }
    }
}
