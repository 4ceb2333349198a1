//! `hil experiments`, and the tables that it makes for the documentation.

use std::fs;

use hil::experiments::{self, COMPUTED, table};
use hil::scenario::expectation::Expectation;
use hil::scenario::file::ScenarioFile;
use serde_json::Value;

use super::bench::{CORNER, Folder, checkout, hil, json, scenarios, stderr};

fn library() -> Vec<ScenarioFile> {
    scenarios("tests/scenarios")
}

/// The lines of a document's tables that the command made, cell by cell.
fn lines_of(document: &str) -> Vec<Vec<String>> {
    let [begin, end] = table::MARKERS;
    let (_, rest) = document.split_once(begin).expect("a first marker");
    let (made, _) = rest.split_once(end).expect("a second marker");
    let mut lines = Vec::new();
    for line in made.lines().filter(|line| line.starts_with('|')) {
        let cells = line
            .trim_start_matches("| ")
            .trim_end_matches(" |")
            .split(" | ");
        let cells: Vec<String> = cells.map(|cell| cell.trim().to_owned()).collect();
        assert_eq!(cells.len(), table::HEADS.len(), "{line}");
        let is_rule = cells.iter().all(|cell| cell.trim_matches('-').is_empty());
        if cells != table::HEADS && !is_rule {
            lines.push(cells);
        }
    }
    lines
}

#[test]
fn every_claim_of_the_paper_has_a_row() {
    let files = library();
    let flown = files.iter().flat_map(|file| &file.expectations);
    let mut claims: Vec<u8> = flown.filter_map(|expectation| expectation.claim).collect();
    claims.extend(COMPUTED.iter().flat_map(|computed| computed.claims));
    assert_eq!(experiments::unanswered(&claims), Vec::<u8>::new());
    claims.retain(|claim| *claim != 34);
    assert_eq!(experiments::unanswered(&claims), [34]);
}

/// The lines of docs/experiments.md.
fn documented() -> Vec<Vec<String>> {
    let document = fs::read_to_string(checkout("docs/experiments.md")).expect("the document");
    lines_of(&document)
}

/// The rows of a scenario's flights: the claim, and what is looked at.
fn expected(files: &[ScenarioFile]) -> Vec<(Option<u8>, String)> {
    let of_file = |file: &ScenarioFile| {
        let name = file.name.clone();
        let row = move |expectation: &Expectation| {
            let what = format!("{name}: {}", expectation.metric);
            (expectation.claim, what)
        };
        file.expectations.iter().map(row).collect::<Vec<_>>()
    };
    files.iter().flat_map(of_file).collect()
}

#[test]
fn the_document_has_every_claim_in_the_papers_order_with_all_that_is_flown_for_it() {
    let lines = documented();
    let numbers = lines.iter().filter_map(|cells| cells[0].parse().ok());
    let claims: Vec<u8> = numbers.collect();
    assert_eq!(experiments::unanswered(&claims), Vec::<u8>::new());
    assert!(claims.is_sorted(), "{claims:?}");
    for (claim, what) in expected(&library()) {
        let Some(claim) = claim.map(|claim| claim.to_string()) else {
            continue;
        };
        let mut found = lines.iter().map(|cells| (&cells[0], &cells[1]));
        assert!(found.any(|line| line == (&claim, &what)), "no line: {what}");
    }
}

#[test]
fn the_document_has_no_line_that_the_command_does_not_print() {
    let files = library();
    let expected = expected(&files);
    for cells in documented() {
        let [_, what, _, _, _, kept, _] = &cells[..] else {
            panic!("{cells:?}");
        };
        let scenario = what.split(':').next().unwrap_or_default();
        let is_flown = files.iter().any(|file| file.name == scenario);
        let is_expected = expected.iter().any(|(_, expected)| expected == what);
        assert!(!is_flown || is_expected, "nobody expects: {what}");
        assert!(
            ["yes", "NO", "not checked"].contains(&kept.as_str()),
            "{what}: {kept}"
        );
    }
}

#[test]
fn experiments_print_a_row_for_each_claim_they_were_asked_for() {
    let output = hil(&["experiments", "--only", "board", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = json(&output);
    let rows = table["rows"].as_array().expect("rows");
    let claims: Vec<_> = rows.iter().map(|row| &row["claim"]).collect();
    assert_eq!(claims, [1, 3]);
    for name in ["what", "paper", "ours"] {
        assert!(rows[0][name].is_string(), "{name}");
    }
    assert_eq!(
        (&rows[0]["seeds"], &rows[0]["kept"]),
        (&Value::from(0), &Value::from(true))
    );

    let output = hil(&["experiments", "--only", "moon"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("drift-model"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn rows_are_told_as_they_come_and_printed_as_the_document_has_them() {
    let output = hil(&[
        "experiments",
        "--only",
        "board",
        "--only",
        "elsewhere",
        "--markdown",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stderr(&output);
    for words in ["Kept 1: mass of the drone: 56 g", "Unchecked 36: "] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let printed = String::from_utf8(output.stdout).expect("text");
    let claims: Vec<String> = lines_of(&printed)
        .into_iter()
        .map(|mut cells| cells.swap_remove(0))
        .collect();
    assert_eq!(claims, ["1", "3", "36"]);
}

#[test]
fn a_flight_on_the_emulated_board_stands_beside_the_native_one_it_repeats() {
    let folder = Folder::new();
    let claims = "at_most = 0.5\nclaim = 31\npaper = \"followed home\"";
    let short = CORNER.replace("at_most = 0.5", claims);
    folder.with("short.toml", short.replace("count = 3", "count = 1"));
    let scenarios = folder.path().display().to_string();
    let arguments = ["experiments", "--scenarios", &scenarios, "--only", "short"];
    let output = hil(&[&arguments[..], &["--emulated-beside", "--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let row = &json(&output)["rows"][0];
    assert_eq!(row["emulated"]["as_native"], true);
    let ours = row["ours"].as_str().expect("a figure");
    let beside = row["emulated"]["ours"].as_str().expect("a figure");
    assert!(ours.starts_with(beside), "{ours}, {beside}");
}
