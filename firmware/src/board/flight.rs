//! The board that flies: an STM32F407VG with the pins of TU Delft's stereo board (STM32F405). EXTCLK is
//! TIM3's, on PA7.

use embassy_stm32::Peri;
use embassy_stm32::gpio::OutputType;
use embassy_stm32::peripherals::{PA7, TIM3};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::Channel;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use frames::BoardName;

/// What the board is called.
pub const NAME: BoardName = BoardName::Flight;

/// What makes EXTCLK: channel 2 of the timer, on its pin.
pub struct ClockSource {
    /// The timer, from APB1's 84 MHz.
    pub timer: Peri<'static, TIM3>,
    /// EXTCLK.
    pub pin: Peri<'static, PA7>,
}

/// A clock that can be let out.
pub type SensorClock = SimplePwm<'static, TIM3>;

/// The timer's channel on EXTCLK.
pub const CLOCK_CHANNEL: Channel = Channel::Ch2;

impl ClockSource {
    /// The clock at a frequency, not let out yet.
    pub fn at(self, frequency: Hertz) -> SensorClock {
        let pin = PwmPin::new(self.pin, OutputType::PushPull);
        let counting = CountingMode::EdgeAlignedUp;
        SimplePwm::new(self.timer, None, Some(pin), None, None, frequency, counting)
    }
}

/// What this board alone has, out of the chip's peripherals.
macro_rules! own {
    ($p:ident) => {
        $crate::board::pins::ClockSource {
            timer: $p.TIM3,
            pin: $p.PA7,
        }
    };
}
pub(super) use own;
