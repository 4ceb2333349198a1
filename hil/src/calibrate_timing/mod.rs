//! A fixed set of kernels on the emulated core, beside the same image on a board.

mod comparison;
mod timing;

use emulator::time::Nanos;
use emulator::wiring::Unwired;

use crate::board::emulated::Firmware;
use crate::board::timing::TimingModel;
use crate::board::{BoardError, FirmwareLog};

pub use comparison::{Comparison, Pair, Published};
pub use timing::Timing;

/// The firmware's example that runs the kernels.
pub const EXAMPLE: &str = "kernels";

/// The kernel whose cycles are those of calling one.
pub const NOTHING: &str = "nothing";

/// Longer than all of it takes: 135 kernels of some 2 ms.
const PATIENCE: Nanos = Nanos::from_millis(2_000);

/// Time between two looks at the log, which holds 1 KiB.
const GLANCE: Nanos = Nanos::from_millis(5);

/// What the image says last.
const END: &str = "kernels done";

/// Why there are no timings.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// The image, or the chip that ran it.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The image did not come to its end.
    #[error("the kernels did not end within {} s: {told} of them were told", PATIENCE.as_secs_f64())]
    Unfinished {
        /// Kernels that were.
        told: usize,
    },
    /// A log without a kernel in it.
    #[error(
        "no line `kernel ROUND NAME items N first N then N`: is it the log of the example `{EXAMPLE}`?"
    )]
    NoKernels,
    /// A log of another image.
    #[error("`{0}` is missing: the log is of another version of the kernels")]
    Missing(String),
}

/// Runs the kernels of the image on the emulated chip.
pub fn emulate(elf: &[u8], model: TimingModel) -> Result<Vec<Timing>, CalibrationError> {
    let firmware = Firmware::parse(elf)?.with_timing(model);
    let mut machine = firmware.machine(Unwired)?;
    let mut probe = firmware.probe()?;
    let (mut timings, mut log) = (Vec::new(), Vec::new());
    while machine.now() < PATIENCE {
        let until = machine.now() + GLANCE;
        machine.run_until(until).map_err(BoardError::from)?;
        probe.read(&mut machine, &mut log)?;
        for record in log.drain(..) {
            let FirmwareLog::Line { text, .. } = record else {
                continue;
            };
            if text == END {
                return Ok(timings);
            }
            timings.extend(Timing::from_log(&text));
        }
    }
    Err(CalibrationError::Unfinished {
        told: timings.len(),
    })
}

/// Reads the log of a board.
pub fn read(log: &str) -> Result<Vec<Timing>, CalibrationError> {
    let timings: Vec<Timing> = log.lines().filter_map(Timing::from_log).collect();
    if timings.is_empty() {
        return Err(CalibrationError::NoKernels);
    }
    Ok(timings)
}
