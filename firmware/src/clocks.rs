//! Clocks and what hangs on them: the core at 168 MHz from the board's 8 MHz crystal.

use embassy_stm32::rcc::{
    AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllQDiv, PllSource,
    Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, pac};

/// Core clock: the F407's maximum (data sheet DS8626 table 14).
pub const CORE_HZ: u32 = 168_000_000;

/// The crystal of the STM32F4DISCOVERY and of the flight board.
const CRYSTAL: Hertz = Hertz(8_000_000);

/// 8 MHz / 4 x 168 / 2 = 168 MHz; APB1 at its maximum of 42 MHz, APB2 at its maximum of 84 MHz,
/// so that the timers of APB1 run at 84 MHz.
pub fn config() -> Config {
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: CRYSTAL,
        mode: HseMode::Oscillator,
    });
    config.rcc.pll_src = PllSource::HSE;
    config.rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV4,
        mul: PllMul::MUL168,
        divp: Some(PllPDiv::DIV2),
        divq: Some(PllQDiv::DIV7),
        divr: None,
    });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV4;
    config.rcc.apb2_pre = APBPrescaler::DIV2;
    config
}

/// Turns on the instruction cache, the data cache and the prefetch of the flash interface (RM0090
/// §3.5.2). The HAL sets the five wait states of 168 MHz and leaves the rest off, which nearly
/// doubles the cycles of a frame.
pub fn enable_flash_accelerator() {
    pac::FLASH.acr().modify(|acr| {
        acr.set_icen(true);
        acr.set_dcen(true);
        acr.set_prften(true);
    });
}

/// Starts the core's cycle counter (ARM DDI0439 §9.2), which [`cycles`] reads.
pub fn enable_cycle_counter() {
    // SAFETY: nobody else on this board touches DCB or DWT.
    let mut core = unsafe { cortex_m::Peripherals::steal() };
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
}

/// The core's cycle counter. It wraps every 25.6 s: take differences with `wrapping_sub`.
pub fn cycles() -> u32 {
    cortex_m::peripheral::DWT::cycle_count()
}
