//! The folder that a flight leaves behind.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::flight::Flown;
use crate::record::Recording;
use crate::report;
use crate::scenario::Scenario;

/// The file of everything that happened in a flight.
pub const RECORDING: &str = "recording.json";

/// Where a flight goes unless it is told otherwise.
pub fn default_path(scenario: &Scenario, backend: &str) -> PathBuf {
    Path::new("flights").join(format!(
        "{}-{backend}-{}",
        scenario.route.name(),
        scenario.seed
    ))
}

/// Makes the folder and tries whether a file can be written in it.
pub fn prepare(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let probe = folder.join(".writable");
    fs::write(&probe, "")?;
    fs::remove_file(probe)
}

/// Writes `summary.json`, `flight.log`, `recording.json`, `report.html` and `map.svg` into a folder
/// that is [prepared](prepare).
pub fn write(folder: &Path, flown: &Flown) -> io::Result<()> {
    fs::write(
        folder.join("summary.json"),
        serde_json::to_string_pretty(&flown.summary)? + "\n",
    )?;
    fs::write(folder.join(RECORDING), recording_text(&flown.recording)?)?;
    fs::write(folder.join("flight.log"), log(&flown.recording))?;
    fs::write(
        folder.join("report.html"),
        report::html(&flown.recording, &flown.summary),
    )?;
    fs::write(
        folder.join("map.svg"),
        report::picture(&flown.recording, &flown.summary),
    )
}

/// `recording.json`, byte for byte.
///
/// # Errors
/// Never: a recording has nothing that JSON does not.
pub fn recording_text(recording: &Recording) -> serde_json::Result<String> {
    Ok(serde_json::to_string(recording)? + "\n")
}

/// The log as text. A record of the firmware's has its own time stamp before it and its log
/// statement below it, as under probe-rs.
fn log(recording: &Recording) -> String {
    let mut text = String::new();
    for line in &recording.log {
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "{:10.3} {:<5} {:<8} ",
            line.t, line.level, line.source
        );
        let _ = match &line.origin {
            Some(origin) => writeln!(text, "{} {}", origin.stamp, line.text),
            None => writeln!(text, "{}", line.text),
        };
        if let Some(place) = line.place() {
            let _ = writeln!(text, "{:26}└─ {place}", "");
        }
    }
    text
}
