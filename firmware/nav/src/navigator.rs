//! The navigator: commands and poses in, set-points and corrections out.
//!
//! On the way out it records the route; on the way back it follows the stored odometry to each
//! snapshot, homes there by sight, realigns the pose and goes on (paper, Fig. 2C).
//!
//! The route is used up on the way back. A command begins with what is left of it:
//!
//! | command | the drone is | what is done |
//! |---|---|---|
//! | record | anywhere | the straight way from the route's end to the drone is stored, a snapshot is taken, and recording goes on |
//! | record | at home, the route is used up | a new route begins; without Clear none does before |
//! | follow | at the route's end, or on its way there | it is led home |
//! | follow | beside the route, up to 2 m away | the route beyond the nearest point is forgotten; from there it is led home |
//! | follow | farther away | it is told to stay where it is, and the route is kept |
//! | follow and stay | anywhere | it is led to the last snapshot; the route is kept |
//! | idle | anywhere | nothing is said any more: the autopilot holds the last set-point, and may land |
//!
//! Nothing on the link makes an autopilot land. A drone that is lost holds its position, and the MAP that is said
//! once a second from then on tells what is left of the route. What becomes of a way that is longer than the
//! memory stands at the head of `recorder`.

mod follower;
mod homing_run;
mod mode;
mod motion;
mod parameters;
mod place_fit;
mod realignment;
mod recorder;
mod spacing;
mod step;

use crate::pose::Pose;
use crate::route::Route;
use crate::snapshot::{Snapshot, SnapshotFormat};
use crate::spectrum::Spectrum;

use follower::{Context, Follower};
use motion::Motion;
use realignment::Realigner;
use recorder::Recorder;

pub use mode::{Mode, Recording, UnknownCommand};
pub use parameters::Parameters;
pub use spacing::{Drift, catchment, deviations_within};
pub use step::{Arrival, Correction, EVENTS_PER_STEP, Event, MapEntry, SetPoint, Source, Step};

/// The whole memory and logic of route following.
#[derive(Clone, Debug)]
pub struct Navigator {
    parameters: Parameters,
    route: Route,
    mode: Mode,
    activity: Activity,
    realigner: Realigner,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Activity {
    Resting,
    Recording(Recorder),
    Following(Follower),
}

impl Navigator {
    /// An idle navigator with an empty route.
    pub const fn new(parameters: Parameters) -> Self {
        Self {
            parameters,
            route: Route::new(),
            mode: Mode::Idle,
            activity: Activity::Resting,
            realigner: Realigner::new(),
            motion: Motion::new(),
        }
    }

    /// Obeys a command byte. The one that is already obeyed is a retransmission and changes nothing.
    ///
    /// # Errors
    ///
    /// [`UnknownCommand`]; the mode stays.
    pub fn command(&mut self, byte: u8) -> Result<Mode, UnknownCommand> {
        let mode = Mode::from_byte(byte).ok_or(UnknownCommand(byte))?;
        if mode == self.mode {
            return Ok(mode);
        }
        self.mode = mode;
        self.activity = match mode {
            Mode::Idle => Activity::Resting,
            Mode::Clear => {
                self.route.clear();
                Activity::Resting
            }
            Mode::Record(what) => Activity::Recording(Recorder::new(what)),
            Mode::FollowStay => Activity::Following(Follower::new(true)),
            Mode::Follow => Activity::Following(Follower::new(false)),
        };
        Ok(mode)
    }

    /// Begins the way anew from wherever the drone is, in the same mode: after a time without poses.
    /// The route stays as it is, and a drone that had finished it stays where it was.
    pub fn resume(&mut self) {
        if let Activity::Following(follower) = &mut self.activity {
            follower.resume();
        }
    }

    /// Whether the mode is one in which the camera leads.
    pub const fn leads(&self) -> bool {
        matches!(self.activity, Activity::Following(_))
    }

    /// The mode.
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// The byte of the last command obeyed: what is echoed, now and later.
    pub const fn mode_byte(&self) -> u8 {
        self.mode.byte()
    }

    /// The route memory.
    pub const fn route(&self) -> &Route {
        &self.route
    }

    /// The constants in force.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Changes the way between two snapshots along odometry, metres, from now on. What is not a
    /// positive number is ignored.
    pub const fn set_snapshot_spacing(&mut self, metres: f32) {
        if metres > 0.0 && metres.is_finite() {
            self.parameters.snapshot_spacing_m = metres;
            self.parameters.spacing_by_theory = false;
        }
    }

    /// Lets snapshots along odometry be as far apart as the drift allows, from now on.
    pub const fn space_snapshots_by_theory(&mut self) {
        self.parameters.spacing_by_theory = true;
    }

    /// How the snapshots of the next route that is begun are stored.
    pub const fn set_snapshot_format(&mut self, format: SnapshotFormat) {
        self.parameters.snapshot_format = format;
    }

    /// How far a stored way may deviate from the one flown, metres, from now on. What is not a positive
    /// number is ignored.
    pub const fn set_simplify_tolerance(&mut self, metres: f32) {
        if metres > 0.0 && metres.is_finite() {
            self.parameters.simplify_tolerance_m = metres;
        }
    }

    /// Whether views need their detail: to be stored, or to be compared with what is.
    pub fn needs_detail(&self) -> bool {
        let format = if self.route.is_empty() {
            self.parameters.snapshot_format
        } else {
            self.route.snapshots().format()
        };
        format.needs_detail() && !matches!(self.activity, Activity::Resting)
    }

    /// One step for each STATE message (10 Hz): the time (wrapping milliseconds), the autopilot's
    /// estimate, and the newest view, aligned by that estimate's heading; none where no frame came
    /// since the last step.
    pub fn step(&mut self, now_ms: u32, pose: &Pose, view: Option<&Spectrum>) -> Step {
        let mut step = Step::default();
        if !pose.is_plausible() {
            step.report(Event::InvalidPose);
            return step;
        }
        let seen_from = self.motion.seen_from(&self.parameters, pose.position);
        match &mut self.activity {
            Activity::Resting => {}
            Activity::Recording(recorder) => {
                let now = (now_ms, seen_from);
                recorder.step(&self.parameters, &mut self.route, now, view, &mut step);
                if step.has_snapshot() && recorder.stores_odometry() {
                    step.correction = self.realigner.anchor(&self.parameters, now_ms, pose);
                }
            }
            Activity::Following(follower) => {
                let mut context = Context {
                    parameters: &self.parameters,
                    route: &mut self.route,
                    realigner: &mut self.realigner,
                    now_ms,
                    pose,
                    view,
                    seen_from,
                };
                follower.step(&mut context, &mut step);
            }
        }
        step
    }
}

/// The route's end, with the last snapshot where that is news.
#[inline(never)] // Many ask for it, and seldom: flash counts more than cycles here.
fn map_entry(route: &Route, snapshot: Option<Snapshot>) -> MapEntry {
    // Both stacks hold fewer than 65536 entries.
    let index = |count: usize| u16::try_from(count).unwrap_or(u16::MAX);
    MapEntry {
        snapshot_index: index(route.snapshots().len().saturating_sub(1)),
        snapshot_position: route.top_snapshot_position().unwrap_or(route.tip()),
        odometry_index: index(route.vectors().len()),
        odometry_position: route.tip(),
        snapshot,
    }
}

#[cfg(test)]
mod tests;
