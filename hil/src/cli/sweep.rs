//! `hil sweep`: many seeds of a scenario on every processor, whole or in shards.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::console::Console;
use super::fly::Image;
use crate::folder;
use crate::scenario::file::{Backend, ScenarioFile, Seeds};
use crate::sweep::{self, FlightFigures, Flights, Outcome, Part, Vessel};

/// Options of `hil sweep`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil sweep tests/scenarios/u.toml                       as many seeds as the file says\n  \
    hil sweep tests/scenarios/u.toml --flights 1000 --csv u.csv\n  \
    hil sweep tests/scenarios/u.toml --shard 2/8 --out shards   one of eight; `hil merge` puts them together\n\n\
    A flight that fails leaves its folder, from which `hil replay` flies it again.\n\
    Exit code 0: every expectation of the file came true. 1: one did not. 2: it could not be flown.")]
pub struct Arguments {
    /// The scenario
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// How many seeds, from the file's first on [default: as the file says]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    flights: Option<u64>,
    /// The board [default: as the file says]
    #[arg(long, value_enum)]
    backend: Option<Backend>,
    /// Flies one part of several and leaves it in a file for `hil merge`
    #[arg(long, value_name = "INDEX/OF", requires = "out")]
    shard: Option<Part>,
    /// Folder for the flights' figures, and for the folders of flights that failed [default: none, and flights]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Table with a line for each flight
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Ends with one JSON object on stdout
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let file = ScenarioFile::open(&arguments.file)?;
    let backend = arguments.backend.unwrap_or(file.backend);
    let seeds = Seeds {
        count: arguments.flights.unwrap_or(file.seeds.count),
        ..file.seeds
    };
    let part = arguments.shard.unwrap_or(Part::WHOLE);
    let image = image(backend, arguments.firmware.clone(), console)?;
    if let Some(out) = &arguments.out {
        folder::prepare(out).map_err(|error| format!("{}: {error}", out.display()))?;
    }
    let failed = arguments.out.clone().unwrap_or_else(|| "flights".into());
    let sweep = Sweep {
        file: &file,
        backend,
        image: image.as_ref(),
        failed: Some(&failed),
    };
    let flights = sweep.fly(&part.of_seeds(seeds), console)?;
    if let Some(out) = &arguments.out {
        let flights = Flights::new(&file, backend, (part, seeds), flights.clone());
        let written = flights.write(out)?;
        console.status("Flights", &written.display().to_string());
    }
    let outcome = Outcome::of(&file, &flights);
    report(
        &outcome,
        &flights,
        (arguments.csv.as_deref(), arguments.json),
        console,
    )
}

/// The image that an emulated board runs.
pub(super) fn image(
    backend: Backend,
    given: Option<PathBuf>,
    console: &Console,
) -> Result<Option<Image>, Failure> {
    match backend {
        Backend::Native => Ok(None),
        Backend::Emulator => Image::get(given, console).map(Some),
    }
}

/// Flights of one scenario.
pub(super) struct Sweep<'s> {
    pub(super) file: &'s ScenarioFile,
    pub(super) backend: Backend,
    /// What an emulated board runs.
    pub(super) image: Option<&'s Image>,
    /// Where flights that fail leave their folders, if they do.
    pub(super) failed: Option<&'s Path>,
}

impl Sweep<'_> {
    /// Flies these seeds with a progress bar.
    pub(super) fn fly(
        &self,
        seeds: &[u64],
        console: &Console,
    ) -> Result<Vec<FlightFigures>, Failure> {
        let file = self.file;
        let vessel = self
            .image
            .map_or(Vessel::Native, |image| Vessel::Emulator(&image.bytes));
        let leave = |flown: &crate::flight::Flown, figures: &FlightFigures| match self.failed {
            Some(failed) if figures.has_failed(&file.expectations) => {
                let name = format!("{}-{}-{}", file.name, self.backend.name(), figures.seed);
                sweep::write_failed(&failed.join(name), file, self.backend, flown)
                    .map_err(|error| error.to_string())
            }
            _ => Ok(()),
        };
        let mut progress = console.progress("Flying", seeds.len() as u64);
        let flights = sweep::fly_each(
            seeds,
            vessel,
            |seed| file.scenario(seed),
            |flown, figures| leave(flown, figures).map_err(Stopped::Folder),
            |done| {
                progress.set(done as u64, || {
                    format!("{done} of {} flights, {}", seeds.len(), file.name)
                });
            },
        );
        progress.finish();
        Ok(flights.map_err(|error| format!("{}: {error}", file.name))?)
    }
}

/// Why a sweep ended before its end.
#[derive(Debug, thiserror::Error)]
enum Stopped {
    /// A flight could not be flown.
    #[error(transparent)]
    Flight(#[from] crate::flight::FlightError),
    /// The folder of a flight that failed could not be written.
    #[error("{0}")]
    Folder(String),
}

/// Says what was found, and whether it was expected.
pub(super) fn report(
    outcome: &Outcome,
    flights: &[FlightFigures],
    (csv, json): (Option<&Path>, bool),
    console: &Console,
) -> Result<bool, Failure> {
    if let Some(file) = csv {
        File::create(file)
            .map_err(csv_error)
            .and_then(|to| sweep::csv(flights, to).map_err(|error| csv_error(error.into())))
            .map_err(|error| format!("{}: {error}", file.display()))?;
    }
    if json {
        console.result(&serde_json::to_string(outcome)?)?;
    } else {
        console.result(&in_words(outcome))?;
    }
    for broken in outcome.broken() {
        console.warning(&broken);
    }
    Ok(outcome.is_kept())
}

fn csv_error(error: io::Error) -> String {
    error.to_string()
}

/// The statistics for people, without a newline at the end.
fn in_words(outcome: &Outcome) -> String {
    let statistics = &outcome.statistics;
    let mut lines = vec![format!(
        "{}: {} of {} flights home within 0.5 m",
        outcome.scenario, statistics.home_within_half_metre, statistics.flights
    )];
    let mut row = |name: &str, value: String| lines.push(format!("  {name:<22}{value}"));
    let error = &statistics.home_error_m;
    row(
        "home error",
        format!(
            "p50 {:.2} m, p95 {:.2} m, max {:.2} m",
            error.p50, error.p95, error.max
        ),
    );
    row(
        "odometry alone",
        format!("p50 {:.2} m", statistics.odometry_only_error_m.p50),
    );
    row(
        "cross-track error",
        format!("{:.2} m rms", statistics.cross_track_rms_m),
    );
    row(
        "route memory",
        format!(
            "{:.0} snapshots, {:.0} bytes, {:.1} bytes/m",
            statistics.snapshots, statistics.memory_bytes, statistics.bytes_per_m
        ),
    );
    row(
        "flown",
        format!(
            "{:.1} m out, {:.0} s",
            statistics.outbound_m, statistics.flight_s
        ),
    );
    if !statistics.failed_seeds.is_empty() {
        row("failed seeds", format!("{:?}", statistics.failed_seeds));
    }
    for verdict in &outcome.expectations {
        row("expected", verdict.to_string());
    }
    lines.join("\n")
}
