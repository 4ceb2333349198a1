//! What is to be flown: route, world, seed and the navigator's settings.

mod conditions;
pub mod expectation;
pub mod file;
mod lens;
mod meander;
mod spacing;
mod storage;
mod wire_fault;

use autopilot::app::{self, Experiment, Script};
use clap::ValueEnum;
use link::{Mode, Record, WorldPoint};

pub use conditions::{
    Conditions, Correction, LARGEST_SWING, LIGHTS, Quirk, STRONGEST_WIND_M_S, SWING_PERIODS_S,
    Wind, flow_scale,
};
pub use lens::{LensFileError, LensPage};
pub use meander::{Meander, NoWay};
pub use spacing::{Distance, NoSpacing, Spacing};
pub use storage::{Deviation, SnapshotForm, Storage};
pub use wire_fault::{CameraTrouble, WireFault};

/// The scripted way out.
#[derive(Clone, Debug, Default, PartialEq, ValueEnum)]
pub enum Route {
    /// The paper's U (Fig. 6B): 5 m, 4 m, 5 m, out and back twice: 56 m
    #[default]
    U,
    /// The paper's S (Fig. 6A): 20 m out and back: 40 m
    S,
    /// One leg of 5 m (Fig. 5)
    Line,
    /// Round one corner, 4 m: seconds, for tests
    Corner,
    /// The leg of the corridor (Fig. 5C and D): 6 m out and back ten times: 120 m
    Corridor,
    /// A way of a scenario's own
    #[value(skip)]
    Own(Polyline),
    /// A whole experiment of the published app: ways, recording and homing are its own
    #[value(skip)]
    Experiment(Experiment),
    /// A script of a scenario's own: ways, recording and following are its own
    #[value(skip)]
    Scripted(Scripted),
}

/// What an operator lets the drone do, step by step.
#[derive(Clone, Debug, PartialEq)]
pub struct Scripted {
    /// The steps. Commands to record have no arguments here: they get the scenario's.
    pub steps: Vec<app::Step>,
}

impl Scripted {
    /// The script of the flight app, each command to record with these arguments.
    fn script(&self, arguments: &[u8]) -> Script {
        let mut steps = self.steps.clone();
        for step in &mut steps {
            if let app::Step::Command {
                mode: Mode::Record(_),
                args,
            } = step
            {
                args.extend_from_slice(arguments);
            }
        }
        Script { steps }
    }
}

/// A way through places.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// What it is called.
    pub name: String,
    /// North and east of the start, metres. The first is where recording begins.
    pub places: Vec<[f32; 2]>,
    /// How often it is flown, every second time backwards.
    pub passes: usize,
}

impl Route {
    /// The name on the command line and in the summary.
    pub fn name(&self) -> &str {
        match self {
            Self::U => "u",
            Self::S => "s",
            Self::Line => "line",
            Self::Corner => "corner",
            Self::Corridor => "corridor",
            Self::Own(polyline) => &polyline.name,
            Self::Experiment(experiment) => experiment.name(),
            Self::Scripted(_) => "script",
        }
    }

    /// The way points.
    pub fn waypoints(&self) -> app::Route {
        match self {
            Self::U => app::Route::u(),
            Self::S => app::Route::s(),
            // South, like the first leg of the U: the arena's middle is there.
            Self::Line => along(&[[0.0, 0.0], [-5.0, 0.0]], 1),
            Self::Corner => along(&[[0.0, 0.0], [-3.0, 0.0], [-3.0, 1.0]], 1),
            Self::Corridor => app::Route::corridor(),
            Self::Own(polyline) => along(&polyline.places, polyline.passes),
            Self::Experiment(experiment) => places_of(&experiment.script(Experiment::REPEATS)),
            Self::Scripted(scripted) => places_of(&scripted.script(&[])),
        }
    }
}

/// A route through places (north, east), metres.
fn along(places: &[[f32; 2]], passes: usize) -> app::Route {
    let places: Vec<_> = places
        .iter()
        .map(|[north, east]| WorldPoint::from_north_east(*north, *east))
        .collect();
    app::Route::passes(&places, passes)
}

/// The places that a script flies to, from the origin on.
fn places_of(script: &Script) -> app::Route {
    let flown_to = script.steps.iter().filter_map(|step| match step {
        app::Step::FlyTo { place, .. } => Some(*place),
        _ => None,
    });
    let start = WorldPoint::default();
    let places: Vec<_> = std::iter::once(start).chain(flown_to).collect();
    app::Route::through(&places)
}

/// How the drone finds back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Homing {
    /// Odometry between snapshots, homing at each (the paper's strategy)
    #[default]
    Both,
    /// Odometry alone: what the paper compares with
    Odometry,
    /// Homing from snapshot to snapshot, 0.25 m apart, without odometry (Fig. 6C); where one is missed
    /// nothing leads to the next
    Sequence,
    /// The same with another distance between snapshots than the firmware's own
    #[value(skip)]
    SequenceEvery(Distance),
}

impl Homing {
    /// The name on the command line and in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::Odometry => "odometry",
            Self::Sequence | Self::SequenceEvery(_) => "sequence",
        }
    }

    /// What the camera is told to record.
    pub fn record(self) -> Record {
        match self {
            Self::Both => Record::ROUTE,
            Self::Odometry => Record::ODOMETRY,
            Self::Sequence | Self::SequenceEvery(_) => Record::SEQUENCE,
        }
    }
}

/// One flight, except for the board that it is flown on.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// The way out.
    pub route: Route,
    /// A name that `fake_sensors::world` knows.
    pub world: String,
    /// Seed of world, sensors and camera noise.
    pub seed: u64,
    /// Between snapshots along odometry; a sequence has the firmware's own spacing.
    pub spacing: Spacing,
    /// What the route memory makes of the way.
    pub storage: Storage,
    /// How the drone finds back.
    pub homing: Homing,
    /// What the flight is up against.
    pub conditions: Conditions,
}

impl Scenario {
    /// What the operator lets the flight app do.
    pub fn script(&self) -> Script {
        let arguments = self.storage.arguments(self.spacing);
        match &self.route {
            Route::Experiment(experiment) => experiment.script(Experiment::REPEATS),
            Route::Scripted(scripted) => scripted.script(&arguments),
            route => {
                Script::record_and_return(&route.waypoints(), self.homing.record(), &arguments)
            }
        }
    }

    /// The distance between snapshots that holds in this flight, metres; NaN where the firmware finds it on
    /// the way.
    pub fn snapshot_spacing_m(&self) -> f64 {
        match self.homing {
            Homing::Both | Homing::Odometry => match self.spacing {
                Spacing::Every(distance) => distance.metres(),
                Spacing::ByTheory => f64::NAN,
            },
            Homing::SequenceEvery(distance) => distance.metres(),
            Homing::Sequence => pilot::Parameters::DEFAULT
                .navigator
                .sequence_spacing_m
                .into(),
        }
    }
}
