//! `hil replay`: a flight that failed, flown again.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::fly::{Image, with_progress};
use super::sweep::image;
use crate::sweep::{Replay, VERSION, Vessel};

/// Options of `hil replay`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil replay flights/u-native-17\n  \
    hil replay flights/u-native-17 --json\n\n\
    Exit code 0: recording.json came out the same, to the byte. 1: it did not. 2: it could not be flown.")]
pub struct Arguments {
    /// What a flight that failed in `hil sweep` left
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Ends with one JSON object on stdout
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Outcome {
    scenario: String,
    seed: u64,
    /// The recording came out the same, to the byte.
    reproduced: bool,
    /// The first byte that differs, from 0.
    first_difference: Option<usize>,
    home_error_m: f64,
    outcome: String,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let replay = Replay::read(&arguments.folder)?;
    if replay.version != VERSION {
        let then = &replay.version;
        console.warning(&format!("flown by version {then}, this is {VERSION}"));
    }
    let file = replay.scenario_file()?;
    let scenario = file.scenario(replay.seed)?;
    let image: Option<Image> = image(replay.backend, arguments.firmware.clone(), console)?;
    let vessel = image
        .as_ref()
        .map_or(Vessel::Native, |image| Vessel::Emulator(&image.bytes));
    let flown = with_progress(console, |progress| vessel.fly(&scenario, progress))?;
    let first_difference = replay.first_difference(&arguments.folder, &flown)?;
    let outcome = Outcome {
        scenario: replay.name,
        seed: replay.seed,
        reproduced: first_difference.is_none(),
        first_difference,
        home_error_m: flown.summary.home_error_m,
        outcome: flown.summary.outcome,
    };
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome))?;
    }
    Ok(outcome.reproduced)
}

/// The verdict for people, without a newline at the end.
fn in_words(outcome: &Outcome) -> String {
    let verdict = match outcome.first_difference {
        None => "the same flight, to the byte".to_owned(),
        Some(byte) => format!("NOT the same flight: the recordings differ from byte {byte} on"),
    };
    format!(
        "{}, seed {}: {verdict}\n  {}, {:.2} m from home",
        outcome.scenario, outcome.seed, outcome.outcome, outcome.home_error_m
    )
}
