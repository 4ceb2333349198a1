//! What a camera says to an autopilot, message by message.

mod bench;

use std::f32::consts::FRAC_PI_2;

use bench::{Bench, mode, patches, uniform};
use link::{Message, Mode, Record, State};
use pilot::{Event, PERIOD_BYTES};
use proptest::prelude::*;

const ROUTE: u8 = Mode::Record(Record::ROUTE).byte();
const SINGLE_SNAPSHOT: u8 = Mode::Record(Record::SINGLE_SNAPSHOT).byte();
const FOLLOW: u8 = Mode::Follow.byte();

fn snapshots_taken(events: &[Event]) -> usize {
    let taken = |event: &&Event| matches!(event, Event::SnapshotTaken { .. });
    events.iter().filter(taken).count()
}

#[test]
fn frames_alone_make_the_camera_say_nothing() {
    // A frame has no outbox; nor may it leave behind what the first STATE would let out.
    let mut bench = Bench::new();
    for _ in 0..100 {
        bench.see(&patches());
    }
    assert_eq!(bench.state(0.0, 0.0, 0.0), []);
}

#[test]
fn every_mode_the_autopilot_knows_is_echoed_as_the_same_byte() {
    let modes = [
        Mode::Record(Record::SINGLE_SNAPSHOT),
        Mode::Record(Record::ODOMETRY),
        Mode::Record(Record::ROUTE),
        Mode::Record(Record::SEQUENCE),
        Mode::Record(Record::SEQUENCE_WITH_ODOMETRY),
        Mode::FollowAndStay,
        Mode::Follow,
        Mode::Clear,
        Mode::Idle,
    ];
    let mut bench = Bench::new();
    for byte in modes.map(Mode::byte) {
        assert_eq!(bench.command(byte, &[]), [mode(byte)]);
        assert_eq!(bench.command(byte, &[]), [mode(byte)], "a repetition");
    }
}

#[test]
fn a_byte_that_is_no_command_changes_nothing_and_the_answer_says_so() {
    let mut bench = Bench::new();
    bench.command(ROUTE, &[30]);
    // 0xFF is the client's internal mark, never to be echoed.
    for unknown in [0x42, 0xFF] {
        assert_eq!(bench.command(unknown, &[5]), [mode(ROUTE)]);
    }
    let parameters = bench.pilot.navigator().parameters();
    assert_eq!(parameters.snapshot_spacing_m, 3.0);
}

#[test]
fn the_first_argument_of_a_command_is_the_spacing_of_snapshots_in_decimetres() {
    let spacing = |bench: &Bench| bench.pilot.navigator().parameters().snapshot_spacing_m;
    let mut bench = Bench::new();
    let initial = spacing(&bench);
    for (args, metres) in [
        (&[][..], initial),
        (&[0], initial),
        (&[5], 0.5),
        (&[254, 7], 25.4),
        (&[], 25.4),
    ] {
        assert_eq!(bench.command(ROUTE, args), [mode(ROUTE)]);
        assert_eq!(spacing(&bench), metres, "after the arguments {args:?}");
    }
}

#[test]
fn the_largest_first_argument_asks_for_snapshots_as_far_apart_as_the_drift_allows() {
    let by_theory = |bench: &Bench| bench.pilot.navigator().parameters().spacing_by_theory;
    let mut bench = Bench::new();
    for (args, expected) in [
        (&[][..], false),
        (&[255], true),
        (&[0], true),
        (&[20], false),
    ] {
        assert_eq!(bench.command(ROUTE, args), [mode(ROUTE)]);
        assert_eq!(by_theory(&bench), expected, "after the arguments {args:?}");
    }
}

#[test]
fn the_second_argument_is_the_format_of_snapshots_and_the_third_how_far_a_way_may_deviate() {
    let settings = |bench: &Bench| {
        let parameters = bench.pilot.navigator().parameters();
        (
            parameters.snapshot_format.number(),
            parameters.simplify_tolerance_m,
        )
    };
    let mut bench = Bench::new();
    for (args, expected) in [
        (&[20][..], (1, 0.1)),
        (&[0, 3, 3], (3, 0.3)),
        (&[0, 0, 0], (3, 0.3)),
        (&[0, 4], (3, 0.3)),
        (&[0, 2, 1], (2, 0.1)),
    ] {
        assert_eq!(bench.command(ROUTE, args), [mode(ROUTE)]);
        assert_eq!(settings(&bench), expected, "after the arguments {args:?}");
    }
}

#[test]
fn the_mode_is_said_every_tenth_state_counted_from_the_last_time() {
    let mut bench = Bench::new();
    let spoke = |bench: &mut Bench| !bench.state(0.0, 0.0, 0.0).is_empty();
    let unasked: Vec<_> = (1..=25).filter(|_| spoke(&mut bench)).collect();
    assert_eq!(unasked, [10, 20]);
    bench.command(SINGLE_SNAPSHOT, &[]);
    let after_an_echo: Vec<_> = (1..=25).filter(|_| spoke(&mut bench)).collect();
    assert_eq!(after_an_echo, [10, 20]);
    assert_eq!(bench.command(0x42, &[]), [mode(SINGLE_SNAPSHOT)]);
}

#[test]
fn a_state_that_is_not_finite_is_passed_over_in_silence() {
    let mut bench = Bench::new();
    bench.command(FOLLOW, &[]);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (north, east, psi) in [(bad, 0.0, 0.0), (0.0, bad, 0.0), (0.0, 0.0, bad)] {
            assert_eq!(bench.state(north, east, psi), []);
            assert_eq!(bench.events, [Event::InvalidPose]);
        }
    }
    let answer = bench.state(1.0, -2.0, 0.0);
    let [Message::Vector(vector)] = answer.as_slice() else {
        panic!("there is no route: hold here, not {answer:?}");
    };
    assert_eq!((vector.target_n, vector.target_e), (1.0, -2.0));
}

#[test]
fn the_cameras_own_messages_are_not_answered() {
    let mut bench = Bench::new();
    for message in [
        Message::Debug(Default::default()),
        Message::Vector(Default::default()),
        Message::Map(Default::default()),
        Message::InsCorrection(Default::default()),
        Message::Camera(Default::default()),
    ] {
        assert_eq!(bench.hear(&message), []);
    }
}

#[test]
fn a_view_serves_one_state() {
    let mut bench = Bench::new();
    bench.see(&patches());
    bench.state(0.0, 0.0, 0.0);
    bench.command(SINGLE_SNAPSHOT, &[]);
    bench.state(0.0, 0.0, 0.0);
    assert_eq!(snapshots_taken(&bench.events), 0, "the view was used up");
    bench.see(&patches());
    bench.state(0.0, 0.0, 0.0);
    assert_eq!(snapshots_taken(&bench.events), 1);
}

/// The counts a_1..a_8, b_1..b_8 of a snapshot taken by a drone that faces `psi`.
fn snapshot(psi: f32) -> Vec<i8> {
    let mut bench = Bench::new();
    bench.command(SINGLE_SNAPSHOT, &[]);
    bench.state(0.0, 0.0, psi);
    bench.see(&patches());
    let answer = bench.state(0.0, 0.0, psi);
    let [Message::Map(map)] = answer.as_slice() else {
        panic!("a snapshot goes into the map, not {answer:?}");
    };
    map.snapshot_ak_bk.to_vec()
}

#[test]
fn a_drone_that_faces_east_sees_its_nose_in_the_east() {
    let (north, east) = (snapshot(0.0), snapshot(FRAC_PI_2));
    let (a, b) = north.split_at(8);
    let (turned_a, turned_b) = east.split_at(8);
    assert!(north.iter().filter(|count| count.abs() > 3).count() > 8);
    for k in 1..=8 {
        // Bearings grow counter-clockwise: what was at 0 is at -π/2, I'(θ) = I(θ + π/2), so that
        // a' cos kθ + b' sin kθ = a cos k(θ + π/2) + b sin k(θ + π/2).
        let (a, b) = (a[k - 1], b[k - 1]);
        let expected = match k % 4 {
            0 => (a, b),
            1 => (b, -a),
            2 => (-a, -b),
            _ => (-b, a),
        };
        let found = (turned_a[k - 1], turned_b[k - 1]);
        let off = (found.0 - expected.0).abs() + (found.1 - expected.1).abs();
        assert!(off <= 1, "k = {k}: {found:?} instead of {expected:?}");
    }
}

#[test]
fn a_dark_horizon_asks_for_light_in_proportion() {
    // Black level 12, set-point 80: 46 is half the light that is wanted, so that the 135 lines of the
    // start become 270: two periods of 100 Hz, 269.2 lines, and the gain next to 270 / 269.
    let mut bench = Bench::new();
    let exposure = bench.see(&uniform(46)).exposure.unwrap();
    assert_eq!(
        (exposure.shutter_lines, exposure.gain),
        (269, 192.0 / 191.0)
    );
    assert_eq!(bench.pilot.exposure(), exposure);
    let asked: Vec<_> = (0..3).map(|_| bench.see(&uniform(46)).exposure).collect();
    assert!(
        matches!(asked.as_slice(), [None, None, Some(_)]),
        "{asked:?}"
    );
}

/// Something that happens before each STATE.
type Disturbance = fn(&mut Bench);

/// Records a metre northward with a snapshot every four decimetres.
fn record(disturb: Disturbance) -> Bench {
    let mut bench = Bench::new();
    bench.command(ROUTE, &[4]);
    for step in 0..=10 {
        bench.see(&patches());
        disturb(&mut bench);
        bench.state(step as f32 * 0.1, 0.0, 0.0);
    }
    bench
}

/// Follows that route home in a world that looks the same everywhere; the answers on the way.
fn follow_home(bench: &mut Bench, disturb: Disturbance) -> Vec<Vec<Message>> {
    bench.command(FOLLOW, &[]);
    let (mut north, mut east) = (1.0, 0.0);
    let mut answers = vec![];
    for _ in 0..300 {
        bench.see(&patches());
        disturb(bench);
        let answer = bench.state(north, east, 0.0);
        if let [Message::Vector(vector), ..] = answer.as_slice() {
            (north, east) = (vector.target_n, vector.target_e);
        }
        answers.push(answer);
    }
    assert!(north.abs() < 0.1 && east.abs() < 0.1, "not at home");
    answers
}

fn quiet(_: &mut Bench) {}

fn flight() -> Vec<Vec<Message>> {
    follow_home(&mut record(quiet), quiet)
}

/// Places and headings where no flight gets, and what is no number.
fn absurd(bench: &mut Bench) {
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -1000.5] {
        for [ins_n, ins_e, psi] in [[bad, 0.0, 0.0], [0.0, bad, 0.0], [0.0, 0.0, bad]] {
            let state = State {
                ins_n,
                ins_e,
                psi,
                ..State::default()
            };
            assert_eq!(bench.hear(&Message::State(state)), []);
            assert_eq!(bench.events, [Event::InvalidPose]);
        }
    }
}

#[test]
fn a_stream_of_absurd_states_leaves_route_and_answers_untouched() {
    let route = |bench: &Bench| format!("{:?}", bench.pilot.navigator().route());
    let (mut disturbed, mut reference) = (record(absurd), record(quiet));
    assert_eq!(route(&disturbed), route(&reference));
    let answers = follow_home(&mut disturbed, absurd);
    assert_eq!(answers, follow_home(&mut reference, quiet));
}

#[test]
fn on_the_way_home_each_state_is_answered_by_a_vector_and_the_rest_in_order_of_need() {
    fn rank(message: &Message) -> u8 {
        match message {
            Message::Vector(_) => 0,
            Message::InsCorrection(_) => 1,
            Message::Map(_) => 2,
            Message::Command(_) => 3,
            other => panic!("not the camera's to say: {other:?}"),
        }
    }
    for answer in flight() {
        let ranks: Vec<_> = answer.iter().map(rank).collect();
        assert_eq!(ranks.first(), Some(&0), "{answer:?}");
        assert!(ranks.windows(2).all(|pair| pair[0] < pair[1]), "{answer:?}");
    }
}

#[test]
fn the_fullest_answer_and_an_echo_fit_into_one_period() {
    let snapshot = link::Map {
        snapshot_ak_bk: [1; 16].into_iter().collect(),
        ..Default::default()
    };
    let answer = [
        Message::Vector(Default::default()),
        Message::InsCorrection(Default::default()),
        Message::Map(snapshot),
        mode(FOLLOW),
    ];
    let bytes = |message: &Message| message.encode().len();
    let answer: usize = answer.iter().map(bytes).sum();
    assert_eq!(answer, 118);
    assert!(answer + bytes(&mode(FOLLOW)) <= PERIOD_BYTES);
}

#[test]
fn each_correction_has_a_number_of_its_own_that_is_not_zero() {
    let answers = flight();
    let corrections = answers
        .iter()
        .flatten()
        .filter_map(|message| match message {
            Message::InsCorrection(correction) => Some(correction),
            _ => None,
        });
    let mut distinct: Vec<&link::InsCorrection> = vec![];
    for correction in corrections {
        match distinct.last() {
            Some(last) if last.snapshot_index == correction.snapshot_index => {
                assert_eq!(*last, correction, "a repetition is the same correction");
            }
            _ => distinct.push(correction),
        }
    }
    // One for each of the three snapshots.
    assert_eq!(distinct.len(), 3);
    assert!(
        distinct
            .iter()
            .all(|correction| correction.snapshot_index != 0)
    );
}

/// What may happen to a pilot.
#[derive(Clone, Debug)]
enum Input {
    Frame(u8),
    Command(u8, Vec<u8>),
    State(f32, f32, f32),
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![9 => -2.0_f32..2.0, 1 => any::<u32>().prop_map(f32::from_bits)]
}

fn input() -> impl Strategy<Value = Input> {
    let buttons = [0x00, 0x0F, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12];
    let byte = prop_oneof![9 => prop::sample::select(buttons.to_vec()), 1 => any::<u8>()];
    let args = prop::collection::vec(any::<u8>(), 0..4);
    prop_oneof![
        8 => any::<u8>().prop_map(Input::Frame),
        1 => (byte, args).prop_map(|(byte, args)| Input::Command(byte, args)),
        8 => (coordinate(), coordinate(), coordinate())
            .prop_map(|(north, east, psi)| Input::State(north, east, psi)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn whatever_happens_answers_are_whole_short_and_finite(
        inputs in prop::collection::vec(input(), 1..150),
    ) {
        let mut bench = Bench::new();
        for input in inputs {
            // The bench sees to whole and short.
            let answer = match input {
                Input::Frame(seed) => {
                    let frame = patches().map(|byte| byte.rotate_left(u32::from(seed) % 8));
                    bench.see(&frame);
                    continue;
                }
                Input::Command(byte, args) => bench.command(byte, &args),
                Input::State(north, east, psi) => bench.state(north, east, psi),
            };
            for message in answer {
                let finite = match &message {
                    Message::Vector(v) => {
                        v.target().is_ok() && v.start().is_ok() && v.turn().is_ok()
                    }
                    Message::InsCorrection(c) => c.poses().is_ok(),
                    Message::Map(m) => m.snapshot().is_ok() && m.odometry().is_ok(),
                    other => matches!(other, Message::Command(_)),
                };
                prop_assert!(finite, "{:?}", message);
            }
        }
    }
}
