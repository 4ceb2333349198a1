//! What an operator lets the drone do, step by step, as a scenario's file describes it.

use std::ops::RangeInclusive;

use autopilot::app::{Arrival, Step, Until};
use link::{Mode, Record, WorldPoint};
use serde::Deserialize;

use super::way::LENGTHS_M;
use crate::scenario::{Route, Scripted};

/// How long the camera may lead in one step, seconds.
const TIMES_S: RangeInclusive<f64> = 0.1..=10_000.0;

/// One step.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StepTable {
    /// Forget the route.
    Clear,
    /// The camera rests and keeps the route; the drone stays where it is.
    Idle,
    /// Record from here on.
    Record(RecordName),
    /// Fly to a place, north and east of the start.
    FlyTo([f32; 2]),
    /// Follow the route to its first snapshot.
    FollowHome,
    /// Follow the route for so many seconds.
    FollowFor(f64),
    /// Home at the last snapshot for so many seconds.
    StayFor(f64),
}

/// What is recorded.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RecordName {
    /// Odometry, and snapshots along it.
    Both,
    /// Odometry alone.
    Odometry,
    /// A visual sequence.
    Sequence,
    /// One snapshot.
    Snapshot,
}

/// The steps as the flight app flies them, or what is wrong with them.
pub fn check(tables: &[StepTable]) -> Result<Scripted, String> {
    let steps: Result<Vec<_>, _> = tables.iter().map(check_step).collect();
    let scripted = Scripted { steps: steps? };
    let length_m = Route::Scripted(scripted.clone()).waypoints().length_m();
    if length_m > *LENGTHS_M.end() {
        return Err(format!(
            "a way of {length_m} m: {} m at most",
            LENGTHS_M.end()
        ));
    }
    match scripted.steps.last() {
        Some(Step::Follow { .. }) => Ok(scripted),
        _ => Err("a script ends with following".to_owned()),
    }
}

fn check_step(table: &StepTable) -> Result<Step, String> {
    let command = |mode| Step::Command { mode, args: vec![] };
    let follow = |mode, until| Step::Follow { mode, until };
    let elapsed = |seconds: f64| {
        let (least, most) = (TIMES_S.start(), TIMES_S.end());
        if TIMES_S.contains(&seconds) {
            Ok(Until::Elapsed((1_000.0 * seconds) as u64))
        } else {
            Err(format!("{seconds} s: from {least} to {most} s"))
        }
    };
    Ok(match *table {
        StepTable::Clear => command(Mode::Clear),
        StepTable::Idle => command(Mode::Idle),
        StepTable::Record(what) => command(Mode::Record(match what {
            RecordName::Both => Record::ROUTE,
            RecordName::Odometry => Record::ODOMETRY,
            RecordName::Sequence => Record::SEQUENCE,
            RecordName::Snapshot => Record::SINGLE_SNAPSHOT,
        })),
        StepTable::FlyTo([north, east]) if north.is_finite() && east.is_finite() => Step::FlyTo {
            place: WorldPoint::from_north_east(north, east),
            arrival: Arrival::WAYPOINT,
        },
        StepTable::FlyTo(_) => return Err("a place that is no number".to_owned()),
        StepTable::FollowHome => follow(Mode::Follow, Until::Home),
        StepTable::FollowFor(seconds) => follow(Mode::Follow, elapsed(seconds)?),
        StepTable::StayFor(seconds) => follow(Mode::FollowAndStay, elapsed(seconds)?),
    })
}
