//! An STM32F4DISCOVERY (MB997, UM1472) with a camera on jumper wires, as short as they can be: 10 cm and
//! no more.
//!
//! EXTCLK is TIM1's, on PA8: PA7 is the data line of the motion sensor's bus. What else is soldered to
//! the camera's and the link's pins:
//!
//! | pin | camera | also | what is done |
//! |---|---|---|---|
//! | PA4, PC7 | HSYNC, D1 | audio DAC: I2S word select, master clock | inputs of a DAC in reset: PD4 is held low |
//! | PB6, PB9 | D5, D7 | audio DAC: I2C, pulled up by 4.7 kOhm | as above; the sensor's outputs drive 2 mA, the resistors take 0.7 |
//! | PA6 | PIXCLK | motion sensor: data out | high impedance while its chip select, PE3, is high |
//! | PB10 | I2C clock | microphone: clock | its data pin, PC3, has no other use; I2C is slower than its least clock |
//! | PB7, PB8, PC6, PC8, PC9, PC11, PB11, PD2 | VSYNC, D6, D0, D2, D3, D4, I2C data, RESET | nothing | |
//! | PA2, PA3 | (autopilot, USART2) | nothing | |
//! | PD8, PD9 | (frames, USART3) | nothing | |
//!
//! PC10, which USART3 could have, is the DAC's bit clock, and PC11 is D4. The I2C lines have no pull-ups
//! on this board: 4.7 kOhm to the sensor's 2.8 V are part of the wiring. The LEDs (PD12 to PD15), the
//! button (PA0) and USB (PA9 to PA12) are left alone.

use embassy_stm32::Peri;
use embassy_stm32::gpio::{Level, Output, OutputType, Speed};
use embassy_stm32::peripherals::{PA8, PD4, PE3, TIM1};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::Channel;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use frames::BoardName;

/// What the board is called.
pub const NAME: BoardName = BoardName::Discovery;

/// What makes EXTCLK, channel 1 of the timer on its pin, and what must be silent on this board before
/// the camera speaks.
pub struct ClockSource {
    /// The timer, from APB2's 168 MHz.
    pub timer: Peri<'static, TIM1>,
    /// EXTCLK.
    pub pin: Peri<'static, PA8>,
    /// Reset of the audio DAC, active low.
    pub dac_reset: Peri<'static, PD4>,
    /// Chip select of the motion sensor, active low.
    pub motion_select: Peri<'static, PE3>,
}

/// A clock that can be let out.
pub type SensorClock = SimplePwm<'static, TIM1>;

/// The timer's channel on EXTCLK.
pub const CLOCK_CHANNEL: Channel = Channel::Ch1;

impl ClockSource {
    /// The clock at a frequency, not let out yet; the other chips on the camera's pins are off.
    pub fn at(self, frequency: Hertz) -> SensorClock {
        // For ever: a dropped output lets go of its pin.
        core::mem::forget(Output::new(self.dac_reset, Level::Low, Speed::Low));
        core::mem::forget(Output::new(self.motion_select, Level::High, Speed::Low));
        let pin = PwmPin::new(self.pin, OutputType::PushPull);
        let counting = CountingMode::EdgeAlignedUp;
        SimplePwm::new(self.timer, Some(pin), None, None, None, frequency, counting)
    }
}

/// What this board alone has, out of the chip's peripherals.
macro_rules! own {
    ($p:ident) => {
        $crate::board::pins::ClockSource {
            timer: $p.TIM1,
            pin: $p.PA8,
            dac_reset: $p.PD4,
            motion_select: $p.PE3,
        }
    };
}
pub(super) use own;
