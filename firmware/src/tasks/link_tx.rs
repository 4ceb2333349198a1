//! Answers to the autopilot.

use embassy_stm32::mode::Async;
use embassy_stm32::usart::UartTx;
use embassy_time::with_timeout;
use pilot::PERIOD_BYTES;

use crate::check_in::{self, Member, check_in};
use crate::counters::COUNTERS;
use crate::wires::OUTGOING;

/// Sends what vision has queued, in order, at most a period's answers at a time. The wire sets the
/// pace: 200 bytes take 2.2 ms.
#[embassy_executor::task]
pub async fn link_tx(mut uart: UartTx<'static, Async>) {
    let mut piece = [0; PERIOD_BYTES];
    loop {
        check_in(Member::LinkTx);
        let Ok(length) = with_timeout(check_in::PERIOD, OUTGOING.read(&mut piece)).await else {
            continue;
        };
        let bytes = piece.get(..length).unwrap_or_default();
        if uart.write(bytes).await.is_err() {
            COUNTERS.uart_errors.count();
        }
    }
}
