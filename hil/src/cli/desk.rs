//! `hil emulate --frames`: an emulated board on the desk.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use super::live::{LiveArguments, say};
use crate::image::Variant;
use crate::live::{Endpoint, Stop, TcpPort};
use crate::rig::desk::{Desk, DeskSetup};
use crate::rig::file::BoardName;

/// Options of a board that stands for one on the desk.
#[derive(Debug, Args)]
pub struct DeskArguments {
    /// Takes frames over serial here, as on a rig whose board has no camera: pty, tty:PATH or tcp:PORT
    #[arg(long, value_name = "ENDPOINT", requires = "probe", conflicts_with_all = ["pose", "out"])]
    pub frames: Option<Endpoint>,
    /// Where its probe is met, for flash, log and memory: tcp:PORT
    #[arg(long, value_name = "tcp:PORT", requires = "frames")]
    probe: Option<TcpPort>,
    /// Writes the rig that this board makes, ready for --rig
    #[arg(long, value_name = "FILE", requires = "frames")]
    write_rig: Option<PathBuf>,
}

impl DeskArguments {
    /// Runs the board until somebody ends it.
    pub fn run(
        &self,
        live: &LiveArguments,
        frames: &Endpoint,
        firmware: Option<PathBuf>,
        console: &Console,
    ) -> Result<bool, Failure> {
        let probe = self.probe.ok_or("--frames needs --probe")?;
        let image = Image::of(firmware, &Variant::RIG, console)?;
        let stop = Stop::on_signals()?;
        let setup = DeskSetup {
            common: live.common(&stop),
            elf: &image.bytes,
            frames: frames.clone(),
            frames_baud: frames::DEFAULT_BAUD,
            probe,
        };
        let hear = |notice| say(console, notice);
        let desk = Desk::open(setup, &hear)?;
        if let Some(file) = &self.write_rig {
            let board = image
                .identity()
                .map_or(BoardName::Flight, |identity| identity.board.into());
            write_rig(&desk, board, file)?;
            console.status("Rig", &file.display().to_string());
        }
        let pace = desk.run();
        console.result(&format!(
            "{:.2} % of the steps began late, the latest by {:.1} ms",
            100.0 * pace.late_share,
            pace.largest_lateness_ms
        ))?;
        Ok(true)
    }
}

/// Whole or not at all: somebody may wait for it.
fn write_rig(desk: &Desk, board: BoardName, file: &Path) -> Result<(), Failure> {
    let text = desk.rig("emulated", board).to_toml()?;
    let unwritable = |error| format!("{}: {error}", file.display());
    let draft = file.with_extension("toml.new");
    std::fs::write(&draft, text).map_err(unwritable)?;
    Ok(std::fs::rename(&draft, file).map_err(unwritable)?)
}
