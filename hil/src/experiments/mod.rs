//! The paper's checkable claims beside what is measured here, one row each.
//!
//! Most claims are about flights: their rows come from the scenarios that expect something of them. The others
//! are measured without a scenario.
//!
//! | room | what it does |
//! | --- | --- |
//! | `claims` | the claims by number |
//! | `computed` | the list of what is measured without a scenario, and the short ones: board, odometry, Fig. 4 |
//! | `drift_model` | the paper's simulation of odometry |
//! | `catchments` | catchment areas by method and size (Fig. 3C) |
//! | `scaling` | the same in rooms of half and double the size |
//! | `moved_objects` | the home vector while something is moved (tables S1 to S4) |
//! | `rooms` | the rooms in which those three look round |
//! | `table` | the rows as documents have them |

mod catchments;
mod claims;
mod computed;
mod drift_model;
mod moved_objects;
mod rooms;
mod scaling;
pub mod table;

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::catchment::PlaceError;
use crate::catchment::survey::Unsuited;
use crate::flight::FlightError;
use crate::image::BuildError;
use crate::scenario::expectation::{Bounds, Verdict};
use crate::scenario::file::ScenarioFile;
use crate::sweep::{FlightFigures, Outcome};

pub use claims::CHECKABLE;
pub use computed::{COMPUTED, Computed, Order};

/// Something could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The checkout, which has the photographed room, was not found.
    #[error(transparent)]
    Checkout(#[from] BuildError),
    /// A place to look round in cannot be opened.
    #[error(transparent)]
    Place(#[from] PlaceError),
    /// A place cannot be looked at under a condition.
    #[error(transparent)]
    Unsuited(#[from] Unsuited),
    /// A run could not be flown.
    #[error(transparent)]
    Flight(#[from] FlightError),
}

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Number of the paper's claim; none for what goes beyond those.
    pub claim: Option<u8>,
    /// What is looked at.
    pub what: String,
    /// The paper's figure.
    pub paper: String,
    /// The figure found here, with the bound that it is held to.
    pub ours: String,
    /// Over how many seeds, runs, vectors or snapshots; zero where there is nothing random.
    pub seeds: usize,
    /// Whether the claim holds here; none where it is not checked.
    pub kept: Option<bool>,
    /// The same from a flight on the emulated board, where one was flown beside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emulated: Option<Emulated>,
}

/// The figure of one flight on the emulated board, beside that of the native flights.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Emulated {
    /// The figure.
    pub ours: String,
    /// Whether every figure of the flight is the native one's of the same seed, to the bit.
    pub as_native: bool,
}

impl Row {
    /// A row that is about no claim and checks none.
    fn of(what: impl Into<String>, paper: impl Into<String>, ours: impl Into<String>) -> Self {
        Self {
            claim: None,
            what: what.into(),
            paper: paper.into(),
            ours: ours.into(),
            seeds: 0,
            kept: None,
            emulated: None,
        }
    }

    /// The row as one about a claim.
    fn about(self, claim: u8) -> Self {
        Self {
            claim: Some(claim),
            ..self
        }
    }

    /// Whether nothing is wrong with it: the claim holds or is not checked, and the emulated flight, if there is
    /// one, equals the native one.
    pub fn is_sound(&self) -> bool {
        self.kept != Some(false) && self.emulated.as_ref().is_none_or(|beside| beside.as_native)
    }
}

/// A row for every expectation of a scenario.
pub fn rows(file: &ScenarioFile, outcome: &Outcome) -> Vec<Row> {
    let row = |verdict: &Verdict| {
        let expectation = &verdict.expectation;
        let metric = expectation.metric;
        let ours = format!(
            "{} ({})",
            metric.in_words(verdict.found),
            limits(&expectation.bounds, |limit| metric.in_words(limit))
        );
        Row {
            claim: expectation.claim,
            seeds: outcome.statistics.flights,
            kept: Some(verdict.kept),
            ..Row::of(
                format!("{}: {metric}", file.name),
                expectation.paper.clone().unwrap_or_default(),
                ours,
            )
        }
    };
    outcome.expectations.iter().map(row).collect()
}

/// Writes the flight of a seed on the emulated board beside the rows of a scenario; `native` is the native flight
/// of the same seed.
pub fn beside(
    rows: &mut [Row],
    file: &ScenarioFile,
    native: &FlightFigures,
    emulated: &FlightFigures,
) {
    let outcome = Outcome::of(file, std::slice::from_ref(emulated));
    for (row, verdict) in rows.iter_mut().zip(&outcome.expectations) {
        row.emulated = Some(Emulated {
            ours: verdict.expectation.metric.in_words(verdict.found),
            as_native: native == emulated,
        });
    }
}

/// Bounds for people.
fn limits(bounds: &Bounds, in_words: impl Fn(f64) -> String) -> String {
    let least = bounds
        .at_least
        .map(|limit| format!("≥ {}", in_words(limit)));
    let most = bounds.at_most.map(|limit| format!("≤ {}", in_words(limit)));
    let all: Vec<_> = least.into_iter().chain(most).collect();
    all.join(", ")
}

/// The rows in the order of the paper's claims; what goes beyond it comes last.
pub fn in_order(mut rows: Vec<Row>) -> Vec<Row> {
    rows.sort_by_key(|row| row.claim.unwrap_or(u8::MAX));
    rows
}

/// Claims that none of these numbers is about.
pub fn unanswered(claims: &[u8]) -> Vec<u8> {
    let numbers = CHECKABLE.iter().map(|(number, _)| *number);
    numbers.filter(|number| !claims.contains(number)).collect()
}

/// A row about a claim, which holds where the figure lies in a range.
fn measured(
    claim: u8,
    paper: &str,
    (figure, ours): (f64, String),
    accepted: &RangeInclusive<f64>,
    seeds: usize,
) -> Row {
    Row {
        seeds,
        kept: Some(accepted.contains(&figure)),
        ..Row::of(claims::what(claim), paper, ours).about(claim)
    }
}
