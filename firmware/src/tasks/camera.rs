//! Frames from the capture to vision.

use embassy_time::{Duration, with_timeout};

use crate::capture::{Capture, Frame};
use crate::check_in::{Member, check_in};
use crate::counters::COUNTERS;
use crate::wires::{EVENTS, Event, SENSOR_SILENT, SENSOR_STARTED};

/// Five frame times at 25.6 frames per second: nothing in a healthy sensor takes as long.
const FRAME_TIMEOUT: Duration = Duration::from_millis(200);

/// Time-outs in a row after which the sensor, and not the capture, is to be started again.
const SILENCES_TO_RESET: u32 = 5;

/// Passes every frame on. It is not the deadline's keeper: the capture goes on by itself. Where no
/// frame comes, the capture is started again, and after a second of silence the sensor; a camera
/// that stays away is counted, and no reason to stop answering the autopilot.
#[embassy_executor::task]
pub async fn camera(mut capture: Capture) {
    let mut silences = 0;
    let mut settling = 0;
    loop {
        check_in(Member::Camera);
        match with_timeout(FRAME_TIMEOUT, capture.next()).await {
            Ok(frame) => {
                silences = 0;
                settling = SENSOR_STARTED.try_take().unwrap_or(settling);
                if settling == 0 {
                    pass_on(frame);
                } else {
                    settling -= 1;
                }
            }
            Err(_) => {
                COUNTERS.camera_silent.count();
                capture.restart();
                silences += 1;
                if silences >= SILENCES_TO_RESET {
                    silences = 0;
                    SENSOR_SILENT.signal(());
                }
            }
        }
    }
}

fn pass_on(frame: Frame) {
    if EVENTS.try_send(Event::Frame(frame)).is_err() {
        COUNTERS.queue_full.count();
        COUNTERS.frames_missed.count();
    }
}
