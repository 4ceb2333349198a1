//! `hil merge`: the shards of a sweep put together.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use super::sweep::report;
use crate::scenario::file::ScenarioFile;
use crate::sweep::{self, Flights, Outcome};

/// Options of `hil merge`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil merge shards/u-*-of-8.json\n  \
    hil merge shards/u-*-of-8.json --json --csv u.csv\n\n\
    Prints what the sweep in one piece would have printed.\n\
    Exit code 0: every expectation came true. 1: one did not. 2: the shards are not one whole sweep.")]
pub struct Arguments {
    /// What `hil sweep --shard` left
    #[arg(value_name = "SHARD", required = true)]
    shards: Vec<PathBuf>,
    /// Table with a line for each flight
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Ends with one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let shards = arguments
        .shards
        .iter()
        .map(|file| Ok((file.display().to_string(), Flights::read(file)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let whole = sweep::merge(&shards)?;
    let name = whole.folder.join(&whole.scenario).with_extension("toml");
    let file = ScenarioFile::parse(&name, whole.text)?;
    let outcome = Outcome::of(&file, &whole.flights);
    let to = (arguments.csv.as_deref(), arguments.json);
    report(&outcome, &whole.flights, to, console)
}
