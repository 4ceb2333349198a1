//! The scenario library, and the verbs that fly it: fly, sweep, merge, replay.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use fake_sensors::world::World;
use hil::flight::FlightError;
use hil::parallel;
use hil::scenario::file::{Backend, ScenarioFile};
use hil::sweep::{FlightFigures, Outcome, Vessel, fly_each};
use nalgebra::Vector2;

use super::bench::{CORNER, Folder, hil, json, scenarios, stderr};

/// Scenarios whose flights take many seconds, some of them minutes: flown by `hil experiments` alone.
const LONG: [&str; 14] = [
    "corridor-120m",
    "corridor-odometry",
    "corridor-snapshot",
    "forest-300m",
    "forest-300m-fine",
    "s-greenhouse",
    "s-lean",
    "s-one-metre",
    "s-soft",
    "u-lean-photograph",
    "u-lean-swing",
    "u-odometry",
    "u-office",
    "u-wind",
];

fn image() -> &'static [u8] {
    static IMAGE: OnceLock<Vec<u8>> = OnceLock::new();
    IMAGE.get_or_init(|| {
        let path = hil::image::build(&|_| ()).expect("the firmware builds");
        fs::read(path).expect("the image is there")
    })
}

/// The outcome of a scenario's first seed, which speaks for all of them when it keeps what they should. If it does not,
/// it may be one of those that are allowed not to: then all seeds decide.
fn outcome(file: &ScenarioFile) -> Outcome {
    let first = flown(file, &[file.seeds.first]);
    if first.is_kept() {
        first
    } else {
        flown(file, &file.seeds.all().collect::<Vec<_>>())
    }
}

fn flown(file: &ScenarioFile, seeds: &[u64]) -> Outcome {
    let vessel = match file.backend {
        Backend::Native => Vessel::Native,
        Backend::Emulator => Vessel::Emulator(image()),
    };
    let nothing = |_: &_, _: &FlightFigures| Ok::<_, FlightError>(());
    let flights = fly_each(seeds, vessel, |seed| file.scenario(seed), nothing, |_| ());
    Outcome::of(file, &flights.expect("a flight"))
}

#[test]
fn every_short_scenario_of_the_library_keeps_what_it_expects() {
    let mut files = scenarios("tests/scenarios");
    files.retain(|file| !LONG.contains(&file.name.as_str()));
    assert!(files.len() >= 20, "{} scenarios", files.len());
    let broken: Vec<String> = parallel::map(&files, outcome, |_| ())
        .iter()
        .flat_map(|outcome| outcome.broken().collect::<Vec<_>>())
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn every_way_of_a_kilometre_is_as_long_and_clear_of_what_stands_there() {
    // Beside the way, metres: what a drone that follows by odometry and sight may stray, and its rotors.
    const ASIDE_M: [f32; 3] = [-0.6, 0.0, 0.6];
    const HEIGHTS_M: [f32; 3] = [0.3, 0.55, 0.8];
    let files = scenarios("tests/scenarios/kilometre");
    assert_eq!(files.len(), 3);
    for file in files {
        let scenario = file.scenario(file.seeds.first).expect("a flight");
        let world = World::open(&scenario.world, scenario.seed).expect("a world");
        let route = scenario.route.waypoints();
        let length_m = route.length_m();
        assert!(
            (1_000.0..1_025.0).contains(&length_m),
            "{}: {length_m} m",
            file.name
        );
        for leg in route.waypoints.windows(2) {
            let [from, to] =
                [leg[0].place, leg[1].place].map(|place| Vector2::new(place.x, place.y));
            let along = (to - from).normalize();
            let across = Vector2::new(-along.y, along.x);
            for (aside_m, height_m) in ASIDE_M
                .iter()
                .flat_map(|aside| HEIGHTS_M.map(|height| (aside, height)))
            {
                let at = |place: Vector2<f32>| (place + *aside_m * across).push(height_m);
                assert!(
                    world.clear_between(at(from), at(to)),
                    "{}: {from} to {to}, {aside_m} m aside, at {height_m} m",
                    file.name
                );
            }
        }
    }
}

#[test]
fn a_flight_that_fails_is_named_with_both_figures_and_replayed_to_the_byte() {
    let folder = Folder::new();
    let hopeless = CORNER.replace("at_most = 0.5", "at_most = 0.01");
    let file = folder.with("hopeless.toml", hopeless.replace("count = 3", "count = 1"));
    let output = hil(&["sweep", &file, "--json", "--out", &folder.file("out")]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let found = &json(&output)["expectations"][0];
    let error_m = found["found"].as_f64().expect("a figure");
    let said = stderr(&output);
    let figure = format!("{error_m:.2} m");
    for word in ["hopeless", "home error, largest", "at most 0.01 m", &figure] {
        assert!(said.contains(word), "{word}: {said}");
    }
    assert_eq!(json(&output)["failed_seeds"], serde_json::json!([1]));

    let flight = folder.file("out/hopeless-native-1");
    let output = hil(&["replay", &flight, "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(json(&output)["reproduced"], true);

    let recording = Path::new(&flight).join("recording.json");
    let mut bytes = fs::read(&recording).expect("the recording");
    bytes[1_000] ^= 1;
    fs::write(&recording, bytes).expect("a changed recording");
    let output = hil(&["replay", &flight, "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(json(&output)["first_difference"], 1_000);
}

#[test]
fn shards_put_together_are_the_sweep_and_nothing_else_is_taken_for_one() {
    let folder = Folder::new();
    let file = folder.with("corner.toml", CORNER);
    let out = folder.file("out");
    let whole = hil(&["sweep", &file, "--json", "--out", &folder.file("whole")]);
    assert_eq!(whole.status.code(), Some(0), "{}", stderr(&whole));
    for shard in ["1/2", "2/2"] {
        let output = hil(&["sweep", &file, "--shard", shard, "--out", &out]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let (one, two) = (
        folder.file("out/corner-1-of-2.json"),
        folder.file("out/corner-2-of-2.json"),
    );
    let table = folder.file("flights.csv");
    let merged = hil(&["merge", &two, &one, "--json", "--csv", &table]);
    assert_eq!(merged.status.code(), Some(0), "{}", stderr(&merged));
    assert_eq!(merged.stdout, whole.stdout);
    let table = fs::read_to_string(table).expect("a table");
    assert_eq!(table.lines().count(), 1 + 3);

    for (shards, reason) in [
        (vec!["merge", &one], "missing: shard 2/2"),
        (vec!["merge", &one, &two, &one], "overlap"),
    ] {
        let output = hil(&shards);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
    let text = fs::read_to_string(&two).expect("a shard");
    let older = text.replace(env!("CARGO_PKG_VERSION"), "0.0.1");
    let older = folder.with("older.json", &older);
    let output = hil(&["merge", &one, &older]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("older.json") && said.contains("version"),
        "{said}"
    );
}

#[test]
fn a_sweep_names_its_figures_as_scripts_expect() {
    let folder = Folder::new();
    let file = folder.with("corner.toml", CORNER);
    let out = folder.file("out");
    let output = hil(&["sweep", &file, "--flights", "1", "--json", "--out", &out]);
    let sweep = json(&output);
    for name in ["flights", "home_within_half_metre"] {
        assert_eq!(sweep[name], 1, "{name}");
    }
    for name in ["p50", "p95", "max"] {
        assert!(sweep["home_error_m"][name].is_number(), "{name}");
    }
    for name in ["cross_track_rms_m", "bytes_per_m"] {
        assert!(sweep[name].is_number(), "{name}");
    }
    assert_eq!(sweep["failed_seeds"], serde_json::json!([]));
}

#[test]
fn a_wrong_file_gets_its_line_and_a_reason() {
    let folder = Folder::new();
    let file = folder.with("wrong.toml", CORNER.replace("count = 3", "count = 0"));
    for verb in ["fly", "sweep"] {
        let output = hil(&[verb, &file]);
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(said.contains("wrong.toml:5: 0 seeds"), "{said}");
    }
}

#[test]
fn a_file_is_flown_as_it_says_and_nothing_beside_it() {
    let folder = Folder::new();
    let file = folder.with("corner.toml", CORNER);
    let output = hil(&[
        "fly",
        &file,
        "--seed",
        "2",
        "--json",
        "--out",
        &folder.file("out"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let summary = json(&output);
    assert_eq!(summary["seed"], 2);
    assert_eq!(summary["world"], "arena");
    assert_eq!(summary["backend"], "native");
    for option in [
        "--route=u",
        "--world=hall",
        "--spacing=1",
        "--homing=both",
        "--wind=1",
    ] {
        let output = hil(&["fly", &file, option]);
        assert_eq!(output.status.code(), Some(2), "{option}");
        assert!(stderr(&output).contains("cannot be used with"), "{option}");
    }
}
