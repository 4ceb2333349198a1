//! `hil rig`: what is connected, and whether the rig sees what is wrong.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use frames::Verdict;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use crate::board::emulated::Firmware;
use crate::rig::canary::canary;
use crate::rig::check::check;
use crate::rig::file::Rig;

/// Options of `hil rig`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil rig check --rig discovery           hil/rigs/discovery.toml: what is there, what is missing\n  \
    hil rig check --rig rigs/mine.toml --json\n  \
    hil rig canary --rig mine               must end with 1: the rig sees a frame that is broken\n\n\
    A rig is a TOML file (examples: hil/rigs). A name stands for rigs/NAME.toml, or else for an example.\n\
    Exit code 0: it is ready. 1: something is missing or wrong. 2: there is no such rig.")]
pub struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Walks through a rig and says what is missing
    Check(CheckArguments),
    /// Claims that a broken frame is a good one, and must fail: 1, the rig sees it. 0, it does not.
    /// 2, it is not ready
    Canary(CanaryArguments),
}

/// The rig that is meant.
#[derive(Clone, Debug, Args)]
pub struct RigArgument {
    /// The rig: the path of its file, or its name
    #[arg(long, value_name = "NAME|FILE")]
    rig: String,
}

impl RigArgument {
    /// Reads its file.
    pub fn open(&self) -> Result<Rig, Failure> {
        Ok(Rig::open(&self.rig)?)
    }
}

#[derive(Debug, Args)]
struct CheckArguments {
    #[command(flatten)]
    rig: RigArgument,
    /// Ends with one JSON object on stdout: rig, findings (place, right, text)
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct CanaryArguments {
    #[command(flatten)]
    rig: RigArgument,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    match &arguments.verb {
        Verb::Check(arguments) => {
            let findings = check(&arguments.rig.open()?);
            if arguments.json {
                console.result(&serde_json::to_string(&findings)?)?;
            } else {
                console.result(&findings.to_string())?;
            }
            Ok(findings.right())
        }
        Verb::Canary(arguments) => sing(arguments, console),
    }
}

/// True, and a rig that must not be believed, where the broken frame was as good as the other.
fn sing(arguments: &CanaryArguments, console: &Console) -> Result<bool, Failure> {
    let rig = arguments.rig.open()?;
    let image = Image::for_rig(arguments.firmware.clone(), &rig, console)?;
    let firmware = Firmware::parse(&image.bytes)?;
    let canary = canary(&rig, &image.on_board(&firmware), image.identity().as_ref())?;
    let in_words = |verdict: Option<Verdict>| verdict.map_or("no answer", Verdict::name);
    console.result(&format!(
        "a whole frame: {}; a broken one: {}",
        in_words(canary.whole),
        in_words(canary.broken)
    ))?;
    match (canary.whole, canary.broken) {
        (Some(Verdict::Used), Some(Verdict::Used)) => Ok(true),
        (Some(Verdict::Used), _) => Ok(false),
        _ => Err("the rig does not even take a whole frame".into()),
    }
}
