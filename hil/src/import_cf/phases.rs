//! What the drone was doing: the app's mode is not logged, but its height is, and what the camera sends.

use autopilot::app::Phase;

use super::estimate::Track;
use super::messages::Messages;

/// Above this height the drone flies, m: half the height of the published experiments (0.5 m).
const AIRBORNE_M: f64 = 0.25;

/// The camera sends a vector in each period of the app while it leads, 0.1 s. Longer than this without a new one, and
/// it does not lead any more, ms.
const SILENT_MS: u64 = 2_000;
/// The same where the vectors are logged slowly: so many rows.
const SILENT_ROWS: u64 = 3;

/// The app's phase at any time.
#[derive(Clone, Debug)]
pub struct Phases<'v> {
    track: Option<&'v Track<'v>>,
    /// When vectors were seen, ms.
    led: Vec<u64>,
    silent_ms: u64,
}

impl<'v> Phases<'v> {
    /// From what was logged; `row_ms` is the time between two rows of the vectors' file.
    pub fn of(track: Option<&'v Track<'v>>, messages: &Messages, row_ms: u64) -> Self {
        Self {
            track,
            led: messages.vectors.iter().map(|(ms, _)| *ms).collect(),
            silent_ms: SILENT_MS.max(SILENT_ROWS * row_ms),
        }
    }

    /// The phase at a time.
    pub fn at(&self, ms: u64) -> Phase {
        if !self.is_airborne(ms) {
            Phase::Ground
        } else if self.is_led(ms) {
            Phase::Following
        } else {
            Phase::Recording
        }
    }

    /// Where no height was logged, all of it counts as flight.
    fn is_airborne(&self, ms: u64) -> bool {
        let height = self.track.and_then(|track| track.height_held(ms));
        height.is_none_or(|height| height >= AIRBORNE_M)
    }

    fn is_led(&self, ms: u64) -> bool {
        let seen = self.led.partition_point(|vector| *vector <= ms);
        let last = seen.checked_sub(1).map(|last| self.led[last]);
        last.is_some_and(|last| ms - last <= self.silent_ms)
    }
}
