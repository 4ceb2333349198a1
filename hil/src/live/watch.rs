//! What the messages on the link tell of a flight whose autopilot is not ours.

use autopilot::app;
use link::{Command, InsCorrection, Message, Mode, Record, WorldPose};

use crate::record::PlanarPose;
use crate::scenario::{Homing, SnapshotForm, Spacing};

/// Bit that separates following from recording in a command byte.
const FOLLOWING: u8 = 0x10;

/// Follows both directions.
#[derive(Debug, Default)]
pub struct Watch {
    /// The mode that the firmware reports.
    mode: Option<u8>,
    /// What the newest route was recorded with.
    recorded: Option<u8>,
    /// What the first argument of the newest recording command asked for.
    spacing: Option<Spacing>,
    /// What the last second argument asked for.
    snapshot_form: SnapshotForm,
    estimate: PlanarPose,
    drift: Drift,
    finished: bool,
}

/// What is special about a message of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// It now is in this mode.
    Mode(u8),
    /// It has forgotten a route and begins a new one.
    NewRoute,
}

impl Watch {
    /// The autopilot believes to be there.
    pub fn on_state(&mut self, pose: WorldPose) {
        self.estimate = planar(pose);
    }

    /// The autopilot has sent a command.
    pub fn on_command(&mut self, command: &Command) {
        if records(command.command) {
            let asked = command.args.first();
            self.spacing = asked.and_then(|argument| Spacing::from_argument(*argument));
            let number = command.args.get(1).copied().unwrap_or(0);
            if let Some(form) = SnapshotForm::from_number(number) {
                self.snapshot_form = form;
            }
        }
    }

    /// The firmware has sent a message.
    pub fn on_answer(&mut self, message: &Message) -> Option<Turn> {
        match message {
            Message::Command(command) => self.on_mode(command.command),
            Message::InsCorrection(correction) => {
                self.drift.on_correction(correction);
                None
            }
            _ => None,
        }
    }

    fn on_mode(&mut self, mode: u8) -> Option<Turn> {
        if self.mode.replace(mode) == Some(mode) {
            return None;
        }
        if records(mode) {
            self.recorded = Some(mode);
        }
        if mode == Mode::Clear.byte() && self.recorded.is_some() {
            *self = Self {
                mode: Some(mode),
                estimate: self.estimate,
                ..Self::default()
            };
            return Some(Turn::NewRoute);
        }
        Some(Turn::Mode(mode))
    }

    /// The firmware has logged a line.
    pub fn on_log(&mut self, text: &str) {
        self.finished |= text == "RouteFinished" && self.mode.is_some_and(follows);
    }

    /// What the drone does, if it is in the air.
    pub fn phase(&self, airborne: bool) -> app::Phase {
        match self.mode {
            Some(mode) if airborne && follows(mode) => app::Phase::Following,
            Some(mode) if airborne && records(mode) => app::Phase::Recording,
            _ => app::Phase::Ground,
        }
    }

    /// Where the drone believes to be.
    pub fn estimate(&self) -> PlanarPose {
        self.estimate
    }

    /// Where it would believe to be without the corrections, had it taken each one as it stands.
    pub fn uncorrected(&self) -> PlanarPose {
        self.drift.undo(self.estimate)
    }

    /// Whether the firmware has followed the route to its end.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// How the drone is to find back.
    pub fn homing(&self) -> Homing {
        [Homing::Odometry, Homing::Sequence]
            .into_iter()
            .find(|homing| self.recorded == Some(Mode::Record(homing.record()).byte()))
            .unwrap_or_default()
    }

    /// How the snapshots of a route that is begun now are stored.
    pub fn snapshot_form(&self) -> SnapshotForm {
        self.snapshot_form
    }

    /// The way between two snapshots that was asked for.
    pub fn spacing(&self) -> Option<Spacing> {
        self.spacing
    }
}

/// What a camera in this mode does, for people.
pub fn mode_name(mode: u8) -> &'static str {
    match mode {
        _ if mode == Mode::Idle.byte() => "idle",
        _ if mode == Mode::Clear.byte() => "forgot its route",
        _ if records(mode) => "records",
        _ if follows(mode) => "follows",
        _ => "unknown",
    }
}

fn follows(mode: u8) -> bool {
    mode & FOLLOWING != 0
}

fn records(mode: u8) -> bool {
    let all = Mode::Record(Record::SEQUENCE_WITH_ODOMETRY).byte();
    mode != 0 && mode <= all
}

fn planar(pose: WorldPose) -> PlanarPose {
    PlanarPose {
        x: pose.x.into(),
        y: pose.y.into(),
        yaw: pose.yaw.into(),
    }
}

/// All corrections so far, as one turn about the origin and one shift after it.
#[derive(Debug, Default)]
struct Drift {
    shift: PlanarPose,
    index: Option<u16>,
}

impl Drift {
    /// A new correction: what was called `from` is `to`. The firmware repeats it, the autopilot does
    /// not.
    fn on_correction(&mut self, correction: &InsCorrection) {
        let Ok((from, to)) = correction.poses() else {
            return;
        };
        if self.index.replace(correction.snapshot_index) == Some(correction.snapshot_index) {
            return;
        }
        let (from, to) = (planar(from), planar(to));
        let turn = to.yaw - from.yaw;
        let before = self.undo(from);
        let yaw = self.shift.yaw + turn;
        let (x, y) = rotated(before.x, before.y, yaw);
        self.shift = PlanarPose {
            x: to.x - x,
            y: to.y - y,
            yaw,
        };
    }

    /// A pose as it was called before any correction.
    fn undo(&self, pose: PlanarPose) -> PlanarPose {
        let (x, y) = rotated(
            pose.x - self.shift.x,
            pose.y - self.shift.y,
            -self.shift.yaw,
        );
        PlanarPose {
            x,
            y,
            yaw: pose.yaw - self.shift.yaw,
        }
    }
}

fn rotated(x: f64, y: f64, yaw: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(yaw);
    (cos * x - sin * y, sin * x + cos * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f32, y: f32, yaw: f32) -> WorldPose {
        WorldPose { x, y, yaw }
    }

    fn correction(index: u16, from: WorldPose, to: WorldPose) -> Message {
        Message::InsCorrection(InsCorrection::from_world(index, from, to).expect("plausible"))
    }

    fn mode(mode: Mode) -> Message {
        Message::Command(Command {
            command: mode.byte(),
            ..Command::default()
        })
    }

    #[test]
    fn corrections_undone_in_turn_give_what_was_believed_at_first() {
        let mut watch = Watch::default();
        watch.on_answer(&correction(1, pose(1.0, 2.0, 0.1), pose(1.5, 1.0, 0.4)));
        watch.on_state(pose(1.5, 1.0, 0.4));
        assert_near(watch.uncorrected(), [1.0, 2.0, 0.1]);
        // The same index is the same correction.
        watch.on_answer(&correction(1, pose(1.0, 2.0, 0.1), pose(1.5, 1.0, 0.4)));
        assert_near(watch.uncorrected(), [1.0, 2.0, 0.1]);
        watch.on_answer(&correction(2, pose(1.5, 1.0, 0.4), pose(-3.0, 0.0, -0.2)));
        watch.on_state(pose(-3.0, 0.0, -0.2));
        assert_near(watch.uncorrected(), [1.0, 2.0, 0.1]);
    }

    fn assert_near(pose: PlanarPose, [x, y, yaw]: [f64; 3]) {
        let error = (pose.x - x).abs() + (pose.y - y).abs() + (pose.yaw - yaw).abs();
        assert!(error < 1e-5, "{pose:?}");
    }

    #[test]
    fn phases_follow_the_modes_that_the_firmware_reports_in_the_air() {
        let mut watch = Watch::default();
        assert_eq!(watch.phase(true), app::Phase::Ground);
        watch.on_answer(&mode(Mode::Record(Record::ROUTE)));
        assert_eq!(watch.phase(true), app::Phase::Recording);
        watch.on_answer(&mode(Mode::Follow));
        assert_eq!(watch.phase(true), app::Phase::Following);
        assert_eq!(watch.phase(false), app::Phase::Ground);
    }

    #[test]
    fn clear_begins_a_new_route_only_where_there_is_one() {
        let mut watch = Watch::default();
        let turn = |watch: &mut Watch, to| watch.on_answer(&mode(to));
        assert_eq!(turn(&mut watch, Mode::Clear), Some(Turn::Mode(0x0f)));
        assert_eq!(turn(&mut watch, Mode::Clear), None);
        turn(&mut watch, Mode::Record(Record::ROUTE));
        turn(&mut watch, Mode::Follow);
        watch.on_log("RouteFinished");
        assert!(watch.finished());
        assert_eq!(turn(&mut watch, Mode::Clear), Some(Turn::NewRoute));
        assert!(!watch.finished());
    }

    #[test]
    fn the_recording_command_tells_how_the_drone_finds_back() {
        for homing in [Homing::Both, Homing::Odometry, Homing::Sequence] {
            let mut watch = Watch::default();
            watch.on_answer(&mode(Mode::Record(homing.record())));
            assert_eq!(watch.homing(), homing);
        }
    }
}
