//! The command as its users meet it: exit codes, streams and messages.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn hil(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hil"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

/// A folder for one test, gone after it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("hil-{name}-{}", std::process::id())))
    }

    fn path(&self) -> String {
        self.0.display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Not every test gets as far as making it.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn golden(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the workspace");
    root.join("tests/golden/data")
        .join(name)
        .display()
        .to_string()
}

#[test]
fn a_wrong_value_gets_an_error_that_names_the_right_ones() {
    for (option, wrong, right) in [
        ("--world", "moon", "arena-panels"),
        ("--route", "zigzag", "u, s, line, corner"),
        ("--backend", "abacus", "emulator, native"),
        ("--spacing", "40", "0.2 to 10 metres"),
        ("--spacing", "0.25", "steps of 0.1"),
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
    let out = Folder::new("no-image");
    for (image, reason) in [
        ("no/such/file", "No such file"),
        (text_file.as_str(), "not a readable ELF file"),
        // This very program, an ELF file for another machine.
        (env!("CARGO_BIN_EXE_hil"), "image"),
    ] {
        let output = hil(&["fly", "--firmware", image, "--out", &out.path()]);
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
    let folder = Folder::new("flight");
    let out = folder.path();
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
    let summary: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("one JSON object");
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
    for file in [
        "summary.json",
        "recording.json",
        "flight.log",
        "report.html",
        "map.svg",
    ] {
        assert!(
            folder.0.join(file).metadata().expect(file).len() > 100,
            "{file}"
        );
    }
}

#[test]
fn homing_check_counts_and_fails_by_exit_code() {
    let output = hil(&["homing-check", &golden("homing.jsonl"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(report["records"], 200);
    assert_eq!(report["failed"], serde_json::json!([]));
    assert!(report["worst_h"].as_f64().is_some_and(|worst| worst < 1e-3));

    let output = hil(&["homing-check", &golden("pprzlink.jsonl")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("line 1"));
}
