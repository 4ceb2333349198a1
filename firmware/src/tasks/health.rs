//! The watchdog's feeder.

use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{Peri, pac};
use embassy_time::{Duration, Ticker};

use crate::check_in;
use crate::log;

/// The watchdog's own oscillator is anywhere between 17 and 47 kHz (DS8626, LSI oscillator): nominal
/// 1.5 s are 1.0 to 2.8 s, above the sum of the check-in period and the round below in any case.
const WATCHDOG_US: u32 = 1_500_000;

/// Time between two looks at the roll.
const ROUND: Duration = Duration::from_millis(100);

/// Rounds between two lines in the log.
const ROUNDS_PER_LINE: u32 = 10;

/// Feeds the watchdog only when every task has checked in since it was fed; a task that hangs
/// resets the board within the watchdog's time. Runs at the lowest priority, so that a busy loop
/// above it starves it and ends the same way. Reports once a second.
#[embassy_executor::task]
pub async fn health(watchdog: Peri<'static, IWDG>) {
    let mut watchdog = IndependentWatchdog::new(watchdog, WATCHDOG_US);
    // A core halted by a debugger is not a hanging one.
    pac::DBGMCU.apb1fzr().modify(|freeze| freeze.set_iwdg(true));
    watchdog.unleash();
    let mut rounds = Ticker::every(ROUND);
    loop {
        for _ in 0..ROUNDS_PER_LINE {
            rounds.next().await;
            if check_in::all_present() {
                watchdog.pet();
            }
        }
        log::health();
    }
}
