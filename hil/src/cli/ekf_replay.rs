//! `hil ekf-replay`: the filter against a recording of the firmware's own.

use std::path::PathBuf;

use autopilot::ekf::replay::{Largest, Limits};
use clap::Args;

use super::Failure;
use super::console::Console;
use crate::ekf_replay::{self, Report};

/// Options of `hil ekf-replay`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil ekf-replay tests/golden/data/ekf/g1_hover\n  \
    hil ekf-replay recordings/north --initial-yaw 1.57 --json\n\n\
    PREFIX.imu.csv holds a row for each millisecond, PREFIX.events.csv what else reached the\n\
    filter, PREFIX.ekf.csv the recorded filter's state; tests/golden/data/ekf/FORMAT.md has the\n\
    columns.\n\
    Exit code 0: within the limits. 1: beyond one of them. 2: the recording cannot be read.")]
pub struct Arguments {
    /// The recording: folder and name without .imu.csv
    prefix: PathBuf,
    /// Heading that the recorded filter assumed at a reset, radians, counter-clockwise
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_angle, value_name = "RAD")]
    initial_yaw: f32,
    /// Ends with one JSON object: position_m, velocity_mps, attitude_rad, variance_relative, within, compared
    #[arg(long)]
    json: bool,
}

fn parse_angle(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|angle: &f32| angle.is_finite())
        .ok_or_else(|| "an angle in radians".to_owned())
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let report = ekf_replay::check(&arguments.prefix, arguments.initial_yaw)?;
    if arguments.json {
        console.result(&serde_json::to_string(&report)?)?;
    } else {
        console.result(&in_words(&report))?;
    }
    Ok(report.within)
}

/// The report for people, without a newline at the end.
fn in_words(report: &Report) -> String {
    let limits = Limits::FIRMWARE;
    let found = &report.deviation;
    let row = |name: &str, unit: &str, largest: Largest, limit: f32| {
        let verdict = if largest.value <= limit {
            "within"
        } else {
            "BEYOND"
        };
        format!(
            "  {name:<10}{:>10.1e} {unit:<4} at {:>8.3} s   {verdict} {limit:.0e}",
            largest.value,
            largest.tick_ms as f64 / 1000.0
        )
    };
    [
        format!("largest deviation over {} instants", report.compared),
        row("position", "m", found.position_m, limits.position_m),
        row("velocity", "m/s", found.velocity_m_s, limits.velocity_m_s),
        row("attitude", "rad", found.attitude_rad, limits.attitude_rad),
        row("variance", "", found.variance_share, limits.variance_share),
    ]
    .join("\n")
}
