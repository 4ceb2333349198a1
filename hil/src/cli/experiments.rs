//! `hil experiments`: every claim of the paper beside what is measured here.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use super::sweep::{Sweep, image};
use crate::experiments::{self, COMPUTED, Computed, Order, Row, table};
use crate::image::workspace_root;
use crate::scenario::file::{Backend, ScenarioFile, Seeds};
use crate::sweep::{FlightFigures, Outcome, Part};

/// The scenarios of a checkout.
const SCENARIOS: &str = "tests/scenarios";

/// Options of `hil experiments`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil experiments                       all of them, as many seeds as their files say\n  \
    hil experiments --quick               two seeds of each scenario at most\n  \
    hil experiments --only u --seeds 100\n  \
    hil experiments --only catchment --only scaling --only moved-objects\n  \
    hil experiments --seeds 1 --backend emulator --json\n  \
    hil experiments --emulated-beside --markdown   the tables of docs/experiments.md\n\n\
    Each row is told on stderr as soon as it is there; all of them in the paper's order at the end, on stdout.\n\
    Exit code 0: everything that was checked holds. 1: something does not. 2: something could not be measured.")]
pub struct Arguments {
    /// How many seeds of each scenario; of what is measured without one as many runs or snapshots, within limits of its
    /// own [default: as the files say]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: Option<u64>,
    /// At most two seeds of each scenario; what is measured without a scenario stays as it is
    #[arg(long, conflicts_with = "seeds")]
    quick: bool,
    /// One of them alone: a scenario's name, board, elsewhere, drift-model, drift, moved-objects, scaling, catchment or
    /// homing-test; repeatable
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// The board [default: as the files say]
    #[arg(long, value_enum)]
    backend: Option<Backend>,
    /// Flies the first seed of each scenario that is about a claim on the emulated board as well, and holds it against
    /// the native flight
    #[arg(long, conflicts_with = "backend")]
    emulated_beside: bool,
    /// Folder of the scenarios [default: the checkout's tests/scenarios]
    #[arg(long, value_name = "FOLDER")]
    scenarios: Option<PathBuf>,
    /// Folder for the folders of flights that failed [default: none]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Ends with one JSON object on stdout: rows
    #[arg(long)]
    json: bool,
    /// Ends with the part of docs/experiments.md that is made by this command
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

/// Seeds of a scenario with `--quick`, at most.
const QUICK_SEEDS: u64 = 2;

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
    let mut found = Found::default();
    for computed in COMPUTED.iter().filter(|computed| wanted(computed.name)) {
        found.add(
            measure(computed, arguments, console),
            computed.name,
            console,
        );
    }
    for file in files.iter().filter(|file| wanted(&file.name)) {
        found.add(fly(file, arguments, console), &file.name, console);
    }
    let rows = experiments::in_order(found.rows);
    if arguments.only.is_empty() {
        let answered: Vec<u8> = rows.iter().filter_map(|row| row.claim).collect();
        for claim in experiments::unanswered(&answered) {
            console.warning(&format!("nothing here checks claim {claim}"));
        }
    }
    let is_sound = rows.iter().all(Row::is_sound);
    console.result(&if arguments.json {
        serde_json::to_string(&Table { rows })?
    } else if arguments.markdown {
        table::document(&rows)
    } else {
        table::markdown(&rows)
    })?;
    match found.impossible.as_slice() {
        [] => Ok(is_sound),
        names => Err(format!("could not be measured: {}", names.join(", ")).into()),
    }
}

/// What has been measured so far.
#[derive(Default)]
struct Found {
    rows: Vec<Row>,
    /// The names of what could not be measured. They are told in the end, so that the flights of hours are not lost.
    impossible: Vec<String>,
}

impl Found {
    /// Takes the rows of an experiment, or why there are none, and tells of them.
    fn add(&mut self, rows: Result<Vec<Row>, Failure>, name: &str, console: &Console) {
        match rows {
            Ok(rows) => {
                for row in &rows {
                    let verb = match row.kept {
                        _ if !row.is_sound() => "NOT kept",
                        Some(_) => "Kept",
                        None => "Unchecked",
                    };
                    console.status(verb, &table::in_words(row));
                }
                self.rows.extend(rows);
            }
            Err(failure) => {
                console.error(&format!("{name}: {failure}"));
                self.impossible.push(name.to_owned());
            }
        }
    }
}

/// The rows of what is measured without a scenario.
fn measure(
    computed: &Computed,
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<Row>, Failure> {
    const PARTS: f64 = 100.0;
    let mut bar = console.progress("Measuring", PARTS as u64);
    let rows = (computed.rows)(&mut Order {
        seeds: arguments.seeds,
        progress: &mut |share| {
            bar.set((PARTS * share) as u64, || {
                format!("{}: {:.0} %", computed.name, PARTS * share)
            });
        },
    });
    bar.finish();
    Ok(rows?)
}

/// The rows of one scenario.
fn fly(file: &ScenarioFile, arguments: &Arguments, console: &Console) -> Result<Vec<Row>, Failure> {
    let backend = arguments.backend.unwrap_or(file.backend);
    let usual = match arguments.quick {
        true => file.seeds.count.min(QUICK_SEEDS),
        false => file.seeds.count,
    };
    let seeds = Seeds {
        count: arguments.seeds.unwrap_or(usual),
        ..file.seeds
    };
    let fly = |backend: Backend, seeds: &[u64]| -> Result<Vec<FlightFigures>, Failure> {
        let image: Option<Image> = image(backend, arguments.firmware.clone(), console)?;
        let sweep = Sweep {
            file,
            backend,
            image: image.as_ref(),
            failed: arguments.out.as_deref(),
        };
        sweep.fly(seeds, console)
    };
    let flights = fly(backend, &Part::WHOLE.of_seeds(seeds))?;
    let mut rows = experiments::rows(file, &Outcome::of(file, &flights));
    let is_about_a_claim = rows.iter().any(|row| row.claim.is_some());
    if arguments.emulated_beside && backend == Backend::Native && is_about_a_claim {
        let emulated = fly(Backend::Emulator, &[file.seeds.first])?;
        if let (Some(native), Some(emulated)) = (flights.first(), emulated.first()) {
            experiments::beside(&mut rows, file, native, emulated);
        }
    }
    Ok(rows)
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
