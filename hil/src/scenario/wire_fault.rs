//! Something wrong with the camera's wires for a while of a flight.

use std::fmt;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all(serialize = "snake_case", deserialize = "kebab-case"))]
pub enum WireFault {
    /// VSYNC stays low
    LostVsync,
    /// VSYNC stays high
    StuckVsync,
    /// HSYNC stays low
    LostHsync,
    /// One line of each frame ends two pixels early
    ShortLine,
    /// Every line brings eight bytes too many
    ExtraBytes,
    /// The sensor's clock stops
    StoppedClock,
    /// The camera is pulled out
    Unplugged,
}

/// Its name on the command line.
impl fmt::Display for WireFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.to_possible_value() {
            Some(value) => f.write_str(value.get_name()),
            None => fmt::Debug::fmt(self, f),
        }
    }
}

/// A fault with its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CameraTrouble {
    /// What is wrong.
    pub fault: WireFault,
    /// From when on, milliseconds of flight.
    pub from_ms: u64,
    /// For how long, milliseconds.
    pub for_ms: u64,
}

impl CameraTrouble {
    /// For so long, where nothing is said: longer than any time-out of the firmware's.
    pub const USUAL_MS: u64 = 500;

    /// When it is over, milliseconds of flight.
    pub fn until_ms(&self) -> u64 {
        self.from_ms.saturating_add(self.for_ms)
    }
}
