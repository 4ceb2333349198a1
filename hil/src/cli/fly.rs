//! `hil fly`: one flight, its folder and its summary.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use frames::Identity;

use super::Failure;
use super::conditions::ConditionArguments;
use super::console::Console;
use super::{live, summary, world};
use crate::board::emulated::Firmware;
use crate::flight::{self, FlightError, Flown, Progress};
use crate::folder;
use crate::image::{self, Variant};
use crate::live::Stop;
use crate::rig::file::Rig;
use crate::rig::{BoardSetup, fly_board, probe};
use crate::scenario::file::{self, ScenarioFile};
use crate::scenario::{
    Deviation, Homing, NoSpacing, Route, Scenario, SnapshotForm, Spacing, Storage,
};

/// The board a flight is flown on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The image that would be flashed, on an emulated STM32F407
    #[default]
    Emulator,
    /// The same logic compiled for this machine: faster, without timing
    Native,
    /// A board that is there, in real time (--rig)
    Board,
}

impl Backend {
    /// The name on the command line and in the summary.
    fn name(self) -> &'static str {
        match self {
            Self::Emulator => "emulator",
            Self::Native => "native",
            Self::Board => "board",
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
    /// Metres between snapshots, in steps of 0.1, or `auto`: as far as the drift of odometry allows; a
    /// sequence has its own spacing, 0.25 m
    #[arg(long, default_value = "2", value_parser = parse_spacing, value_name = "METRES")]
    pub spacing: Spacing,
    /// How a snapshot is stored
    #[arg(long, value_enum, default_value_t)]
    pub snapshots: SnapshotForm,
    /// How far the stored way may deviate from the one flown, in steps of 0.1 m
    #[arg(long, default_value = "0.1", value_parser = parse_deviation, value_name = "METRES")]
    pub deviation: Deviation,
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
            route: self.route.clone(),
            world: self.world.clone(),
            seed,
            spacing: self.spacing,
            storage: Storage {
                snapshots: self.snapshots,
                deviation: self.deviation,
            },
            homing: self.homing,
            conditions: self.conditions.conditions(),
        }
    }
}

fn parse_spacing(text: &str) -> Result<Spacing, String> {
    text.parse()
        .map_err(|wrong: NoSpacing| format!("{wrong}; the paper flies 1 or 2"))
}

fn parse_percent(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|percent| (0.0..=100.0).contains(percent))
        .ok_or_else(|| "a number from 0 to 100".to_owned())
}

fn parse_deviation(text: &str) -> Result<Deviation, String> {
    text.parse()
        .ok()
        .and_then(Deviation::from_metres)
        .ok_or_else(|| {
            "a distance from 0.1 to 1 metre in steps of 0.1; the paper has 0.1".to_owned()
        })
}

/// Options of `hil fly`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil fly                                 the paper's U on the emulated board\n  \
    hil fly --backend native --seed 7       the same logic, without a processor\n  \
    hil fly --route s --spacing 1 --json    one JSON object on stdout\n  \
    hil fly --snapshots lean --deviation 0.3 --spacing 7  a quarter of the bytes\n  \
    hil fly --route line --homing sequence  home by the camera alone\n  \
    hil fly tests/scenarios/u.toml --seed 7 one flight of a scenario\n  \
    hil fly --corrupt 1% --quirk self-acknowledge\n  \
    hil fly --restart-autopilot 120         a brown-out in mid-route\n  \
    hil fly --backend board --rig discovery a board on the desk, in real time; frames over serial\n\n\
    In a checkout, `cargo fly` is `hil fly`, built first.\n\
    Exit code 0: the drone came home. 1: it did not. 2: the flight could not be flown.")]
pub struct Arguments {
    /// A scenario: world, route, homing and conditions are its own
    #[arg(value_name = "FILE.toml", conflicts_with_all = ["route", "world", "spacing", "snapshots", "deviation", "homing", "ConditionArguments"])]
    file: Option<PathBuf>,
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// The board [default: as the file says, else emulator]
    #[arg(long, value_enum)]
    backend: Option<Backend>,
    /// The rig of the backend `board`: the path of its file, or its name
    #[arg(long, value_name = "NAME|FILE", required_if_eq("backend", "board"))]
    rig: Option<String>,
    /// Seed of world, sensors and camera noise [default: the file's first, else 1]
    #[arg(long)]
    seed: Option<u64>,
    /// Folder for summary.json, flight.log, recording.json, report.html and map.svg [default: flights/ROUTE-BACKEND-SEED]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Ends with one JSON object, the summary, on stdout
    #[arg(long)]
    json: bool,
    /// An image that is already built [default: this checkout's, built first]
    #[arg(long, value_name = "ELF")]
    firmware: Option<PathBuf>,
    /// Per cent of the steps on the backend `board` that may begin more than 5 ms late
    #[arg(long, value_name = "PERCENT", default_value = "1", value_parser = parse_percent)]
    late: f64,
}

/// What is to be flown, and on which board.
fn scenario(arguments: &Arguments) -> Result<(Scenario, Backend), Failure> {
    let Some(file) = &arguments.file else {
        let scenario = arguments.scenario.scenario(arguments.seed.unwrap_or(1));
        return Ok((scenario, arguments.backend.unwrap_or_default()));
    };
    let file = ScenarioFile::open(file)?;
    let scenario = file.scenario(arguments.seed.unwrap_or(file.seeds.first))?;
    let own = match file.backend {
        file::Backend::Native => Backend::Native,
        file::Backend::Emulator => Backend::Emulator,
    };
    Ok((scenario, arguments.backend.unwrap_or(own)))
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let (scenario, backend) = scenario(arguments)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| folder::default_path(&scenario, backend.name()));
    let unwritable = |error| format!("{}: {error}", out.display());
    let rig = match (backend, &arguments.rig) {
        (Backend::Board, Some(rig)) => Some(Rig::open(rig)?),
        (_, Some(_)) => return Err("--rig is for --backend board".into()),
        (_, None) => None,
    };
    let image = match backend {
        Backend::Native => None,
        Backend::Board => rig
            .as_ref()
            .map(|rig| Image::for_rig(arguments.firmware.clone(), rig, console))
            .transpose()?,
        Backend::Emulator => Some(Image::get(arguments.firmware.clone(), console)?),
    };
    // Before the flight: minutes in the air are not to be lost to a folder that cannot be written.
    folder::prepare(&out).map_err(unwritable)?;
    let flown = match &image {
        Some(image) if let Some(rig) = &rig => on_board(&scenario, rig, image, console)?,
        None => with_progress(console, |progress| flight::fly_native(&scenario, progress))?,
        Some(image) => with_progress(console, |progress| {
            flight::fly_emulated_alone(&scenario, &image.bytes, progress)
        })
        .map_err(|error| image.failure(error))?,
    };
    folder::write(&out, &flown).map_err(unwritable)?;
    console.status("Report", &out.join("report.html").display().to_string());
    kept_step(&flown, arguments.late)?;
    if arguments.json {
        console.result(&serde_json::to_string(&flown.summary)?)?;
    } else {
        console.result(&summary::in_words(&flown.summary))?;
    }
    Ok(flown.summary.completed)
}

/// Flies on a rig, which says what happens while it happens.
fn on_board(
    scenario: &Scenario,
    rig: &Rig,
    image: &Image,
    console: &Console,
) -> Result<Flown, Failure> {
    let conditions = &scenario.conditions;
    if conditions.camera.is_some() || conditions.lens.is_some() {
        return Err("a camera fault or a lens of its own wants the emulator".into());
    }
    if matches!(scenario.homing, Homing::SequenceEvery(_)) {
        return Err(FlightError::SequenceSpacing.into());
    }
    let firmware = Firmware::parse(&image.bytes)?;
    let stop = Stop::on_signals()?;
    let setup = BoardSetup {
        rig,
        image: image.on_board(&firmware),
        identity: image.identity(),
        scenario: scenario.clone(),
        speed: 1.0,
        stop: &stop,
    };
    let flight = fly_board(&setup, &|notice| live::say(console, notice))?;
    match &flight.transcript {
        Some(Ok(transcript)) => {
            if let Some(difference) = transcript.difference(&flight.snapshots())? {
                return Err(difference.into());
            }
            let text = "the board took every snapshot as this machine does from the same frames";
            console.status("Twin", text);
        }
        Some(Err(gap)) => console.warning(&format!("not held against this machine: {gap}")),
        None => {}
    }
    Ok(flight.flown)
}

/// A flight against the clock that did not keep step with it is none.
fn kept_step(flown: &Flown, most_percent: f64) -> Result<(), Failure> {
    match &flown.summary.live {
        Some(live) if 100.0 * live.pace.late_share > most_percent => Err(format!(
            "{:.1} % of the steps began late, where {most_percent} % may: this machine has too much else to do",
            100.0 * live.pace.late_share
        )
        .into()),
        _ => Ok(()),
    }
}

/// A firmware image and where it came from.
pub(super) struct Image {
    pub(super) elf: PathBuf,
    pub(super) bytes: Vec<u8>,
}

impl Image {
    /// The image that was given, or else the one of this checkout that flies.
    pub(super) fn get(given: Option<PathBuf>, console: &Console) -> Result<Self, Failure> {
        Self::of(given, &Variant::FLIGHT, console)
    }

    /// The image that was given, or else this checkout's for a rig's board.
    pub(super) fn for_rig(
        given: Option<PathBuf>,
        rig: &Rig,
        console: &Console,
    ) -> Result<Self, Failure> {
        Self::of(given, &rig.variant(), console)
    }

    /// The image that was given, or else this checkout's of a variant.
    pub(super) fn of(
        given: Option<PathBuf>,
        variant: &Variant,
        console: &Console,
    ) -> Result<Self, Failure> {
        let elf = match given {
            Some(elf) => elf,
            None => image::build_variant(variant, &|line| console.status("Firmware", line))?,
        };
        let bytes = std::fs::read(&elf).map_err(|error| format!("{}: {error}", elf.display()))?;
        Ok(Self { elf, bytes })
    }

    /// As a probe needs it.
    pub(super) fn on_board<'i>(&'i self, firmware: &'i Firmware) -> probe::Image<'i> {
        probe::Image {
            elf: &self.elf,
            firmware,
        }
    }

    /// What it says of itself; none where it says nothing.
    pub(super) fn identity(&self) -> Option<Identity> {
        image::identity(&self.bytes).ok()
    }

    pub(super) fn failure(&self, error: FlightError) -> Failure {
        format!("{}: {error}", self.elf.display()).into()
    }
}

/// Flies with a progress bar.
pub(super) fn with_progress(
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
