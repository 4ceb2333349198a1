//! `hil experiments`: every claim of the paper beside what is measured here.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::sweep::{Sweep, image};
use crate::experiments::{self, COMPUTED, Row};
use crate::image::workspace_root;
use crate::scenario::file::{Backend, ScenarioFile, Seeds};
use crate::sweep::{Outcome, Part};

/// The scenarios of a checkout.
const SCENARIOS: &str = "tests/scenarios";

/// Seeds of what is measured without a scenario, where nothing is said.
const COMPUTED_SEEDS: u64 = 200;

/// Options of `hil experiments`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil experiments                       all of them, as many seeds as their files say\n  \
    hil experiments --only u --seeds 100\n  \
    hil experiments --seeds 1 --backend emulator --json\n\n\
    Exit code 0: everything that was checked holds. 1: something does not. 2: it could not be flown.")]
pub struct Arguments {
    /// How many seeds of each [default: as the files say]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: Option<u64>,
    /// One of them alone: a scenario's name, board, drift, drift-model, homing-test or elsewhere; repeatable
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// The board [default: as the files say]
    #[arg(long, value_enum)]
    backend: Option<Backend>,
    /// Folder of the scenarios [default: the checkout's tests/scenarios]
    #[arg(long, value_name = "FOLDER")]
    scenarios: Option<PathBuf>,
    /// Folder for the folders of flights that failed [default: none]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Ends with one JSON object on stdout: rows
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Table {
    rows: Vec<Row>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let folder = match &arguments.scenarios {
        Some(folder) => folder.clone(),
        None => workspace_root()?.join(SCENARIOS),
    };
    let files = ScenarioFile::open_all(&folder)?;
    check_names(&arguments.only, &files)?;
    let wanted =
        |name: &str| arguments.only.is_empty() || arguments.only.iter().any(|only| only == name);
    let mut rows = Vec::new();
    for computed in COMPUTED.iter().filter(|computed| wanted(computed.name)) {
        console.status("Measuring", computed.name);
        rows.extend((computed.rows)(arguments.seeds.unwrap_or(COMPUTED_SEEDS)));
    }
    for file in files.iter().filter(|file| wanted(&file.name)) {
        rows.extend(fly(file, arguments, console)?);
    }
    let rows = experiments::in_order(rows);
    if arguments.only.is_empty() {
        for claim in experiments::unanswered(&rows) {
            console.warning(&format!("nothing here checks claim {claim}"));
        }
    }
    let kept = rows.iter().all(|row| row.kept != Some(false));
    if arguments.json {
        console.result(&serde_json::to_string(&Table { rows })?)?;
    } else {
        console.result(&experiments::table(&rows))?;
    }
    Ok(kept)
}

/// The rows of one scenario.
fn fly(file: &ScenarioFile, arguments: &Arguments, console: &Console) -> Result<Vec<Row>, Failure> {
    let backend = arguments.backend.unwrap_or(file.backend);
    let seeds = Seeds {
        count: arguments.seeds.unwrap_or(file.seeds.count),
        ..file.seeds
    };
    let image = image(backend, arguments.firmware.clone(), console)?;
    let sweep = Sweep {
        file,
        backend,
        image: image.as_ref(),
        failed: arguments.out.as_deref(),
    };
    let flights = sweep.fly(&Part::WHOLE.of_seeds(seeds), console)?;
    Ok(experiments::rows(file, &Outcome::of(file, &flights)))
}

fn check_names(only: &[String], files: &[ScenarioFile]) -> Result<(), String> {
    let computed = COMPUTED.iter().map(|computed| computed.name);
    let known: Vec<&str> = files
        .iter()
        .map(|file| file.name.as_str())
        .chain(computed)
        .collect();
    match only.iter().find(|name| !known.contains(&name.as_str())) {
        Some(name) => Err(format!("no experiment `{name}`: {}", known.join(", "))),
        None => Ok(()),
    }
}
