//! Homing to a single snapshot in closed loop, from nine starts up to 2 m away (paper, Fig. 4).
//!
//! The flight is the published app's: one snapshot (0x01), off to the start, and then follow and stay (0x11) until
//! its time is over. Nothing tells the camera where it is but its odometry since the snapshot, and what it sees.

mod flight;
mod picture;

use core::f64::consts::TAU;

use serde::Serialize;

pub use flight::{Run, fly};
pub use picture::picture;

use crate::flight::FlightError;
use crate::metrics::quantile;
use crate::parallel;
use crate::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage};

/// Within this many metres a run counts as home, as in the paper.
pub const NEAR_M: f64 = 0.5;
/// So many starts of each seed have to be home, as the paper's were.
pub const ENOUGH: usize = 8;
/// Starts round a snapshot, and how far away they are, in turn.
pub const STARTS: usize = 9;
const DISTANCES_M: [f64; 3] = [1.0, 1.5, 2.0];

/// The starts: every 40 degrees, from the snapshot, north and west, metres.
pub fn starts_m() -> [[f64; 2]; STARTS] {
    core::array::from_fn(|start| {
        let bearing = TAU * start as f64 / STARTS as f64;
        let away_m = DISTANCES_M[start % DISTANCES_M.len()];
        [away_m * libm::cos(bearing), away_m * libm::sin(bearing)]
    })
}

/// A flight with nothing against it; its route is not flown.
pub fn nominal(world: &str, seed: u64) -> Scenario {
    Scenario {
        route: Route::default(),
        world: world.to_owned(),
        seed,
        spacing: Spacing::DEFAULT,
        storage: Storage::PAPER,
        homing: Homing::default(),
        conditions: Conditions::default(),
    }
}

/// Flies from every start of every seed, on all processors, in the order of seeds and starts. `done` hears
/// how many have ended.
///
/// # Errors
/// [`FlightError`] of the first run that could not be flown.
pub fn fly_all(
    world: &str,
    seeds: impl Iterator<Item = u64>,
    done: impl FnMut(usize),
) -> Result<Vec<Run>, FlightError> {
    let all: Vec<_> = seeds
        .flat_map(|seed| starts_m().map(|start_m| (seed, start_m)))
        .collect();
    let one = |(seed, start_m): &(u64, [f64; 2])| fly(&nominal(world, *seed), *start_m);
    parallel::map(&all, one, done).into_iter().collect()
}

/// What came of all runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Runs in all.
    pub runs: usize,
    /// How many of them ended within [`NEAR_M`].
    pub home: usize,
    /// The fewest of one seed.
    pub fewest: usize,
    /// Median of the distances at which they ended, metres.
    pub p50_m: f64,
    /// That within which 95 of 100 ended.
    pub p95_m: f64,
    /// Whether [`ENOUGH`] of each seed ended near.
    pub holds: bool,
}

impl Verdict {
    /// On the runs of some seeds, [`starts_m`] each.
    pub fn on(runs: &[Run]) -> Self {
        let near = |runs: &[Run]| runs.iter().filter(|run| run.end_error_m() < NEAR_M).count();
        let fewest = runs.chunks(STARTS).map(near).min().unwrap_or(0);
        let mut errors_m: Vec<f64> = runs.iter().map(Run::end_error_m).collect();
        errors_m.sort_by(f64::total_cmp);
        Self {
            runs: runs.len(),
            home: near(runs),
            fewest,
            p50_m: quantile(&errors_m, 0.5),
            p95_m: quantile(&errors_m, 0.95),
            holds: fewest >= ENOUGH,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ending_at(end_m: [f64; 2]) -> Run {
        Run {
            seed: 1,
            snapshot_m: [1.0, 2.0],
            path_m: vec![[3.0, 2.0], end_m],
        }
    }

    #[test]
    fn starts_are_one_to_two_metres_away_and_all_round() {
        let starts = starts_m();
        assert_eq!(starts[0], [1.0, 0.0]);
        for [x, y] in starts {
            let away_m = libm::hypot(x, y);
            assert!((1.0 - 1e-9..=2.0 + 1e-9).contains(&away_m), "{away_m}");
        }
        let sum = [0, 1].map(|axis: usize| starts.iter().map(|start| start[axis]).sum::<f64>());
        assert!(libm::hypot(sum[0], sum[1]) < 1.5, "{sum:?}");
    }

    #[test]
    fn a_seed_fails_that_brings_home_fewer_than_eight() {
        let [near, far] = [[1.3, 2.3], [1.4, 2.4]].map(ending_at);
        let mut runs = vec![near; 2 * STARTS];
        runs[3] = far.clone();
        let verdict = Verdict::on(&runs);
        assert_eq!((verdict.home, verdict.fewest, verdict.holds), (17, 8, true));
        runs[4] = far;
        let verdict = Verdict::on(&runs);
        assert_eq!(
            (verdict.home, verdict.fewest, verdict.holds),
            (16, 7, false)
        );
    }

    #[test]
    fn a_drone_two_metres_off_homes_to_its_snapshot() {
        let scenario = nominal("arena", 1);
        let start_m = starts_m()[2];
        let run = fly(&scenario, start_m).unwrap();
        let [x, y] = run.path_m[0];
        let away_m = libm::hypot(x - run.snapshot_m[0], y - run.snapshot_m[1]);
        assert!((away_m - 2.0).abs() < 0.4, "{away_m}");
        assert!(run.end_error_m() < NEAR_M, "{}", run.end_error_m());
        assert_eq!(fly(&scenario, start_m).unwrap(), run);
    }

    #[test]
    fn a_drone_that_knows_its_heading_finds_home_where_the_view_fits_better_turned() {
        // In this arena a rotation search of ±31 degrees turns the vector of both starts away from home.
        for start in [2, 8] {
            let run = fly(&nominal("arena", 4), starts_m()[start]).unwrap();
            assert!(run.end_error_m() < NEAR_M, "{start}: {}", run.end_error_m());
        }
    }
}
