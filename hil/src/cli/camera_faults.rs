//! `hil camera-faults`: what becomes of frames when the camera's wires fail.

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::Failure;
use super::console::Console;
use crate::board::emulated::Firmware;
use crate::camera_faults::{self, CameraFault, RECOVERY_LIMIT_MS, Row, Soak};
use crate::image;

/// The soak of a run of all faults, minutes.
const SOAK_MINUTES: f64 = 10.0;

/// Options of `hil camera-faults`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil camera-faults                         every fault, then ten minutes at 30 frames a second\n  \
    hil camera-faults --only unplugged        one fault, no soak\n  \
    hil camera-faults --soak 1 --json\n\n\
    The image is booted on the emulated board anew for each fault, and that eight times: the fault\n\
    strikes at eight places of the frame, and the worst counts. Each frame that the firmware looks at\n\
    is held against the one that the camera sent, byte for byte.\n\
    Exit code 0: every fault was noticed and over within 200 ms of the signal's return, no wrong\n\
    frame was looked at and none was dropped in the soak. 1: not so. 2: it could not be done.")]
pub struct Arguments {
    /// This fault alone; repeatable
    #[arg(long, value_name = "FAULT", value_enum)]
    only: Vec<CameraFault>,
    /// Emulated minutes without a fault, at 30 frames a second [default: 10, with --only 0]
    #[arg(long, value_name = "MINUTES", value_parser = parse_minutes)]
    soak: Option<f64>,
    /// Ends with one JSON object: rows (fault, detected_as, frames_lost, recovery_ms) and soak (minutes,
    /// fps, frames_sent, frames_captured; null without a soak)
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct Report {
    rows: Vec<Row>,
    soak: Option<Soak>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let path = image::build(&|line| console.status("Firmware", line))?;
    let firmware = Firmware::parse(&std::fs::read(path)?)?;
    let faults = if arguments.only.is_empty() {
        CameraFault::value_variants()
    } else {
        &arguments.only
    };
    let default = if arguments.only.is_empty() {
        SOAK_MINUTES
    } else {
        0.0
    };
    let minutes = arguments.soak.unwrap_or(default);
    let report = Report {
        rows: suffer(&firmware, faults, console)?,
        soak: (minutes > 0.0)
            .then(|| soak(&firmware, minutes, console))
            .transpose()?,
    };
    if arguments.json {
        console.result(&serde_json::to_string(&report)?)?;
    } else {
        tell(&report, console)?;
    }
    Ok(report.rows.iter().all(Row::holds) && report.soak.as_ref().is_none_or(Soak::holds))
}

fn suffer(
    firmware: &Firmware,
    faults: &[CameraFault],
    console: &Console,
) -> Result<Vec<Row>, Failure> {
    let mut progress = console.progress("Suffering", faults.len() as u64);
    let mut rows = Vec::new();
    for (done, fault) in (1..).zip(faults) {
        rows.push(camera_faults::suffer_all(firmware, *fault)?);
        progress.set(done, || fault.to_string());
    }
    progress.finish();
    Ok(rows)
}

fn soak(firmware: &Firmware, minutes: f64, console: &Console) -> Result<Soak, Failure> {
    let seconds = (60.0 * minutes).ceil() as u64;
    let mut progress = console.progress("Soaking", seconds);
    let soak = camera_faults::soak(firmware, minutes, &mut |done| {
        progress.set(done, || format!("{done} of {seconds} s"));
    })?;
    progress.finish();
    Ok(soak)
}

fn tell(report: &Report, console: &Console) -> Result<(), Failure> {
    console.result(&format!(
        "{:<18} {:<24} {:>11} {:>11}",
        "fault", "detected as", "frames lost", "recovery ms"
    ))?;
    for row in &report.rows {
        let lost = row
            .frames_lost
            .map_or("-".to_owned(), |lost| lost.to_string());
        let recovery = row
            .recovery_ms
            .map_or("never".to_owned(), |ms| format!("{ms:.1}"));
        console.result(&format!(
            "{:<18} {:<24} {lost:>11} {recovery:>11}{}",
            row.fault,
            row.detected_as.as_deref().unwrap_or("not at all"),
            shortcoming(row)
        ))?;
    }
    if let Some(soak) = &report.soak {
        console.result(&format!(
            "{} min at {:.2} frames/s without a fault: {} sent, {} captured, {} dropped{}",
            soak.minutes,
            soak.fps,
            soak.frames_sent,
            soak.frames_captured,
            soak.frames_sent.saturating_sub(soak.frames_captured),
            if soak.mistakes > 0 {
                "; wrong frames or false alarms"
            } else {
                ""
            }
        ))?;
    }
    Ok(())
}

fn shortcoming(row: &Row) -> String {
    if row.wrong_frames > 0 {
        format!("  {} wrong frames taken for good", row.wrong_frames)
    } else if row.holds() {
        String::new()
    } else if row.detected_as.is_none() {
        "  not noticed".to_owned()
    } else {
        format!("  not within {RECOVERY_LIMIT_MS} ms")
    }
}

fn parse_minutes(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|minutes: &f64| (0.0..=1_440.0).contains(minutes))
        .ok_or_else(|| "minutes, from 0 to 1440".to_owned())
}
