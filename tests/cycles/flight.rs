//! What a flight costs the core, stage by stage, and what the image takes of the chip's memories: by
//! the emulated core's counter at the functions of the image that flies.
//!
//! The table is printed with `cargo hil profile --route corner`.

use std::collections::BTreeSet;
use std::fs;
use std::sync::OnceLock;

use hil::board::emulated::Firmware;
use hil::board::timing::TimingModel;
use hil::flight;
use hil::image;
use hil::profile::{self, Profiled, Stage, Window, chrome};
use hil::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage};
use hil::size::Size;
use tests::Budgets;

fn elf() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| {
        let path = image::build(&|line| eprintln!("{line}"));
        fs::read(path.expect("the firmware builds")).expect("the image is there")
    })
}

/// Round one corner, with homing at the end.
fn corner() -> Scenario {
    Scenario {
        route: Route::Corner,
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing: Spacing::from_metres(2.0).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions: Conditions::default(),
    }
}

/// A second of the way back.
const WINDOW: Window = Window {
    from_s: 20.0,
    for_s: 1.0,
};

fn profiled() -> &'static Profiled {
    static PROFILED: OnceLock<Profiled> = OnceLock::new();
    PROFILED.get_or_init(|| {
        let profiled = profile::fly(
            &corner(),
            elf(),
            TimingModel::default(),
            Some(WINDOW),
            &mut |_| {},
        );
        profiled.expect("a flight")
    })
}

#[test]
fn each_stage_of_a_flight_keeps_its_budget() {
    let budgets = Budgets::load();
    let profile = &profiled().profile;
    for stage in Stage::ALL {
        let name = stage.name();
        let quantiles = profile.stages[name];
        assert!(quantiles.count > 0, "no frame needed {name}");
        budgets.hold(&format!("flight_{name}_cycles_p99"), quantiles.p99 as f64);
    }
    budgets.hold("flight_vision_cycles_p99", profile.vision.p99 as f64);
    budgets.hold("pixel_to_vector_p99_s", profile.pixel_to_vector_s.p99);
    budgets.hold("flight_load", profile.load);
    budgets.hold("frames_missed", profile.missed as f64);
}

#[test]
fn the_image_keeps_the_memories_it_was_given() {
    let budgets = Budgets::load();
    let firmware = Firmware::parse(elf()).expect("an image");
    let figures = profiled()
        .flown
        .summary
        .firmware
        .expect("an emulated board");
    let size = Size::of(firmware.image(), figures.stack_peak_bytes);
    budgets.hold("flash_bytes", size.flash_bytes.into());
    budgets.hold("ram_bytes", size.ram_bytes.into());
    let free = size
        .stack_free_bytes
        .expect("a stack that keeps to its memory");
    budgets.hold(
        "stack_free_share",
        f64::from(free) / f64::from(size.stack_bytes),
    );
    // What the crates and what no symbol names take is all there is.
    let by_crate = size.crates.values();
    let sums = by_crate.fold((0, 0), |(flash, ram), bytes| {
        (flash + bytes.flash, ram + bytes.ram)
    });
    assert_eq!(sums, (size.flash_bytes, size.ram_bytes));
    assert!(size.crates["nav"].flash > 1_000 && size.crates["firmware"].ram > 49_152);
}

#[test]
fn a_profiled_flight_is_the_flight_and_its_stages_add_up_to_what_the_firmware_measured() {
    let profiled = profiled();
    let plain = flight::fly_emulated(&corner(), elf(), &mut |_| {}).expect("a flight");
    let text = |value| serde_json::to_string(value).expect("a recording");
    assert!(text(&plain.recording) == text(&profiled.flown.recording));

    // The firmware reads its own counter before and after it looks at a frame; interrupts, which it
    // counts with it, come now and then.
    let own: Vec<u32> = plain
        .recording
        .frames
        .iter()
        .filter_map(|frame| frame.cycles)
        .collect();
    assert!(own.len().abs_diff(profiled.frames.len()) <= 1);
    let looks = [Stage::Unwrap, Stage::Spectrum, Stage::Expose];
    let differences = own
        .iter()
        .rev()
        .zip(profiled.frames.iter().rev())
        .map(|(own, frame)| {
            let traced: u64 = looks
                .iter()
                .filter_map(|stage| frame.stages[*stage as usize])
                .sum();
            i64::from(*own) - traced as i64
        });
    let differences: Vec<i64> = differences.collect();
    assert!(differences.iter().all(|difference| *difference >= 0));
    let close = differences
        .iter()
        .filter(|difference| **difference <= 64)
        .count();
    assert!(
        10 * close > 9 * differences.len(),
        "{close} of {}",
        differences.len()
    );

    let load = plain.summary.cpu_load.expect("a processor");
    assert!((load - profiled.profile.load).abs() < 1e-4);
    let profile = &profiled.profile;
    let tasks = profile.tasks.values().chain(profile.interrupts.values());
    let parts: f64 = tasks.map(|load| load.share).sum();
    assert!((parts + profile.executor - profile.load).abs() < 1e-9);
    for task in [
        "camera", "exposure", "health", "link_rx", "link_tx", "vision",
    ] {
        assert!(profile.tasks[task].share > 0.0, "{task}");
    }
}

#[test]
fn the_time_line_has_every_kind_of_track_and_nothing_on_a_track_overlaps_by_halves() {
    let timeline = profiled().timeline.as_ref().expect("a time line");
    let names: Vec<&str> = timeline.tracks().values().map(String::as_str).collect();
    for name in [
        "camera",
        "stages",
        "task vision",
        "interrupt DCMI",
        "DMA2 stream 1",
        "link, from autopilot",
        "link, to autopilot",
        "core",
    ] {
        assert!(names.contains(&name), "no {name} in {names:?}");
    }
    for track in timeline.tracks().keys() {
        let slices = timeline
            .slices()
            .iter()
            .filter(|slice| slice.track == *track);
        let mut spans: Vec<(f64, f64)> = slices
            .map(|slice| (slice.from_us, slice.from_us + slice.for_us))
            .collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
        let mut open: Vec<f64> = Vec::new();
        for (from, to) in spans {
            while open.pop_if(|end| *end <= from + 1e-3).is_some() {}
            assert!(
                open.last().is_none_or(|end| to <= end + 1e-3),
                "{track:?} at {from}"
            );
            open.push(to);
        }
    }
}

/// Trace Event Format (Chromium project): events in the order of their times; complete ones have a
/// duration, instants a scope; each on a track that has a name.
#[test]
fn the_trace_keeps_to_chromes_format() {
    let timeline = profiled().timeline.as_ref().expect("a time line");
    let json = chrome::to_json(timeline).expect("a text");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let events = json["traceEvents"].as_array().expect("events");
    let (metadata, others): (Vec<_>, Vec<_>) = events.iter().partition(|event| event["ph"] == "M");
    let names = metadata
        .iter()
        .filter(|event| event["name"] == "thread_name");
    let named: BTreeSet<u64> = names
        .map(|event| event["tid"].as_u64().expect("a track"))
        .collect();
    assert_eq!(named.len(), timeline.tracks().len());
    assert_eq!(others.len(), timeline.slices().len());
    let mut latest = f64::NEG_INFINITY;
    for event in others {
        let ts = event["ts"].as_f64().expect("a time");
        assert!(ts >= latest, "{event} after {latest}");
        latest = ts;
        match event["ph"].as_str() {
            Some("X") => assert!(
                event["dur"].as_f64().is_some_and(|dur| dur > 0.0),
                "{event}"
            ),
            Some("i") => assert_eq!(event["s"], "t", "{event}"),
            _ => panic!("{event}"),
        }
        assert!(
            named.contains(&event["tid"].as_u64().expect("a track")),
            "{event}"
        );
        assert_eq!(event["pid"], 1);
        assert!(event["name"].as_str().is_some_and(|name| !name.is_empty()));
    }
}
