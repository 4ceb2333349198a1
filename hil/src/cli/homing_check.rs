//! `hil homing-check`: the firmware's homing against solved problems.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use crate::homing_check;

/// Options of `hil homing-check`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  hil homing-check tests/golden/data/homing.jsonl --json\n\n\
    Exit code 0: every record holds. 1: some do not. 2: the file cannot be read."
)]
pub struct Arguments {
    /// One solved problem a line, as JSON
    file: PathBuf,
    /// Ends with one JSON object: records, failed (line numbers), worst_h
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let text = std::fs::read_to_string(&arguments.file)
        .map_err(|error| format!("{}: {error}", arguments.file.display()))?;
    let report = homing_check::check(&text)
        .map_err(|error| format!("{}: {error}", arguments.file.display()))?;
    if arguments.json {
        console.result(&serde_json::to_string(&report)?)?;
    } else {
        for failure in &report.failures {
            console.result(&format!("line {}: {}", failure.line, failure.reason))?;
        }
        console.result(&format!(
            "{} of {} records hold; largest deviation of h {:.1e}",
            report.records - report.failed.len(),
            report.records,
            report.worst_h
        ))?;
    }
    Ok(report.failed.is_empty())
}
