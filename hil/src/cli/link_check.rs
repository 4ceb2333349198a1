//! `hil link-check`: the link's codec against records of another implementation's.

use std::path::PathBuf;

use clap::Args;

use super::Failure;
use super::console::Console;
use crate::link_check;

/// Options of `hil link-check`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  hil link-check tests/golden/data/pprzlink.jsonl --json\n\n\
    A record holds if our parser delivers every good frame the recorded receiver delivered, and\n\
    beyond those only whole frames that it lost; and if our sender makes the same bytes of what\n\
    was sent.\n\
    Exit code 0: every record holds. 1: some do not. 2: the file cannot be read."
)]
pub struct Arguments {
    /// One record a line, as JSON: name, hex, chunks, sent, decoded
    file: PathBuf,
    /// Ends with one JSON object: records, failed (names), encoded, recovered (by name)
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let text = std::fs::read_to_string(&arguments.file)
        .map_err(|error| format!("{}: {error}", arguments.file.display()))?;
    let report = link_check::check(&text)
        .map_err(|error| format!("{}: {error}", arguments.file.display()))?;
    if arguments.json {
        console.result(&serde_json::to_string(&report)?)?;
    } else {
        for reason in &report.reasons {
            console.result(reason)?;
        }
        console.result(&format!(
            "{} of {} records hold, {} of them encoded as well; {} frames delivered that the recorded receiver lost",
            report.records - report.failed.len(),
            report.records,
            report.encoded,
            report.recovered.values().sum::<usize>()
        ))?;
    }
    Ok(report.failed.is_empty())
}
