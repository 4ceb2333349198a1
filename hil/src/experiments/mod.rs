//! The paper's checkable claims beside what is measured here, one row each.

mod claims;
mod drift_model;

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::scenario::expectation::{Bounds, Verdict};
use crate::scenario::file::ScenarioFile;
use crate::sweep::Outcome;

pub use claims::{CHECKABLE, COMPUTED, Computed};

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Number of the paper's claim; none for what goes beyond it.
    pub claim: Option<u8>,
    /// What is looked at.
    pub what: String,
    /// The paper's figure.
    pub paper: String,
    /// The same here.
    pub ours: String,
    /// Over how many seeds; zero where there is nothing random.
    pub seeds: usize,
    /// Whether the claim holds here; none where it is not checked.
    pub kept: Option<bool>,
}

/// A row for every expectation of a scenario.
pub fn rows(file: &ScenarioFile, outcome: &Outcome) -> Vec<Row> {
    let row = |verdict: &Verdict| {
        let expectation = &verdict.expectation;
        let metric = expectation.metric;
        Row {
            claim: expectation.claim,
            what: format!("{}: {metric}", file.name),
            paper: expectation.paper.clone().unwrap_or_default(),
            ours: format!(
                "{} ({})",
                metric.in_words(verdict.found),
                limits(&expectation.bounds, |limit| metric.in_words(limit))
            ),
            seeds: outcome.statistics.flights,
            kept: Some(verdict.kept),
        }
    };
    outcome.expectations.iter().map(row).collect()
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

/// The rows as a table in Markdown.
pub fn table(rows: &[Row]) -> String {
    let cells = |row: &Row| {
        [
            row.claim.map_or("–".to_owned(), |claim| claim.to_string()),
            row.what.clone(),
            row.paper.clone(),
            row.ours.clone(),
            if row.seeds == 0 {
                "–".to_owned()
            } else {
                row.seeds.to_string()
            },
            match row.kept {
                Some(true) => "yes".to_owned(),
                Some(false) => "NO".to_owned(),
                None => "not checked".to_owned(),
            },
        ]
    };
    let heads = ["claim", "what", "paper", "here", "seeds", "kept"].map(str::to_owned);
    let body: Vec<_> = rows.iter().map(cells).collect();
    let width = |column: usize| {
        let of = |line: &[String; 6]| line[column].chars().count();
        body.iter().map(of).fold(of(&heads), usize::max)
    };
    let widths: [usize; 6] = core::array::from_fn(width);
    let line = |cells: &[String; 6]| {
        let padded = cells
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!("{cell:width$}"));
        format!("| {} |", padded.collect::<Vec<_>>().join(" | "))
    };
    let rule = widths.map(|width| "-".repeat(width));
    let lines: Vec<_> = [&heads, &rule].into_iter().chain(&body).map(line).collect();
    lines.join("\n")
}

/// Claims of which no row says anything, by number.
pub fn unanswered(rows: &[Row]) -> Vec<u8> {
    let numbers = CHECKABLE.iter().map(|(number, _)| *number);
    numbers
        .filter(|number| rows.iter().all(|row| row.claim != Some(*number)))
        .collect()
}

/// A row whose figure lies in a range.
fn measured(
    claim: u8,
    paper: &str,
    (figure, ours): (f64, String),
    accepted: &RangeInclusive<f64>,
    seeds: usize,
) -> Row {
    Row {
        claim: Some(claim),
        what: claims::what(claim).to_owned(),
        paper: paper.to_owned(),
        ours,
        seeds,
        kept: Some(accepted.contains(&figure)),
    }
}
