//! What a sweep found, and whether that was expected.

use serde::Serialize;

use super::{FlightFigures, Statistics};
use crate::scenario::expectation::Verdict;
use crate::scenario::file::ScenarioFile;

/// What `hil sweep --json` prints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Name of the scenario.
    pub scenario: String,
    /// The figures.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// What was expected of them.
    pub expectations: Vec<Verdict>,
}

impl Outcome {
    /// Of all flights of a scenario.
    pub fn of(file: &ScenarioFile, flights: &[FlightFigures]) -> Self {
        let statistics = Statistics::of(flights, &file.expectations);
        let judge = |expectation: &crate::scenario::expectation::Expectation| {
            expectation.judge(&statistics)
        };
        Self {
            scenario: file.name.clone(),
            expectations: file.expectations.iter().map(judge).collect(),
            statistics,
        }
    }

    /// Whether every expectation came true; where there is none, whether every flight came home.
    pub fn is_kept(&self) -> bool {
        if self.expectations.is_empty() {
            self.statistics.failed_seeds.is_empty()
        } else {
            self.expectations.iter().all(|verdict| verdict.kept)
        }
    }

    /// The expectations that did not come true, each with scenario, expectation and both figures.
    pub fn broken(&self) -> impl Iterator<Item = String> {
        self.expectations
            .iter()
            .filter(|verdict| !verdict.kept)
            .map(|verdict| format!("{}: {verdict}", self.scenario))
    }
}
