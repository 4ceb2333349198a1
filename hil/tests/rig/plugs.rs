//! Pulled plugs and worse: each ends with a word about what it is, or is counted and gone.

use std::thread;
use std::time::{Duration, Instant};

use hil::live::Stop;
use hil::rig::file::{Camera, Line, Rig};
use hil::rig::{Blind, Unready};

use super::bench::{Folder, OnDesk, at_once, flight_image, hil, rig_image, stderr};
use super::cable::{Cable, Random};
use super::flights::{SPEED, fly, fly_until, unready};

/// What a cable should do.
fn nothing(_: Duration, _: &mut Random, byte: u8) -> Option<u8> {
    Some(byte)
}

/// One byte in ten does not arrive.
fn a_tenth_is_lost(_: Duration, random: &mut Random, byte: u8) -> Option<u8> {
    (random.share() >= 0.1).then_some(byte)
}

/// One byte in ten does not arrive for a second.
fn a_tenth_is_lost_for_a_while(since: Duration, random: &mut Random, byte: u8) -> Option<u8> {
    (since.as_secs() != 5 || random.share() >= 0.1).then_some(byte)
}

/// After five seconds, anything.
fn garbage(since: Duration, random: &mut Random, byte: u8) -> Option<u8> {
    Some(match since.as_secs() {
        0..5 => byte,
        _ => (256.0 * random.share()) as u8,
    })
}

fn frames_of(rig: &Rig) -> &Line {
    match &rig.camera {
        Camera::Serial(line) => line,
        Camera::Fitted => panic!("a rig with frames"),
    }
}

/// The rig with a cable to its frames.
fn with_frames(rig: &Rig, cable: &Cable) -> Rig {
    Rig {
        camera: Camera::Serial(cable.line.clone()),
        ..rig.clone()
    }
}

/// Ends within `limit`.
fn within<T>(limit: Duration, work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let done = work();
    assert!(started.elapsed() < limit, "took {:?}", started.elapsed());
    done
}

#[test]
fn a_frames_plug_pulled_in_mid_flight_ends_the_flight_with_its_name() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let pulled = Some(Duration::from_secs(3));
    let cable = Cable::to(frames_of(&desk.rig), pulled, nothing);
    let rig = with_frames(&desk.rig, &cable);
    let why = within(Duration::from_secs(12), || unready(fly(&rig, rig_image())));
    assert!(matches!(&why, Unready::Blind(Blind::Gone(_))), "{why}");
    let device = cable.line.device.display().to_string();
    assert!(why.to_string().contains(&device), "{why}");
}

#[test]
fn a_link_plug_pulled_in_mid_flight_ends_the_flight() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let cable = Cable::to(&desk.rig.link, Some(Duration::from_secs(3)), nothing);
    let rig = Rig {
        link: cable.line.clone(),
        ..desk.rig.clone()
    };
    let why = within(Duration::from_secs(12), || unready(fly(&rig, rig_image())));
    assert!(matches!(&why, Unready::LinkLost { .. }), "{why}");
}

#[test]
fn a_peer_that_turns_to_garbage_is_told_with_what_became_of_the_frames() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let cable = Cable::to(frames_of(&desk.rig), None, garbage);
    let rig = with_frames(&desk.rig, &cable);
    let why = within(Duration::from_secs(20), || unready(fly(&rig, rig_image())));
    let Unready::Blind(Blind::Unused(figures)) = &why else {
        panic!("{why}");
    };
    assert!(figures.used > 0 && figures.unanswered > 0, "{why}");
}

#[test]
fn a_line_that_loses_a_tenth_of_all_bytes_is_no_line() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let cable = Cable::to(frames_of(&desk.rig), None, a_tenth_is_lost);
    let rig = with_frames(&desk.rig, &cable);
    let why = within(Duration::from_secs(15), || unready(fly(&rig, rig_image())));
    let lost = matches!(
        &why,
        Unready::Blind(Blind::Unused(_)) | Unready::NoIdentity { .. } | Unready::NoSession
    );
    assert!(lost, "{why}");
}

#[test]
fn a_second_of_lost_bytes_is_counted_and_the_flight_goes_on() {
    let desk = OnDesk::with(rig_image(), SPEED);
    let cable = Cable::to(frames_of(&desk.rig), None, a_tenth_is_lost_for_a_while);
    let rig = with_frames(&desk.rig, &cable);
    let stop = Stop::default();
    let asks = stop.clone();
    let timer = thread::spawn(move || {
        thread::sleep(Duration::from_secs(10));
        asks.request();
    });
    let flown = fly_until(&rig, rig_image(), &stop);
    timer.join().expect("it has asked");
    let flight = flown.unwrap_or_else(|error| panic!("{error}"));
    assert!(
        flight.flown.summary.frames_dropped > 0,
        "what was torn is counted"
    );
    let log = &flight.flown.recording.log;
    let told = log
        .iter()
        .find(|line| line.text.starts_with("frames over serial: "));
    let told = told.expect("an account of the frames");
    assert_eq!(told.level, "warn");
}

#[test]
fn a_flight_image_is_refused_before_it_is_flashed() {
    let (desk, image) = (OnDesk::with(rig_image(), SPEED), flight_image());
    let why = at_once(|| unready(fly(&desk.rig, image)));
    assert!(matches!(why, Unready::NoRigImage), "{why}");
}

#[test]
fn an_image_that_never_says_who_it_is_is_told() {
    // A probe that says it has flashed, and a board on which the old image runs.
    let desk = OnDesk::with(flight_image(), SPEED);
    let folder = Folder::new("other-image");
    super::probe_rs::play_success(&folder);
    let text = desk.rig.to_toml().expect("text");
    let probe = text
        .split("[probe]")
        .nth(1)
        .and_then(|rest| rest.split('[').next());
    let text = text.replace(probe.expect("a probe"), "\n");
    let rig = folder.file("rig.toml", &text).display().to_string();
    let elf = rig_image().display().to_string();
    let out = folder.0.join("out").display().to_string();
    let arguments = [
        "fly",
        "--backend",
        "board",
        "--rig",
        &rig,
        "--firmware",
        &elf,
        "--out",
        &out,
    ];
    let output = at_once(|| hil(&arguments, &folder.0));
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("no identification came"), "{said}");
}

#[test]
fn a_rig_that_is_not_there_fails_at_once_and_names_all_that_is_missing() {
    let folder = Folder::new("absent");
    let text = "board = \"flight\"\ncamera = \"serial\"\n[probe]\nemulated-port = 9\n\
        [link]\ndevice = \"/dev/no-such-link\"\n[frames]\ndevice = \"/dev/no-such-frames\"\n";
    let rig = folder.file("rig.toml", text).display().to_string();
    let elf = rig_image().display().to_string();
    let out = folder.0.join("out").display().to_string();
    let arguments = [
        "fly",
        "--backend",
        "board",
        "--rig",
        &rig,
        "--firmware",
        &elf,
        "--out",
        &out,
    ];
    let output = at_once(|| hil(&arguments, &folder.0));
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for told in ["tcp:9", "/dev/no-such-link", "/dev/no-such-frames"] {
        assert!(said.contains(told), "{told}: {said}");
    }
}
