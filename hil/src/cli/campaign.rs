//! `hil campaign`: many seeds of one scenario on the native backend, and their statistics.

use clap::Args;
use serde::Serialize;

use super::Failure;
use super::console::Console;
use super::fly::ScenarioArguments;
use crate::flight::FlightError;
use crate::scenario::{Homing, Scenario};
use crate::sweep::{self, FlightFigures, HOME_RADIUS_M, Vessel};

/// Options of `hil campaign`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    hil campaign                          20 seeds of the U\n  \
    hil campaign --compare                the same seeds with odometry alone as well\n  \
    hil campaign --route s --seeds 100 --json\n  \
    hil campaign --seeds 10 --corrupt 1%")]
pub struct Arguments {
    #[command(flatten)]
    scenario: ScenarioArguments,
    /// How many seeds
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: u64,
    /// The first seed
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// Flies each seed with odometry alone as well
    #[arg(long)]
    compare: bool,
    /// Ends with one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Statistics of one setting over all seeds.
#[derive(Debug, Serialize)]
struct Statistics {
    homing: &'static str,
    flights: usize,
    completed: usize,
    within_half_a_metre: usize,
    mean_home_error_m: f64,
    p50_home_error_m: f64,
    p95_home_error_m: f64,
    mean_cross_track_rms_m: f64,
    mean_bytes_per_m: f64,
    mean_flight_s: f64,
    /// Frames of the link that were dropped, per flight, both ways.
    mean_link_drops: f64,
    home_errors_m: Vec<f64>,
}

#[derive(Debug, Serialize)]
struct Outcome {
    first_seed: u64,
    settings: Vec<Statistics>,
    /// Mean home error with odometry alone over that with homing; only with `--compare`.
    improvement: Option<f64>,
}

pub fn run(arguments: &Arguments, console: &Console) -> Result<bool, Failure> {
    let mut settings = vec![fly_all(arguments, arguments.scenario.homing, console)?];
    if arguments.compare {
        settings.push(fly_all(arguments, Homing::Odometry, console)?);
    }
    let improvement = match settings.as_slice() {
        [with, without] => Some(without.mean_home_error_m / with.mean_home_error_m),
        _ => None,
    };
    let all_completed = settings[0].completed == settings[0].flights;
    let outcome = Outcome {
        first_seed: arguments.first,
        settings,
        improvement,
    };
    if arguments.json {
        console.result(&serde_json::to_string(&outcome)?)?;
    } else {
        console.result(&in_words(&outcome))?;
    }
    Ok(all_completed)
}

/// Flies every seed, one flight per processor at a time. The results do not depend on how the
/// flights are shared out.
fn fly_all(
    arguments: &Arguments,
    homing: Homing,
    console: &Console,
) -> Result<Statistics, FlightError> {
    let seeds: Vec<u64> = (0..arguments.seeds)
        .map(|index| arguments.first.wrapping_add(index))
        .collect();
    let mut progress = console.progress("Flying", arguments.seeds);
    let flights = sweep::fly_each(
        &seeds,
        Vessel::Native,
        |seed| {
            Ok(Scenario {
                homing,
                ..arguments.scenario.scenario(seed)
            })
        },
        |_, _| Ok(()),
        |done| {
            progress.set(done as u64, || {
                let flights = seeds.len();
                format!("{done} of {flights} flights, homing: {}", homing.name())
            });
        },
    );
    progress.finish();
    flights.map(|flights| statistics(homing, &flights))
}

fn statistics(homing: Homing, flights: &[FlightFigures]) -> Statistics {
    let all = sweep::Statistics::of(flights, &[]);
    let home_errors_m: Vec<f64> = flights.iter().map(|flight| flight.home_error_m).collect();
    let near = home_errors_m
        .iter()
        .filter(|error| **error <= HOME_RADIUS_M);
    Statistics {
        homing: homing.name(),
        flights: all.flights,
        completed: all.completed,
        within_half_a_metre: near.count(),
        mean_home_error_m: home_errors_m.iter().sum::<f64>() / flights.len() as f64,
        p50_home_error_m: all.home_error_m.p50,
        p95_home_error_m: all.home_error_m.p95,
        mean_cross_track_rms_m: all.cross_track_rms_m,
        mean_bytes_per_m: all.bytes_per_m,
        mean_flight_s: all.flight_s,
        mean_link_drops: all.link_drops,
        home_errors_m,
    }
}

/// The statistics for people, without a newline at the end.
fn in_words(outcome: &Outcome) -> String {
    let mut lines = vec![
        "homing     flights  completed  <= 0.5 m   mean m    p50 m    p95 m  path rms m  bytes/m  flight s  drops"
            .to_owned(),
    ];
    for row in &outcome.settings {
        lines.push(format!(
            "{:<10} {:>7}  {:>9}  {:>8} {:>8.2} {:>8.2} {:>8.2} {:>11.2} {:>8.1} {:>9.0} {:>6.0}",
            row.homing,
            row.flights,
            row.completed,
            row.within_half_a_metre,
            row.mean_home_error_m,
            row.p50_home_error_m,
            row.p95_home_error_m,
            row.mean_cross_track_rms_m,
            row.mean_bytes_per_m,
            row.mean_flight_s,
            row.mean_link_drops
        ));
    }
    if let Some(improvement) = outcome.improvement {
        lines.push(format!(
            "homing makes the mean home error {improvement:.1} times smaller"
        ));
    }
    lines.join("\n")
}
