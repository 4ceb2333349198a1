//! Flights whose eye is put to the test: light that the first exposure does not suit, lamps that go up
//! amid the flight, a lens record that is off. Each comes home.

use std::path::Path;

use hil::flight::{FlightError, Flown, fly_emulated, fly_native};
use hil::image;
use hil::record::LogLine;
use hil::scenario::{
    CameraTrouble, Conditions, Homing, LensPage, Route, Scenario, Spacing, Storage, WireFault,
};
use nav::LensCalibration;
use tests::Budgets;

/// The lamps of `arena-lamps.toml` go up then, seconds.
const LAMPS_UP_S: f64 = 130.0;

fn fly(world: &str, conditions: Conditions) -> Flown {
    let scenario = Scenario {
        route: Route::U,
        world: world.to_owned(),
        seed: 1,
        spacing: Spacing::from_metres(2.0).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions,
    };
    let flown = fly_native(&scenario, &mut |_| ()).expect("a flight");
    let summary = &flown.summary;
    assert!(summary.completed, "{}", summary.outcome);
    let budgets = Budgets::load();
    budgets.hold("home_error_m", summary.home_error_m);
    budgets.hold("frames_dropped", summary.frames_dropped as f64);
    flown
}

fn lit(light: f32) -> Conditions {
    Conditions {
        light,
        ..Conditions::default()
    }
}

/// Frames from the first whose luma is farther than `band` from the set-point of 80 to the last of
/// that first spell.
fn spell(luma: impl Iterator<Item = f32>, band: f32) -> usize {
    let outside = |luma: &f32| (luma - 80.0).abs() > band;
    luma.skip_while(|luma| !outside(luma))
        .take_while(outside)
        .count()
}

#[test]
fn a_drone_whose_first_exposure_is_fifty_times_too_short_comes_home() {
    let flown = fly("arena-panels", lit(0.02));
    let first = flown.recording.frames[0].luma;
    assert!(first < 20.0, "the first frame is dark: {first}");
}

#[test]
fn a_drone_whose_first_exposure_is_fifty_times_too_long_comes_home() {
    let flown = fly("arena-panels", lit(50.0));
    let first = flown.recording.frames[0].luma;
    assert!(first > 240.0, "the first frame is white: {first}");
}

#[test]
fn a_drone_comes_home_though_the_lamps_go_up_half_way() {
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join("worlds/arena-lamps.toml");
    let flown = fly(&world.display().to_string(), Conditions::default());
    let frames = &flown.recording.frames;
    let after = frames.iter().filter(|frame| frame.t >= LAMPS_UP_S);
    let brightest = after.clone().map(|frame| frame.luma).fold(0.0, f32::max);
    assert!(brightest > 120.0, "they do go up: {brightest}");
    let frames_off = spell(after.map(|frame| frame.luma), 20.0);
    assert!((1..10).contains(&frames_off), "{frames_off} frames");
}

#[test]
fn a_drone_comes_home_with_a_lens_record_that_is_a_pixel_off_either_way() {
    for (dx, dy) in [(1.0, 0.0), (0.0, -1.0)] {
        let (x, y) = LensCalibration::DEFAULT.centre_px;
        let lens = LensCalibration {
            centre_px: (x + dx, y + dy),
            ..LensCalibration::DEFAULT
        };
        let flown = fly(
            "arena-panels",
            Conditions {
                lens: Some(LensPage::of(&lens)),
                ..Conditions::default()
            },
        );
        let read = |line: &&LogLine| line.text.starts_with("lens record: ");
        let said = flown.recording.log.iter().find(read);
        assert!(
            said.is_some_and(|line| line.text.contains("centre")),
            "{said:?}"
        );
    }
}

fn corner(conditions: Conditions) -> Scenario {
    Scenario {
        route: Route::Corner,
        world: "arena-panels".to_owned(),
        seed: 1,
        spacing: Spacing::from_metres(2.0).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions,
    }
}

/// A corner is flown out in ten seconds, and homed along after that.
fn troubled(fault: WireFault) -> Conditions {
    Conditions {
        camera: Some(CameraTrouble {
            fault,
            from_ms: 15_000,
            for_ms: 2_000,
        }),
        ..Conditions::default()
    }
}

#[test]
fn a_drone_comes_home_whatever_happens_to_its_camera_for_two_seconds() {
    let elf = image::build(&|line| eprintln!("{line}")).expect("the firmware builds");
    let elf = std::fs::read(elf).expect("the image");
    for (fault, name) in [
        (WireFault::LostVsync, "no vsync"),
        (WireFault::StuckVsync, "no vsync"),
        (WireFault::LostHsync, "no signal"),
        (WireFault::ShortLine, "short line"),
        (WireFault::ExtraBytes, "extra bytes"),
        (WireFault::StoppedClock, "no signal"),
        (WireFault::Unplugged, "no signal"),
    ] {
        let flown = fly_emulated(&corner(troubled(fault)), &elf, &mut |_| ()).expect("a flight");
        assert!(
            flown.summary.completed,
            "{fault}: {}",
            flown.summary.outcome
        );
        Budgets::load().hold("home_error_m", flown.summary.home_error_m);
        let told = format!("capture fault: {name}");
        let log = &flown.recording.log;
        assert!(log.iter().any(|line| line.text == told), "{fault}: {told}");
        // Two seconds at 25.6 frames a second, and not one more than the recovery takes.
        let dark = |frame: &&hil::record::FrameMark| (15.1..17.0).contains(&frame.t);
        let frames = &flown.recording.frames;
        assert_eq!(frames.iter().filter(dark).count(), 0, "{fault}");
        assert!(
            frames.iter().any(|frame| (17.0..17.25).contains(&frame.t)),
            "{fault}"
        );
    }
}

#[test]
fn a_board_without_wires_refuses_their_faults() {
    let refused = fly_native(&corner(troubled(WireFault::Unplugged)), &mut |_| ());
    assert!(matches!(refused, Err(FlightError::NoWires)));
}
