//! The flash as the flight image has it.

use embassy_stm32::pac;
use embassy_stm32::pac::flash::vals::Latency;

/// Wait states as at 168 MHz and 3.3 V (RM0090 table 10), accelerator on: the core's own clock does not
/// change its cycles.
pub fn set_up() {
    pac::FLASH.acr().modify(|acr| {
        acr.set_latency(Latency::WS5);
        acr.set_icen(true);
        acr.set_dcen(true);
        acr.set_prften(true);
    });
}
