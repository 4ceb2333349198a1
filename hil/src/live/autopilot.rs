//! The emulated autopilot against the clock: its link at a port, its true pose for whoever renders.

use std::thread;
use std::time::Duration;

use autopilot::app::{Outcome, Phase};
use fake_sensors::camera;
use fake_sensors::world::World;

use crate::board::BoardFigures;
use crate::board::emulated::Firmware;
use crate::flight::aircraft::Aircraft;
use crate::flight::wire::Wire;
use crate::flight::{self, Flown, sum_up};
use crate::record::{Side, What};
use crate::scenario::Scenario;
use crate::summary::{LiveFigures, Summary};

use super::endpoint::{Endpoint, TcpPort};
use super::frames::Frames;
use super::pace::Pacer;
use super::port::Port;
use super::pose::PoseLine;
use super::scribe::{Notice, Scribe};
use super::{Common, LiveError};

/// The board's name in the summary: it is somebody else's.
const BOARD: &str = "peer";
/// The true pose is told every 5 ms: a camera frame takes 39.
const POSE_PERIOD_MS: u64 = 5;
/// Between two looks for a peer before the flight.
const PATIENCE: Duration = Duration::from_millis(POSE_PERIOD_MS);

/// What is to be flown, for whom.
#[derive(Debug)]
pub struct AutopilotSetup<'s> {
    /// Link, speed and end.
    pub common: Common<'s>,
    /// Route, seed and the navigator's settings; the world is for the map alone.
    pub scenario: Scenario,
    /// Where the true pose is told.
    pub pose: Option<TcpPort>,
}

/// What is done in each millisecond for the board at the link, and what is known of it in the end.
pub trait Attendant {
    /// One millisecond.
    ///
    /// # Errors
    /// [`LiveError`] where the flight cannot go on.
    fn attend(&mut self, moment: &Moment, scribe: &mut Scribe) -> Result<(), LiveError>;

    /// After the flight. Writes down what is left to say.
    fn finish(&mut self, now_ms: u64, scribe: &mut Scribe) -> Account<'_>;
}

/// A flight at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Flight time, milliseconds.
    pub now_ms: u64,
    /// Where the camera is.
    pub camera: camera::Pose,
    /// Whether there is a peer at the link.
    pub linked: bool,
}

/// What is known of a board after a flight.
#[derive(Debug)]
pub struct Account<'f> {
    /// Its name in the summary.
    pub backend: &'static str,
    /// Its counters.
    pub figures: BoardFigures,
    /// The image, where that is known.
    pub firmware: Option<&'f Firmware>,
}

/// The board is somebody else's.
struct NoAttendant;

impl Attendant for NoAttendant {
    fn attend(&mut self, _: &Moment, _: &mut Scribe) -> Result<(), LiveError> {
        Ok(())
    }

    fn finish(&mut self, _: u64, _: &mut Scribe) -> Account<'_> {
        Account {
            backend: BOARD,
            figures: BoardFigures::default(),
            firmware: None,
        }
    }
}

/// Flies a scenario for a camera board at the link, from when somebody is there until the drone has
/// landed, somebody asks to end, or the limit.
///
/// # Errors
/// [`LiveError`] where it cannot begin.
pub fn fly_aircraft(setup: &AutopilotSetup, say: &dyn Fn(Notice)) -> Result<Flown, LiveError> {
    let link = Port::open(&setup.common.link, setup.common.baud)?;
    fly_attended(setup, link, &mut NoAttendant, say)
}

/// The same for a board that has to be attended to, at a link that is open already.
///
/// # Errors
/// [`LiveError`] where it cannot begin, or where the attendant cannot go on.
pub fn fly_attended(
    setup: &AutopilotSetup,
    link: Port,
    attendant: &mut dyn Attendant,
    say: &dyn Fn(Notice),
) -> Result<Flown, LiveError> {
    let scenario = &setup.scenario;
    let world = World::open(&scenario.world, scenario.seed)?;
    let route = scenario.route.waypoints();
    let mut session = Session {
        aircraft: Aircraft::new(scenario, &route),
        link,
        pose: setup.pose.map(Port::open_tcp).transpose()?,
        scribe: Scribe::new(flight::blank(&world, scenario), say),
        wire: Wire::new(scenario.conditions.corrupted_share, scenario.seed),
        spoken: Frames::default(),
        phase: Phase::Ground,
        now_ms: 0,
    };
    session.announce();
    session.wait_for_a_peer(&setup.common);
    let mut pacer = Pacer::new(setup.common.speed);
    while !session.landed() && !setup.common.over(session.now_ms) {
        pacer.wait();
        if let Some(late) = pacer.falls_behind() {
            session.scribe.behind(session.now_ms, late);
        }
        session.step(attendant)?;
    }
    Ok(session.finish(setup, &pacer, attendant))
}

/// An aircraft with its ports.
struct Session<'s> {
    aircraft: Aircraft,
    link: Port,
    pose: Option<Port>,
    scribe: Scribe<'s>,
    wire: Wire,
    /// What the app sends.
    spoken: Frames,
    /// As told.
    phase: Phase,
    now_ms: u64,
}

impl Session<'_> {
    fn announce(&mut self) {
        let link = self.link.place().to_owned();
        self.scribe.tell(0, "Link", link);
        let pose = match &self.pose {
            Some(port) => format!("told to whoever comes ({})", port.place()),
            None => "told to nobody".to_owned(),
        };
        self.scribe.tell(0, "Pose", pose);
    }

    /// The drone stands on the ground until there is a camera.
    fn wait_for_a_peer(&mut self, common: &Common) {
        let mut told = false;
        if matches!(common.link, Endpoint::Tty(_)) {
            let text = "at once: a tty does not tell whether a board is there".to_owned();
            self.scribe.tell(0, "Flying", text);
        }
        loop {
            // What comes before the flight is not for this flight.
            self.meet(&mut Vec::new());
            self.tell_pose();
            if self.link.has_peer() || common.stop.requested() {
                return;
            }
            if !std::mem::replace(&mut told, true) {
                let text = "on the ground until a camera board is connected".to_owned();
                self.scribe.tell(0, "Waiting", text);
            }
            thread::sleep(PATIENCE);
        }
    }

    fn landed(&self) -> bool {
        matches!(self.aircraft.phase(), Phase::Landed(_))
    }

    /// One millisecond.
    fn step(&mut self, attendant: &mut dyn Attendant) -> Result<(), LiveError> {
        let moment = Moment {
            now_ms: self.now_ms,
            camera: self.aircraft.camera_pose(),
            linked: self.link.has_peer(),
        };
        attendant.attend(&moment, &mut self.scribe)?;
        let mut received = Vec::new();
        self.meet(&mut received);
        for message in self.wire.carry_to_autopilot(&mut received) {
            let by = Side::Camera;
            let recorder = &mut self.scribe.recorder;
            recorder.deed(self.now_ms, What::Sent { by, message });
        }
        let sent = self.aircraft.tick(self.now_ms, &received);
        self.hand_over(&sent);
        self.note();
        if self.now_ms.is_multiple_of(POSE_PERIOD_MS) {
            self.tell_pose();
        }
        self.now_ms += 1;
        Ok(())
    }

    fn meet(&mut self, received: &mut Vec<u8>) {
        for news in self.link.poll(received) {
            self.scribe.link_news(self.now_ms, Side::Camera, news);
        }
        if let Some(pose) = &mut self.pose {
            // Whoever renders has nothing to say.
            for news in pose.poll(&mut Vec::new()) {
                self.scribe.news(self.now_ms, "Pose", news);
            }
        }
    }

    fn hand_over(&mut self, bytes: &[u8]) {
        for mut piece in self.spoken.push(bytes) {
            for message in self.wire.carry_to_camera(&mut piece.bytes) {
                let by = Side::Autopilot;
                let recorder = &mut self.scribe.recorder;
                recorder.deed(self.now_ms, What::Sent { by, message });
            }
            if let Err(why) = self.link.send(&piece.bytes) {
                self.scribe
                    .unsent(self.now_ms, Side::Camera, piece.name(), why);
            }
        }
    }

    fn note(&mut self) {
        flight::record(self.now_ms, &mut self.aircraft, &mut self.scribe.recorder);
        let phase = self.aircraft.phase();
        if phase != self.phase {
            self.phase = phase;
            self.scribe.say("Flying", in_words(phase).to_owned());
        }
    }

    /// A renderer that does not read misses poses, and has the next one.
    fn tell_pose(&mut self) {
        let Some(port) = &mut self.pose else {
            return;
        };
        let truth = self.aircraft.truth();
        let t = self.now_ms as f64 / 1_000.0;
        if let Ok(line) = PoseLine::new(t, &truth.position_m, &truth.attitude).encode() {
            let _ = port.send(&line);
        }
    }

    /// What has come and will not be read any more.
    fn name_the_rest(&mut self) {
        let mut rest = Vec::new();
        self.meet(&mut rest);
        for message in self.wire.carry_to_autopilot(&mut rest) {
            self.scribe.too_late(self.now_ms, Side::Autopilot, &message);
        }
    }

    fn finish(
        mut self,
        setup: &AutopilotSetup,
        pacer: &Pacer,
        attendant: &mut dyn Attendant,
    ) -> Flown {
        self.name_the_rest();
        let account = attendant.finish(self.now_ms, &mut self.scribe);
        let live = LiveFigures {
            pace: pacer.figures(),
            link: setup.common.link.to_string(),
            link_peers: self.link.peers(),
            pose: setup
                .pose
                .map_or("none".to_owned(), |port| port.to_string()),
            pose_peers: self.pose.as_ref().map_or(0, Port::peers),
            poses: 0,
            bad_poses: 0,
        };
        self.scribe.report_pace(self.now_ms, &live.pace);
        let recording = self.scribe.recorder.finish();
        let end = sum_up::End {
            completed: self.aircraft.phase() == Phase::Landed(Outcome::Completed),
            outcome: outcome(&self.aircraft, &setup.scenario),
            flight_s: Duration::from_millis(self.now_ms).as_secs_f64(),
            figures: account.figures,
            backend: account.backend,
            firmware: account.firmware,
            link: self.wire.figures(&recording),
            wall: pacer.elapsed(),
        };
        let summary = Summary {
            live: Some(live),
            ..sum_up::summary(&setup.scenario, &recording, end)
        };
        Flown { summary, recording }
    }
}

fn in_words(phase: Phase) -> &'static str {
    match phase {
        Phase::Ground => "on the ground",
        Phase::TakeOff => "taking off",
        Phase::Recording => "recording the route",
        Phase::Following => "following it home",
        Phase::Landing => "landing",
        Phase::Landed(_) => "landed",
    }
}

fn outcome(aircraft: &Aircraft, scenario: &Scenario) -> &'static str {
    match aircraft.phase() {
        Phase::Landed(_) if aircraft.stopped_safely() => sum_up::SAFE_STOP,
        Phase::Landed(outcome) => sum_up::in_words(outcome, scenario.homing),
        Phase::Ground => "ended before the drone took off",
        _ => "ended in mid-flight",
    }
}
