//! The published experiments on the native board, whole where seconds allow it.
//!
//! The U is flown by the native flights; the S and the long series here in one pass, or in their first rounds.

use autopilot::app::{Experiment, Outcome, Phase, Script, Settings, Step};
use nalgebra::Point2;

use super::rig::{self, Flown};

/// The arena without panels, from a place where an experiment of some metres to the north fits.
const SOUTH_END: (&str, [f64; 2]) = ("arena", [-6.5, -2.0]);
/// The middle of the same.
const MIDDLE: (&str, [f64; 2]) = ("arena", [-2.5, -2.0]);
/// Where the U and the S begin.
const CORNER: (&str, [f64; 2]) = ("arena-panels", [0.0, 0.0]);
/// The paper's radius for homing, m (Fig. 4).
const HOME_M: f64 = 0.5;

fn fly(script: Script, place: (&str, [f64; 2])) -> Flown {
    let flown = rig::fly(script, Settings::default(), place, |_| ());
    assert_eq!(flown.outcome, Outcome::Completed);
    assert_eq!(flown.dropped, []);
    flown
}

/// The first steps of a script.
fn first(mut script: Script, steps: usize) -> Script {
    script.steps.truncate(steps);
    script
}

/// The grid without its outermost starts: from 2.8 m away the views of this arena have too little in common.
fn inner_grid() -> Script {
    let Script { steps } = Experiment::SingleSnapshot.script(1);
    let (take_snapshot, starts) = steps.split_at(3);
    let is_inner = |start: &&[Step]| match start.first() {
        Some(Step::FlyTo { place, .. }) => place.x.abs() <= 1.0 && place.y.abs() <= 1.0,
        _ => false,
    };
    let inner = starts.chunks(4).filter(is_inner).flatten();
    Script {
        steps: take_snapshot.iter().chain(inner).cloned().collect(),
    }
}

/// Where the camera's leading began and ended each time, m.
fn led(flown: &Flown) -> Vec<[Point2<f64>; 2]> {
    let stages = flown.track.chunk_by(|a, b| a.1 == b.1);
    let following = stages.filter(|stage| stage[0].1 == Phase::Following);
    following
        .map(|stage| [stage[0].2, stage[stage.len() - 1].2])
        .collect()
}

#[test]
fn from_each_start_of_the_inner_grid_the_drone_homes_to_its_single_snapshot() {
    const SINGLE: u8 = 0x01;
    let flown = fly(inner_grid(), MIDDLE);
    let snapshot = flown.at(flown.first_heard(SINGLE));
    let led = led(&flown);
    assert_eq!(led.len(), 9);
    for [from, to] in led {
        let error_m = (to - snapshot).norm();
        assert!(error_m < HOME_M, "from {from} to {to}, not to {snapshot}");
    }
}

#[test]
fn after_legs_of_one_to_five_metres_two_seconds_of_homing_come_back_to_the_snapshot() {
    let flown = fly(Experiment::Rmse.script(1), SOUTH_END);
    let led = led(&flown);
    assert_eq!(led.len(), 5);
    for [_, to] in &led {
        assert!(to.coords.norm() < HOME_M, "{to}");
    }
    assert!(flown.counters.corrections_applied <= 5);
}

#[test]
fn one_snapshot_bounds_the_error_of_ten_rounds_in_the_corridor_and_odometry_alone_does_not() {
    let with = fly(Experiment::CorridorBoth.script(1), SOUTH_END);
    let led = led(&with);
    assert_eq!(led.len(), 10);
    for [_, to] in &led {
        assert!(to.coords.norm() < HOME_M, "{to}");
    }
    let without = fly(Experiment::CorridorOdometry.script(1), SOUTH_END);
    let (with_m, without_m) = (with.end().coords.norm(), without.end().coords.norm());
    assert!(without_m > 2.0 * with_m, "{with_m} m and {without_m} m");
}

#[test]
fn along_a_sequence_of_snapshots_the_corridor_is_flown_back() {
    // One round of ten: four steps.
    let script = first(Experiment::CorridorSnapshots.script(1), 4);
    let flown = fly(script, SOUTH_END);
    assert!(flown.end().coords.norm() < HOME_M, "{}", flown.end());
}

#[test]
fn one_pass_of_the_s_is_flown_home_with_odometry_between_snapshots_and_along_snapshots_alone() {
    let end = |experiment: Experiment| fly(experiment.script(1), CORNER).end().coords.norm();
    let both_m = end(Experiment::SBoth);
    assert!(both_m < HOME_M, "{both_m} m with both");
    let snapshots_m = end(Experiment::SSnapshots);
    assert!(snapshots_m < HOME_M, "{snapshots_m} m along snapshots");
}

#[test]
fn in_the_first_experiment_the_drone_hovers_until_it_is_told_to_land() {
    let Script { steps } = Experiment::Idle.script(1);
    assert_eq!(steps, [Step::Buttons]);
    let settings = Settings {
        flight_limit_ms: 10_000,
        ..Settings::default()
    };
    let flown = rig::fly(Script { steps }, settings, CORNER, |_| ());
    assert_eq!(flown.outcome, Outcome::TimedOut);
    // Before the flow sensor sees the floor, the climb drifts by some decimetres.
    assert!(flown.end().coords.norm() < HOME_M, "{}", flown.end());
}
