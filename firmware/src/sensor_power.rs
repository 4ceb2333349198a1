//! The image sensor's clock, reset and bus, in the order and with the waits of its data sheet
//! (TCM8230MD v1.20, power-on sequence). Its supplies are up before the processor runs.

use embassy_stm32::gpio::{Level, Output, OutputOpenDrain, Speed};
use embassy_stm32::i2c::{self, I2c, Master};
use embassy_stm32::mode::Async;
use embassy_stm32::time::Hertz;
use embassy_time::{Duration, Timer};

use crate::board::pins::{CLOCK_CHANNEL, SensorClock};
use crate::board::{Irqs, SensorBus, SensorPort};

/// EXTCLK: the timer's 84 or 168 MHz by an even divider, for the 45 to 55 % duty the sensor wants.
/// Gives 25.64 frames per second and lines of 74.3 us.
pub const EXTCLK_HZ: u32 = 21_000_000;

/// Clock before the end of reset: at least 100 cycles (4.8 us).
const RESET_TIME: Duration = Duration::from_millis(1);

/// Clock before the first transfer: at least 2000 cycles (95 us).
const WAKE_TIME: Duration = Duration::from_millis(5);

/// The sensor takes 400 kHz; the pull-ups and the edges decide, and nothing is in a hurry.
const I2C_HZ: u32 = 100_000;

/// Half a bit of the clock that frees the bus.
const HALF_BIT: Duration = Duration::from_micros(5);

/// Who holds the sensor's clock and reset, and lends its bus.
pub struct SensorPower {
    clock: SensorClock,
    reset: Output<'static>,
    bus: SensorBus,
}

impl SensorPower {
    /// The sensor in reset, without a clock.
    pub fn new(port: SensorPort) -> Self {
        let mut clock = port.clock.at(Hertz(EXTCLK_HZ));
        clock.channel(CLOCK_CHANNEL).set_duty_cycle_fraction(1, 2);
        Self {
            clock,
            reset: Output::new(port.reset, Level::Low, Speed::Low),
            bus: port.bus,
        }
    }

    /// Resets the sensor and gives the bus on which it then answers.
    pub async fn restart(&mut self) -> I2c<'_, Async, Master> {
        self.reset.set_low();
        self.clock.channel(CLOCK_CHANNEL).enable();
        Timer::after(RESET_TIME).await;
        self.reset.set_high();
        Timer::after(WAKE_TIME).await;
        self.free_bus().await;
        let mut config = i2c::Config::default();
        config.frequency = Hertz(I2C_HZ);
        I2c::new(
            self.bus.i2c.reborrow(),
            self.bus.scl.reborrow(),
            self.bus.sda.reborrow(),
            self.bus.tx_dma.reborrow(),
            self.bus.rx_dma.reborrow(),
            Irqs,
            config,
        )
    }

    /// A sensor that was cut off in the middle of a byte holds the data line until it has been
    /// clocked to the byte's end, nine bits at most; then a stop condition (UM10204 §3.1.16).
    async fn free_bus(&mut self) {
        let bus = &mut self.bus;
        let mut scl = OutputOpenDrain::new(bus.scl.reborrow(), Level::High, Speed::Low);
        let mut sda = OutputOpenDrain::new(bus.sda.reborrow(), Level::High, Speed::Low);
        for _ in 0..9 {
            if sda.is_high() {
                return;
            }
            scl.set_low();
            Timer::after(HALF_BIT).await;
            scl.set_high();
            Timer::after(HALF_BIT).await;
        }
        sda.set_low();
        Timer::after(HALF_BIT).await;
        sda.set_high();
        Timer::after(HALF_BIT).await;
    }
}
