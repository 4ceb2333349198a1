//! Flies a script: one step after the other, one look at each in every cycle.

use link::{Implausible, Mode, WorldPoint};

use super::camera::Camera;
use super::phase::{Outcome, Phase};
use super::pilot::Pilot;
use super::route::{Arrival, distance_m};
use super::script::{FIRST_SNAPSHOT, Script, Step, Until};
use super::settings::{CYCLE_MS, Settings};
use crate::ekf::Measurement;

/// Period of the loop, s.
const CYCLE_S: f32 = CYCLE_MS as f32 / 1_000.0;

/// What a cycle knows.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// The time, ms.
    pub now_ms: u64,
    /// Where the drone believes to be.
    pub position: WorldPoint,
    /// How high it believes to be, m.
    pub height_m: f32,
    /// Where it has been sent.
    pub set_point: WorldPoint,
    /// Who leads it on scripted legs; without one they are legs of the filter's coordinates.
    pub pilot: Option<Pilot>,
}

/// What a cycle decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Decision {
    /// Keep the set-point.
    Hold,
    /// Fly to a place.
    GoTo(WorldPoint),
    /// Keep the set-point, and tell the filter this.
    Realign([Measurement; 2]),
    /// End the flight.
    Land(Outcome),
}

/// A script and how far it has been flown.
#[derive(Debug)]
pub struct Mission {
    settings: Settings,
    steps: std::vec::IntoIter<Step>,
    /// The step that is being flown; `None` at the end of the script.
    step: Option<Step>,
    /// Who leads in this step, and after the last one until the drone lands.
    phase: Phase,
    progress: Progress,
    /// The operator's button pressed last.
    button: Mode,
}

/// How far a step has been flown.
#[derive(Debug, Default)]
struct Progress {
    /// When the step began; `None` before its first cycle.
    began_ms: Option<u64>,
    /// Since when its end has been reached.
    reached_ms: Option<u64>,
    /// Where on the ground the pilot has led the drone.
    led_to: Option<WorldPoint>,
    /// Whether the camera has given a target during the step.
    led: bool,
    /// Whether the camera has turned to the first snapshot of the route during the step.
    at_first: bool,
    /// Whether a correction has been applied since then.
    realigned: bool,
}

impl Progress {
    /// Notes whether the end is reached now, and says for how long it has been.
    fn stayed_ms(&mut self, now_ms: u64, reached: bool) -> Option<u64> {
        if !reached {
            self.reached_ms = None;
            return None;
        }
        Some(now_ms - *self.reached_ms.get_or_insert(now_ms))
    }
}

impl Mission {
    /// The script from its first step on.
    pub fn new(script: Script, settings: Settings) -> Self {
        let mut steps = script.steps.into_iter();
        let step = steps.next();
        Self {
            settings,
            phase: step.as_ref().map_or(Phase::Recording, phase),
            step,
            steps,
            progress: Progress::default(),
            button: Mode::Idle,
        }
    }

    /// The operator presses a button.
    pub fn press(&mut self, button: Mode) {
        self.button = button;
    }

    /// Whether the script or the camera leads.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// The camera has turned to a snapshot.
    pub fn on_active_snapshot(&mut self, index: u16) {
        self.progress.at_first |= index == FIRST_SNAPSHOT;
    }

    /// A correction has been applied.
    pub fn on_realignment(&mut self) {
        if self.progress.at_first && !self.progress.realigned {
            self.progress.realigned = true;
            self.progress.reached_ms = None;
        }
    }

    /// One cycle.
    pub fn cycle(&mut self, view: &View, camera: &mut Camera) -> Decision {
        let Some(step) = self.step.take() else {
            return Decision::Land(Outcome::Completed);
        };
        let began_ms = *self.progress.began_ms.get_or_insert(view.now_ms);
        let elapsed_ms = view.now_ms - began_ms;
        let (decision, done) = match &step {
            Step::Command { mode, args } => self.command(*mode, args, elapsed_ms, camera),
            Step::FlyTo { place, arrival } => self.fly_to(*place, *arrival, view),
            Step::Follow { mode, until } => {
                let target = camera.follow(*mode);
                self.progress.led |= target.is_some();
                let done = self.followed(*until, elapsed_ms, view, target.is_some());
                (self.follow(target, elapsed_ms), done)
            }
            Step::Realign { place } => (realign(*place, view, camera), true),
            Step::Buttons => (self.obey_buttons(camera), false),
        };
        if done {
            self.step = self.steps.next();
            self.phase = self.step.as_ref().map_or(self.phase, phase);
            self.progress = Progress::default();
        } else {
            self.step = Some(step);
        }
        decision
    }

    fn command(
        &self,
        mode: Mode,
        args: &[u8],
        elapsed_ms: u64,
        camera: &mut Camera,
    ) -> (Decision, bool) {
        let echoed = camera.command(mode, args);
        let decision = if elapsed_ms >= self.settings.echo_limit_ms {
            Decision::Land(Outcome::NoEcho)
        } else {
            Decision::Hold
        };
        (decision, echoed)
    }

    fn fly_to(&mut self, place: WorldPoint, arrival: Arrival, view: &View) -> (Decision, bool) {
        let (from, here) = match view.pilot {
            None => (view.set_point, view.position),
            Some(pilot) => {
                let led_to = self.progress.led_to;
                let from = led_to.unwrap_or_else(|| pilot.on_the_ground(view.set_point));
                (from, pilot.on_the_ground(view.position))
            }
        };
        let led_to = match self.settings.cruise_speed_m_s {
            Some(speed) => towards(from, place, speed * CYCLE_S),
            None => place,
        };
        self.progress.led_to = Some(led_to);
        // Once reached, the dwell runs on even if the drone swings out of the radius.
        let there = led_to == place && distance_m(here, place) <= arrival.radius_m;
        let reached = there || self.progress.reached_ms.is_some();
        let stayed_ms = self.progress.stayed_ms(view.now_ms, reached);
        let done = stayed_ms >= Some(arrival.dwell_ms);
        let set_point = view
            .pilot
            .map_or(led_to, |pilot| pilot.in_the_filter(led_to));
        (Decision::GoTo(set_point), done)
    }

    fn follow(&self, target: Option<WorldPoint>, elapsed_ms: u64) -> Decision {
        if elapsed_ms >= self.settings.follow_limit_ms {
            return Decision::Land(Outcome::TimedOut);
        }
        target.map_or(Decision::Hold, Decision::GoTo)
    }

    /// The operator leads.
    fn obey_buttons(&mut self, camera: &mut Camera) -> Decision {
        let mode = self.button;
        if leads(mode) {
            self.phase = Phase::Following;
            camera.follow(mode).map_or(Decision::Hold, Decision::GoTo)
        } else {
            self.phase = Phase::Recording;
            camera.command(mode, &[]);
            Decision::Hold
        }
    }

    /// Whether following is done.
    fn followed(&mut self, until: Until, elapsed_ms: u64, view: &View, turned: bool) -> bool {
        let there = distance_m(view.position, view.set_point) <= Arrival::PASS_END.radius_m;
        let resting = there && self.progress.led && !turned;
        match until {
            Until::Home if self.progress.realigned => {
                self.progress.stayed_ms(view.now_ms, true) >= Some(Until::SETTLE_MS)
            }
            Until::Home => {
                let reached = resting && self.progress.at_first;
                self.progress.stayed_ms(view.now_ms, reached) >= Some(Until::REST_MS)
            }
            Until::TargetAt(place) => {
                let near = distance_m(view.set_point, place) <= Arrival::PASS_END.radius_m;
                let stayed_ms = self.progress.stayed_ms(view.now_ms, resting && near);
                stayed_ms >= Some(Arrival::PASS_END.dwell_ms)
            }
            Until::Elapsed(limit_ms) => elapsed_ms >= limit_ms,
        }
    }
}

/// Who leads in a step.
fn phase(step: &Step) -> Phase {
    match step {
        Step::Follow { .. } => Phase::Following,
        Step::Command { .. } | Step::FlyTo { .. } | Step::Realign { .. } | Step::Buttons => {
            Phase::Recording
        }
    }
}

/// Whether the camera leads in a mode.
fn leads(mode: Mode) -> bool {
    match mode {
        Mode::Follow | Mode::FollowAndStay => true,
        Mode::Idle | Mode::Clear | Mode::Record(_) => false,
    }
}

/// Tells the filter that the drone is at `place`, if the camera has led it there.
fn realign(place: WorldPoint, view: &View, camera: &Camera) -> Decision {
    match camera.realignment(place, view.height_m) {
        Ok(Some(measurements)) => Decision::Realign(measurements),
        Ok(None) => Decision::Hold,
        Err(Implausible::NotFinite | Implausible::TooLarge) => {
            Decision::Land(Outcome::BrokenMessage)
        }
    }
}

/// The place `step_m` from `from` on the way to `to`, or `to` where that is nearer.
fn towards(from: WorldPoint, to: WorldPoint, step_m: f32) -> WorldPoint {
    let way_m = distance_m(from, to);
    if way_m <= step_m {
        return to;
    }
    let part = step_m / way_m;
    WorldPoint {
        x: from.x + (to.x - from.x) * part,
        y: from.y + (to.y - from.y) * part,
    }
}
