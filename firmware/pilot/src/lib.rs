//! The flight logic without the hardware: frames and messages in, messages and exposures out.
//!
//! The board's tasks and the rig's native backend run this same room, so that a flight is the same
//! flight on both, bit for bit. It has no clock and no peripherals: time comes as an argument.
//!
//! ```text
//! frame   -> horizon band -> exposure
//!      '---> horizon -> spectrum ---.
//! message -> command / pose --------+-> navigator -> outbox
//!                        |               |
//!                        '-> continuity -'  (which coordinates the autopilot counts in)
//! ```
#![no_std]

mod anchor;
mod continuity;
mod outbox;
mod reply;

use continuity::{Continuity, Verdict};
use heapless::Vec;
use link::{Message, State};
use nalgebra::Point2;
use nav::navigator::EVENTS_PER_STEP;
use nav::{
    CalibrationError, Derotation, ExposureController, ExposureParameters, FrameLayout, Horizon,
    LensCalibration, Navigator, PanoramaMap, Pose, SetPoint, SnapshotFormat, Spectrum, Step, Tilt,
};

pub use nav::{Event, Exposure};
pub use outbox::{Outbox, PERIOD_BYTES};

/// The frames that the camera delivers: 128 x 96 pixels, U Y V Y.
pub const FRAME_LAYOUT: FrameLayout = FrameLayout::SUBQCIF_UYVY;

/// One frame as the camera delivers it.
pub type Frame = [u8; FRAME_LAYOUT.bytes()];

/// What happened in the answer to one message.
pub type Events = Vec<Event, EVENTS_PER_STEP>;

/// Every how many STATE messages the camera says its mode without being asked: once a second. It is
/// the only way in which an autopilot recovers that believes in another mode.
const MODE_PERIOD_STATES: u8 = 10;

/// The argument that asks for snapshots as far apart as the drift of odometry allows, instead of a length.
pub const SPACING_BY_THEORY: u8 = u8::MAX;

/// Farther from the drone than this, metres, no target of a route can lie: the longest vector that is
/// stored, and what homing and a correction add.
pub const REACH_M: f32 = 12.7 * core::f32::consts::SQRT_2 + 1.0;

fn is_out_of_reach(vector: &SetPoint) -> bool {
    (vector.target - vector.start).norm() > REACH_M
}

/// What the pilot is made of.
#[derive(Clone, Copy, Debug)]
pub struct Parameters {
    /// The lens.
    pub lens: LensCalibration,
    /// Whether roll and pitch of STATE level the horizon. Off, as in the paper: the angles of this drone
    /// are small, and the published flight app sends zeros.
    pub derotate: bool,
    /// The autoexposure.
    pub exposure: ExposureParameters,
    /// The navigator.
    pub navigator: nav::Parameters,
}

impl Parameters {
    /// The flight board: default lens, gamma off as the sensor driver sets it. Luma above the black
    /// level is then proportional to exposure; the sensor's contrast cancels in the control.
    pub const DEFAULT: Self = Self {
        lens: LensCalibration::DEFAULT,
        derotate: false,
        exposure: ExposureParameters {
            gamma: 1.0,
            ..ExposureParameters::DEFAULT
        },
        navigator: nav::Parameters::DEFAULT,
    };
}

impl Default for Parameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What a frame told the pilot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameReport {
    /// Mean luma of the horizon band, 0..=255.
    pub mean_luma: f32,
    /// To be written to the sensor, if it is to change.
    pub exposure: Option<Exposure>,
}

/// What a level camera would see. Apart from the rest, which is quick and has no use for its registers.
#[cold]
#[inline(never)]
fn level(derotation: &Derotation, frame: &Frame, heading: f32, tilt: Tilt) -> Horizon {
    derotation.horizon(frame, heading, tilt)
}

/// What routes of fine snapshots see. Apart from the rest for the same reason.
#[cold]
#[inline(never)]
fn detailed_view(horizon: &Horizon) -> Spectrum {
    Spectrum::with_detail(horizon)
}

/// Eyes, memory and decisions.
#[derive(Debug)]
pub struct Pilot {
    map: PanoramaMap,
    /// Where it is switched on.
    derotation: Option<Derotation>,
    /// From the newest STATE that was believed.
    tilt: Tilt,
    exposure: ExposureController,
    navigator: Navigator,
    /// The newest view, aligned to north by the newest heading, until a STATE has used it: a camera
    /// that fails must not leave the navigator with an old view.
    view: Option<Spectrum>,
    /// Radians, from the newest STATE that was believed, in the route's coordinates.
    heading: f32,
    continuity: Continuity,
    states_since_mode: u8,
}

impl Pilot {
    /// A pilot on the ground: idle, with an empty route.
    ///
    /// # Errors
    /// [`CalibrationError`] where the lens makes no sense.
    pub fn new(parameters: &Parameters) -> Result<Self, CalibrationError> {
        Ok(Self {
            map: PanoramaMap::new(&parameters.lens, &FRAME_LAYOUT)?,
            derotation: if parameters.derotate {
                Some(Derotation::new(&parameters.lens, &FRAME_LAYOUT)?)
            } else {
                None
            },
            tilt: Tilt::default(),
            exposure: ExposureController::new(parameters.exposure),
            navigator: Navigator::new(parameters.navigator),
            view: None,
            heading: 0.0,
            continuity: Continuity::default(),
            states_since_mode: 0,
        })
    }

    /// Looks at a frame. Once per frame; takes effect with the next STATE.
    #[inline(never)]
    pub fn on_frame(&mut self, frame: &Frame) -> FrameReport {
        let (horizon, mean_luma) = self.map.horizon_and_band(frame, self.heading);
        let level = self
            .derotation
            .as_ref()
            .map(|derotation| level(derotation, frame, self.heading, self.tilt));
        let seen = level.as_ref().unwrap_or(&horizon);
        self.view = Some(if self.navigator.needs_detail() {
            detailed_view(seen)
        } else {
            Spectrum::of(seen)
        });
        FrameReport {
            mean_luma,
            exposure: self.exposure.update(mean_luma, || self.map.band(frame)),
        }
    }

    /// What the sensor should be set to.
    pub fn exposure(&self) -> Exposure {
        self.exposure.current()
    }

    /// The route and what is done with it.
    pub fn navigator(&self) -> &Navigator {
        &self.navigator
    }

    /// Hears a message; the answer is added to the outbox. `now_ms` are milliseconds and may wrap.
    ///
    /// Nothing is said before the autopilot has spoken: what a Crazyflie on the ground receives
    /// waits in its buffer and is taken for fresh at take-off.
    ///
    /// Returns what happened, in order, for the log.
    #[inline(never)]
    pub fn on_message(&mut self, now_ms: u32, message: &Message, outbox: &mut Outbox) -> Events {
        match message {
            Message::Command(command) => self.on_command(command, outbox),
            Message::State(state) => return self.on_state(now_ms, state, outbox),
            // The camera's own messages, echoed or misrouted.
            Message::Debug(_)
            | Message::Vector(_)
            | Message::Map(_)
            | Message::InsCorrection(_)
            | Message::Camera(_) => {}
        }
        Events::new()
    }

    /// Takes a command and says which mode holds now: the same byte if it was understood. An unknown
    /// one changes nothing.
    ///
    /// The published client sends no arguments. Those that follow, in this order, hold from now on; zero,
    /// or none, leaves what is: the way between two snapshots along odometry, decimetres, or
    /// [`SPACING_BY_THEORY`]; the number of the [`SnapshotFormat`] of the next route; how far a stored way
    /// may deviate from the one flown, decimetres.
    fn on_command(&mut self, command: &link::Command, outbox: &mut Outbox) {
        let before = self.navigator.mode_byte();
        let understood = self.navigator.command(command.command).is_ok();
        if self.navigator.mode_byte() != before {
            self.continuity.look_again();
        }
        if understood {
            self.take_arguments(&command.args);
        }
        self.say_mode(outbox);
    }

    fn take_arguments(&mut self, arguments: &[u8]) {
        let argument = |index: usize| arguments.get(index).copied().unwrap_or(0);
        let metres = |decimetres: u8| f32::from(decimetres) / 10.0;
        match argument(0) {
            SPACING_BY_THEORY => self.navigator.space_snapshots_by_theory(),
            decimetres => self.navigator.set_snapshot_spacing(metres(decimetres)),
        }
        if let Some(format) = SnapshotFormat::from_number(argument(1)) {
            self.navigator.set_snapshot_format(format);
        }
        self.navigator.set_simplify_tolerance(metres(argument(2)));
    }

    fn on_state(&mut self, now_ms: u32, state: &State, outbox: &mut Outbox) -> Events {
        let Ok(pose) = state.pose() else {
            return Events::from_iter([Event::InvalidPose]);
        };
        let pose = Pose::new(Point2::new(pose.x, pose.y), pose.yaw);
        self.tilt = Tilt {
            roll_rad: state.phi,
            pitch_rad: state.theta,
        };
        let step = self.answer(now_ms, &pose);
        reply::push(&step, outbox);
        self.states_since_mode += 1;
        if self.states_since_mode >= MODE_PERIOD_STATES {
            self.say_mode(outbox);
        }
        step.events
    }

    /// What to do about the autopilot's pose, in the autopilot's coordinates.
    fn answer(&mut self, now_ms: u32, pose: &Pose) -> Step {
        if self.navigator.route().is_empty() && !self.navigator.leads() {
            // Whatever origin the autopilot has now is the next route's.
            self.continuity = Continuity::default();
        }
        match self.continuity.judge(
            now_ms,
            pose,
            self.view.as_ref(),
            self.navigator.parameters(),
        ) {
            Verdict::GoesOn(here) => self.go_on(now_ms, pose, &here),
            Verdict::NewOrigin(here) => {
                self.navigator.resume();
                let mut step = self.go_on(now_ms, pose, &here);
                // First of at most five.
                let _ = step.events.insert(0, Event::NewOrigin);
                step
            }
            Verdict::Doubtful { news } => Step {
                events: news.then_some(Event::PoseDoubtful).into_iter().collect(),
                ..Step::default()
            },
            Verdict::Lost { stay, news } => self.stay(&stay, pose, news),
        }
    }

    /// A step of the navigator `here` on the route, where the autopilot's pose is `pose`.
    fn go_on(&mut self, now_ms: u32, pose: &Pose, here: &Pose) -> Step {
        self.heading = here.heading;
        let view = self.view.take();
        let step = self.navigator.step(now_ms, here, view.as_ref());
        self.continuity.remember(now_ms, here, view, &step);
        if step.vector.is_some_and(|vector| is_out_of_reach(&vector)) {
            self.continuity.lose(pose);
            return self.stay(&pose.position, pose, true);
        }
        self.continuity.to_autopilot(step)
    }

    /// A safe stop: nothing is recorded, and where the camera leads it leads nowhere.
    fn stay(&self, stay: &Point2<f32>, pose: &Pose, news: bool) -> Step {
        let vector = SetPoint {
            source: nav::Source::Odometry,
            target: *stay,
            start: pose.position,
            delta_yaw: 0.0,
        };
        Step {
            vector: self.navigator.leads().then_some(vector),
            events: news.then_some(Event::Lost).into_iter().collect(),
            ..Step::default()
        }
    }

    fn say_mode(&mut self, outbox: &mut Outbox) {
        self.states_since_mode = 0;
        reply::push_mode(self.navigator.mode_byte(), outbox);
    }
}
