//! The verbs that hold us against data: drift, ekf-replay, link-check.

use std::fs;

use serde_json::Value;

use super::bench::{Folder, golden, hil, json, stderr};

/// The hover recording without its truth, under another name.
fn copy_of_the_hover(folder: &Folder) -> String {
    for part in ["imu", "events", "ekf"] {
        let from = golden(&format!("ekf/g1_hover.{part}.csv"));
        fs::copy(from, folder.file(&format!("mine.{part}.csv"))).expect("a copy");
    }
    folder.file("mine")
}

/// Replaces the first `from` of a file.
fn tamper(path: &str, from: &str, to: &str) {
    let text = fs::read_to_string(path).expect("the file");
    assert!(text.contains(from), "{from:?} is not in the file");
    fs::write(path, text.replacen(from, to, 1)).expect("the file is rewritten");
}

#[test]
fn ekf_replay_says_how_far_the_filter_strays_and_that_it_is_within() {
    let output = hil(&["ekf-replay", &golden("ekf/g1_hover"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = json(&output);
    for (field, limit) in [
        ("position_m", 5e-4),
        ("velocity_mps", 2e-4),
        ("attitude_rad", 1e-4),
        ("variance_relative", 1e-3),
    ] {
        let value = report[field].as_f64().expect(field);
        assert!(value > 0.0 && value <= limit, "{field}: {value}");
    }
    assert_eq!(report["within"], true);
}

#[test]
fn ekf_replay_needs_no_truth_and_fails_by_exit_code_when_the_filter_strays() {
    let folder = Folder::new();
    let prefix = copy_of_the_hover(&folder);
    let output = hil(&["ekf-replay", &prefix]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("position"));

    let output = hil(&["ekf-replay", &prefix, "--initial-yaw", "-0.5", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(json(&output)["within"], false);
    let attitude = json(&output)["attitude_rad"].as_f64().expect("an angle");
    // 2 |vec| of the quaternion between two headings half a radian apart: 2 sin 0.25, and a little drift.
    assert!((attitude - 2.0 * 0.25_f64.sin()).abs() < 0.02, "{attitude}");
}

#[test]
fn ekf_replay_names_file_and_line_of_what_it_cannot_read() {
    let nothing = hil(&["ekf-replay", "no/such/recording"]);
    assert_eq!(nothing.status.code(), Some(2));
    let message = stderr(&nothing);
    assert!(message.contains("no/such/recording.imu.csv"), "{message}");
    assert!(message.contains("No such file"), "{message}");

    for (part, from, to, place) in [
        (
            "imu",
            "3,9,37,167",
            "3,9,,167",
            "mine.imu.csv:3: column \"gz_cdps\" is missing",
        ),
        (
            "imu",
            "ay_1e4g",
            "ay",
            "mine.imu.csv:2: no column \"ay_1e4g\"",
        ),
        (
            "events",
            "15,tof,0,",
            "15,tof,NaN,",
            "mine.events.csv:2: column \"v0\" holds \"NaN\"",
        ),
        (
            "events",
            "46,tof,",
            "46,sonar,",
            "mine.events.csv:3: unknown event \"sonar\"",
        ),
        (
            "ekf",
            "\n19,",
            "\n20000,",
            "mine.ekf.csv:3: tick 20000 ms is behind the last",
        ),
    ] {
        let folder = Folder::new();
        let prefix = copy_of_the_hover(&folder);
        tamper(&folder.file(&format!("mine.{part}.csv")), from, to);
        let output = hil(&["ekf-replay", &prefix]);
        assert_eq!(output.status.code(), Some(2), "{place}");
        assert!(stderr(&output).contains(place), "{}", stderr(&output));
    }

    let yaw = hil(&["ekf-replay", "x", "--initial-yaw", "north"]);
    assert_eq!(yaw.status.code(), Some(2));
    assert!(stderr(&yaw).contains("an angle in radians"));
}

#[test]
fn link_check_counts_and_names_what_fails() {
    let output = hil(&["link-check", &golden("pprzlink.jsonl"), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = json(&output);
    assert_eq!(report["records"], 192);
    assert_eq!(report["failed"], serde_json::json!([]));

    let folder = Folder::new();
    let file = folder.file("records.jsonl");
    fs::copy(golden("pprzlink.jsonl"), &file).expect("a copy");
    tamper(&file, "\"msg\": [109,", "\"msg\": [110,");
    let output = hil(&["link-check", &file, "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let failed = serde_json::json!(["valid/IMCU_DEBUG/typ/1"]);
    assert_eq!(json(&output)["failed"], failed);
    let output = hil(&["link-check", &file]);
    let words = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(words.contains("valid/IMCU_DEBUG/typ/1: "), "{words}");
    assert!(words.contains("191 of 192 records hold"), "{words}");
}

#[test]
fn link_check_names_the_line_of_what_it_cannot_read() {
    let record = |hex: &str, sent: &str| {
        format!("{{\"name\": \"a\", \"hex\": \"{hex}\", {sent}\"decoded\": []}}")
    };
    let sent = |fields: &str| {
        format!(
            "\"sent\": {{\"name\": \"VISUALHOMING_COMMAND\", \"sender\": 0, \"receiver\": 0, \"fields\": {fields}}}, "
        )
    };
    let folder = Folder::new();
    let file = folder.file("records.jsonl");
    let good = record("", "");
    for (bad, why) in [
        ("{".to_owned(), "EOF"),
        ("{}".to_owned(), "missing field `name`"),
        (record("9", ""), "pairs of hexadecimal digits"),
        (record("9x", ""), "pairs of hexadecimal digits"),
        (record("+9é", ""), "pairs of hexadecimal digits"),
        (record("", &sent("{}")), "command is missing"),
        (
            record("", &sent("{\"command\": 256, \"args\": []}")),
            "command cannot be 256",
        ),
        (
            record("", &sent("{\"command\": 1, \"args\": [-1]}")),
            "args cannot be [-1]",
        ),
        (
            record(
                "",
                &sent(&format!("{{\"command\": 1, \"args\": {:?}}}", vec![0; 246])),
            ),
            "args cannot be [0,",
        ),
        (
            record("", &sent("{}").replace("COMMAND", "TEA")),
            "no message \"VISUALHOMING_TEA\"",
        ),
    ] {
        fs::write(&file, format!("{good}\n\n{bad}\n")).expect("the file is written");
        let output = hil(&["link-check", &file]);
        assert_eq!(output.status.code(), Some(2), "{bad}");
        let message = stderr(&output);
        assert!(message.contains("records.jsonl: line 3: "), "{message}");
        assert!(message.contains(why), "{message}");
    }

    fs::write(&file, "\n").expect("the file is written");
    let output = hil(&["link-check", &file]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no record"));
    let output = hil(&["link-check", "no/such/file"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no/such/file"));
}

#[test]
fn drift_gives_a_row_for_each_distance_and_leaves_a_picture() {
    let folder = Folder::new();
    let output = hil(&[
        "drift",
        "--seeds",
        "6",
        "--distances",
        "2,0.5,1,2",
        "--json",
        "--out",
        &folder.file(""),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = json(&output);
    let rows = report["rows"].as_array().expect("rows");
    let distances: Vec<_> = rows.iter().map(|row| row["distance_m"].as_f64()).collect();
    assert_eq!(distances, [Some(0.5), Some(1.0), Some(2.0)]);
    for row in rows {
        assert_eq!(row["seeds"], 6);
        for field in ["cross_rms_m", "along_rms_m", "yaw_rms_rad"] {
            let value = row[field].as_f64().expect(field);
            assert!(value > 0.0 && value < 0.5, "{field}: {value}");
        }
        assert_eq!(row.as_object().map(serde_json::Map::len), Some(5));
    }
    assert_eq!(report["published"].as_array().map(Vec::len), Some(2));
    let svg = fs::read_to_string(folder.file("drift.svg")).expect("a picture");
    assert!(svg.starts_with("<svg") && svg.contains("</svg>"));
    let written: Value =
        serde_json::from_slice(&fs::read(folder.file("drift.json")).expect("the table"))
            .expect("JSON");
    assert_eq!(written, report);
}

#[test]
fn drift_of_the_same_seeds_is_the_same_to_the_byte() {
    let drift = || hil(&["drift", "--seeds", "5", "--distances", "1", "--json"]).stdout;
    assert_eq!(drift(), drift());
}

#[test]
fn drift_refuses_what_it_cannot_measure_before_it_flies() {
    for (arguments, why) in [
        (["--distances", "1,far"], "0.1 to 100 metres"),
        (["--distances", "0"], "0.1 to 100 metres"),
        (["--distances", "NaN"], "0.1 to 100 metres"),
        (["--seeds", "0"], "0 is not in 1..=1000000"),
        (["--out", "/dev/null"], "/dev/null"),
    ] {
        let output = hil(&[&["drift"], &arguments[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let message = stderr(&output);
        assert!(message.contains(why), "{message}");
        assert!(!message.contains("Flying"), "{message}");
    }
}
