//! How far dead reckoning strays: the filter's error over a straight leg, over many seeds, beside what the firmware's
//! own filter made of the same flight.
//!
//! Error is estimate less truth. That of the position is counted from the leg's start, that of the heading from the
//! reset.

mod flight;
mod plot;
mod published;

pub use flight::OpenLoop;
pub use plot::picture;
pub use published::{PUBLISHED, Published, accepted, verdict};

use fake_sensors::motion::SensorModel;
use serde::Serialize;

/// Errors of the estimate where the leg has this length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Across the leg, to the left, metres.
    pub cross_m: f64,
    /// Along the leg, metres.
    pub along_m: f64,
    /// Of the heading, counter-clockwise, radians.
    pub yaw_rad: f64,
}

/// The errors at one distance over many seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Length of the leg, metres.
    pub distance_m: f64,
    /// Root mean square across the leg, metres.
    pub cross_rms_m: f64,
    /// Root mean square along it, metres.
    pub along_rms_m: f64,
    /// Root mean square of the heading, radians.
    pub yaw_rms_rad: f64,
    /// How many seeds.
    pub seeds: usize,
}

/// Flies one leg and looks at the errors where its length reaches each distance, metres, in ascending order.
pub fn fly(model: &SensorModel, seed: u64, distances_m: &[f64]) -> Vec<Drift> {
    let mut flight = OpenLoop::new(model, seed);
    flight.run_until(OpenLoop::LEG_START_MS);
    let start = flight.position_error();
    distances_m
        .iter()
        .map(|distance_m| {
            while flight.vehicle.truth().position_m.x < *distance_m {
                flight.step();
            }
            let [along_m, cross_m, _] = (flight.position_error() - start).into();
            Drift {
                cross_m,
                along_m,
                yaw_rad: flight.yaw_error(),
            }
        })
        .collect()
}

/// Statistics over the flights of many seeds, each with one [`Drift`] per distance.
pub fn rows(distances_m: &[f64], flights: &[Vec<Drift>]) -> Vec<Row> {
    let rms = |index: usize, of: fn(&Drift) -> f64| {
        let squares = flights.iter().map(|flight| {
            let error = of(&flight[index]);
            error * error
        });
        (squares.sum::<f64>() / flights.len() as f64).sqrt()
    };
    let row = |(index, distance_m): (usize, &f64)| Row {
        distance_m: *distance_m,
        cross_rms_m: rms(index, |drift| drift.cross_m),
        along_rms_m: rms(index, |drift| drift.along_m),
        yaw_rms_rad: rms(index, |drift| drift.yaw_rad),
        seeds: flights.len(),
    };
    distances_m.iter().enumerate().map(row).collect()
}
