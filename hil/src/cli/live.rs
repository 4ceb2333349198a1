//! What the two live verbs share: their options, what they say, and how they end.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::Failure;
use super::console::Console;
use crate::flight::Flown;
use crate::folder;
use crate::live::{Common, Endpoint, Notice, Stop, TcpPort};
use crate::summary::{DirectionFigures, Summary};

/// Fastest that anybody may ask for: beyond it no machine keeps up.
const FASTEST: f64 = 100.0;

/// Options of both verbs.
#[derive(Clone, Debug, Args)]
pub struct LiveArguments {
    /// Where the other half is met: pty, tty:PATH, tcp:PORT (on this machine) or none
    #[arg(long, value_name = "ENDPOINT", default_value = "none")]
    link: Endpoint,
    /// Rate of a tty; a pty and TCP have none
    #[arg(long, default_value_t = 921_600)]
    baud: u32,
    /// Virtual over real time; both programs need the same, and real peers 1
    #[arg(long, default_value = "1", value_parser = parse_speed, value_name = "FACTOR")]
    speed: f64,
    /// Ends after so many seconds of flight
    #[arg(long, value_parser = parse_seconds, value_name = "N")]
    seconds: Option<Duration>,
    /// Ends with one JSON object, the summary, on stdout
    #[arg(long)]
    json: bool,
}

impl LiveArguments {
    /// Where the other half is met.
    pub fn link(&self) -> &Endpoint {
        &self.link
    }

    /// The link and this port for poses, where there is one, must be two.
    pub fn beside(&self, pose: Option<TcpPort>) -> Result<(), Failure> {
        match &self.link {
            Endpoint::Tcp(port) if pose == Some(*port) => {
                Err(format!("{port} cannot be both --link and --pose").into())
            }
            _ => Ok(()),
        }
    }

    /// For the flight.
    pub fn common<'s>(&self, stop: &'s Stop) -> Common<'s> {
        Common {
            link: self.link.clone(),
            baud: self.baud,
            speed: self.speed,
            limit_ms: self.seconds.map(|limit| limit.as_millis() as u64),
            stop,
        }
    }

    /// Writes the folder and says what came of the flight.
    pub fn end(&self, out: &Path, flown: &Flown, console: &Console) -> Result<bool, Failure> {
        folder::write(out, flown).map_err(unwritable(out))?;
        console.status("Report", &out.join("report.html").display().to_string());
        if self.json {
            console.result(&serde_json::to_string(&flown.summary)?)?;
        } else {
            console.result(&in_words(flown))?;
        }
        Ok(flown.summary.completed)
    }
}

/// The folder that was asked for, or the default one, tried before the flight.
pub fn prepare(out: Option<&PathBuf>, name: &str) -> Result<PathBuf, Failure> {
    let out = out
        .cloned()
        .unwrap_or_else(|| Path::new("flights").join(name));
    folder::prepare(&out).map_err(unwritable(&out))?;
    Ok(out)
}

fn unwritable(out: &Path) -> impl Fn(std::io::Error) -> String {
    move |error| format!("{}: {error}", out.display())
}

/// Says something at once.
pub fn say(console: &Console, notice: Notice) {
    match notice {
        Notice::Status(verb, text) => console.status(verb, &text),
        Notice::Warning(text) => console.warning(&text),
    }
}

fn parse_speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if speed > 0.0 && speed <= FASTEST => Ok(speed),
        _ => Err(format!("a number above 0 and up to {FASTEST}")),
    }
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    text.parse()
        .ok()
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "a number of seconds".to_owned())
}

/// The summary for people, without a newline at the end.
fn in_words(flown: &Flown) -> String {
    let summary = &flown.summary;
    let verdict = if summary.completed {
        "home"
    } else {
        "NOT HOME"
    };
    let mut lines = vec![format!("{verdict}: {}", summary.outcome)];
    let mut row = |name: &str, value: String| lines.push(format!("  {name:<22}{value}"));
    row(
        "home error",
        format!(
            "{:.2} m (odometry alone: {:.2} m)",
            summary.home_error_m, summary.odometry_only_error_m
        ),
    );
    row(
        "flown",
        format!(
            "{:.1} m out, {:.1} m back, {:.0} s",
            summary.outbound_m, summary.inbound_m, summary.flight_s
        ),
    );
    row(
        "route memory",
        format!(
            "{} snapshots, {} bytes; {} corrections",
            summary.snapshots,
            summary.memory_bytes,
            flown.recording.corrections.len()
        ),
    );
    if summary.frames_sent > 0 {
        row(
            "frames",
            format!(
                "{} captured of {} sent, {} dropped",
                summary.frames_captured, summary.frames_sent, summary.frames_dropped
            ),
        );
    }
    row("to the camera", direction(&summary.link.to_camera));
    row("to the autopilot", direction(&summary.link.to_autopilot));
    if let Some(pace) = pace(summary) {
        row("real time", pace);
    }
    lines.join("\n")
}

fn direction(figures: &DirectionFigures) -> String {
    format!(
        "{} frames, {} dropped",
        figures.frames_sent, figures.frames_dropped
    )
}

fn pace(summary: &Summary) -> Option<String> {
    let pace = summary.live.as_ref()?.pace;
    Some(format!(
        "{:.2} % of the steps more than 5 ms late, the latest {:.1} ms",
        100.0 * pace.late_share,
        pace.largest_lateness_ms
    ))
}
