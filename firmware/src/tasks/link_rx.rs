//! Bytes from the autopilot to messages.

use embassy_stm32::usart::RingBufferedUartRx;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use link::{Counters, Parser};

use crate::check_in::{Member, check_in};
use crate::counters::COUNTERS;
use crate::wires::{EVENTS, Event};

/// Bytes taken out of the ring at a time.
const PIECE_BYTES: usize = 128;

/// Silence after which an unfinished frame will not be finished: the longest frame takes 3 ms.
const SILENCE: Duration = Duration::from_millis(20);

/// Pause after a UART error, ten characters: a line that is held low raises one per character, and
/// must not take the processor.
const ERROR_PAUSE: Duration = Duration::from_micros(100);

/// Decodes each message once and queues it for vision. The DMA receives by itself; the deadline is
/// the ring. Lost bytes cost their frame, the parser counts it and finds the next.
#[embassy_executor::task]
pub async fn link_rx(mut uart: RingBufferedUartRx<'static>) {
    let mut parser = Parser::new();
    let mut piece = [0; PIECE_BYTES];
    loop {
        check_in(Member::LinkRx);
        match with_timeout(SILENCE, uart.read(&mut piece)).await {
            Ok(Ok(length)) => decode(&mut parser, piece.get(..length).unwrap_or_default()),
            Ok(Err(_)) => {
                COUNTERS.uart_errors.count();
                Timer::after(ERROR_PAUSE).await;
            }
            Err(_) => parser.give_up(),
        }
        report(parser.counters());
    }
}

fn decode(parser: &mut Parser, mut bytes: &[u8]) {
    while let Some(frame) = parser.next_frame(&mut bytes) {
        let event = Event::Message {
            at: Instant::now(),
            message: frame.message,
        };
        if EVENTS.try_send(event).is_err() {
            COUNTERS.queue_full.count();
        }
    }
}

fn report(counters: Counters) {
    COUNTERS.link_ok.set(counters.frames_ok);
    let bad = [
        counters.bad_length,
        counters.wrong_class,
        counters.unknown_message,
        counters.wrong_size,
        counters.bad_checksum,
        counters.cut_short,
    ];
    COUNTERS
        .link_bad
        .set(bad.iter().fold(0, |sum: u32, n| sum.saturating_add(*n)));
}
