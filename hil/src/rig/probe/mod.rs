//! Access to a board's chip: flash, reset, memory and log. A debug probe has it, and so has an
//! emulated board; whatever else the rig does with a board goes over its wires.

mod command;
mod emulated;
mod probe_rs;
mod text_log;
pub mod wire;

use std::path::Path;
use std::time::Duration;

use crate::board::emulated::Firmware;
use crate::board::{BoardError, FirmwareLog};

use super::file::{ProbeKind, Rig};

pub use command::{Finished, run};
pub use emulated::DeskProbe;
pub use probe_rs::ProbeRs;

/// The oldest probe-rs that is believed: those before ended with 0 where a target had failed
/// (probe-rs pull request 3568, September 2025).
pub const LEAST_PROBE_RS: (u32, u32) = (0, 30);

/// Somebody who has access to the chip.
pub trait Probe {
    /// Looks whether all that is needed is there: the tool, then the probe. For people: which they are.
    ///
    /// # Errors
    /// What is missing.
    fn find(&mut self) -> Result<String, ProbeError>;

    /// Writes an image into the flash, holds it against the file, and starts it.
    ///
    /// # Errors
    /// [`ProbeError`].
    fn flash(&mut self, elf: &Path) -> Result<(), ProbeError>;

    /// Starts what is in the flash again.
    ///
    /// # Errors
    /// [`ProbeError`].
    fn reset(&mut self) -> Result<(), ProbeError>;

    /// Reads `length` bytes of the chip's memory.
    ///
    /// # Errors
    /// [`ProbeError`].
    fn read(&mut self, address: u32, length: usize) -> Result<Vec<u8>, ProbeError>;

    /// Listens to the log of a running image.
    ///
    /// # Errors
    /// [`ProbeError`].
    fn log<'f>(&mut self, image: &Image<'f>) -> Result<Box<dyn LogSource + 'f>, ProbeError>;
}

/// An image that is on the board.
#[derive(Clone, Copy, Debug)]
pub struct Image<'f> {
    /// Its file.
    pub elf: &'f Path,
    /// What it says of its log.
    pub firmware: &'f Firmware,
}

/// A board's log, as it comes.
pub trait LogSource {
    /// Appends what has come. Does not wait.
    ///
    /// # Errors
    /// [`ProbeError`], once nothing more can come.
    fn poll(&mut self, into: &mut Vec<FirmwareLog>) -> Result<(), ProbeError>;
}

/// The board cannot be got at.
#[derive(Debug, thiserror::Error)]
pub enum ProbeError {
    /// The tool is not installed.
    #[error(
        "probe-rs is not on the PATH: `cargo install probe-rs-tools --locked`, or the installer on \
         https://probe.rs/docs/getting-started/installation"
    )]
    NoTool,
    /// The tool is too old to be believed.
    #[error(
        "{found} is too old: before {}.{} it ended with success where a target had failed; \
         `cargo install probe-rs-tools --locked`", LEAST_PROBE_RS.0, LEAST_PROBE_RS.1
    )]
    OldTool {
        /// As it says itself.
        found: String,
    },
    /// No probe is plugged in.
    #[error(
        "no debug probe: is it plugged in, and may you use it (udev rules: https://probe.rs/docs/getting-started/probe-setup)?"
    )]
    NoProbe,
    /// Probes, but not the one of the rig's file.
    #[error("no debug probe `{wanted}`; there are:\n{found}")]
    OtherProbe {
        /// The selector of the rig's file.
        wanted: String,
        /// What `probe-rs list` says.
        found: String,
    },
    /// The rig's file names none, and there are several.
    #[error("several debug probes; name one in the rig's file (probe.selector):\n{found}")]
    ManyProbes {
        /// What `probe-rs list` says.
        found: String,
    },
    /// probe-rs knows no such chip.
    #[error("probe-rs knows no chip `{chip}` (probe.chip; `probe-rs chip list`)")]
    UnknownChip {
        /// As in the rig's file.
        chip: String,
    },
    /// The probe is there, and no chip behind it that answers.
    #[error("the probe reaches no {chip}: is the board powered, and is SWD wired?\n{said}")]
    NoChip {
        /// As in the rig's file.
        chip: String,
        /// What the tool said.
        said: String,
    },
    /// The chip's flash is protected against reading.
    #[error(
        "the chip is locked (read protection); `probe-rs erase --allow-erase-all` unlocks it and loses what is in it\n{said}"
    )]
    Locked {
        /// What the tool said.
        said: String,
    },
    /// Anything else that the tool does not like.
    #[error("`{command}` failed:\n{said}")]
    Failed {
        /// The command line.
        command: String,
        /// What it said.
        said: String,
    },
    /// A command that does not come back.
    #[error("`{command}` did not end within {} s", limit.as_secs_f64())]
    TimedOut {
        /// The command line.
        command: String,
        /// How long it had.
        limit: Duration,
    },
    /// A command that cannot be started.
    #[error("`{command}`: {source}")]
    NotStarted {
        /// The program.
        command: String,
        /// Why.
        source: std::io::Error,
    },
    /// What came is not what the tool promises.
    #[error("`{command}` said what is not understood: {said}")]
    NotUnderstood {
        /// The command line.
        command: String,
        /// What it said.
        said: String,
    },
    /// No emulated board is there.
    #[error(
        "no emulated board at {port}: `hil emulate --frames pty --probe {port}` is one ({source})"
    )]
    NoDesk {
        /// The rig's emulated port.
        port: String,
        /// Why.
        source: std::io::Error,
    },
    /// The emulated board does not want to.
    #[error("the emulated board refuses: {0}")]
    Refused(String),
    /// The log has come to an end.
    #[error("the log has ended: {0}")]
    LogEnded(String),
    /// The log is not that of the image.
    #[error(transparent)]
    Log(#[from] BoardError),
}

/// For a switch to go off and on.
const POWER: Duration = Duration::from_secs(30);

/// Switches a board off and on again, with the command of the rig's file.
///
/// # Errors
/// [`ProbeError`] where that fails.
pub fn power_cycle(cycle: &[String]) -> Result<(), ProbeError> {
    let [program, arguments @ ..] = cycle else {
        return Ok(());
    };
    let mut command = std::process::Command::new(program);
    command.args(arguments);
    let finished = run(&mut command, POWER)?;
    if finished.status.success() {
        return Ok(());
    }
    Err(ProbeError::Failed {
        command: command::in_words(&command),
        said: finished.said(),
    })
}

/// The probe of a rig.
pub fn of(rig: &Rig) -> Box<dyn Probe> {
    match &rig.probe {
        ProbeKind::ProbeRs { chip, selector } => {
            Box::new(ProbeRs::new(chip.clone(), selector.clone()))
        }
        ProbeKind::Emulated(port) => Box::new(DeskProbe::new(*port)),
    }
}
