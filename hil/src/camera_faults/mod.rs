//! What becomes of frames when the camera's wires fail: the firmware's image on the emulated board,
//! with faults injected one by one, and then minutes without any.
//!
//! Every frame that the firmware says it has looked at is held against the frame that the camera
//! meant to send: all its bytes must lie in the firmware's buffer, and the mean luma of the horizon
//! that the firmware logs must be, to the bit, the one that the pilot computes on this machine.
//! Consecutive frames differ in their noise, so neither holds for a frame that is torn or shifted.

mod bench;
mod fault;
mod soak;

pub use bench::{Bench, BenchError};
pub use fault::{CameraFault, Phase};
pub use soak::{Soak, soak};

use emulator::time::Nanos;
use fake_sensors::camera::tcm8230::frame_period_ns;
use serde::Serialize;

use crate::board::emulated::Firmware;
use crate::board::native::EXTCLK_HZ;

/// The longest that may pass from the signal's return to the end of the first good frame.
pub const RECOVERY_LIMIT_MS: f64 = 200.0;

/// Healthy frames before a fault: the exposure settles meanwhile.
const FRAMES_BEFORE: u64 = 8;

/// How long a recovery is waited for.
const PATIENCE: Nanos = Nanos::from_millis(600);

/// How long the recovery must last: four frames.
const PROBATION: Nanos = Nanos::from_millis(160);

/// Frames that must come in that time: one may end just behind it.
const PROBATION_FRAMES: usize = 3;

const BETWEEN_NAMES: &str = ", ";

/// What became of one fault.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The fault's name.
    pub fault: String,
    /// What the firmware called it, the names in the order in which they came; none: it said nothing.
    pub detected_as: Option<String>,
    /// Frames that the camera sent, or would have sent, and the firmware did not see. None where it
    /// did not recover.
    pub frames_lost: Option<u64>,
    /// From the return of the signal to the end of the first good frame that the firmware looked at,
    /// milliseconds. None where there was none.
    pub recovery_ms: Option<f64>,
    /// Frames that the firmware looked at although they were not what the camera had sent.
    #[serde(skip)]
    pub wrong_frames: u64,
}

impl Row {
    /// Whether the fault was noticed, passed in time, and cost no more than frames.
    pub fn holds(&self) -> bool {
        self.detected_as.is_some()
            && self.recovery_ms.is_some_and(|ms| ms <= RECOVERY_LIMIT_MS)
            && self.wrong_frames == 0
    }
}

/// Boots the image on a board of its own, injects the fault and looks on.
pub fn suffer(firmware: &Firmware, fault: CameraFault, phase: Phase) -> Result<Row, BenchError> {
    let mut bench = Bench::boot(firmware, None)?;
    bench.run_frames(FRAMES_BEFORE)?;
    let (from, back) = fault.inject(&mut bench, phase)?;
    let recovered = bench.run_to_good_frame(back, back + PATIENCE)?;
    let good_until_then = bench.good_frames().len();
    bench.run_until(bench.now() + PROBATION)?;
    let lasts = bench.good_frames().len() >= good_until_then + PROBATION_FRAMES;
    let recovered = recovered.filter(|_| lasts);
    Ok(Row {
        fault: fault.to_string(),
        detected_as: names(bench.faults_since(from)),
        frames_lost: recovered.map(|end| frames_lost(bench.good_frames(), from, end)),
        recovery_ms: recovered.map(|end| (end - back).0 as f64 / 1e6),
        wrong_frames: bench.wrong_frames(),
    })
}

/// The fault in every [`Phase`]: the worst of all, and all the names.
pub fn suffer_all(firmware: &Firmware, fault: CameraFault) -> Result<Row, BenchError> {
    let [first, rest @ ..] = Phase::ALL;
    let mut worst = suffer(firmware, fault, first)?;
    for phase in rest {
        worst = worse(worst, suffer(firmware, fault, phase)?);
    }
    Ok(worst)
}

fn worse(a: Row, b: Row) -> Row {
    let detected = a.detected_as.zip(b.detected_as);
    let recovery_ms = a.recovery_ms.zip(b.recovery_ms);
    Row {
        fault: a.fault,
        detected_as: detected
            .and_then(|(a, b)| names(a.split(BETWEEN_NAMES).chain(b.split(BETWEEN_NAMES)))),
        frames_lost: a.frames_lost.zip(b.frames_lost).map(|(a, b)| a.max(b)),
        recovery_ms: recovery_ms.map(|(a, b)| a.max(b)),
        wrong_frames: a.wrong_frames + b.wrong_frames,
    }
}

/// Each name once, in the order in which they came.
fn names<'n>(faults: impl Iterator<Item = &'n str>) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for name in faults {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    (!names.is_empty()).then(|| names.join(BETWEEN_NAMES))
}

/// Frames that would have fitted between the last good frame before `from` and the one that ended
/// at `end`, without those that came.
fn frames_lost(good: &[Nanos], from: Nanos, end: Nanos) -> u64 {
    let before = good.iter().rev().find(|good| **good <= from);
    let since = before.copied().unwrap_or(from);
    let period = frame_period_ns(EXTCLK_HZ);
    let periods = ((end - since).0 + period / 2) / period;
    let came = good.iter().filter(|good| **good > since && **good <= end);
    periods.saturating_sub(came.count() as u64)
}
