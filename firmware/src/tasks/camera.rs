//! Frames from the capture to vision.

use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Instant, TimeoutError, with_timeout};

use crate::capture::{Capture, Fault, Frame};
use crate::check_in::{self, Member, check_in};
use crate::counters::COUNTERS;
use crate::log;
use crate::wires::{EVENTS, Event, SENSOR_SILENT, SENSOR_STARTED};

/// From the end of the sensor's set-up to its first line: the frame that is passing then is not put
/// out. Two frames.
const FIRST_LINE: Duration = Duration::from_millis(80);

/// No whole frame for so long, whatever the reason: the sensor is set up again. It may have lost a
/// register that shapes its frames. A sensor that has just been set up needs 160 ms.
const FRAMELESS: Duration = Duration::from_millis(250);

/// Frames that may have been exposed while the clock stood, after the one it stood in.
const FRAMES_AFTER_STOP: u8 = 1;

/// Passes every frame on. It is not the deadline's keeper: the capture goes on by itself, and starts
/// afresh by itself. A camera that stays away is counted, and no reason to stop answering the
/// autopilot.
#[cfg(not(feature = "rig"))]
#[embassy_executor::task]
pub async fn camera(mut capture: Capture) {
    pass_frames(&mut capture).await;
}

/// What the task does. Dropped, it loses nothing but what it knows of the sensor's health.
pub async fn pass_frames(capture: &mut Capture) -> ! {
    let mut log = log::CaptureFaults::new();
    let mut settling = 0;
    // When the sensor last did what it should; none while it is being set up.
    let mut healthy: Option<Instant> = None;
    loop {
        check_in(Member::Camera);
        let event = with_timeout(check_in::PERIOD, capture.next());
        match select(SENSOR_STARTED.wait(), event).await {
            Either::First(settling_frames) => {
                settling = settling_frames;
                healthy = Some(Instant::now());
                capture.restart();
                capture.expect_signal(Instant::now() + FIRST_LINE);
            }
            Either::Second(Ok(Ok(frame))) => {
                healthy = healthy.map(|_| Instant::now());
                COUNTERS.frames_missed.count_many(frame.missed());
                if settling == 0 {
                    pass_on(frame);
                } else {
                    settling -= 1;
                }
            }
            Either::Second(Ok(Err(fault))) => {
                COUNTERS.capture(fault).count();
                log.tell(fault);
                if fault == Fault::StoppedClock {
                    settling = settling.max(FRAMES_AFTER_STOP);
                }
                let frameless = healthy.is_some_and(|last| last.elapsed() >= FRAMELESS);
                if frameless || fault == Fault::NoSignal {
                    healthy = None;
                    capture.expect_silence();
                    SENSOR_SILENT.signal(());
                }
            }
            Either::Second(Err(TimeoutError)) => {}
        }
    }
}

/// Queues a frame for vision.
pub fn pass_on(frame: Frame) {
    if EVENTS.try_send(Event::Frame(frame)).is_err() {
        COUNTERS.queue_full.count();
        COUNTERS.frames_missed.count();
    }
}
