//! Logs of the real thing: what cfclient would have written of a flight of our own comes back as that flight, and what
//! it never wrote is refused by file, line and column.

use std::sync::LazyLock;

use hil::flight::{Flown, fly_native};
use hil::import_cf::{ImportError, LogFile, import};
use hil::metrics;
use hil::record::{Phase, PlanarPose, Reference};
use hil::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage};
use proptest::prelude::*;

use super::bench::{Folder, hil, json, stderr};
use super::cfclient;

/// Round one corner with a snapshot every metre, seed 1.
static FLOWN: LazyLock<Flown> = LazyLock::new(|| {
    let scenario = Scenario {
        route: Route::Corner,
        world: "arena-panels".into(),
        seed: 1,
        spacing: Spacing::from_metres(1.0).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions: Conditions::default(),
    };
    fly_native(&scenario, &mut |_| ()).expect("a flight")
});

/// Its logs, and what is imported from them.
static LOGS: LazyLock<Vec<LogFile>> = LazyLock::new(|| cfclient::logs(&FLOWN.recording));
static IMPORTED: LazyLock<Flown> = LazyLock::new(|| import(&LOGS).expect("logs"));

/// Places and headings in the logs are single precision.
const SINGLE: f64 = 1e-5;

fn assert_same_pose(ours: &PlanarPose, original: &PlanarPose, what: &str) {
    let turn = (ours.yaw - original.yaw).abs();
    assert!(
        ours.distance(original) < SINGLE && turn < SINGLE,
        "{what}: {ours:?} is not {original:?}"
    );
}

#[test]
fn the_track_is_the_filters_estimate() {
    let original = &FLOWN.recording.track;
    let ours = &IMPORTED.recording.track;
    assert_eq!(IMPORTED.recording.reference, Reference::Estimate);
    assert_eq!(ours.len(), original.len());
    for (ours, original) in ours.iter().zip(original) {
        assert!((ours.t - original.t).abs() < 1e-9, "{} s", original.t);
        assert_same_pose(&ours.truth, &original.estimate, "place");
        assert!((ours.height - original.height).abs() < SINGLE);
        assert!(ours.uncorrected.x.is_nan(), "nothing tells of it");
    }
}

#[test]
fn the_phases_are_those_that_were_flown() {
    let pairs = FLOWN.recording.track.iter().zip(&IMPORTED.recording.track);
    let differing = pairs
        .clone()
        .filter(|(original, ours)| original.phase != ours.phase)
        .count();
    // At each of the changes, by at most: the climb and the sinking above half the height, and the handshake.
    assert!(differing < 60, "{differing} of {} points", pairs.count());
    let track = &IMPORTED.recording.track;
    for end in [track.first(), track.last()] {
        assert_eq!(end.map(|point| point.phase), Some(Phase::Ground));
    }
    for phase in [Phase::Outbound, Phase::Odometry, Phase::Homing] {
        let flown = |flown: &Flown| {
            let track = flown.recording.track.iter();
            track.filter(|point| point.phase == phase).count() as f64 / 10.0
        };
        let (original, ours) = (flown(&FLOWN), flown(&IMPORTED));
        assert!(
            (original - ours).abs() < 3.0,
            "{phase:?}: {ours} s of {original} s"
        );
    }
}

#[test]
fn every_vector_that_a_row_saw_is_there_and_no_other() {
    let original = &FLOWN.recording.vectors;
    let ours = &IMPORTED.recording.vectors;
    assert!(
        ours.len() > original.len() / 2,
        "{} of {}",
        ours.len(),
        original.len()
    );
    for mark in ours {
        let source = original
            .iter()
            .rfind(|original| original.t <= mark.t)
            .expect("a vector before");
        assert!(mark.t - source.t < 0.2, "seen {} s late", mark.t - source.t);
        assert!((mark.target.x - source.target.x).abs() < SINGLE);
        assert!((mark.target.y - source.target.y).abs() < SINGLE);
        assert!((mark.start.x - source.start.x).abs() < SINGLE);
        assert!((mark.start.y - source.start.y).abs() < SINGLE);
    }
}

#[test]
fn the_turn_and_the_source_of_a_vector_come_from_another_file() {
    let original = &FLOWN.recording.vectors;
    let ours = &IMPORTED.recording.vectors;
    let visual =
        |marks: &[hil::record::VectorMark]| marks.iter().filter(|mark| mark.visual).count();
    let (expected, found) = (visual(original) as f64, visual(ours) as f64);
    let seen = ours.len() as f64 / original.len() as f64;
    assert!(
        (found - seen * expected).abs() < 0.1 * expected,
        "{found} of {expected}"
    );
    let turned = ours
        .iter()
        .filter(|mark| mark.visual && mark.target.yaw != 0.0)
        .count();
    assert!(turned > 0);
}

#[test]
fn every_snapshot_is_where_and_when_it_was_taken() {
    let original = &FLOWN.recording.snapshots;
    let ours = &IMPORTED.recording.snapshots;
    assert!(original.len() > 2);
    assert_eq!(ours.len(), original.len());
    for (ours, original) in ours.iter().zip(original) {
        assert_eq!(ours.index, original.index);
        assert_eq!(ours.odometry_count, original.odometry_count);
        assert!(ours.believed.distance(&original.believed) < SINGLE);
        assert!(
            (0.0..0.1).contains(&(ours.t - original.t)),
            "{} s",
            ours.t - original.t
        );
        assert!(ours.coefficients.is_empty(), "the logs have none");
    }
    assert_eq!(IMPORTED.summary.memory_bytes, FLOWN.summary.memory_bytes);
}

#[test]
fn every_correction_is_there_once() {
    let original = &FLOWN.recording.corrections;
    let ours = &IMPORTED.recording.corrections;
    assert!(original.len() > 1);
    assert_eq!(ours.len(), original.len());
    for (ours, original) in ours.iter().zip(original) {
        assert_eq!(ours.index, original.index);
        assert_same_pose(&ours.from, &original.from, "from");
        assert_same_pose(&ours.to, &original.to, "to");
        assert!(
            (0.0..0.2).contains(&(ours.t - original.t)),
            "{} s",
            ours.t - original.t
        );
    }
}

#[test]
fn the_figures_are_by_the_drones_own_estimate() {
    let (ours, original) = (&IMPORTED.summary, &FLOWN.summary);
    // Not the original's own lengths: those are of the true way, and of phases that begin elsewhere by a second.
    let estimated = |phases: &[Phase]| {
        let way: Vec<PlanarPose> = (FLOWN.recording.track.iter())
            .zip(&IMPORTED.recording.track)
            .filter(|(_, ours)| phases.contains(&ours.phase))
            .map(|(original, _)| original.estimate)
            .collect();
        metrics::length_in_steps(&way)
    };
    let out = ours.outbound_m - estimated(&[Phase::Outbound]);
    let back = ours.inbound_m - estimated(&[Phase::Odometry, Phase::Homing]);
    assert!(ours.outbound_m > 3.0 && out.abs() < 1e-3, "{out:+.4} m out");
    assert!(
        ours.inbound_m > 3.0 && back.abs() < 1e-3,
        "{back:+.4} m back"
    );
    let last = FLOWN.recording.track.last().expect("a track").estimate;
    assert!((ours.home_error_m - last.distance(&PlanarPose::default())).abs() < SINGLE);
    assert_eq!(ours.snapshots, original.snapshots);
    assert!(ours.completed);
    assert!(ours.odometry_only_error_m.is_nan());
}

#[test]
fn the_log_says_that_values_hold_from_row_to_row() {
    let lines = &IMPORTED.recording.log;
    assert!(lines.iter().any(|line| {
        line.text
            .contains("a value holds from row to row, here up to 200 ms apart")
    }));
    assert!(
        !lines.iter().any(|line| line.text.contains("for want of")),
        "nothing is missing"
    );
}

#[test]
fn vectors_that_are_left_behind_one_by_one_are_the_odometry() {
    let state = "Timestamp,stateEstimate.x,stateEstimate.y\n0,0,0\n1000,0,0\n";
    let vectors = "Timestamp,vh.v_to_n,vh.v_to_e,vh.v_from_n,vh.v_from_e\n0,0,0,0,0\n\
                   100,1,0,2,0\n1000,1.5,0,2,0\n";
    let maps = "Timestamp,vh.m_ss_idx,vh.m_ss_n,vh.m_ss_e,vh.m_odo_idx,vh.m_odo_n,vh.m_odo_e\n\
                0,0,0,0,0,0,0\n50,0,0,0,3,2.5,1.2\n200,0,0,0,2,2.3,1.5\n300,0,0,0,1,2.0,1.0\n";
    let file = |text: &str| LogFile {
        name: "a.csv".into(),
        bytes: text.into(),
    };
    let flown = import(&[state, vectors, maps].map(file)).expect("logs");
    let odometry = &flown.recording.odometry;
    // North and east in metres become counts of 0.1 m to the north and west.
    assert_eq!((odometry[0].index, odometry[0].counts), (2, [2, 3]));
    assert_eq!((odometry[1].index, odometry[1].counts), (1, [3, -5]));
    assert_eq!(flown.recording.odometry_stored, 3);
}

#[test]
fn what_is_missing_is_told_and_the_rest_is_drawn() {
    let only = |name: &str| {
        let file = LOGS
            .iter()
            .find(|file| file.name.starts_with(name))
            .expect(name);
        import(std::slice::from_ref(file)).expect("a log").recording
    };
    let told = |recording: &hil::record::Recording, text: &str| {
        recording
            .log
            .iter()
            .any(|line| line.level == "warn" && line.text.contains(text))
    };
    let state = only("state");
    assert!(state.track.len() > 100);
    assert!(told(
        &state,
        "not known for want of vh.v_to_n, vh.v_to_e, vh.v_from_n, vh.v_from_e"
    ));
    assert!(told(&state, "not known for want of vh.i_ss_idx"));

    // The flight app notes where it took its vectors: a track, where there is no other.
    let vectors = only("vector");
    assert!(vectors.track.len() > 100);
    let led = FLOWN.recording.vectors[0].t + 1.0;
    let whole_track = &IMPORTED.recording.track;
    for point in vectors.track.iter().filter(|point| point.t > led) {
        let whole = whole_track
            .iter()
            .find(|whole| (whole.t - point.t).abs() < 0.06);
        let apart = whole.map(|whole| whole.truth.distance(&point.truth));
        assert!(
            apart.is_none_or(|apart| apart < 0.5),
            "{} s: {apart:?} m",
            point.t
        );
    }
    assert!(told(&vectors, "not known for want of stateEstimate.z"));
    assert!(told(&vectors, "not known for want of vh.v_source"));
}

#[test]
fn files_of_two_flights_are_told_apart() {
    let late = "Timestamp,vh.p_block\n9000000,1\n9000100,2\n";
    let mut files = vec![LOGS[0].clone()];
    files.push(LogFile {
        name: "late.csv".into(),
        bytes: late.into(),
    });
    let flown = import(&files).expect("logs");
    let told = |line: &hil::record::LogLine| line.text.contains("late.csv shares no time");
    assert!(flown.recording.log.iter().any(told));
}

#[test]
fn a_pause_of_the_rows_is_told_and_nothing_is_drawn_in_it() {
    let log = "Timestamp,stateEstimate.x,stateEstimate.y\n0,9,0\n5000,0,0\n6000,0,0\n14000,4,0\n15000,4,0\n";
    let flown = import(&[LogFile {
        name: "a.csv".into(),
        bytes: log.into(),
    }])
    .expect("a log");
    let told = |line: &hil::record::LogLine| line.text.contains("without a row, once 8.0 s");
    assert!(flown.recording.log.iter().any(told));
    let track = &flown.recording.track;
    let known = |t: f64| (5.0..=6.0).contains(&t) || (14.0..=15.0).contains(&t);
    assert!(track.iter().all(|point| known(point.t)));
    assert_eq!(track.len(), 22);
    assert!(
        track
            .iter()
            .any(|point| point.t == 14.5 && point.truth.x == 4.0)
    );
}

/// Every error but that of a file that cannot be read says in which line.
fn names_a_line(error: &ImportError) -> bool {
    matches!(
        error,
        ImportError::Faulty {
            line: 1..,
            column: 1..,
            ..
        }
    )
}

fn holds(files: &[LogFile]) -> Result<(), TestCaseError> {
    match import(files) {
        Ok(flown) => {
            let page = hil::report::html(&flown.recording, &flown.summary);
            prop_assert!(page.contains("</html>"));
        }
        Err(error) => prop_assert!(names_a_line(&error), "{error}"),
    }
    Ok(())
}

fn named(bytes: Vec<u8>) -> LogFile {
    LogFile {
        name: "any.csv".into(),
        bytes,
    }
}

/// A log whose values are any numbers: huge, tiny, none.
fn any_log() -> impl Strategy<Value = Vec<u8>> {
    let names = prop::sample::subsequence(cfclient::VARIABLES.to_vec(), 1..12);
    let value = prop_oneof![
        any::<f64>().prop_map(|value| value.to_string()),
        any::<u8>().prop_map(|value| value.to_string()),
        (-3.0..3.0_f64).prop_map(|value| value.to_string()),
        Just("nan".to_owned()),
    ];
    let rows = prop::collection::vec((0..5_000_u32, prop::collection::vec(value, 12)), 0..20);
    (names, 0..16_777_216_u32, rows).prop_map(|(names, start, rows)| {
        let mut text = format!("Timestamp,{}\n", names.join(","));
        let mut tick = start;
        for (step, values) in rows {
            tick = (tick + step) % 16_777_216;
            text += &format!("{tick},{}\n", values[..names.len()].join(","));
        }
        text.into_bytes()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_a_flight_or_an_error_with_its_line(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        holds(&[named(bytes.clone())])?;
        holds(&[named([b"Timestamp,vh.v_to_n\n".as_slice(), &bytes].concat())])?;
    }

    #[test]
    fn any_values_are_a_flight(first in any_log(), second in any_log()) {
        holds(&[named(first), named(second)])?;
    }

    #[test]
    fn a_log_with_a_broken_byte_is_a_flight_or_an_error_with_its_line(
        file in 0..cfclient::FILES, place in any::<prop::sample::Index>(), byte: u8
    ) {
        // The header and some rows: enough to break.
        let mut bytes = LOGS[file].bytes[..2_000].to_vec();
        let place = place.index(bytes.len());
        bytes[place] = byte;
        holds(&[named(bytes)])?;
    }
}

fn write(folder: &Folder, file: &LogFile) -> String {
    folder.with(&file.name, &file.bytes)
}

#[test]
fn the_command_leaves_the_folder_of_a_flight_and_one_json_object() {
    let folder = Folder::new();
    let files: Vec<String> = LOGS.iter().map(|file| write(&folder, file)).collect();
    let out = folder.file("out");
    let mut arguments = vec!["import-cf", "--json", "--out", &out];
    arguments.extend(files.iter().map(String::as_str));
    let output = hil(&arguments);
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    let summary = json(&output);
    assert_eq!(summary["backend"], "cfclient");
    assert!(summary["odometry_only_error_m"].is_null());
    folder.assert_holds_a_flight("out");
    let recording =
        std::fs::read_to_string(folder.file("out/recording.json")).expect("a recording");
    assert!(recording.contains("\"reference\":\"estimate\""));
}

#[test]
fn the_command_refuses_what_is_no_log_by_file_line_and_column() {
    let folder = Folder::new();
    for (name, text, message) in [
        (
            "none.csv",
            "time,x\n1,2\n",
            "none.csv:1:1: not a log of cfclient",
        ),
        (
            "word.csv",
            "Timestamp,vh.v_to_n\n1,0.5\n2,half\n",
            "word.csv:3:3: `half` is no number",
        ),
        (
            "twice.csv",
            "Timestamp,vh.p_pt\n70000,1\n300,1\n",
            "twice.csv:3:1: the time falls",
        ),
        (
            "other.csv",
            "Timestamp,pm.vbat\n1,3.7\n",
            "other.csv:1:1: no file has a column `vh.*`",
        ),
    ] {
        let path = write(
            &folder,
            &LogFile {
                name: name.into(),
                bytes: text.into(),
            },
        );
        let output = hil(&["import-cf", &path, "--out", &folder.file("")]);
        let stderr = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(message), "{stderr}");
    }
    let output = hil(&["import-cf", "no/such/file.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no/such/file.csv: No such file"));
}
