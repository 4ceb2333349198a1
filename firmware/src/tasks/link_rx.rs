//! Bytes from the autopilot to messages.

use embassy_stm32::usart::RingBufferedUartRx;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use link::{Counters, Message, Parser};

use crate::check_in::{Member, check_in};
use crate::counters::COUNTERS;
use crate::log;
use crate::wires::{EVENTS, Event};

/// Bytes taken out of the ring at a time.
const PIECE_BYTES: usize = 128;

/// Silence after which an unfinished frame will not be finished: the longest frame takes 3 ms.
const SILENCE: Duration = Duration::from_millis(20);

/// Pause after a UART error, ten characters: a line that is held low raises one per character, and
/// must not take the processor.
const ERROR_PAUSE: Duration = Duration::from_micros(100);

/// Drops that are logged in a second at most: what a link with one byte in a hundred broken loses
/// (it carries 300 B/s), three times over. A noisy line drops hundreds; they are counted, and at
/// 45 bytes a line the log keeps room for the frames' lines.
const LOGGED_PER_SECOND: u8 = 20;

/// Decodes each message once and queues it for vision. The DMA receives by itself; the deadline is
/// the ring. Lost bytes cost their frame, the parser counts it and finds the next.
#[embassy_executor::task]
pub async fn link_rx(mut uart: RingBufferedUartRx<'static>) {
    let mut parser = Parser::new();
    let mut drops = DropLog::new();
    let mut piece = [0; PIECE_BYTES];
    loop {
        check_in(Member::LinkRx);
        match with_timeout(SILENCE, uart.read(&mut piece)).await {
            Ok(Ok(length)) => {
                let bytes = piece.get(..length).unwrap_or_default();
                decode(&mut parser, bytes, &mut drops);
            }
            Ok(Err(_)) => {
                COUNTERS.uart_errors.count();
                Timer::after(ERROR_PAUSE).await;
            }
            Err(_) => {
                parser.give_up();
                decode(&mut parser, &[], &mut drops);
            }
        }
        report(parser.counters());
    }
}

fn decode(parser: &mut Parser, mut bytes: &[u8], drops: &mut DropLog) {
    while let Some(event) = parser.next_event(&mut bytes) {
        match event {
            link::Event::Frame(frame) => queue(frame.message, drops),
            link::Event::Refused(refused) => {
                drops.log(refused.message_name(), refused.why.name());
            }
        }
    }
}

fn queue(message: Message, drops: &mut DropLog) {
    let name = message.name();
    let at = Instant::now();
    if EVENTS.try_send(Event::Message { at, message }).is_err() {
        COUNTERS.queue_full.count();
        drops.log(name, "queue full");
    }
}

/// Logs what was dropped as long as it is little.
struct DropLog {
    since: Instant,
    left: u8,
}

impl DropLog {
    fn new() -> Self {
        Self {
            since: Instant::now(),
            left: LOGGED_PER_SECOND,
        }
    }

    fn log(&mut self, message: &str, why: &str) {
        if self.since.elapsed() >= Duration::from_secs(1) {
            *self = Self::new();
        }
        if let Some(left) = self.left.checked_sub(1) {
            self.left = left;
            log::link_dropped(message, why);
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
