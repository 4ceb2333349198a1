//! The figures of one flight among many, and their statistics.

use std::io;

use serde::{Deserialize, Serialize};

use crate::metrics::quantile;
use crate::scenario::expectation::Expectation;
use crate::summary::Summary;

/// Closer than this to the true start counts as home, metres (the radius within which 8 of 9 homing
/// runs of the paper ended, Fig. 4).
pub const HOME_RADIUS_M: f64 = 0.5;

/// What is kept of each flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightFigures {
    /// Its seed.
    pub seed: u64,
    /// It followed the route to its end and landed.
    pub completed: bool,
    /// How it ended, for people.
    pub outcome: String,
    /// From the true start to where the drone stands at the end, metres.
    pub home_error_m: f64,
    /// Way back against way out, root mean square, metres.
    pub cross_track_rms_m: f64,
    /// Error at the end of an estimate that was never corrected, metres.
    pub odometry_only_error_m: f64,
    /// Snapshots taken.
    pub snapshots: usize,
    /// Route memory with its counts, bytes.
    pub memory_bytes: usize,
    /// The same per metre of the way out.
    pub bytes_per_m: f64,
    /// True length of the way out, metres.
    pub outbound_m: f64,
    /// Flight time, seconds.
    pub flight_s: f64,
    /// Frames that the camera sent and the firmware did not use.
    pub frames_dropped: u64,
    /// Frames of the link that were dropped, both ways.
    pub link_drops: u64,
}

impl FlightFigures {
    /// Those of a summary.
    pub fn of(summary: &Summary) -> Self {
        let link = &summary.link;
        Self {
            seed: summary.seed,
            completed: summary.completed,
            outcome: summary.outcome.clone(),
            home_error_m: summary.home_error_m,
            cross_track_rms_m: summary.cross_track_rms_m,
            odometry_only_error_m: summary.odometry_only_error_m,
            snapshots: summary.snapshots,
            memory_bytes: summary.memory_bytes,
            bytes_per_m: summary.bytes_per_m,
            outbound_m: summary.outbound_m,
            flight_s: summary.flight_s,
            frames_dropped: summary.frames_dropped,
            link_drops: link.to_camera.frames_dropped + link.to_autopilot.frames_dropped,
        }
    }

    /// Whether it followed the route to its end and stands within [`HOME_RADIUS_M`] of home.
    pub fn is_home(&self) -> bool {
        self.completed && self.home_error_m <= HOME_RADIUS_M
    }

    /// Whether it did not do what is expected of every flight: to come home, where nothing else is.
    pub fn has_failed(&self, expectations: &[Expectation]) -> bool {
        if expectations.is_empty() {
            !self.is_home()
        } else {
            expectations
                .iter()
                .any(|expectation| expectation.is_broken_by(self))
        }
    }
}

/// The middle and the end of a distribution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// Median.
    pub p50: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Largest.
    pub max: f64,
}

impl Quantiles {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        Self {
            p50: quantile(&sorted, 0.5),
            p95: quantile(&sorted, 0.95),
            max: quantile(&sorted, 1.0),
        }
    }
}

/// Statistics over flights. Field names are a promise to scripts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// How many.
    pub flights: usize,
    /// How many followed the route to its end and landed.
    pub completed: usize,
    /// How many of those stand within half a metre of home.
    pub home_within_half_metre: usize,
    /// Distances from home at the end, metres.
    pub home_error_m: Quantiles,
    /// Mean of the flights' root mean square distances from way back to way out, metres.
    pub cross_track_rms_m: f64,
    /// Errors of odometry alone on the same flights, metres.
    pub odometry_only_error_m: Quantiles,
    /// Mean route memory, bytes.
    pub memory_bytes: f64,
    /// Mean of the flights' bytes per metre.
    pub bytes_per_m: f64,
    /// Mean number of snapshots.
    pub snapshots: f64,
    /// Mean length of the way out, metres.
    pub outbound_m: f64,
    /// Mean flight time, seconds.
    pub flight_s: f64,
    /// Mean number of camera frames that were not used.
    pub frames_dropped: f64,
    /// Mean number of link frames that were dropped.
    pub link_drops: f64,
    /// Flights that did not do what is expected of each.
    pub failed_seeds: Vec<u64>,
}

impl Statistics {
    /// Over these flights, of which this is expected.
    pub fn of(flights: &[FlightFigures], expectations: &[Expectation]) -> Self {
        let count = |of: fn(&FlightFigures) -> bool| flights.iter().filter(|f| of(f)).count();
        let mean = |of: fn(&FlightFigures) -> f64| {
            flights.iter().map(of).sum::<f64>() / flights.len() as f64
        };
        let failed = flights.iter().filter(|f| f.has_failed(expectations));
        Self {
            flights: flights.len(),
            completed: count(|f| f.completed),
            home_within_half_metre: count(FlightFigures::is_home),
            home_error_m: Quantiles::of(flights.iter().map(|f| f.home_error_m)),
            cross_track_rms_m: mean(|f| f.cross_track_rms_m),
            odometry_only_error_m: Quantiles::of(flights.iter().map(|f| f.odometry_only_error_m)),
            memory_bytes: mean(|f| f.memory_bytes as f64),
            bytes_per_m: mean(|f| f.bytes_per_m),
            snapshots: mean(|f| f.snapshots as f64),
            outbound_m: mean(|f| f.outbound_m),
            flight_s: mean(|f| f.flight_s),
            frames_dropped: mean(|f| f.frames_dropped as f64),
            link_drops: mean(|f| f.link_drops as f64),
            failed_seeds: failed.map(|f| f.seed).collect(),
        }
    }
}

/// The flights as a table with a line for each.
///
/// # Errors
/// Where it cannot be written.
pub fn csv(flights: &[FlightFigures], to: impl io::Write) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    for flight in flights {
        writer.serialize(flight)?;
    }
    Ok(writer.flush()?)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::scenario::expectation::{Bounds, Metric};

    /// A flight that ends this far from home.
    pub fn flight(seed: u64, home_error_m: f64) -> FlightFigures {
        FlightFigures {
            seed,
            completed: true,
            outcome: "followed the route to its first snapshot".to_owned(),
            home_error_m,
            cross_track_rms_m: 0.1,
            odometry_only_error_m: 2.0,
            snapshots: 28,
            memory_bytes: 580,
            bytes_per_m: 10.0,
            outbound_m: 58.0,
            flight_s: 260.0,
            frames_dropped: 0,
            link_drops: 0,
        }
    }

    fn expectation(metric: Metric, bounds: Bounds) -> Expectation {
        Expectation {
            metric,
            bounds,
            claim: None,
            paper: None,
            reason: String::new(),
        }
    }

    #[test]
    fn a_flight_is_home_within_half_a_metre_having_followed_its_route_to_the_end() {
        let stopped = FlightFigures {
            completed: false,
            ..flight(3, 0.1)
        };
        let flights = [flight(1, 0.5), flight(2, 0.51), stopped];
        let statistics = Statistics::of(&flights, &[]);
        assert_eq!((statistics.flights, statistics.completed), (3, 2));
        assert_eq!(statistics.home_within_half_metre, 1);
        assert_eq!(statistics.failed_seeds, [2, 3]);
    }

    #[test]
    fn a_flight_fails_alone_by_what_is_expected_of_each_and_not_by_what_is_of_the_many() {
        let flights: Vec<_> = (1..=4)
            .map(|seed| flight(seed, 0.1 * seed as f64))
            .collect();
        let failed = |metric, bounds| {
            let expectations = [expectation(metric, bounds)];
            Statistics::of(&flights, &expectations).failed_seeds
        };
        let at_most = |limit| Bounds {
            at_most: Some(limit),
            ..Bounds::default()
        };
        let at_least = |limit| Bounds {
            at_least: Some(limit),
            ..Bounds::default()
        };
        let none: [u64; 0] = [];
        assert_eq!(failed(Metric::HomeErrorMaxM, at_most(0.25)), [3, 4]);
        assert_eq!(failed(Metric::HomeErrorP50M, at_most(0.25)), none);
        assert_eq!(failed(Metric::HomeErrorMaxM, at_least(0.35)), none);
        assert_eq!(
            failed(Metric::HomeWithinHalfMetreShare, at_least(0.5)),
            none
        );
        // Flights that were expected to get lost have not failed where they come home.
        assert_eq!(failed(Metric::HomeWithinHalfMetreShare, at_most(0.5)), none);
    }

    #[test]
    fn the_table_has_a_line_for_each_flight_below_its_heads() {
        let mut text = Vec::new();
        csv(&[flight(1, 0.1), flight(2, 0.2)], &mut text).expect("a table");
        let text = String::from_utf8(text).expect("text");
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("seed,completed,outcome,home_error_m"));
        assert!(lines[2].starts_with("2,true,"), "{}", lines[2]);
    }
}
