//! A flight on a board that is there: the live autopilot, and for the board its camera's frames and a
//! listener to its log.

use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::world::World;
use frames::{Identity, Shape};
use link::Message;
use pilot::Pilot;

use crate::board::native::EXTCLK_HZ;
use crate::board::{BoardError, BoardFigures, FirmwareLog};
use crate::flight::{self, Flown};
use crate::live::{
    Account, Attendant, AutopilotSetup, Common, Endpoint, LiveError, Moment, Notice, Port, Scribe,
    Stop, fly_attended,
};
use crate::record::{Side, What};
use crate::scenario::Scenario;

use super::eye::{Eye, FrameFigures};
use super::file::Rig;
use super::probe::{self, Image, LogSource};
use super::ready::{Unready, in_words, make_ready};
use super::transcript::{Gap, Order, Snapshots, Transcript, snapshots_said};

/// The name in the summary.
const BACKEND: &str = "board";
/// How long the link's device may be away.
const LINK_PATIENCE_MS: u64 = 3_000;

/// What is to be flown on which rig.
#[derive(Debug)]
pub struct BoardSetup<'s> {
    /// The rig.
    pub rig: &'s Rig,
    /// What is to be on the board.
    pub image: Image<'s>,
    /// What that image says of itself; none where it says nothing.
    pub identity: Option<Identity>,
    /// Route, world, seed.
    pub scenario: Scenario,
    /// Virtual over real time: 1, but for an emulated board that is as fast.
    pub speed: f64,
    /// Asks to end.
    pub stop: &'s Stop,
}

/// A flight on a rig.
#[derive(Debug)]
pub struct BoardFlight {
    /// As every flight.
    pub flown: Flown,
    /// What the board took; none where its camera is fitted.
    pub transcript: Option<Result<Transcript, Gap>>,
}

impl BoardFlight {
    /// The snapshots that the board took on the way out.
    pub fn snapshots(&self) -> Snapshots {
        snapshots_said(&self.flown.recording.deeds)
    }
}

/// Flies a scenario on a rig: flashes, waits for the identification, and flies against the clock.
///
/// # Errors
/// [`LiveError`]: what is missing, or what broke.
pub fn fly_board(setup: &BoardSetup, say: &dyn Fn(Notice)) -> Result<BoardFlight, LiveError> {
    let BoardSetup { rig, image, .. } = setup;
    let mut probe = probe::of(rig);
    let ready = make_ready(rig, probe.as_mut(), image, setup.identity.as_ref())?;
    let described = described(rig, setup.identity.as_ref());
    say(Notice::Status("Flashed", described));
    let log = probe.log(image).map_err(Unready::from)?;
    let mut bench = Bench {
        eye: eye(&setup.scenario, ready.frames)?,
        log: Some(log),
        image,
        unlinked_since_ms: 0,
        records: Vec::new(),
        order: Order::default(),
    };
    let autopilot = AutopilotSetup {
        common: Common {
            link: Endpoint::Tty(rig.link.device.clone()),
            baud: rig.link.baud,
            speed: setup.speed,
            limit_ms: None,
            stop: setup.stop,
        },
        scenario: setup.scenario.clone(),
        pose: None,
    };
    let flown = fly_attended(&autopilot, ready.link, &mut bench, say)?;
    let transcript = bench.eye.take().map(|eye| {
        let (frames, shape) = eye.into_used();
        Transcript::merge(&bench.order, frames, sent(&flown), shape)
    });
    Ok(BoardFlight { flown, transcript })
}

/// What the autopilot sent.
fn sent(flown: &Flown) -> Vec<(u64, Message)> {
    let deeds = flown.recording.deeds.iter();
    deeds
        .filter_map(|deed| match &deed.what {
            What::Sent {
                by: Side::Autopilot,
                message,
            } => Some((deed.t_ms, message.clone())),
            _ => None,
        })
        .collect()
}

fn described(rig: &Rig, identity: Option<&Identity>) -> String {
    let image = identity.map_or("an image without identification".to_owned(), in_words);
    format!("{}: {image}", rig.name)
}

/// The camera that the board is to have, exposed at first as the firmware wants it at boot.
fn eye(scenario: &Scenario, frames: Option<(Port, Shape)>) -> Result<Option<Eye>, LiveError> {
    let Some((port, shape)) = frames else {
        return Ok(None);
    };
    let pilot = Pilot::new(&pilot::Parameters::DEFAULT).map_err(BoardError::Calibration)?;
    let wanted = pilot.exposure();
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, wanted.shutter_lines, wanted.gain);
    let world = World::open(&scenario.world, scenario.seed)?;
    let camera = flight::camera(scenario, &world, chip);
    Ok(Some(Eye::new(camera, shape, port)))
}

/// All that is done for a board on the desk.
struct Bench<'f> {
    eye: Option<Eye>,
    /// None once it has ended.
    log: Option<Box<dyn LogSource + 'f>>,
    image: &'f Image<'f>,
    unlinked_since_ms: u64,
    records: Vec<FirmwareLog>,
    order: Order,
}

impl Bench<'_> {
    /// A flight without its log is a flight; that it is missing is told.
    fn read_log(&mut self, now_ms: u64, scribe: &mut Scribe) {
        let Some(log) = &mut self.log else {
            return;
        };
        if let Err(error) = log.poll(&mut self.records) {
            self.log = None;
            scribe.warn(now_ms, error.to_string());
        }
        self.records
            .iter()
            .for_each(|record| self.order.note(record));
        scribe.recorder.log(now_ms, self.records.drain(..));
    }

    fn is_linked(&mut self, moment: &Moment) -> Result<(), Unready> {
        if moment.linked {
            self.unlinked_since_ms = moment.now_ms;
        }
        if moment.now_ms >= self.unlinked_since_ms + LINK_PATIENCE_MS {
            let seconds = LINK_PATIENCE_MS as f64 / 1_000.0;
            return Err(Unready::LinkLost { seconds });
        }
        Ok(())
    }
}

impl Attendant for Bench<'_> {
    fn attend(&mut self, moment: &Moment, scribe: &mut Scribe) -> Result<(), LiveError> {
        self.read_log(moment.now_ms, scribe);
        self.is_linked(moment)?;
        if let Some(eye) = &mut self.eye {
            eye.step(moment.now_ms, moment.camera)
                .map_err(Unready::from)?;
        }
        Ok(())
    }

    fn finish(&mut self, now_ms: u64, scribe: &mut Scribe) -> Account<'_> {
        self.read_log(now_ms, scribe);
        let frames = self.eye.as_ref().map(Eye::figures);
        if let Some(frames) = &frames {
            let level = if frames.sent == frames.used {
                "info"
            } else {
                "warn"
            };
            scribe.recorder.note(now_ms, level, account(frames));
        }
        Account {
            backend: BACKEND,
            figures: board_figures(frames.unwrap_or_default()),
            firmware: Some(self.image.firmware),
        }
    }
}

fn board_figures(frames: FrameFigures) -> BoardFigures {
    BoardFigures {
        frames_sent: frames.sent,
        frames_captured: frames.used + frames.missed,
        frames_processed: frames.used,
        ..BoardFigures::default()
    }
}

fn account(frames: &FrameFigures) -> String {
    let FrameFigures {
        rendered,
        sent,
        used,
        missed,
        torn,
        late,
        repeated,
        busy,
        unanswered,
        damaged_answers,
    } = frames;
    format!(
        "frames over serial: {rendered} taken, {sent} sent, {used} used, {missed} missed, {torn} torn, {late} late, \
         {repeated} repeated, {busy} without a buffer, {unanswered} without an answer, {damaged_answers} answers damaged"
    )
}
