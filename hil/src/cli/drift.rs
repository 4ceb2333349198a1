//! `hil drift`: how far dead reckoning strays.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use fake_sensors::motion::SensorModel;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use crate::drift::{self, Published, Row};
use crate::folder;
use crate::parallel;

/// Options of `hil drift`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil drift                             200 seeds, the reference's distances\n  \
    hil drift --seeds 1000 --distances 5 --json\n  \
    hil drift --out drift                 with a picture, drift/drift.svg\n\n\
    The filter listens to the nominal sensors while the drone flies straight on by the truth, at\n\
    0.5 m/s and 0.5 m. Beside each row stands what the firmware's own filter made of that flight\n\
    (cross over 200 seeds, the rest over 50).\n\
    Exit code 0: every row is within 25 % of the firmware's, and cross at 5 m is 13 +- 2 cm; few seeds\n\
    are held to three standard errors, other distances to nothing. 1: a row is not. 2: no flight.")]
pub struct Arguments {
    /// How many seeds, from 1
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: u64,
    /// Lengths of the leg, metres
    #[arg(long, default_value = "1,2,5,10,20", value_delimiter = ',', value_parser = parse_distance, value_name = "METRES")]
    distances: Vec<f64>,
    /// Ends with one JSON object: rows, published, within
    #[arg(long)]
    json: bool,
    /// Folder for drift.svg and drift.json
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn parse_distance(text: &str) -> Result<f64, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|distance| (0.1..=100.0).contains(distance))
        .ok_or_else(|| "a distance from 0.1 to 100 metres".to_owned())
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Outcome {
    rows: Vec<Row>,
    /// The firmware's own filter at those of the distances it was measured at.
    published: Vec<Published>,
    /// Whether the two agree.
    within: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let unwritable = |folder: &Path, error| format!("{}: {error}", folder.display());
    if let Some(out) = &arguments.out {
        folder::prepare(out).map_err(|error| unwritable(out, error))?;
    }
    let mut distances = arguments.distances.clone();
    distances.sort_by(f64::total_cmp);
    distances.dedup();
    let seeds: Vec<u64> = (1..=arguments.seeds).collect();
    let model = SensorModel::default();
    let mut progress = console.progress("Flying", arguments.seeds);
    let flights = parallel::map(
        &seeds,
        |seed| drift::fly(&model, *seed, &distances),
        |done| progress.set(done as u64, || format!("{done} of {} flights", seeds.len())),
    );
    progress.finish();

    let rows = drift::rows(&distances, &flights);
    let outcome = Outcome {
        published: rows
            .iter()
            .filter_map(|row| Published::at(row.distance_m).copied())
            .collect(),
        within: drift::verdict(&rows),
        rows,
    };
    if let Some(out) = &arguments.out {
        write(out, &outcome).map_err(|error| unwritable(out, error))?;
        let picture = out.join("drift.svg");
        console.status("Picture", &picture.display().to_string());
    }
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome.rows))?;
    }
    Ok(outcome.within)
}

/// Leaves the table in a folder that is prepared.
fn write(folder: &Path, outcome: &Outcome) -> io::Result<()> {
    let json = serde_json::to_string_pretty(outcome)? + "\n";
    fs::write(folder.join("drift.json"), json)?;
    fs::write(folder.join("drift.svg"), drift::picture(&outcome.rows))
}

/// The table for people, without a newline at the end.
fn in_words(rows: &[Row]) -> String {
    let mut lines = vec![
        "RMS over the seeds; in brackets the firmware's own filter".to_owned(),
        "distance      cross cm        along cm         yaw deg     seeds".to_owned(),
    ];
    for row in rows {
        let published = Published::at(row.distance_m);
        let pair = |found: f64, decimals: usize, of: fn(&Published) -> f64| {
            let reference = published.map_or(String::new(), |published| {
                format!("({:.decimals$})", of(published))
            });
            format!("{found:>7.decimals$} {reference:<8}")
        };
        lines.push(format!(
            "{:>6} m  {}{}{}{:>8}",
            row.distance_m,
            pair(row.cross_rms_m * 100.0, 1, |p| p.cross_rms_m * 100.0),
            pair(row.along_rms_m * 100.0, 1, |p| p.along_rms_m * 100.0),
            pair(row.yaw_rms_rad.to_degrees(), 2, |p| p
                .yaw_rms_rad
                .to_degrees()),
            row.seeds
        ));
    }
    lines.join("\n")
}
