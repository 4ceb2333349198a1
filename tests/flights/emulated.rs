//! Flights of the image that would be flashed, on an emulated STM32F407. The image is built first.

use std::path::PathBuf;
use std::sync::OnceLock;

use hil::flight::{Flown, fly_emulated, fly_emulated_alone, fly_native};
use hil::image;
use hil::scenario::{
    Conditions, Deviation, Homing, Route, Scenario, SnapshotForm, Spacing, Storage,
};
use tests::Budgets;

/// The image; a machine that cannot build it fails every test here.
fn elf() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| {
        let path: PathBuf = image::build(&|line| eprintln!("{line}")).expect("the firmware builds");
        std::fs::read(path).expect("the image is there")
    })
}

fn scenario(route: Route) -> Scenario {
    let spacing = Spacing::from_metres(2.0).expect("a spacing");
    Scenario {
        route,
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing,
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions: Conditions::default(),
    }
}

fn fly(route: Route) -> Flown {
    fly_emulated(&scenario(route), elf(), &mut |_| ()).expect("a flight")
}

/// One flight for all tests that only look at it.
fn corner() -> &'static Flown {
    static FLOWN: OnceLock<Flown> = OnceLock::new();
    FLOWN.get_or_init(|| fly(Route::Corner))
}

fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).expect("JSON")
}

#[test]
fn native_and_emulated_flights_agree_to_the_bit() {
    let (emulated, native) = (
        &corner().recording,
        fly_native(&scenario(Route::Corner), &mut |_| ())
            .expect("a flight")
            .recording,
    );
    assert!(
        emulated.snapshots.len() >= 2
            && emulated.vectors.len() > 100
            && !emulated.corrections.is_empty()
    );
    assert_eq!(json(&emulated.snapshots), json(&native.snapshots));
    assert_eq!(json(&emulated.vectors), json(&native.vectors));
    assert_eq!(json(&emulated.corrections), json(&native.corrections));
    assert_eq!(json(&emulated.track), json(&native.track));
    let exposures = |recording: &hil::record::Recording| -> Vec<_> {
        recording
            .frames
            .iter()
            .map(|frame| (frame.luma.to_bits(), frame.lines, frame.gain.to_bits()))
            .collect()
    };
    assert_eq!(exposures(emulated), exposures(&native));
}

#[test]
fn a_route_of_packed_snapshots_is_followed_home_alike_on_either_board() {
    for snapshots in [SnapshotForm::Lean, SnapshotForm::Fine] {
        let scenario = Scenario {
            storage: Storage {
                snapshots,
                deviation: Deviation::from_metres(0.3).expect("three tenths"),
            },
            ..scenario(Route::Corner)
        };
        let emulated = fly_emulated(&scenario, elf(), &mut |_| ()).expect("a flight");
        let native = fly_native(&scenario, &mut |_| ()).expect("a flight");
        assert!(native.summary.completed, "{}", native.summary.outcome);
        assert!(native.recording.corrections.len() >= 2);
        let [emulated, native] = [emulated, native].map(|flown| flown.recording);
        assert_eq!(json(&emulated.snapshots), json(&native.snapshots));
        assert_eq!(json(&emulated.vectors), json(&native.vectors));
        assert_eq!(json(&emulated.track), json(&native.track));
        let paper = &corner().recording;
        assert_eq!(native.snapshots.len(), paper.snapshots.len());
        assert_ne!(json(&native.snapshots), json(&paper.snapshots));
        let less = snapshots == SnapshotForm::Lean;
        assert_eq!(native.memory().snapshots < paper.memory().snapshots, less);
    }
}

#[test]
fn an_emulated_flight_is_the_same_flight_every_time_and_with_a_second_thread() {
    let again = fly_emulated_alone(&scenario(Route::Corner), elf(), &mut |_| ());
    let again = again.expect("a flight");
    assert_eq!(json(&corner().recording), json(&again.recording));
}

#[test]
fn the_emulated_board_comes_home_without_losing_a_frame() {
    let budgets = Budgets::load();
    let summary = &corner().summary;
    assert!(summary.completed, "{}", summary.outcome);
    assert!(summary.frames_sent > 500);
    budgets.hold("home_error_m", summary.home_error_m);
    budgets.hold("frames_dropped", summary.frames_dropped as f64);
}

#[test]
fn the_firmwares_cycle_counter_agrees_with_the_emulators() {
    let budgets = Budgets::load();
    let flown = corner();
    let cycles = flown
        .summary
        .cycles_per_frame
        .expect("an emulated flight has cycles");
    assert_eq!(
        flown.recording.frames.len() as u64,
        flown.summary.frames_sent
    );
    budgets.hold(
        "counter_disagreement_cycles",
        f64::from(cycles.largest_disagreement.expect("of an emulated core")),
    );
    budgets.hold("cycles_per_frame_p99", f64::from(cycles.p99));
}

#[test]
fn the_image_keeps_to_its_budget_of_flash_ram_and_stack() {
    let budgets = Budgets::load();
    let firmware = corner()
        .summary
        .firmware
        .expect("an emulated flight has an image");
    budgets.hold("flash_bytes", f64::from(firmware.flash_bytes));
    budgets.hold("ram_bytes", f64::from(firmware.ram_bytes));
    budgets.hold(
        "stack_peak_bytes",
        f64::from(firmware.stack_peak_bytes.expect("the stack holds")),
    );
}

/// The checkout that this test and the image are built from.
const CHECKOUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// The text of a source line, from 1; a file without it fails the test.
fn source_line(file: &str, line: usize) -> String {
    let path = PathBuf::from(CHECKOUT).join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{file}: {error}"));
    let line = text.lines().nth(line - 1);
    line.unwrap_or_else(|| panic!("{file} is shorter"))
        .to_owned()
}

/// Of the lines of a log: the firmware's words, each with the line below it.
fn firmware_lines(log: &str) -> Vec<(&str, &str)> {
    let lines: Vec<&str> = log.lines().collect();
    let pairs = lines.windows(2).map(|pair| (pair[0], pair[1]));
    pairs
        .filter_map(|(line, below)| Some((line.split_once(" firmware ")?.1, below)))
        .collect()
}

#[test]
fn every_line_of_the_firmware_is_in_the_flights_log_with_its_time_and_the_statement_it_is_from() {
    let folder = std::env::temp_dir().join(format!("flight-log-{}", std::process::id()));
    hil::folder::prepare(&folder).expect("a folder");
    hil::folder::write(&folder, corner()).expect("written");
    let log = std::fs::read_to_string(folder.join("flight.log")).expect("a log");
    std::fs::remove_dir_all(&folder).expect("removed");
    let lines = firmware_lines(&log);
    assert!(lines.len() > 100, "{log}");
    let mut before_s = 0.0;
    for (said, below) in &lines {
        let (stamp, text) = said.split_once(' ').expect("a stamp");
        let stamp_s: f64 = stamp.parse().expect("seconds");
        assert!(stamp_s >= before_s, "{said}");
        before_s = stamp_s;
        let (module, place) = below
            .trim_start()
            .strip_prefix("└─ ")
            .and_then(|place| place.split_once(" @ "))
            .unwrap_or_else(|| panic!("no place below {said}: {below}"));
        assert!(module.starts_with("firmware::"), "{below}");
        let (file, line) = place.rsplit_once(':').expect("a line");
        let source = source_line(file, line.parse().expect("a number"));
        assert!(source.contains("defmt::"), "{text}: {place} is {source}");
    }
    // The statement is the record's own and not just any.
    let place = |text: &str| {
        lines
            .iter()
            .find(|(said, _)| said.contains(text))
            .unwrap()
            .1
    };
    let statement = |text: &str| {
        let (file, line) = place(text)
            .rsplit(' ')
            .next()
            .unwrap()
            .rsplit_once(':')
            .unwrap();
        let line: usize = line.parse().unwrap();
        [line, line + 1]
            .map(|line| source_line(file, line))
            .join("")
    };
    for text in ["state cycles ", "health frames ", "faults sensor "] {
        assert!(
            statement(text).contains(text),
            "{text}: {}",
            statement(text)
        );
    }
}
