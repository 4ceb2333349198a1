use autopilot::app::{Arrival, Step, Until};
use link::{Mode, Record, WorldPoint};

use super::*;
use crate::scenario::SnapshotForm;

const GOOD: &str = r#"
meaning = "Round one corner"
world = "arena"
route = "corner"
seeds = { first = 3, count = 2 }

[recording]
spacing = 1.0
snapshots = "lean"
deviation = 0.3

[conditions]
wind = { mean = 1.5, turbulence = 0.2 }
quirks = ["self-acknowledge"]
flow_scale = { amplitude = 0.03, period = 60 }
pilot = true

[[expect]]
metric = "home_error_m.p95"
at_most = 0.5
claim = 31
reason = "it is short"
"#;

fn parse(text: &str) -> Result<ScenarioFile, FileError> {
    ScenarioFile::parse(Path::new("somewhere/corner.toml"), text.to_owned())
}

/// What is said of the good file with a line of it replaced, and on which line.
fn refused(line: &str, by: &str) -> (usize, String) {
    assert!(GOOD.contains(line), "{line}");
    match parse(&GOOD.replace(line, by)) {
        Err(FileError::Mistake { line, reason, .. }) => (line, reason),
        other => panic!("{by}: {other:?}"),
    }
}

#[test]
fn a_file_says_what_is_flown() {
    let file = parse(GOOD).expect("a scenario");
    assert_eq!(
        (file.name.as_str(), file.backend),
        ("corner", Backend::Native)
    );
    assert_eq!(file.seeds.all().collect::<Vec<_>>(), [3, 4]);
    let scenario = file.scenario(4).expect("a flight");
    assert_eq!((scenario.route, scenario.seed), (Route::Corner, 4));
    let every_metre = Spacing::from_metres(1.0).expect("a spacing");
    assert_eq!(
        (scenario.homing, scenario.spacing),
        (Homing::Both, every_metre)
    );
    let storage = scenario.storage;
    assert_eq!(
        (storage.snapshots, storage.deviation.metres()),
        (SnapshotForm::Lean, 0.3)
    );
    let wind = scenario.conditions.wind.expect("wind");
    assert_eq!((wind.mean_m_s, wind.turbulence), (1.5, 0.2));
    assert!(scenario.conditions.quirks.self_acknowledge);
    let swing = scenario.conditions.flow_scale.expect("a swing");
    assert_eq!((swing.amplitude, swing.period_s), (0.03, 60.0));
    assert!(scenario.conditions.piloted);
    assert!(!scenario.conditions.quirks.short_buffer);
    assert_eq!(file.expectations[0].bounds.at_most, Some(0.5));
}

#[test]
fn what_cannot_be_flown_is_refused_with_its_line_and_a_reason() {
    for (line, by, at, reason) in [
        (
            "spacing = 1.0",
            "spaceing = 1.0",
            8,
            "unknown field `spaceing`",
        ),
        ("spacing = 1.0", "spacing = 0.25", 8, "steps of 0.1"),
        (
            "spacing = 1.0",
            "spacing = \"far\"",
            8,
            "metres, or \"auto\"",
        ),
        ("deviation = 0.3", "deviation = 0.25", 10, "from 0.1 to 1 m"),
        ("lean", "tiny", 9, "unknown variant `tiny`"),
        ("count = 2", "count = 0", 5, "0 seeds: from 1"),
        ("\"arena\"", "\"moon\"", 3, "no world `moon`: arena"),
        ("\"arena\"", "\"moon.toml\"", 3, "moon.toml"),
        ("\"corner\"", "\"zigzag\"", 4, "unknown variant `zigzag`"),
        (
            "\"corner\"",
            "{ through = { places = [[0, 0]] } }",
            4,
            "two places",
        ),
        (
            "\"corner\"",
            "{ through = { places = [[0, 0], [-3, 0]], passes = 1_001 } }",
            4,
            "passes: from 1 to 1000",
        ),
        (
            "\"corner\"",
            "{ script = [{ record = \"both\" }, { fly-to = [-3, 0] }] }",
            4,
            "ends with following",
        ),
        (
            "\"corner\"",
            "{ script = [{ follow-for = 0 }] }",
            4,
            "from 0.1 to 10000 s",
        ),
        (
            "\"corner\"",
            "{ script = [\"land\"] }",
            4,
            "unknown variant `land`",
        ),
        (
            "\"corner\"",
            "{ meander = { length = 1e9 } }",
            4,
            "from 3 to 2000 m",
        ),
        ("mean = 1.5", "mean = 99", 13, "from 0 to 32 m/s"),
        (
            "\"self-acknowledge\"",
            "\"none\"",
            14,
            "unknown variant `none`",
        ),
        (
            "amplitude = 0.03",
            "amplitude = 0.6",
            15,
            "an amplitude from 0 to 0.5",
        ),
        (
            "period = 60",
            "period = 0",
            15,
            "a period from 1 to 10000 s",
        ),
        (
            "home_error_m.p95",
            "home_error",
            19,
            "unknown variant `home_error`",
        ),
        ("at_most = 0.5", "", 18, "`at_least` or `at_most`"),
        (
            "at_most = 0.5",
            "at_most = 0.5\nat_least = 0.6",
            18,
            "beyond",
        ),
        ("at_most = 0.5", "at_most = nan", 18, "no number"),
        ("claim = 31", "claim = 99", 18, "1 to 36"),
        ("reason = \"it is short\"", "", 18, "missing field `reason`"),
        ("spacing = 1.0", "spacing =", 8, ""),
    ] {
        let (line, said) = refused(line, by);
        assert!(said.contains(reason), "{by}: {said}");
        assert_eq!(line, at, "{by}: {said}");
    }
}

#[test]
fn snapshots_are_spaced_by_theory_where_the_file_says_auto() {
    let file = parse(&GOOD.replace("spacing = 1.0", "spacing = \"auto\"")).expect("a scenario");
    let scenario = file.scenario(3).expect("a flight");
    assert_eq!(scenario.spacing, Spacing::ByTheory);
    assert!(scenario.snapshot_spacing_m().is_nan());
}

#[test]
fn a_scenario_that_its_board_cannot_fly_is_refused() {
    let sequence = "route = \"corner\"\nhoming = \"sequence\"\nbackend = \"emulator\"";
    let (line, reason) = refused("route = \"corner\"", sequence);
    assert_eq!(line, 5);
    assert!(reason.contains("native"), "{reason}");
    let sequence = "homing = \"sequence\"\n[recording]\nspacing = \"auto\"";
    let (line, reason) = refused("[recording]\nspacing = 1.0", sequence);
    assert_eq!(line, 9);
    assert!(reason.contains("along odometry"), "{reason}");
    let fault = "camera_fault = { name = \"unplugged\", at = 10 }";
    let (line, reason) = refused("quirks = [\"self-acknowledge\"]", fault);
    assert_eq!(line, 14);
    assert!(reason.contains("no camera wires"), "{reason}");
}

#[test]
fn an_error_names_file_line_and_reason() {
    let error = parse(&GOOD.replace("count = 2", "count = 0")).expect_err("no seeds");
    let said = error.to_string();
    assert_eq!(said, "somewhere/corner.toml:5: 0 seeds: from 1 to 1000000");
}

#[test]
fn a_fingerprint_tells_two_texts_apart() {
    let one = parse(GOOD).expect("a scenario");
    let other = parse(&GOOD.replace("1.5", "1.6")).expect("a scenario");
    assert_eq!(
        one.fingerprint(),
        parse(GOOD).expect("the same").fingerprint()
    );
    assert_ne!(one.fingerprint(), other.fingerprint());
}

#[test]
fn a_way_of_its_own_leads_through_its_places_north_and_east() {
    let own = "{ through = { places = [[0, 0], [-3, 1]], passes = 2 } }";
    let file = parse(&GOOD.replace("\"corner\"", own)).expect("a scenario");
    let route = file.scenario(1).expect("a flight").route.waypoints();
    let places: Vec<_> = route
        .waypoints
        .iter()
        .map(|way| (way.place.x, way.place.y))
        .collect();
    // The link's x is north, its y west.
    assert_eq!(places, [(0.0, 0.0), (-3.0, -1.0), (0.0, 0.0)]);
}

#[test]
fn a_script_is_flown_step_by_step_with_the_files_recording() {
    let own = "{ script = [\"clear\", { record = \"both\" }, { fly-to = [-3, 1] }, \
        { follow-for = 4.5 }, \"idle\", { record = \"snapshot\" }, \"follow-home\"] }";
    let file = parse(&GOOD.replace("\"corner\"", own)).expect("a scenario");
    let scenario = file.scenario(3).expect("a flight");
    let command = |mode, args: &[u8]| Step::Command {
        mode,
        args: args.to_vec(),
    };
    let follow = |until| Step::Follow {
        mode: Mode::Follow,
        until,
    };
    let expected = [
        command(Mode::Clear, &[]),
        command(Mode::Record(Record::ROUTE), &[10, 3, 3]),
        Step::FlyTo {
            place: WorldPoint { x: -3.0, y: -1.0 },
            arrival: Arrival::WAYPOINT,
        },
        follow(Until::Elapsed(4_500)),
        command(Mode::Idle, &[]),
        command(Mode::Record(Record::SINGLE_SNAPSHOT), &[10, 3, 3]),
        follow(Until::Home),
    ];
    assert_eq!(scenario.script().steps, expected);
}
