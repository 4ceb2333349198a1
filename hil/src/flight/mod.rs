//! The flight loop: vehicle, sensors, autopilot and board, a millisecond at a time.
//!
//! One loop, no wall clock: the same scenario is the same flight on every machine. A second thread may render ahead, and
//! changes no bit (`board::rows`).

pub(crate) mod aircraft;
mod autopilot;
pub(crate) mod sum_up;
pub(crate) mod wire;

use std::convert::identity;
use std::fmt;
use std::time::Instant;

use ::autopilot::app;
use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::camera::{PanoramicCamera, PanoramicLens};
use fake_sensors::world::{World, WorldError};
use nav::RecordError;
use pilot::Pilot;

use crate::board::camera::Camera;
use crate::board::emulated::{Emulated, Firmware};
use crate::board::native::{EXTCLK_HZ, Native};
use crate::board::observer::Observer;
use crate::board::{Board, BoardError};
use crate::record::{Recording, Side, WallSegment, What};
use crate::recorder::Recorder;
use crate::scenario::{Homing, NoWay, Scenario};
use crate::summary::Summary;

use aircraft::Aircraft;
use wire::Wire;

/// How often progress is reported, milliseconds of flight.
const PROGRESS_PERIOD_MS: u64 = 500;

/// A flight that has ended, well or badly.
#[derive(Clone, Debug)]
pub struct Flown {
    /// Its figures.
    pub summary: Summary,
    /// Everything that happened.
    pub recording: Recording,
}

/// A flight that could not be flown.
#[derive(Debug, thiserror::Error)]
pub enum FlightError {
    /// There is no such world, or its file is bad.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A fault of the camera's wires, and a board that has none.
    #[error("the native board has no camera wires: a camera fault wants the emulator")]
    NoWires,
    /// A spacing of a sequence's snapshots that an image does not have.
    #[error(
        "the image has its own spacing of a sequence's snapshots: another one wants the native board"
    )]
    SequenceSpacing,
    /// The world has no room for a route drawn in it.
    #[error(transparent)]
    NoWay(#[from] NoWay),
    /// The board cannot go on.
    #[error(transparent)]
    Board(#[from] BoardError),
}

/// How far a flight has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Share of the expected flight time, 0..=1.
    pub fraction: f64,
    /// Flight time, seconds.
    pub flight_s: f64,
    /// What the app is doing.
    pub phase: app::Phase,
    /// Seconds of flight per second of wall time.
    pub realtime_factor: f64,
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let phase = match self.phase {
            app::Phase::Ground | app::Phase::TakeOff => "taking off",
            app::Phase::Recording => "recording the route",
            app::Phase::Following => "following it home",
            app::Phase::Landing | app::Phase::Landed(_) => "landing",
        };
        write!(
            f,
            "{:4.0} s, {phase}, {:.0}x real time",
            self.flight_s, self.realtime_factor
        )
    }
}

/// Flies a scenario with the firmware's logic compiled for this machine.
pub fn fly_native(
    scenario: &Scenario,
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    if scenario.conditions.camera.is_some() {
        return Err(FlightError::NoWires);
    }
    let started = Instant::now();
    let record = scenario.conditions.lens.map(|page| page.lens());
    let lens = record.unwrap_or(Err(RecordError::Empty));
    let mut parameters = pilot::Parameters {
        lens: lens.unwrap_or_default(),
        ..pilot::Parameters::DEFAULT
    };
    if let Homing::SequenceEvery(spacing) = scenario.homing {
        parameters.navigator.sequence_spacing_m = spacing.metres() as f32;
    }
    let pilot = Pilot::new(&parameters).map_err(BoardError::Calibration)?;
    let initial = pilot.exposure();
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, initial.shutter_lines, initial.gain);
    let world = World::open(&scenario.world, scenario.seed)?;
    let mut board = Native::new(pilot, camera(scenario, &world, chip));
    board.log_lens(&lens);
    fly(scenario, &world, &mut board, None, started, progress)
}

/// Flies a scenario with a firmware image on an emulated board.
pub fn fly_emulated(
    scenario: &Scenario,
    elf: &[u8],
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    let firmware = Firmware::parse(elf)?.with_lens(scenario.conditions.lens);
    fly_firmware(scenario, &firmware, identity, None, progress)
}

/// The same flight, bit for bit, where it has the machine to itself: a second thread renders ahead.
pub fn fly_emulated_alone(
    scenario: &Scenario,
    elf: &[u8],
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    let firmware = Firmware::parse(elf)?.with_lens(scenario.conditions.lens);
    fly_firmware(scenario, &firmware, Camera::with_helper, None, progress)
}

/// Flies a scenario on an emulated board that somebody watches. `firmware` has the scenario's lens
/// record.
pub fn fly_watched<'w>(
    scenario: &Scenario,
    firmware: &'w Firmware,
    observer: &'w mut dyn Observer,
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    fly_firmware(scenario, firmware, identity, Some(observer), progress)
}

fn fly_firmware<'w>(
    scenario: &Scenario,
    firmware: &'w Firmware,
    equip: fn(Camera) -> Camera,
    observer: Option<&'w mut dyn Observer>,
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    if matches!(scenario.homing, Homing::SequenceEvery(_)) {
        return Err(FlightError::SequenceSpacing);
    }
    let started = Instant::now();
    let world = World::open(&scenario.world, scenario.seed)?;
    let camera = equip(camera(scenario, &world, Tcm8230::default()));
    let mut board = Emulated::boot(firmware, camera)?.with_trouble(scenario.conditions.camera);
    if let Some(observer) = observer {
        board = board.watched_by(observer)?;
    }
    fly(
        scenario,
        &world,
        &mut board,
        Some(firmware),
        started,
        progress,
    )
}

/// The camera of the drone on the ground at the start of the route.
pub(crate) fn camera(scenario: &Scenario, world: &World, chip: Tcm8230) -> Camera {
    let mut optics = PanoramicCamera::new(world.clone(), &PanoramicLens::default(), scenario.seed);
    optics.set_light(scenario.conditions.light);
    Camera::new(chip, optics, aircraft::pose_on_the_ground())
}

fn fly(
    scenario: &Scenario,
    world: &World,
    board: &mut dyn Board,
    firmware: Option<&Firmware>,
    started: Instant,
    progress: &mut dyn FnMut(Progress),
) -> Result<Flown, FlightError> {
    let route = scenario.route.waypoints();
    let expected_ms = expected_flight_ms(&route);
    let mut aircraft = Aircraft::new(scenario, &route);
    let mut wire = Wire::new(scenario.conditions.corrupted_share, scenario.seed);
    let mut recorder = Recorder::new(blank(world, scenario));
    let mut from_board = Vec::new();
    let mut log = Vec::new();
    let mut now_ms = 0;
    let outcome = loop {
        board.look_from(aircraft.camera_pose());
        let mut to_board = aircraft.tick(now_ms, &from_board);
        record(now_ms, &mut aircraft, &mut recorder);
        for message in wire.carry_to_camera(&mut to_board) {
            let by = Side::Autopilot;
            recorder.deed(now_ms, What::Sent { by, message });
        }
        board.transmit(&to_board);
        board.advance()?;
        from_board.clear();
        board.receive(&mut from_board);
        for message in wire.carry_to_autopilot(&mut from_board) {
            let by = Side::Camera;
            recorder.deed(now_ms, What::Sent { by, message });
        }
        board.drain_log(&mut log);
        recorder.log(now_ms, log.drain(..));
        if now_ms.is_multiple_of(PROGRESS_PERIOD_MS) {
            let flight_s = now_ms as f64 / 1_000.0;
            progress(Progress {
                fraction: (now_ms as f64 / expected_ms).min(1.0),
                flight_s,
                phase: aircraft.phase(),
                realtime_factor: flight_s / started.elapsed().as_secs_f64(),
            });
        }
        now_ms += 1;
        if let app::Phase::Landed(outcome) = aircraft.phase() {
            break outcome;
        }
    };
    let figures = board.finish()?;
    board.drain_log(&mut log);
    recorder.log(now_ms, log.drain(..));
    let recording = recorder.finish();
    let end = sum_up::End {
        completed: outcome == app::Outcome::Completed,
        outcome: if aircraft.stopped_safely() {
            sum_up::SAFE_STOP
        } else {
            sum_up::in_words(outcome, scenario.homing)
        },
        flight_s: now_ms as f64 / 1_000.0,
        figures,
        backend: board.name(),
        firmware,
        link: wire.figures(&recording),
        wall: started.elapsed(),
    };
    Ok(Flown {
        summary: sum_up::summary(scenario, &recording, end),
        recording,
    })
}

/// What is known before a flight.
pub(crate) fn blank(world: &World, scenario: &Scenario) -> Recording {
    let plan = world.plan().iter().map(|line| WallSegment {
        from: line.from_m.map(f64::from),
        to: line.to_m.map(f64::from),
    });
    let route = scenario.route.waypoints();
    let places = route.waypoints.iter().map(|waypoint| waypoint.place);
    Recording {
        snapshot_form: scenario.storage.snapshots,
        plan: plan.collect(),
        route: places
            .map(|place| [place.x.into(), place.y.into()])
            .collect(),
        ..Recording::default()
    }
}

/// Writes down what the aircraft did in this millisecond.
pub(crate) fn record(now_ms: u64, aircraft: &mut Aircraft, recorder: &mut Recorder) {
    if let Some(origin) = aircraft.take_new_origin() {
        recorder.note(
            now_ms,
            "warn",
            "the autopilot counts from a new origin".to_owned(),
        );
        recorder.set_origin(origin);
    }
    let glimpse = aircraft.glimpse();
    for message in aircraft.take_received() {
        recorder.message(now_ms, &message, &glimpse);
    }
    for dropped in aircraft.take_dropped() {
        let (message, why) = (dropped.message.to_owned(), dropped.why.to_string());
        recorder.link_drop(now_ms, Side::Autopilot, message, why);
    }
    for what in aircraft.take_deeds() {
        recorder.deed(now_ms, what);
    }
    recorder.phase(now_ms, aircraft.phase());
    recorder.track(now_ms, &glimpse);
}

/// A guess for the progress bar: the way out and back at the app's cruise speed, and half as long
/// again for way points and homing.
fn expected_flight_ms(route: &app::Route) -> f64 {
    const CRUISE_M_S: f64 = 0.5;
    let both_ways_s = 2.0 * f64::from(route.length_m()) / CRUISE_M_S;
    1.5 * 1_000.0 * both_ways_s
}
