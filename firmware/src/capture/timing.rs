//! The times of the sensor's signal: how long it may be still and be well.
//!
//! For a TCM8230MD in sub-QCIF at full rate with a clock of 21 MHz and faster (data sheet, timing
//! charts): a frame takes 39.0 ms, its lines come 0.15 or 0.6 ms apart, and 3.9 ms pass from the
//! last line of a frame to the first of the next.

use embassy_time::Duration;

/// No line for so long: no signal. Five times the gap between two frames, and short enough that a
/// sensor that lost its registers is up again within 200 ms.
pub const SILENCE: Duration = Duration::from_millis(20);

/// No vertical sync for so long while lines come: it is lost. One and a half frames.
pub const SYNC_SILENCE: Duration = Duration::from_millis(60);

/// More between two lines of a frame: the clock stood, and rows of this frame and of the next were
/// exposed for too long. Between the longest healthy gap and twice that.
pub const LINE_GAP: Duration = Duration::from_millis(1);
