//! The emulated board against the clock: its link at a port, its camera wherever the pose source says.

use std::time::Duration;

use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::world::World;
use link::Message;

use crate::board::emulated::{Emulated, Firmware};
use crate::board::{Board, BoardError, FirmwareLog};
use crate::flight::wire::Wire;
use crate::flight::{self, Flown, sum_up};
use crate::gdb;
use crate::record::{Recording, Reference, Side};
use crate::recorder::{Glimpse, Recorder};
use crate::scenario::{Conditions, Route, Scenario, Spacing, Storage};
use crate::summary::{LiveFigures, Summary};

use super::endpoint::PoseSource;
use super::frames::Frames;
use super::pace::Pacer;
use super::port::{News, Port};
use super::pose::{Eyes, Seen};
use super::scribe::{Notice, Scribe};
use super::stop::Stop;
use super::watch::{self, Turn, Watch};
use super::{Common, LiveError};

/// The route's name in the summary: the autopilot has it.
const ROUTE: &str = "unknown";

/// What is to be emulated.
#[derive(Debug)]
pub struct EmulateSetup<'s> {
    /// Link, speed and end.
    pub common: Common<'s>,
    /// The image.
    pub elf: &'s [u8],
    /// What the camera looks at: a name or a file that `fake_sensors::world` knows.
    pub world: String,
    /// Seed of world and camera noise.
    pub seed: u64,
    /// Where the camera's pose comes from.
    pub pose: PoseSource,
    /// The port on which a GDB is served, if one is; 0 takes any.
    pub gdb: Option<u16>,
}

/// Emulates the board until somebody asks to end, or the limit.
///
/// The flight is completed if the firmware has followed its newest route to the end. A route that is
/// begun anew (CLEAR) takes the place of the one before; log and frames are those of all.
///
/// # Errors
/// [`LiveError`] where it cannot begin, or the emulated chip stops.
pub fn emulate(setup: &EmulateSetup, say: &dyn Fn(Notice)) -> Result<Flown, LiveError> {
    let firmware = Firmware::parse(setup.elf)?;
    let world = World::open(&setup.world, setup.seed)?;
    let scenario = scenario(setup);
    let camera = flight::camera(&scenario, &world, Tcm8230::default());
    let blank = Recording {
        route: Vec::new(),
        ..flight::blank(&world, &scenario)
    };
    let mut session = Session {
        board: Emulated::boot(&firmware, camera)?,
        link: Port::open(&setup.common.link, setup.common.baud)?,
        eyes: Eyes::open(setup.pose)?,
        scribe: Scribe::new(blank.clone(), say),
        watch: Watch::default(),
        spoken: Frames::default(),
        wire: Wire::new(0.0, setup.seed),
        stood_on_belief: false,
        now_ms: 0,
        blank,
        gdb: setup.gdb.map(gdb::Server::open).transpose()?,
        backlog: Backlog::default(),
        stop: setup.common.stop,
    };
    session.announce();
    let mut pacer = Pacer::new(setup.common.speed);
    while !setup.common.over(session.now_ms) {
        pacer.wait();
        if let Some(late) = pacer.falls_behind() {
            session.scribe.behind(session.now_ms, late);
        }
        session.step()?;
        pacer.stood_still(session.take_halted());
    }
    session.finish(scenario, &firmware, setup, &pacer)
}

/// What is known of the flight beforehand; the route stands for one that the autopilot has.
fn scenario(setup: &EmulateSetup) -> Scenario {
    Scenario {
        route: Route::default(),
        world: setup.world.clone(),
        seed: setup.seed,
        spacing: Spacing::DEFAULT,
        storage: Storage::PAPER,
        homing: Default::default(),
        conditions: Conditions::default(),
    }
}

/// A board with all that is around it.
struct Session<'s, 'f> {
    board: Emulated<'f>,
    link: Port,
    eyes: Eyes,
    scribe: Scribe<'s>,
    watch: Watch,
    /// What the firmware sends.
    spoken: Frames,
    /// Reads along; what breaks on the way breaks at the other end.
    wire: Wire,
    /// Whether the camera ever was where the drone believed to be.
    stood_on_belief: bool,
    now_ms: u64,
    /// A recording in which nothing has happened.
    blank: Recording,
    gdb: Option<gdb::Server<'f>>,
    backlog: Backlog,
    /// Asks to end.
    stop: &'s Stop,
}

/// What came over the link while a GDB had the board halted.
#[derive(Default)]
struct Backlog {
    bytes: Vec<u8>,
    news: Vec<News>,
}

impl Session<'_, '_> {
    fn announce(&mut self) {
        let (link, pose) = (self.link.place().to_owned(), self.eyes.place());
        self.scribe.tell(0, "Link", link);
        self.scribe.tell(0, "Pose", pose);
        if let Some(gdb) = &self.gdb {
            let place = gdb.place();
            let text = format!("listening on {place} (target remote {place})");
            self.scribe.tell(0, "GDB", text);
        }
    }

    /// One millisecond.
    fn step(&mut self) -> Result<(), BoardError> {
        let Backlog { bytes, news } = std::mem::take(&mut self.backlog);
        let mut received = bytes;
        for news in news.into_iter().chain(self.link.poll(&mut received)) {
            self.scribe.link_news(self.now_ms, Side::Autopilot, news);
        }
        for seen in self.eyes.poll(self.now_ms) {
            self.saw(seen);
        }
        for message in self.wire.carry_to_camera(&mut received) {
            self.hear(&message);
        }
        self.board.look_from(self.eyes.camera(self.now_ms));
        self.board.transmit(&received);
        self.advance()?;
        self.answer();
        self.log();
        self.note();
        self.now_ms += 1;
        Ok(())
    }

    /// Runs the board for the millisecond. While a GDB has it halted, the link is kept from overflowing.
    fn advance(&mut self) -> Result<(), BoardError> {
        let Some(gdb) = &mut self.gdb else {
            return self.board.advance();
        };
        let (link, backlog) = (&mut self.link, &mut self.backlog);
        let (scribe, now_ms, stop) = (&mut self.scribe, self.now_ms, self.stop);
        let mut tell = |news: Vec<String>| {
            let told = news.into_iter();
            told.for_each(|news| scribe.tell(now_ms, "GDB", news));
        };
        let mut attend = |news| {
            tell(news);
            let news = link.poll(&mut backlog.bytes);
            backlog.news.extend(news);
            !stop.requested()
        };
        let advanced = self
            .board
            .advance_by(|board, until| gdb.run(board, until, &mut attend));
        tell(gdb.take_news());
        advanced
    }

    fn take_halted(&mut self) -> Duration {
        let gdb = self.gdb.as_mut();
        gdb.map(gdb::Server::take_halted).unwrap_or_default()
    }

    fn saw(&mut self, seen: Seen) {
        match seen {
            Seen::News(news) => self.scribe.news(self.now_ms, "Pose", news),
            Seen::Bad(error) => self.scribe.bad_line(self.now_ms, &error),
            Seen::Switched(source) => {
                self.scribe
                    .tell(self.now_ms, "Pose", format!("the camera follows {source}"));
            }
        }
    }

    /// Understands what the autopilot says; what is broken, the firmware will name.
    fn hear(&mut self, message: &Message) {
        match message {
            Message::State(state) => {
                let Ok(pose) = state.pose() else {
                    return;
                };
                self.watch.on_state(pose);
                if let Some(seen) = self.eyes.state(self.now_ms, pose) {
                    self.saw(seen);
                }
            }
            Message::Command(command) => self.watch.on_command(command),
            _ => {}
        }
    }

    /// Hands over what the firmware says.
    fn answer(&mut self) {
        let mut bytes = Vec::new();
        self.board.receive(&mut bytes);
        self.wire.carry_to_autopilot(&mut bytes);
        for piece in self.spoken.push(&bytes) {
            if let Err(why) = self.link.send(&piece.bytes) {
                self.scribe
                    .unsent(self.now_ms, Side::Autopilot, piece.name(), why);
            }
            if let Some(message) = &piece.message {
                self.said(message);
            }
        }
    }

    fn said(&mut self, message: &Message) {
        match self.watch.on_answer(message) {
            Some(Turn::NewRoute) => self.begin_anew(),
            Some(Turn::Mode(mode)) => {
                let text = format!("{} (0x{mode:02x})", watch::mode_name(mode));
                self.scribe.tell(self.now_ms, "Mode", text);
            }
            None => {}
        }
        let glimpse = self.glimpse();
        self.scribe.recorder.message(self.now_ms, message, &glimpse);
    }

    /// The route of before is forgotten, as the firmware has.
    fn begin_anew(&mut self) {
        let recorder = std::mem::replace(
            &mut self.scribe.recorder,
            Recorder::new(Recording::default()),
        );
        let before = recorder.finish();
        let text = format!(
            "a new route; the one before had {} snapshots and {} corrections",
            before.snapshots.len(),
            before.corrections.len()
        );
        self.scribe.recorder = Recorder::new(Recording {
            frames: before.frames,
            link_drops: before.link_drops,
            log: before.log,
            ..self.blank.clone()
        });
        self.scribe.tell(self.now_ms, "Route", text);
    }

    fn log(&mut self) {
        let mut records = Vec::new();
        self.board.drain_log(&mut records);
        for record in &records {
            if let FirmwareLog::Line { text, .. } = record {
                self.watch.on_log(text);
            }
        }
        self.scribe.recorder.log(self.now_ms, records.into_iter());
    }

    fn note(&mut self) {
        let airborne = self.eyes.airborne(self.now_ms);
        self.stood_on_belief |= airborne && self.eyes.is_belief();
        let recorder = &mut self.scribe.recorder;
        recorder.phase(self.now_ms, self.watch.phase(airborne));
        let glimpse = self.glimpse();
        self.scribe.recorder.track(self.now_ms, &glimpse);
    }

    fn glimpse(&self) -> Glimpse {
        let pose = self.eyes.pose(self.now_ms);
        Glimpse {
            truth: pose.planar(),
            estimate: self.watch.estimate(),
            uncorrected: self.watch.uncorrected(),
            height_m: pose.z,
        }
    }

    /// What has come and will not be received any more.
    fn name_the_rest(&mut self) {
        let mut rest = Vec::new();
        for news in self.link.poll(&mut rest) {
            self.scribe.link_news(self.now_ms, Side::Autopilot, news);
        }
        for message in self.wire.carry_to_camera(&mut rest) {
            self.scribe.too_late(self.now_ms, Side::Camera, &message);
        }
    }

    fn finish(
        mut self,
        scenario: Scenario,
        firmware: &Firmware,
        setup: &EmulateSetup,
        pacer: &Pacer,
    ) -> Result<Flown, LiveError> {
        self.name_the_rest();
        let figures = self.board.finish()?;
        self.log();
        let scenario = Scenario {
            homing: self.watch.homing(),
            spacing: self.watch.spacing().unwrap_or(scenario.spacing),
            ..scenario
        };
        let live = self.live_figures(setup, pacer);
        self.scribe.report_pace(self.now_ms, &live.pace);
        let mut recording = self.scribe.recorder.finish();
        recording.snapshot_form = self.watch.snapshot_form();
        if self.stood_on_belief || live.poses == 0 {
            recording.reference = Reference::Estimate;
        }
        let end = sum_up::End {
            completed: self.watch.finished(),
            outcome: outcome(&self.watch),
            flight_s: Duration::from_millis(self.now_ms).as_secs_f64(),
            figures,
            backend: self.board.name(),
            firmware: Some(firmware),
            link: self.wire.figures(&recording),
            wall: pacer.elapsed(),
        };
        let summary = Summary {
            route: ROUTE.to_owned(),
            live: Some(live),
            ..sum_up::summary(&scenario, &recording, end)
        };
        Ok(Flown { summary, recording })
    }

    fn live_figures(&self, setup: &EmulateSetup, pacer: &Pacer) -> LiveFigures {
        let (pose_peers, poses, bad_poses) = self.eyes.counts();
        LiveFigures {
            pace: pacer.figures(),
            link: setup.common.link.to_string(),
            link_peers: self.link.peers(),
            pose: setup.pose.to_string(),
            pose_peers,
            poses,
            bad_poses,
        }
    }
}

fn outcome(watch: &Watch) -> &'static str {
    use autopilot::app::Phase;
    match watch.phase(true) {
        _ if watch.finished() => "the firmware followed the route to its end",
        Phase::Following => "ended before the route was followed to its end",
        Phase::Recording => "ended while the route was recorded",
        _ => "no route was followed",
    }
}
