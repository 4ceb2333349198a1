//! `hil fly`: one flight, its folder and its summary.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Failure;
use super::conditions::ConditionArguments;
use super::console::Console;
use super::world;
use crate::flight::{self, FlightError, Flown, Progress};
use crate::folder;
use crate::image;
use crate::scenario::{Homing, Route, Scenario, Spacing};
use crate::summary::{DirectionFigures, Summary};

/// The board a flight is flown on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The image that would be flashed, on an emulated STM32F407
    #[default]
    Emulator,
    /// The same logic compiled for this machine: faster, without timing
    Native,
}

impl Backend {
    /// The name on the command line and in the summary.
    fn name(self) -> &'static str {
        match self {
            Self::Emulator => "emulator",
            Self::Native => "native",
        }
    }
}

/// What is to be flown; shared by `fly` and `campaign`.
#[derive(Clone, Debug, Args)]
pub struct ScenarioArguments {
    /// The way out
    #[arg(long, value_enum, default_value_t)]
    pub route: Route,
    /// The world: a name that `hil look` lists, or a file
    #[arg(long, default_value = "arena-panels", value_parser = world::parse)]
    pub world: String,
    /// Metres between snapshots, in steps of 0.1; a sequence has its own spacing, 0.25 m
    #[arg(long, default_value = "2", value_parser = parse_spacing, value_name = "METRES")]
    pub spacing: Spacing,
    /// How the drone finds back
    #[arg(long, value_enum, default_value_t)]
    pub homing: Homing,
    #[command(flatten)]
    pub conditions: ConditionArguments,
}

impl ScenarioArguments {
    /// The scenario of one seed.
    pub fn scenario(&self, seed: u64) -> Scenario {
        Scenario {
            route: self.route,
            world: self.world.clone(),
            seed,
            spacing: self.spacing,
            homing: self.homing,
            conditions: self.conditions.conditions(),
        }
    }
}

fn parse_spacing(text: &str) -> Result<Spacing, String> {
    text.parse()
        .ok()
        .and_then(Spacing::from_metres)
        .ok_or_else(|| {
            "a distance from 0.2 to 10 metres in steps of 0.1; the paper flies 1 or 2".to_owned()
        })
}

/// Options of `hil fly`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil fly                                 the paper's U on the emulated board\n  \
    hil fly --backend native --seed 7       the same logic, without a processor\n  \
    hil fly --route s --spacing 1 --json    one JSON object on stdout\n  \
    hil fly --route line --homing sequence  home by the camera alone\n  \
    hil fly --corrupt 1% --quirk self-acknowledge\n  \
    hil fly --restart-autopilot 120         a brown-out in mid-route\n\n\
    In a checkout, `cargo fly` is `hil fly`, built first.\n\
    Exit code 0: the drone came home. 1: it did not. 2: the flight could not be flown.")]
pub struct Arguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// The board
    #[arg(long, value_enum, default_value_t)]
    backend: Backend,
    /// Seed of world, sensors and camera noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for summary.json, flight.log, recording.json, report.html and map.svg [default: flights/ROUTE-BACKEND-SEED]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Ends with one JSON object, the summary, on stdout
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let scenario = arguments.scenario.scenario(arguments.seed);
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| folder::default_path(&scenario, arguments.backend.name()));
    let unwritable = |error| format!("{}: {error}", out.display());
    let image = match arguments.backend {
        Backend::Native => None,
        Backend::Emulator => Some(Image::get(arguments.firmware.clone(), console)?),
    };
    // Before the flight: minutes in the air are not to be lost to a folder that cannot be written.
    folder::prepare(&out).map_err(unwritable)?;
    let flown = match &image {
        None => with_progress(console, |progress| flight::fly_native(&scenario, progress))?,
        Some(image) => with_progress(console, |progress| {
            flight::fly_emulated(&scenario, &image.bytes, progress)
        })
        .map_err(|error| image.failure(error))?,
    };
    folder::write(&out, &flown).map_err(unwritable)?;
    console.status("Report", &out.join("report.html").display().to_string());
    if arguments.json {
        console.result(&serde_json::to_string(&flown.summary)?)?;
    } else {
        console.result(&in_words(&flown.summary))?;
    }
    Ok(flown.summary.completed)
}

/// A firmware image and where it came from.
pub(super) struct Image {
    elf: PathBuf,
    pub(super) bytes: Vec<u8>,
}

impl Image {
    /// The image that was given, or else the one of this checkout.
    pub(super) fn get(given: Option<PathBuf>, console: &Console) -> Result<Self, Failure> {
        let elf = match given {
            Some(elf) => elf,
            None => image::build(&|line| console.status("Firmware", line))?,
        };
        let bytes = std::fs::read(&elf).map_err(|error| format!("{}: {error}", elf.display()))?;
        Ok(Self { elf, bytes })
    }

    pub(super) fn failure(&self, error: FlightError) -> Failure {
        format!("{}: {error}", self.elf.display()).into()
    }
}

/// Flies with a progress bar.
fn with_progress(
    console: &Console,
    fly: impl FnOnce(&mut dyn FnMut(Progress)) -> Result<Flown, FlightError>,
) -> Result<Flown, FlightError> {
    let mut bar = console.progress("Flying", 1000);
    let result = fly(&mut |progress: Progress| {
        bar.set((1000.0 * progress.fraction) as u64, || progress.to_string());
    });
    bar.finish();
    result
}

/// The summary for people, without a newline at the end.
fn in_words(summary: &Summary) -> String {
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
        "cross-track error",
        format!("{:.2} m rms", summary.cross_track_rms_m),
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
            "{} snapshots, {} bytes, {:.1} bytes/m",
            summary.snapshots, summary.memory_bytes, summary.bytes_per_m
        ),
    );
    row(
        "frames",
        format!(
            "{} captured of {} sent, {} dropped",
            summary.frames_captured, summary.frames_sent, summary.frames_dropped
        ),
    );
    let one_way = |figures: DirectionFigures| {
        format!(
            "{} sent, {} dropped",
            figures.frames_sent, figures.frames_dropped
        )
    };
    row(
        "link frames",
        format!(
            "to camera {}; to autopilot {}",
            one_way(summary.link.to_camera),
            one_way(summary.link.to_autopilot)
        ),
    );
    if let Some(cycles) = &summary.cycles_per_frame {
        row(
            "cycles per frame",
            format!("p50 {}, p99 {}, max {}", cycles.p50, cycles.p99, cycles.max),
        );
    }
    if let Some(load) = summary.cpu_load {
        row("processor load", format!("{:.1} %", 100.0 * load));
    }
    if let Some(firmware) = &summary.firmware {
        let stack = firmware
            .stack_peak_bytes
            .map_or("overflown".to_owned(), |bytes| format!("{bytes} B"));
        row(
            "firmware",
            format!(
                "{} B flash, {} B static RAM, {stack} stack",
                firmware.flash_bytes, firmware.ram_bytes
            ),
        );
    }
    row(
        "speed",
        format!(
            "{:.0}x real time ({:.1} s)",
            summary.realtime_factor, summary.wall_s
        ),
    );
    lines.join("\n")
}
