//! Fourier homing against 200 problems solved independently in double precision.
//!
//! Each record is a view of a textured room of 10 x 10 m, a snapshot taken up to 1.1 m away with the
//! viewer turned, and the solution (from the equations of Stürzl & Mallot 2006).

use hil::homing_check::{Problem, check};
use nav::HomingParameters;
use nav::homing::home;

const RECORDS: &str = include_str!("data/homing.jsonl");

fn problems() -> Vec<Problem> {
    let problems: Vec<_> = RECORDS
        .lines()
        .map(|line| serde_json::from_str(line).expect("a golden record"))
        .collect();
    assert_eq!(problems.len(), 200);
    problems
}

#[test]
fn coefficients_rotations_solutions_and_differences_are_those_of_double_precision() {
    let report = check(RECORDS).expect("well-formed records");
    let reasons: Vec<_> = report
        .failures
        .iter()
        .map(|failure| &failure.reason)
        .collect();
    assert_eq!(report.records, 200);
    assert!(
        report.failed.is_empty(),
        "lines {:?}: {reasons:?}",
        report.failed
    );
    assert!(report.worst_h < 1e-3);
}

#[test]
fn a_record_that_was_tampered_with_is_named() {
    let tampered = RECORDS.replacen("\"h2\":[", "\"h2\":[9", 1);
    assert_eq!(check(&tampered).expect("well-formed records").failed, [1]);
}

#[test]
fn a_file_without_records_is_no_success() {
    assert!(check("\n\n").is_err());
    assert!(check("{}").is_err());
}

#[test]
fn homing_points_less_than_a_right_angle_away_from_the_snapshot() {
    for problem in problems() {
        let view = problem.view().expect("128 bearings");
        let vector =
            home(&view, &problem.snapshot(), &HomingParameters::DEFAULT).expect("a vector");
        let [x, y] = problem.true_displacement_m;
        assert!(vector.displacement.x * x + vector.displacement.y * y > 0.0);
    }
}

#[test]
fn homing_tells_how_far_the_viewer_of_the_snapshot_was_turned() {
    for problem in problems() {
        let view = problem.view().expect("128 bearings");
        let vector =
            home(&view, &problem.snapshot(), &HomingParameters::DEFAULT).expect("a vector");
        let error = vector.rotation - problem.true_yaw_rad;
        // With the wrong sign of the residual turn the worst error would be 13.5 degrees.
        assert!(error.abs() < 8_f32.to_radians(), "{error} rad");
    }
}
