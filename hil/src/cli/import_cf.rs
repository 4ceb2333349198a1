//! `hil import-cf`: a flight of the real thing from its log files.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::console::Console;
use crate::flight::Flown;
use crate::folder;
use crate::import_cf::{LogFile, import};

/// Options of `hil import-cf`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil import-cf logdata/20230531T10-11-12/*.csv\n  \
    hil import-cf state.csv vectors.csv --out flights/corridor --json\n\n\
    In cfclient's tab Log Blocks: configurations with stateEstimate.x, .y, .z, .yaw and the group\n\
    vh, each with \"Write to file\". Everything is drawn from the drone's own estimate: there is no\n\
    truth in these logs.\n\
    Exit code 0: imported. 2: a file cannot be read; the error names file, line and column.")]
pub struct Arguments {
    /// Log files of one flight, one for each log configuration
    #[arg(required = true, value_name = "FILE.csv")]
    files: Vec<PathBuf>,
    /// Folder for summary.json, flight.log, recording.json, report.html and map.svg [default: flights/FILE]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Ends with one JSON object, the summary, on stdout
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let paths = arguments.files.iter();
    let files: Vec<LogFile> = paths
        .map(|path| LogFile::read(path))
        .collect::<Result<_, _>>()?;
    let flown = import(&files)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| default_path(&arguments.files));
    let unwritable = |error| format!("{}: {error}", out.display());
    folder::prepare(&out).map_err(unwritable)?;
    folder::write(&out, &flown).map_err(unwritable)?;
    console.status("Report", &out.join("report.html").display().to_string());
    if arguments.json {
        console.result(&serde_json::to_string(&flown.summary)?)?;
    } else {
        console.result(&in_words(&flown))?;
    }
    Ok(true)
}

/// The first file's name without its extension, where flights go.
fn default_path(files: &[PathBuf]) -> PathBuf {
    let stem = files.first().and_then(|file| file.file_stem());
    Path::new("flights").join(stem.unwrap_or("import".as_ref()))
}

/// The flight for people, without a newline at the end.
fn in_words(flown: &Flown) -> String {
    let (summary, recording) = (&flown.summary, &flown.recording);
    let mut lines = vec![format!("imported: {}", summary.outcome)];
    let mut row = |name: &str, value: String| lines.push(format!("  {name:<22}{value}"));
    row(
        "flown",
        format!(
            "{:.1} m out, {:.1} m back, {:.0} s",
            summary.outbound_m, summary.inbound_m, summary.flight_s
        ),
    );
    row(
        "camera",
        format!(
            "{} snapshots, {} vectors, {} corrections",
            summary.snapshots,
            summary.vectors,
            recording.corrections.len()
        ),
    );
    let told = recording.log.iter().filter(|line| line.level == "warn");
    for line in told {
        row("note", line.text.clone());
    }
    lines.join("\n")
}
