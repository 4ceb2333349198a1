//! Minutes without a fault, at the sensor's highest frame rate.

use emulator::time::Nanos;
use serde::Serialize;

use super::bench::{Bench, BenchError};
use crate::board::emulated::Firmware;

/// The camera's own crystal, hertz: 30.00 frames per second (data sheet). The board's timer cannot
/// make it of 84 MHz.
pub const CRYSTAL_HZ: u32 = 24_570_000;

/// How often progress is told.
const PERIOD: Nanos = Nanos::from_millis(1_000);

/// What became of the frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Soak {
    /// Emulated minutes.
    pub minutes: f64,
    /// Frames per second that the camera sent.
    pub fps: f64,
    /// Frames with a picture that the camera sent.
    pub frames_sent: u64,
    /// Frames of these that the firmware looked at, each byte for byte what was sent.
    pub frames_captured: u64,
    /// Frames that the firmware looked at although they were not what the camera had sent, and
    /// faults that it told of without reason.
    #[serde(skip)]
    pub mistakes: u64,
}

impl Soak {
    /// Whether not a frame was lost.
    pub fn holds(&self) -> bool {
        self.frames_captured == self.frames_sent && self.mistakes == 0
    }
}

/// Runs a board for `minutes`. `progress` hears how many seconds are done.
pub fn soak(
    firmware: &Firmware,
    minutes: f64,
    progress: &mut dyn FnMut(u64),
) -> Result<Soak, BenchError> {
    let mut bench = Bench::boot(firmware, Some(CRYSTAL_HZ))?;
    let begin = bench.now();
    let started = bench.camera().camera().frames_started();
    let end = begin + Nanos((minutes * 60e9) as u64);
    while bench.now() < end {
        let next = (bench.now() + PERIOD).min(end);
        bench.run_until(next)?;
        progress(((bench.now() - begin).0) / PERIOD.0);
    }
    let seconds = (bench.now() - begin).as_secs_f64();
    let frames = bench.camera().camera().frames_started() - started;
    // The frame that is on its way counts as sent with its last line.
    bench.run_into_blanking()?;
    bench.run_until(bench.now() + Nanos(500_000))?;
    let told = bench.faults_since(Nanos(0)).count() as u64;
    Ok(Soak {
        minutes,
        fps: (frames as f64 / seconds * 100.0).round() / 100.0,
        frames_sent: bench.camera().camera().frames_sent(),
        frames_captured: bench.good_frames().len() as u64,
        mistakes: bench.wrong_frames() + told,
    })
}
