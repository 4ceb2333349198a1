//! Flights against faults of the link and of the autopilot: each ends at home or in a stated safe stop,
//! and nobody ever acts on what nobody said.

use std::path::PathBuf;

use hil::flight::{Flown, fly_emulated, fly_native};
use hil::image;
use hil::record::{Deed, LinkDrop, Recording, Side, What};
use hil::scenario::{Conditions, Homing, Quirk, Route, Scenario, Spacing, Storage};
use link::{Command, Event, Message, Mode, Parser, State, Vector};
use nav::Navigator;
use serde::Serialize;
use tests::Budgets;

fn scenario(route: Route, seed: u64, conditions: Conditions) -> Scenario {
    Scenario {
        route,
        world: "arena-panels".to_owned(),
        seed,
        spacing: Spacing::from_metres(2.0).expect("a spacing"),
        storage: Storage::PAPER,
        homing: Homing::Both,
        conditions,
    }
}

fn fly(route: Route, seed: u64, conditions: Conditions) -> Flown {
    let flown = fly_native(&scenario(route, seed, conditions), &mut |_| ()).expect("a flight");
    assert_nothing_wrong_was_done(&flown.recording);
    assert_ended_well(&flown);
    flown
}

fn corrupted() -> Conditions {
    Conditions {
        corrupted_share: 0.01,
        ..Conditions::default()
    }
}

fn restarted(seconds: f64) -> Conditions {
    Conditions {
        restart_s: Some(seconds),
        ..Conditions::default()
    }
}

fn self_acknowledging(mut conditions: Conditions) -> Conditions {
    *Quirk::SelfAcknowledge.of(&mut conditions.quirks) = true;
    conditions
}

/// At home, or in the safe stop by its name.
fn assert_ended_well(flown: &Flown) {
    let summary = &flown.summary;
    if summary.completed {
        Budgets::load().hold("home_error_m", summary.home_error_m);
    } else {
        assert!(
            summary.outcome.starts_with("safe stop"),
            "{}",
            summary.outcome
        );
    }
}

/// How long after it was sent a target or a correction may be acted on, ms: the one-cycle latency,
/// and a second of doubt about the mode.
const LATEST_MS: u64 = 1_500;

/// What has been said on the link so far.
#[derive(Default)]
struct Said {
    /// The mode that the app asked for last, and the one that the firmware says it is in.
    asked: u8,
    taken: u8,
    state: Option<State>,
    vectors: Vec<(u64, [f32; 2])>,
    /// Shifts and turns.
    corrections: Vec<(u64, [f32; 2], f32)>,
}

/// Every mode that the firmware took was the one that the app had asked for last; every place that
/// the app flew to, and every correction that it gave its filter, was one that the firmware had sent a
/// moment ago; and no target lay farther away than a leg.
fn assert_nothing_wrong_was_done(recording: &Recording) {
    let mut said = Said::default();
    for Deed { t_ms, what } in &recording.deeds {
        match what {
            What::Sent { by, message } => said.hear(*t_ms, *by, message),
            What::FlyTo(place) => assert!(
                said.vectors
                    .iter()
                    .any(|(at, sent)| sent == place && t_ms - at <= LATEST_MS),
                "{t_ms} ms: flies to {place:?}, which was not asked for"
            ),
            What::Correct { shift_m, turn_rad } => assert!(
                said.corrections.iter().any(|(at, shift, turn)| {
                    let same = |a: f32, b: f32| (a - b).abs() < 1e-4;
                    same(shift[0], shift_m[0])
                        && same(shift[1], shift_m[1])
                        && same(*turn, *turn_rad)
                        && t_ms - at <= LATEST_MS
                }),
                "{t_ms} ms: corrects by {shift_m:?}, which was not asked for"
            ),
        }
    }
    assert!(
        !said.vectors.is_empty(),
        "a flight in which nothing was said"
    );
}

impl Said {
    fn hear(&mut self, t_ms: u64, by: Side, message: &Message) {
        match (by, message) {
            (Side::Autopilot, Message::Command(command)) => self.asked = command.command,
            (Side::Autopilot, Message::State(state)) => self.state = Some(state.clone()),
            (Side::Camera, Message::Command(command)) => {
                let mode = command.command;
                assert!(
                    mode == self.taken || mode == self.asked,
                    "{t_ms} ms: mode {mode:#x}, asked for was {:#x}",
                    self.asked
                );
                self.taken = mode;
            }
            (Side::Camera, Message::Vector(vector)) => {
                let target = vector.target().expect("a target that is a number");
                let state = self.state.as_ref().expect("a STATE before a VECTOR");
                let here = state.pose().expect("a pose that is a number");
                let away_m = (target.x - here.x).hypot(target.y - here.y);
                // The longest leg is the snapshot spacing; homing and a correction add to it.
                assert!(away_m < 3.5, "{t_ms} ms: {away_m} m away");
                self.vectors.push((t_ms, [target.x, target.y]));
            }
            (Side::Camera, Message::InsCorrection(correction)) => {
                let (from, to) = correction.poses().expect("poses that are numbers");
                let shift = [to.x - from.x, to.y - from.y];
                self.corrections.push((t_ms, shift, to.yaw - from.yaw));
            }
            _ => {}
        }
    }
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("JSON")
}

/// How often a mode was asked for.
fn commands(recording: &Recording, mode: Mode) -> usize {
    let asked = recording.deeds.iter().filter(|deed| {
        matches!(
            &deed.what,
            What::Sent { by: Side::Autopilot, message: Message::Command(command) }
                if command.command == mode.byte()
        )
    });
    asked.count()
}

fn says(recording: &Recording, what: &str) -> bool {
    recording.log.iter().any(|line| line.text.contains(what))
}

#[test]
fn a_client_that_acknowledges_itself_is_obeyed_at_its_only_word() {
    let flown = fly(Route::Corner, 1, self_acknowledging(Conditions::default()));
    assert!(flown.summary.completed, "{}", flown.summary.outcome);
    assert_eq!(commands(&flown.recording, Mode::Follow), 1);
}

#[test]
fn a_client_that_acknowledges_itself_comes_home_over_a_broken_link_too() {
    // A command that is lost is sent again only because the camera says its mode once a second.
    for seed in 1..=3 {
        let flown = fly(Route::Corner, seed, self_acknowledging(corrupted()));
        assert!(flown.summary.completed, "{}", flown.summary.outcome);
    }
}

#[test]
fn with_one_byte_in_a_hundred_broken_both_ways_the_drone_comes_home() {
    for seed in 1..=5 {
        let Flown { summary, recording } = fly(Route::Line, seed, corrupted());
        assert!(summary.completed, "seed {seed}: {}", summary.outcome);
        assert_dropped(&recording, summary.link.to_camera.frames_sent, Side::Camera);
        assert_dropped(
            &recording,
            summary.link.to_autopilot.frames_sent,
            Side::Autopilot,
        );
    }
}

#[test]
fn the_u_is_followed_home_over_a_broken_link() {
    let summary = fly(Route::U, 1, corrupted()).summary;
    assert!(summary.completed, "{}", summary.outcome);
}

/// A quarter of the frames of 28 bytes and more is broken, and each is named with its reason.
fn assert_dropped(recording: &Recording, sent: u64, side: Side) {
    let drops: Vec<&LinkDrop> = recording
        .link_drops
        .iter()
        .filter(|drop| drop.side == side)
        .collect();
    let share = drops.len() as f64 / sent as f64;
    assert!((0.1..0.5).contains(&share), "{share}");
    let checksum = drops.iter().filter(|drop| drop.why.contains("checksum"));
    assert!(checksum.count() > drops.len() / 3);
}

#[test]
fn an_undisturbed_flight_drops_nothing_on_either_side() {
    let Flown { summary, recording } = fly(Route::Corner, 1, Conditions::default());
    assert!(summary.completed, "{}", summary.outcome);
    assert_eq!(recording.link_drops, []);
    assert!(summary.link.to_camera.frames_sent > 200);
    assert!(summary.link.to_autopilot.frames_sent > 100);
}

#[test]
fn an_autopilot_that_restarts_while_recording_is_led_home_from_there() {
    let Flown { summary, recording } = fly(Route::Line, 1, restarted(11.0));
    assert!(summary.completed, "{}", summary.outcome);
    assert!(says(&recording, "NewOrigin"));
    assert!(summary.outbound_m < 4.5, "{} m", summary.outbound_m);
}

#[test]
fn an_autopilot_that_restarts_while_following_is_led_home_in_its_new_coordinates() {
    for seed in 1..=3 {
        let Flown { summary, recording } = fly(Route::Corner, seed, restarted(27.0));
        let home = summary.completed && says(&recording, "NewOrigin");
        let stopped = summary.outcome.starts_with("safe stop") && says(&recording, "Lost");
        assert!(home || stopped, "seed {seed}: {}", summary.outcome);
        assert!(home || seed > 1, "{}", summary.outcome);
    }
}

#[test]
fn an_autopilot_that_restarts_on_the_ground_flies_its_script_from_the_start() {
    let Flown { summary, recording } = fly(Route::Corner, 1, restarted(2.0));
    assert!(summary.completed, "{}", summary.outcome);
    assert!(!says(&recording, "NewOrigin") && !says(&recording, "Lost"));
    assert!(summary.outbound_m > 3.5, "{} m", summary.outbound_m);
}

#[test]
fn a_restart_over_a_broken_link_ends_well_and_is_the_same_on_both_boards() {
    let conditions = Conditions {
        corrupted_share: 0.01,
        ..restarted(27.0)
    };
    let path: PathBuf = image::build(&|line| eprintln!("{line}")).expect("the firmware builds");
    let elf = std::fs::read(path).expect("the image is there");
    let scenario = scenario(Route::Corner, 1, conditions);
    let emulated = fly_emulated(&scenario, &elf, &mut |_| ()).expect("a flight");
    assert_nothing_wrong_was_done(&emulated.recording);
    assert_ended_well(&emulated);
    let native = fly(Route::Corner, 1, conditions).recording;
    let emulated = emulated.recording;
    assert_eq!(json(&emulated.track), json(&native.track));
    assert_eq!(json(&emulated.vectors), json(&native.vectors));
    assert_eq!(json(&emulated.corrections), json(&native.corrections));
    // In no order: a drop is told when it is certain, and the emulated board's bytes come one by one, where the native
    // one's come a message at a time.
    let drops = |recording: &Recording| {
        let mut drops: Vec<_> = (recording.link_drops.iter())
            .map(|drop| (format!("{:?}", drop.side), &drop.message, &drop.why))
            .map(|(side, message, why)| (side, message.clone(), why.clone()))
            .collect();
        drops.sort();
        drops
    };
    assert_eq!(drops(&emulated), drops(&native));
    assert!(!drops(&native).is_empty());
}

/// All ways in which exactly two bytes of a frame can be wrong and the parser still delivers it, as
/// something else than was sent; and how many more a receiver would deliver that looks at the checksum
/// alone. Only one value of the second byte can make up in the first sum for the first byte.
fn passing_pairs(frame: &[u8]) -> (Vec<Message>, usize) {
    let sent = whole(frame).expect("a frame");
    let (mut delivered, mut by_checksum_alone) = (vec![], 0);
    let first_sum = frame.len() - 2;
    for first in 1..frame.len() {
        for second in first + 1..frame.len() {
            for error in 1..=255_u8 {
                let mut broken = frame.to_vec();
                broken[first] = broken[first].wrapping_add(error);
                let makes_up = if second == first_sum {
                    error
                } else {
                    error.wrapping_neg()
                };
                broken[second] = broken[second].wrapping_add(makes_up);
                by_checksum_alone += usize::from(checksum_holds(&broken));
                delivered.extend(whole(&broken).filter(|message| *message != sent));
            }
        }
    }
    (delivered, by_checksum_alone)
}

/// The message, if the bytes are one frame and nothing else.
fn whole(bytes: &[u8]) -> Option<Message> {
    match Parser::new().next_event(&mut &bytes[..])? {
        Event::Frame(frame) => Some(frame.message),
        Event::Refused(_) => None,
    }
}

/// pprzlink 2.0: the sums A and B over everything between the start byte and themselves.
fn checksum_holds(frame: &[u8]) -> bool {
    let (covered, sums) = frame[1..].split_at(frame.len() - 3);
    let (mut a, mut b) = (0_u8, 0_u8);
    for byte in covered {
        a = a.wrapping_add(*byte);
        b = b.wrapping_add(a);
    }
    sums == [a, b]
}

/// How often a frame of `length` bytes passes with exactly two wrong ones, where one byte in a hundred
/// is wrong and `pairs` of their values pass.
fn frequency(pairs: usize, length: usize) -> f64 {
    let others = 0.99_f64.powi(length as i32 - 2);
    pairs as f64 * (0.01_f64 / 255.0).powi(2) * others
}

#[test]
fn a_vector_that_is_broken_in_two_places_passes_less_than_once_in_a_million() {
    let vector = Message::Vector(Vector {
        target_e: -2.5,
        target_n: 3.25,
        start_e: -2.0,
        start_n: 3.0,
        ..Vector::default()
    });
    let frame = vector.encode();
    let (delivered, by_checksum_alone) = passing_pairs(&frame);
    let (strict, lax) = (
        frequency(delivered.len(), frame.len()),
        frequency(by_checksum_alone, frame.len()),
    );
    eprintln!(
        "VECTOR: {} pairs pass, {strict:.1e} a frame; by the checksum alone {by_checksum_alone}, {lax:.1e}",
        delivered.len()
    );
    // Errors e and -e that are d bytes apart leave B alone if 256 divides d e: gcd(d, 256) - 1 values
    // of e. So does e in a byte and in A, d bytes behind it. 27 bytes count, from the length to A.
    let values = |d: u32| (1 << d.trailing_zeros()) - 1;
    let expected: usize = (1..27_u32).map(|d| (27 - d as usize) * values(d)).sum();
    assert_eq!(by_checksum_alone, expected);
    assert!(delivered.len() < by_checksum_alone);
    assert!(strict < 1e-6, "{strict:e}");
}

#[test]
fn no_command_becomes_another_by_two_wrong_bytes() {
    let bytes = [0x00, 0x0f, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12];
    for command in bytes {
        let message = Message::Command(Command {
            command,
            ..Command::default()
        });
        for delivered in passing_pairs(&message.encode()).0 {
            let Message::Command(other) = delivered else {
                panic!("{command:#x} became {delivered:?}");
            };
            let mut navigator = Box::new(Navigator::new(nav::Parameters::DEFAULT));
            let obeyed = navigator.command(other.command).is_ok();
            assert!(
                !obeyed || other.command == command,
                "{command:#x}: {other:?}"
            );
        }
    }
}
