//! `hil flash`: an image onto a rig's board.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use super::rig::RigArgument;
use crate::rig::probe;

/// Options of `hil flash`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil flash --rig discovery               builds the rig image for its board and puts it on it\n  \
    hil flash --rig mine --firmware IMAGE   one that was built elsewhere\n\n\
    probe-rs does it (`cargo install probe-rs-tools --locked`), and holds the flash against the file.\n\
    Exit code 0: it is on the board and runs. 2: it could not be done.")]
pub struct Arguments {
    #[command(flatten)]
    rig: RigArgument,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let rig = arguments.rig.open()?;
    let mut probe = probe::of(&rig);
    console.status("Probe", &probe.find()?);
    let image = Image::for_rig(arguments.firmware.clone(), &rig, console)?;
    console.status("Flashing", &image.elf.display().to_string());
    probe.flash(&image.elf)?;
    console.status("Flashed", &format!("{} runs", rig.name));
    Ok(true)
}
