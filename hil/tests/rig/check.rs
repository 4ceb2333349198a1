//! `hil rig check`: what is there, what is missing, and which way round it is.

use hil::rig::check::{Findings, check};
use hil::rig::file::{Camera, Line, Rig};
use hil::rig::info::info;
use hil::rig::probe;

use super::bench::{Folder, OnDesk, at_once, flight_image, hil, rig_image, stdout};

/// What was found at a place.
fn at<'f>(findings: &'f Findings, place: &str) -> (bool, &'f str) {
    let mut found = findings
        .findings
        .iter()
        .filter(|found| found.place == place);
    let one = found
        .next()
        .unwrap_or_else(|| panic!("{place}: {findings}"));
    assert!(found.next().is_none(), "{findings}");
    (one.right, &one.text)
}

/// The rig with its two devices in each other's place.
fn swapped(rig: &Rig) -> Rig {
    let Camera::Serial(frames) = &rig.camera else {
        panic!("a rig with frames");
    };
    let line = |device: &Line, baud| Line {
        device: device.device.clone(),
        baud,
    };
    Rig {
        link: line(frames, rig.link.baud),
        camera: Camera::Serial(line(&rig.link, frames.baud)),
        ..rig.clone()
    }
}

#[test]
fn where_nothing_is_connected_everything_that_is_missing_is_named_at_once() {
    let folder = Folder::new("nothing");
    let text = r#"board = "discovery"
camera = "serial"
[probe]
[link]
device = "/dev/no-such-link"
[frames]
device = "/dev/no-such-frames"
[power]
cycle = ["no-such-switch", "cycle"]
"#;
    let file = folder.file("rig.toml", text).display().to_string();
    let output = at_once(|| hil(&["rig", "check", "--rig", &file], &folder.0));
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    for told in [
        "probe-rs is not on the PATH",
        "cargo install probe-rs-tools",
        "/dev/no-such-link",
        "/dev/no-such-frames",
        "no-such-switch",
        "NOT ready",
    ] {
        assert!(said.contains(told), "{told}: {said}");
    }
    assert!(!said.contains(" ok "), "{said}");
}

#[test]
fn a_rig_without_a_file_cannot_be_checked() {
    let folder = Folder::new("no-file");
    let output = hil(&["rig", "check", "--rig", "no-such-rig"], &folder.0);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_rig_that_is_whole_is_ready_and_says_what_is_on_it() {
    let desk = OnDesk::with(rig_image(), 1.0);
    let findings = at_once(|| check(&desk.rig));
    assert!(findings.right(), "{findings}");
    let (_, text) = at(&findings, "frames");
    assert!(
        text.contains("rig image for `flight`, frames of 128 x 96"),
        "{text}"
    );
    let mut probe = probe::of(&desk.rig);
    let info = info(&desk.rig, probe.as_mut()).expect("a probe");
    let elf = std::fs::read(rig_image()).expect("an image");
    assert_eq!(info.identity, hil::image::identity(&elf).ok());
    assert!(info.lens.is_some_and(|lens| lens.starts_with("none")));
    assert!(info.frames.is_some());
}

#[test]
fn a_flight_image_answers_on_the_link_alone_and_that_is_told() {
    let desk = OnDesk::with(flight_image(), 1.0);
    let findings = at_once(|| check(&desk.rig));
    assert!(!findings.right());
    assert_eq!(at(&findings, "probe"), (true, "emulated STM32F407VG"));
    let (right, text) = at(&findings, "link");
    assert!(right, "{text}");
    let (right, text) = at(&findings, "frames");
    assert!(
        !right && text.contains("a flight image never answers here"),
        "{text}"
    );
}

#[test]
fn an_emulated_board_that_has_ended_is_missed_in_all_its_parts() {
    let rig = OnDesk::with(flight_image(), 1.0).rig.clone();
    let findings = at_once(|| check(&rig));
    let (right, text) = at(&findings, "probe");
    assert!(!right && text.contains("hil emulate"), "{text}");
    assert!(!at(&findings, "link").0 && !at(&findings, "frames").0);
}

#[test]
fn devices_in_each_others_place_are_told_to_be_swapped() {
    let desk = OnDesk::with(flight_image(), 1.0);
    let rig = swapped(&desk.rig);
    let findings = at_once(|| check(&rig));
    assert!(!findings.right());
    let Camera::Serial(frames) = &rig.camera else {
        panic!("a rig with frames");
    };
    let device = frames.device.display();
    let expected = format!("{device} is the board's link: the two devices are swapped");
    assert_eq!(at(&findings, "frames"), (false, expected.as_str()));
    let device = rig.link.device.display();
    let expected = format!("{device} is the board's frames port: the two devices are swapped");
    assert_eq!(at(&findings, "link"), (false, expected.as_str()));
}
