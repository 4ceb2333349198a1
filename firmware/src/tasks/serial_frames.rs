//! Frames from a host in the camera's place, in rig images.

use embassy_futures::select::{Either, Either3, select, select3};
use embassy_stm32::mode::Async;
use embassy_stm32::usart::{RingBufferedUartRx, UartTx};
use embassy_time::{Duration, Instant, Timer};
use frames::{Event, Receiver, Reply, Request, Source, Verdict};
use pilot::Exposure;

use super::camera::{pass_frames, pass_on};
use crate::capture::{Capture, Injection};
use crate::check_in::{self, Member, check_in};
use crate::counters::COUNTERS;
use crate::serial_port::Wire;
use crate::wires::{SEEN, SENSOR_SILENT, SENSOR_STARTED};
use crate::{identity, log};

/// Bytes taken out of the ring at a time: more than [`PACE`] brings at any rate.
const PIECE_BYTES: usize = 1024;

/// Time between two looks into the ring. A read returns as soon as there is a byte, and one comes every
/// 560 cycles: a task that read on and on would leave vision no time.
const PACE: Duration = Duration::from_millis(1);

/// Silence after which a frame that has begun will not be completed. A host that is not real-time
/// pauses for tens of milliseconds.
const SILENCE: Duration = Duration::from_millis(150);

const _: () = assert!(SILENCE.as_ticks() <= check_in::PERIOD.as_ticks());

/// Pause after a UART error, thirty characters: a line that is held low raises one per character.
const ERROR_PAUSE: Duration = Duration::from_micros(100);

/// Time between two lines in the log.
const LINE_PERIOD: Duration = Duration::from_secs(1);

/// Passes the camera's frames on until a host begins a session, then the host's, until it ends it.
#[embassy_executor::task]
pub async fn serial_frames(mut capture: Capture, wire: Wire, initial: Exposure) {
    let (tx, rx) = wire;
    let mut host = Host {
        tx,
        rx,
        receiver: Receiver::new(identity::SHAPE),
        exposure: initial,
        unanswered: [None; 2],
    };
    loop {
        match select(pass_frames(&mut capture), host.until_it_begins()).await {
            Either::First(never) => never,
            Either::Second(()) => {}
        }
        log::source(Source::Serial);
        host.session(&mut capture.divert()).await;
        log::source(Source::Camera);
        // The camera task has not followed what the sensor did: it is set up again.
        SENSOR_STARTED.reset();
        SENSOR_SILENT.signal(());
    }
}

/// Whether the session goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Session {
    GoesOn,
    Ends,
}

/// The other end of the wire.
struct Host {
    tx: UartTx<'static, Async>,
    rx: RingBufferedUartRx<'static>,
    receiver: Receiver,
    /// What the firmware wants.
    exposure: Exposure,
    /// The host's numbers of the frames in the two buffers that vision may still look at, each with
    /// the board's.
    unanswered: [Option<Passed>; 2],
}

/// A frame that went to vision.
#[derive(Clone, Copy)]
struct Passed {
    /// The board's number.
    number: u32,
    /// The host's.
    host_number: u32,
}

impl Host {
    /// Answers questions, refuses frames, until the host begins a session.
    async fn until_it_begins(&mut self) {
        let mut piece = [0; PIECE_BYTES];
        loop {
            let Some(mut bytes) = self.read(&mut piece).await else {
                continue;
            };
            while let Some(event) = self.receiver.next_event(now_ms(), &mut bytes, None) {
                self.answer(event).await;
                if matches!(event, Event::Asked(Request::Begin { .. })) {
                    return;
                }
            }
            Timer::after(PACE).await;
        }
    }

    /// Takes frames until the host ends the session.
    async fn session(&mut self, injection: &mut Injection<'_>) {
        let mut piece = [0; PIECE_BYTES];
        let mut told = Instant::now();
        SEEN.reset();
        self.unanswered = [None; 2];
        loop {
            check_in(Member::Camera);
            if told.elapsed() >= LINE_PERIOD {
                told = Instant::now();
                log::serial_frames(self.receiver.counts());
            }
            let silence = Timer::after(SILENCE);
            let bytes = match select3(SEEN.wait(), self.rx.read(&mut piece), silence).await {
                Either3::First((number, exposure)) => {
                    self.seen(number, exposure).await;
                    continue;
                }
                Either3::Second(Ok(length)) => piece.get(..length).unwrap_or_default(),
                Either3::Second(Err(_)) => {
                    COUNTERS.uart_errors.count();
                    Timer::after(ERROR_PAUSE).await;
                    continue;
                }
                Either3::Third(()) => {
                    self.receiver.give_up();
                    &[]
                }
            };
            if self.take(bytes, injection).await == Session::Ends {
                return;
            }
            Timer::after(PACE).await;
        }
    }

    /// Bytes of a session.
    async fn take(&mut self, mut bytes: &[u8], injection: &mut Injection<'_>) -> Session {
        loop {
            let buffer = injection.buffer().map(|buffer| buffer.as_mut_slice());
            let Some(event) = self.receiver.next_event(now_ms(), &mut bytes, buffer) else {
                return Session::GoesOn;
            };
            if let Event::Frame { number } = event {
                self.pass(number, injection).await;
            }
            self.answer(event).await;
            if event == Event::Asked(Request::End) {
                return Session::Ends;
            }
        }
    }

    /// A whole frame, to vision. It is answered when vision has looked at it, or when its buffer is
    /// filled again.
    async fn pass(&mut self, host_number: u32, injection: &mut Injection<'_>) {
        let frame = injection.complete();
        let number = frame.number();
        let passed = Passed {
            number,
            host_number,
        };
        let [older, newer] = &mut self.unanswered;
        let overtaken = core::mem::replace(older, newer.replace(passed));
        pass_on(frame);
        if let Some(overtaken) = overtaken {
            self.verdict(overtaken.host_number, Verdict::Missed).await;
        }
    }

    /// Vision has looked at a frame.
    async fn seen(&mut self, number: u32, exposure: Exposure) {
        self.exposure = exposure;
        let mut waiting = self.unanswered.iter_mut();
        let slot = waiting.find(|slot| slot.is_some_and(|passed| passed.number == number));
        if let Some(passed) = slot.and_then(Option::take) {
            self.verdict(passed.host_number, Verdict::Used).await;
        }
    }

    /// What is to be said to an event.
    async fn answer(&mut self, event: Event) {
        match event {
            Event::Asked(Request::Identify) => self.send(Reply::Identity(identity::THIS)).await,
            Event::Asked(Request::Begin { .. }) => self.send(Reply::Source(Source::Serial)).await,
            Event::Asked(Request::End) => self.send(Reply::Source(Source::Camera)).await,
            Event::Asked(Request::Count) => {
                self.send(Reply::Counts(self.receiver.counts())).await;
            }
            Event::Dropped { number, why } => self.verdict(number, why).await,
            Event::Frame { .. } | Event::Corrupt(_) => {}
        }
    }

    async fn verdict(&mut self, number: u32, verdict: Verdict) {
        self.send(Reply::Verdict {
            number,
            verdict,
            shutter_lines: self.exposure.shutter_lines,
            gain: self.exposure.gain,
        })
        .await;
    }

    async fn send(&mut self, reply: Reply) {
        if self.tx.write(&reply.encode()).await.is_err() {
            COUNTERS.uart_errors.count();
        }
    }

    async fn read<'p>(&mut self, piece: &'p mut [u8; PIECE_BYTES]) -> Option<&'p [u8]> {
        let Ok(length) = self.rx.read(piece).await else {
            COUNTERS.uart_errors.count();
            Timer::after(ERROR_PAUSE).await;
            return None;
        };
        Some(piece.get(..length).unwrap_or_default())
    }
}

/// The receiver's clock. It wraps.
fn now_ms() -> u32 {
    Instant::now().as_millis() as u32
}
