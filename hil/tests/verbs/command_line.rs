//! The command as its users meet it: exit codes, streams and messages.

use std::process::{Command, Stdio};

use super::bench::{Folder, golden, hil, json, stderr};

#[test]
fn a_wrong_value_gets_an_error_that_names_the_right_ones() {
    for (option, wrong, right) in [
        ("--world", "moon", "arena-panels"),
        ("--route", "zigzag", "u, s, line, corner"),
        ("--backend", "abacus", "emulator, native"),
        ("--spacing", "40", "0.2 to 10 metres"),
        ("--spacing", "0.25", "steps of 0.1"),
        ("--late", "nan", "from 0 to 100"),
    ] {
        let output = hil(&["fly", option, wrong]);
        assert_eq!(output.status.code(), Some(2), "{option}");
        assert!(
            stderr(&output).contains(right),
            "{option}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn an_image_that_is_none_is_an_error_and_no_flight() {
    let text_file = golden("homing.jsonl");
    let folder = Folder::new();
    for (image, reason) in [
        ("no/such/file", "No such file"),
        (text_file.as_str(), "not a readable ELF file"),
        // This very program, an ELF file for another machine.
        (env!("CARGO_BIN_EXE_hil"), "image"),
    ] {
        let output = hil(&["fly", "--firmware", image, "--out", &folder.file("out")]);
        assert_eq!(output.status.code(), Some(2));
        let stderr = stderr(&output);
        assert!(
            stderr.contains(reason) && stderr.contains(image),
            "{stderr}"
        );
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_flight() {
    let output = hil(&[
        "fly",
        "--backend",
        "native",
        "--out",
        &golden("homing.jsonl"),
    ]);
    assert_eq!(output.status.code(), Some(2));
    let stderr = stderr(&output);
    assert!(stderr.contains("homing.jsonl"), "{stderr}");
    assert!(!stderr.contains("Flying"), "{stderr}");
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let mut check = Command::new(env!("CARGO_BIN_EXE_hil"))
        .args(["homing-check", &golden("homing.jsonl")])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    drop(check.stdout.take());
    let output = check.wait_with_output().expect("the command ends");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_flight_leaves_its_folder_and_ends_with_one_json_object() {
    let folder = Folder::new();
    let out = folder.file("out");
    let output = hil(&[
        "fly",
        "--backend",
        "native",
        "--route",
        "corner",
        "--json",
        "--out",
        &out,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary = json(&output);
    for field in [
        "home_error_m",
        "bytes_per_m",
        "odometry_only_error_m",
        "frames_dropped",
        "wall_s",
    ] {
        assert!(summary[field].is_number(), "{field}");
    }
    assert_eq!(summary["completed"], true);
    folder.assert_holds_a_flight("out");
}

#[test]
fn homing_check_counts_and_fails_by_exit_code() {
    let output = hil(&["homing-check", &golden("homing.jsonl"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = json(&output);
    assert_eq!(report["records"], 200);
    assert_eq!(report["failed"], serde_json::json!([]));
    assert!(report["worst_h"].as_f64().is_some_and(|worst| worst < 1e-3));

    let output = hil(&["homing-check", &golden("pprzlink.jsonl")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("line 1"));
}
