//! The app itself: from the ground to the ground, one millisecond at a time.

use link::{Mode, WorldPoint, WorldPose};
use nalgebra::Vector3;

use super::camera::{Camera, Counters, News, Received};
use super::mission::{Decision, Mission, View};
use super::phase::{Outcome, Phase};
use super::pilot::Pilot;
use super::reception::Dropped;
use super::safety;
use super::script::Script;
use super::settings::{CYCLE_MS, FLIGHT_HEIGHT_M, Settings};
use super::signals::Signals;
use super::vertical;
use crate::controller::SetPoint;
use crate::ekf::{Estimate, Measurement, Position};

/// What one millisecond asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Bytes to send to the camera.
    pub transmit: Vec<u8>,
    /// What the controller is to do.
    pub set_point: SetPoint,
    /// Whether the filter is to start afresh.
    pub reset_filter: bool,
    /// What to put into the filter's queue, in this order.
    pub measurements: Vec<Measurement>,
}

/// What the app is doing, with what it needs for that.
#[derive(Debug, Clone, Copy)]
enum Stage {
    Ground,
    /// From the filter's reset at `since_ms` to the hover; the climb starts at `from`.
    TakeOff {
        since_ms: u64,
        from: Option<WorldPose>,
    },
    Airborne {
        since_ms: u64,
    },
    Landing {
        since_ms: u64,
        height_m: f32,
        outcome: Outcome,
    },
    Landed(Outcome),
}

/// The app on board, with its script.
#[derive(Debug)]
pub struct FlightApp {
    settings: Settings,
    signals: Signals,
    mission: Mission,
    camera: Camera,
    stage: Stage,
    /// Whether the motors stand still in this flight.
    dry_run: bool,
    /// Time of the first tick, ms.
    started_ms: Option<u64>,
    /// Where to be, m.
    position_m: Vector3<f32>,
    /// Heading to hold, rad, counter-clockwise: that of the take-off.
    yaw_rad: f32,
    /// Decided in a cycle, issued at the end of its receive window.
    next_target: Option<WorldPoint>,
    /// What the operator has asked for from outside the script.
    ordered: Option<Outcome>,
    /// Where a pilot sees the drone, if there is one.
    seen: Option<WorldPose>,
}

impl FlightApp {
    /// An app on the ground that will fly `script`.
    pub fn new(script: Script, settings: Settings) -> Self {
        Self {
            settings,
            signals: Signals::default(),
            mission: Mission::new(script, settings),
            camera: Camera::new(&settings),
            stage: Stage::Ground,
            dry_run: false,
            started_ms: None,
            position_m: Vector3::zeros(),
            yaw_rad: 0.0,
            next_target: None,
            ordered: None,
            seen: None,
        }
    }

    /// One millisecond: `estimate` is the filter's newest, `received` what arrived from the camera
    /// since the last call. To be called once for each `now_ms`, in order.
    pub fn tick(&mut self, now_ms: u64, estimate: &Estimate, received: &[u8]) -> Output {
        self.camera.arrive(now_ms, received);
        let mut output = Output {
            transmit: Vec::new(),
            set_point: SetPoint::MotorsOff,
            reset_filter: false,
            measurements: Vec::new(),
        };
        self.obey(now_ms, estimate);
        match self.stage {
            Stage::Ground => self.stand(now_ms, estimate, &mut output),
            Stage::TakeOff { since_ms, from } => self.take_off(now_ms, since_ms, from, estimate),
            Stage::Airborne { since_ms } => self.fly(now_ms, since_ms, estimate, &mut output),
            Stage::Landing {
                since_ms,
                height_m,
                outcome,
            } => self.land(now_ms - since_ms, height_m, outcome),
            Stage::Landed(_) => self.rest(now_ms, estimate, &mut output),
        }
        output.set_point = self.set_point();
        output
    }

    /// What the app is doing.
    pub fn phase(&self) -> Phase {
        match self.stage {
            Stage::Ground => Phase::Ground,
            Stage::TakeOff { .. } => Phase::TakeOff,
            Stage::Airborne { .. } => self.mission.phase(),
            Stage::Landing { .. } => Phase::Landing,
            Stage::Landed(outcome) => Phase::Landed(outcome),
        }
    }

    /// The operator's red button: the motors stop with the next tick and never start again.
    pub fn kill(&mut self) {
        self.ordered = Some(Outcome::Killed);
    }

    /// The operator's land button.
    pub fn command_landing(&mut self) {
        self.ordered.get_or_insert(Outcome::LandCommanded);
    }

    /// One of the operator's buttons for the camera: any [`Mode`]. Obeyed in [`super::Step::Buttons`].
    pub fn press(&mut self, button: Mode) {
        self.mission.press(button);
    }

    /// A pilot sees the drone there, relative to its take-off, and leads it along the script's legs on the ground
    /// from now on, where they would else be legs of the filter's drifting coordinates.
    pub fn set_seen(&mut self, seen: WorldPose) {
        self.seen = Some(seen);
    }

    /// The switches and the drone's health from now on. The app starts with [`Signals::default`].
    pub fn set_signals(&mut self, signals: Signals) {
        self.signals = signals;
    }

    /// The messages handled since the last call, in order.
    pub fn take_received(&mut self) -> Vec<Received> {
        self.camera.take_received()
    }

    /// The frames of the camera that were dropped since the last call, in the order in which that
    /// became certain.
    pub fn take_dropped(&mut self) -> Vec<Dropped> {
        self.camera.take_dropped()
    }

    /// How often each thing happened.
    pub fn counters(&self) -> Counters {
        self.camera.counters()
    }

    fn set_point(&self) -> SetPoint {
        if self.motors_turn() {
            SetPoint::Hold {
                position_m: self.position_m,
                yaw_rad: self.yaw_rad,
            }
        } else {
            SetPoint::MotorsOff
        }
    }

    fn motors_turn(&self) -> bool {
        match self.stage {
            Stage::Ground | Stage::Landed(_) => false,
            Stage::TakeOff { from, .. } => from.is_some() && !self.dry_run,
            Stage::Airborne { .. } => !self.dry_run,
            Stage::Landing { .. } => true,
        }
    }

    /// Does what the operator has asked for.
    fn obey(&mut self, now_ms: u64, estimate: &Estimate) {
        match self.ordered {
            Some(Outcome::Killed) if self.motors_turn() => {
                self.stage = Stage::Landed(Outcome::Killed)
            }
            Some(outcome) => self.begin_landing(now_ms, estimate, outcome),
            None => {}
        }
    }

    fn stand(&mut self, now_ms: u64, estimate: &Estimate, output: &mut Output) {
        let started_ms = *self.started_ms.get_or_insert(now_ms);
        let is_calibrated = now_ms - started_ms >= self.settings.ground_ms;
        if !is_calibrated || safety::forbids_take_off(&self.settings, &self.signals) {
            self.zero(now_ms, estimate, output);
            return;
        }
        self.dry_run = self.signals.dry_run;
        output.reset_filter = true;
        self.stage = Stage::TakeOff {
            since_ms: now_ms,
            from: None,
        };
    }

    /// Tells the filter ten times a second that a drone on the ground is at the origin.
    fn zero(&self, now_ms: u64, estimate: &Estimate, output: &mut Output) {
        let height_m = estimate.position_m.z;
        if self.settings.zeroes_on_ground && self.is_cycle(now_ms) && height_m.is_finite() {
            output.measurements.push(Measurement::Position(Position {
                position_m: Vector3::new(0.0, 0.0, height_m),
                sd_m: self.settings.correction.position_m,
            }));
        }
    }

    /// On the ground after the flight.
    fn rest(&mut self, now_ms: u64, estimate: &Estimate, output: &mut Output) {
        self.camera.abandon(now_ms);
        self.zero(now_ms, estimate, output);
    }

    fn take_off(
        &mut self,
        now_ms: u64,
        since_ms: u64,
        from: Option<WorldPose>,
        estimate: &Estimate,
    ) {
        let Some(climbing_ms) = (now_ms - since_ms).checked_sub(vertical::RESET_MS) else {
            return;
        };
        let from = from.unwrap_or_else(|| pose(estimate));
        self.position_m = Vector3::new(from.x, from.y, vertical::climb_m(climbing_ms));
        self.yaw_rad = from.yaw;
        if !self.dry_run && climbing_ms < vertical::CLIMB_MS + vertical::HOVER_MS {
            self.stage = Stage::TakeOff {
                since_ms,
                from: Some(from),
            };
        } else {
            self.camera.begin(now_ms);
            self.stage = Stage::Airborne { since_ms: now_ms };
        }
    }

    /// Whether the loop runs in this millisecond.
    fn is_cycle(&self, now_ms: u64) -> bool {
        now_ms % CYCLE_MS == self.settings.cycle_offset_ms % CYCLE_MS
    }

    fn fly(&mut self, now_ms: u64, since_ms: u64, estimate: &Estimate, output: &mut Output) {
        if self.is_cycle(now_ms) {
            match self.decide(now_ms, since_ms, estimate) {
                Decision::Land(outcome) => {
                    self.begin_landing(now_ms, estimate, outcome);
                    return;
                }
                Decision::GoTo(target) => self.next_target = Some(target),
                Decision::Realign(measurements) => output.measurements.extend(measurements),
                Decision::Hold => {}
            }
            output.transmit = self.camera.report(now_ms, pose(estimate));
        }
        if !self.camera.listening() {
            return;
        }
        self.camera.listen(now_ms);
        if self.camera.listening() {
            return;
        }
        match self.camera.act(now_ms, estimate.position_m) {
            Ok(news) => {
                for news in news {
                    self.take(news, output);
                }
                self.issue_set_point();
            }
            Err(_implausible) => self.begin_landing(now_ms, estimate, Outcome::BrokenMessage),
        }
    }

    fn take(&mut self, news: News, output: &mut Output) {
        match news {
            News::ActiveSnapshot(index) => self.mission.on_active_snapshot(index),
            News::Realigned(measurements) => {
                self.mission.on_realignment();
                output.measurements.extend(measurements);
            }
        }
    }

    /// The first part of a run of the loop: whether to go on, and where.
    fn decide(&mut self, now_ms: u64, since_ms: u64, estimate: &Estimate) -> Decision {
        let danger = safety::danger(&self.settings, &self.signals, self.dry_run, estimate);
        if let Some(danger) = danger {
            return Decision::Land(danger);
        }
        if now_ms - since_ms >= self.settings.flight_limit_ms {
            return Decision::Land(Outcome::TimedOut);
        }
        let view = View {
            now_ms,
            position: pose(estimate).point(),
            height_m: estimate.position_m.z,
            set_point: WorldPoint {
                x: self.position_m.x,
                y: self.position_m.y,
            },
            pilot: self.seen.map(|seen| Pilot {
                seen,
                believed: pose(estimate),
            }),
        };
        self.mission.cycle(&view, &mut self.camera)
    }

    /// The last part of a run of the loop, when the window has closed.
    fn issue_set_point(&mut self) {
        if let Some(target) = self.next_target.take() {
            self.position_m = Vector3::new(target.x, target.y, FLIGHT_HEIGHT_M);
        }
    }

    /// Straight down from here; where the filter does not know where that is, from the set-point.
    /// Does nothing to a drone that is landing already. Motors that stand still are not started.
    fn begin_landing(&mut self, now_ms: u64, estimate: &Estimate, outcome: Outcome) {
        if matches!(self.stage, Stage::Landing { .. } | Stage::Landed(_)) {
            return;
        }
        self.camera.stop_listening(now_ms);
        self.next_target = None;
        if !self.motors_turn() {
            self.stage = Stage::Landed(outcome);
            return;
        }
        let here = estimate.position_m;
        if here.iter().all(|coordinate| coordinate.is_finite()) {
            self.position_m = here;
        }
        self.stage = Stage::Landing {
            since_ms: now_ms,
            height_m: self.position_m.z,
            outcome,
        };
    }

    fn land(&mut self, elapsed_ms: u64, height_m: f32, outcome: Outcome) {
        self.position_m.z = vertical::descent_m(elapsed_ms, height_m);
        if elapsed_ms >= vertical::DESCENT_MS {
            self.stage = Stage::Landed(outcome);
        }
    }
}

fn pose(estimate: &Estimate) -> WorldPose {
    WorldPose {
        x: estimate.position_m.x,
        y: estimate.position_m.y,
        yaw: estimate.yaw_rad(),
    }
}
