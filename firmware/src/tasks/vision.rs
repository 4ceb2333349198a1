//! The pilot's task: frames and messages in, exposures and answers out.

use embassy_time::{Instant, with_timeout};
use pilot::{FrameReport, Outbox, Pilot};

use crate::capture::{Frame, Integrity};
use crate::check_in::{self, Member, check_in};
use crate::counters::COUNTERS;
use crate::retained::Retained;
#[cfg(feature = "rig")]
use crate::wires;
use crate::wires::{EVENTS, EXPOSURE, Event, OUTGOING};
use crate::{clocks, log};

/// Acts on frames and messages in the order in which they came. A frame must be read before the
/// next but one begins; a STATE must be answered before the next (100 ms). A frame that a newer
/// one has overtaken is skipped and counted; an answer that finds no room on the way to the wire
/// is dropped and counted.
#[embassy_executor::task]
pub async fn vision(mut pilot: Retained) {
    let mut outbox = Outbox::new();
    loop {
        check_in(Member::Vision);
        match with_timeout(check_in::PERIOD, EVENTS.receive()).await {
            Ok(Event::Frame(frame)) if frame.is_newest() => see(&mut pilot, frame),
            Ok(Event::Frame(_)) => COUNTERS.frames_missed.count(),
            Ok(Event::Message { at, message }) => {
                answer(&mut pilot, at, &message, &mut outbox);
            }
            Err(_) => {}
        }
    }
}

fn see(pilot: &mut Retained, frame: Frame) {
    let number = frame.number();
    let ((report, cycles), integrity) = frame.read(|bytes| {
        pilot.change(Instant::now(), |pilot, _| {
            let start = clocks::cycles();
            let report = vision_frame(pilot, bytes);
            (report, clocks::cycles().wrapping_sub(start))
        })
    });
    COUNTERS.frames.count();
    if integrity == Integrity::Torn {
        COUNTERS.frames_torn.count();
    }
    if let Some(wanted) = report.exposure {
        EXPOSURE.signal(wanted);
    }
    #[cfg(feature = "rig")]
    wires::SEEN.signal((number, pilot.pilot().exposure()));
    log::frame(number, cycles, report.mean_luma, pilot.pilot().exposure());
}

/// One frame through the pilot. A function of its own name, never inlined: the rig measures its
/// cycles from outside at this symbol, and compares them with what the cycle counter says here.
#[unsafe(no_mangle)]
#[inline(never)]
fn vision_frame(pilot: &mut Pilot, frame: &pilot::Frame) -> FrameReport {
    pilot.on_frame(frame)
}

fn answer(pilot: &mut Retained, at: Instant, message: &link::Message, outbox: &mut Outbox) {
    let (events, cycles) = pilot.change(at, |pilot, now_ms| {
        let start = clocks::cycles();
        let events = pilot.on_message(now_ms, message, outbox);
        (events, clocks::cycles().wrapping_sub(start))
    });
    // The autopilot waits for the answer, nobody for the log.
    send(outbox);
    events.iter().for_each(log::event);
    if matches!(message, link::Message::State(_)) {
        log::state(cycles);
    }
}

/// Hands the answers to the transmitter, all or none: half a frame would spoil the one after it.
fn send(outbox: &mut Outbox) {
    let mut left = outbox.bytes();
    if OUTGOING.free_capacity() < left.len() {
        COUNTERS.tx_dropped.count();
        left = &[];
    }
    // The pipe is a ring, and one write ends at the ring's end.
    while !left.is_empty() {
        let Ok(written) = OUTGOING.try_write(left) else {
            break;
        };
        left = left.get(written..).unwrap_or_default();
    }
    outbox.clear();
}
