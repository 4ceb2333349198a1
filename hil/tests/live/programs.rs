//! The two programs as their users start and end them.

use std::io::Write;
use std::net::TcpStream;
use std::process::Command;

use hil::live::TcpPort;
use serde_json::Value;

use super::free_port;
use super::program::{Folder, Program};

fn count(value: &Value) -> usize {
    value.as_array().map_or(0, Vec::len)
}

#[test]
fn two_programs_fly_a_route_home_and_both_tell_the_same_flight() {
    let link = free_port().to_string();
    let autopilot = Program::autopilot("corner-autopilot", &link, &[]);
    let mut emulator = Program::emulate("corner-emulator", &link, &[]);
    let (status, flown, out) = autopilot.end();
    assert_eq!(status.code(), Some(0), "{flown}");
    assert!(flown["home_error_m"].as_f64() < Some(0.5), "{flown}");
    let corrections = count(&out.recording()["corrections"]);
    assert!(corrections > 0);

    emulator.wait_for("peer lost");
    emulator.signal("-INT");
    let (status, emulated, out) = emulator.end();
    out.is_whole();
    assert_eq!(status.code(), Some(0), "{emulated}");
    let recording = out.recording();
    assert_eq!(recording["reference"], "truth");
    assert!(count(&recording["corrections"]) >= corrections);
    assert!(emulated["snapshots"].as_u64() >= flown["snapshots"].as_u64());
    assert_eq!(emulated["homing"], "both");
    let homes = [&emulated, &flown].map(|summary| summary["home_error_m"].as_f64());
    let apart = homes[0].zip(homes[1]).map(|(a, b)| (a - b).abs());
    assert!(apart < Some(0.02), "{homes:?}");
    // What one end handed over, the other one got; but for answers to an autopilot that has gone.
    let sent =
        |summary: &Value, direction: &str| summary["link"][direction]["frames_sent"].as_u64();
    assert_eq!(sent(&emulated, "to_camera"), sent(&flown, "to_camera"));
    assert!(sent(&emulated, "to_autopilot") >= sent(&flown, "to_autopilot"));
}

#[test]
fn the_end_of_either_is_told_by_the_other_which_goes_on_with_its_successor() {
    let link = free_port().to_string();
    let mut emulator = Program::emulate("restart-emulator", &link, &[]);
    emulator.wait_for("listening");
    let mut autopilot = Program::autopilot("restart-autopilot", &link, &[]);
    emulator.wait_for("records (0x03)");
    emulator.signal("-TERM");
    let (status, summary, out) = emulator.end();
    assert_eq!(status.code(), Some(1), "no route was followed");
    assert_eq!(summary["outcome"], "ended while the route was recorded");
    out.is_whole();

    autopilot.wait_for("link: peer lost");
    let mut emulator = Program::emulate("restart-emulator", &link, &[]);
    // The pose may be there first. Who goes before the link has carried anything was no peer of it.
    emulator.wait_for("Link connected");
    emulator.wait_for("true poses");
    autopilot.signal("-INT");
    let (status, summary, out) = autopilot.end();
    assert_eq!(status.code(), Some(1));
    assert_eq!(summary["outcome"], "ended in mid-flight");
    assert_eq!(summary["live"]["link_peers"], 2);
    let drops = out.recording()["link_drops"].clone();
    let unsent = |drop: &Value| {
        drop["side"] == "camera"
            && drop["message"] == "STATE"
            && drop["why"] == "not handed over: no peer"
    };
    assert!(
        drops
            .as_array()
            .is_some_and(|drops| drops.iter().any(unsent)),
        "{drops}"
    );
    assert!(
        out.read("flight.log")
            .contains("link dropped STATE: not handed over: no peer")
    );

    emulator.wait_for("link: peer lost");
    let mut autopilot = Program::autopilot("restart-autopilot", &link, &["--seconds", "2"]);
    autopilot.wait_for("Report");
    // Connected and lost, for the second time.
    emulator.wait_for_times("link: peer lost", 2);
    emulator.signal("-INT");
    let (_, summary, _) = emulator.end();
    assert_eq!(summary["live"]["link_peers"], 2, "{summary}");
    drop(autopilot.end());
}

#[test]
fn an_autopilot_that_nobody_comes_to_stays_on_the_ground_and_ends_on_ctrl_c() {
    let mut autopilot = Program::autopilot("alone", &free_port().to_string(), &[]);
    autopilot.wait_for("on the ground until a camera board is connected");
    autopilot.signal("-INT");
    let (status, summary, out) = autopilot.end();
    assert_eq!(status.code(), Some(1));
    assert_eq!(summary["outcome"], "ended before the drone took off");
    assert_eq!(summary["flight_s"], 0.0);
    out.is_whole();
}

#[test]
fn a_board_on_a_pty_flies_with_whoever_opens_the_device() {
    let mut emulator = Program::emulate("pty-emulator", "pty", &[]);
    emulator.wait_for("Pose");
    let said = emulator.said();
    let device = said
        .lines()
        .find_map(|line| line.trim().strip_prefix("Link "))
        .unwrap_or_else(|| panic!("no device: {said}"));
    let tty = format!("tty:{device}");
    let autopilot = Program::autopilot("pty-autopilot", &tty, &["--seconds", "8"]);
    let (_, flown, _) = autopilot.end();
    emulator.wait_for("peer lost");
    emulator.signal("-INT");
    let (_, emulated, out) = emulator.end();
    assert_eq!(out.recording()["reference"], "estimate");
    let sent = |summary: &Value, direction: &str| {
        summary["link"][direction]["frames_sent"]
            .as_u64()
            .unwrap_or(0)
    };
    assert!(sent(&flown, "to_camera") > 20, "{flown}");
    assert_eq!(sent(&flown, "to_camera"), sent(&emulated, "to_camera"));
    assert!(sent(&flown, "to_autopilot") > 0, "{flown}");
}

#[test]
fn a_line_that_is_no_pose_is_told_and_counted() {
    let port: TcpPort = free_port();
    let pose = port.to_string();
    let mut emulator = Program::emulate("bad-pose", "pty", &["--pose", &pose]);
    emulator.wait_for("listening");
    let mut sender = TcpStream::connect(("127.0.0.1", port.number())).expect("a connection");
    let line = br#"{"t":0,"x":-1.5,"y":0.5,"z":0.5,"roll":0,"pitch":0,"yaw":0}"#;
    sender.write_all(line).expect("sent");
    sender.write_all(b"\n{\"t\":0,\"x\":nan}\n").expect("sent");
    emulator.wait_for("not a pose");
    assert!(emulator.said().contains("column"), "{}", emulator.said());
    emulator.signal("-INT");
    let (_, summary, _) = emulator.end();
    assert_eq!(summary["live"]["poses"], 1);
    assert_eq!(summary["live"]["bad_poses"], 1);
}

#[test]
fn what_cannot_be_opened_is_an_error_that_names_it() {
    for (verb, arguments, told) in [
        (
            "autopilot",
            ["--link", "tty:/dev/no-such-tty"].as_slice(),
            "/dev/no-such-tty",
        ),
        ("autopilot", &["--link", "tcp:0"], "1 to 65535"),
        (
            "autopilot",
            &["--link", "tcp:5760", "--pose", "tcp:5760"],
            "both --link and --pose",
        ),
        (
            "emulate",
            &["--link", "tcp:5760", "--pose", "tcp:5760"],
            "both --link and --pose",
        ),
        (
            "emulate",
            &["--link", "pty", "--pose", "pty"],
            "neither state nor tcp:PORT",
        ),
        ("emulate", &["--link", "pty", "--speed", "0"], "above 0"),
    ] {
        let out = std::env::temp_dir().join(format!("hil-live-wrong-{}", std::process::id()));
        let output = Command::new(env!("CARGO_BIN_EXE_hil"))
            .arg(verb)
            .args(arguments)
            .arg("--out")
            .arg(&out)
            .output()
            .expect("the command starts");
        drop(Folder(out));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains(told), "{arguments:?}: {stderr}");
    }
}
