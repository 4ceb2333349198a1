//! What holds for every message and for every stream of bytes.

mod common;

use std::f32::consts::PI;

use common::{LONGEST_CLAIM, coordinate, frame, frames_in, frames_in_ended, message, stream};
use link::{InsCorrection, Map, Parser, Source, State, Vector, WorldPoint, WorldPose};
use proptest::collection::vec;
use proptest::prelude::*;

/// Feeds `stream` in pieces cut at multiples of the given lengths; the encoded frames that come out.
fn parse(parser: &mut Parser, stream: &[u8], pieces: &[usize]) -> Vec<Vec<u8>> {
    let mut pieces = pieces.iter().copied().cycle();
    let mut rest = stream;
    let mut frames = Vec::new();
    while !rest.is_empty() {
        let len = pieces.next().unwrap_or(1).clamp(1, rest.len());
        let (piece, behind) = rest.split_at(len);
        frames.extend(parser.frames(piece).map(|frame| frame.encode().to_vec()));
        rest = behind;
    }
    frames
}

/// Bytes without a start byte, framed: nothing inside can be taken for another frame.
fn plain_frame() -> impl Strategy<Value = Vec<u8>> {
    message()
        .prop_map(|message| message.encode().to_vec())
        .prop_filter("a start byte inside", |bytes| {
            !bytes[1..].contains(&0x99) && bytes.len() < 60
        })
}

proptest! {
    #[test]
    fn any_frame_comes_back_bit_for_bit(frame in frame()) {
        let bytes = frame.encode();
        let mut parser = Parser::new();
        let mut rest: &[u8] = &bytes;
        let parsed = parser.next_frame(&mut rest);
        prop_assert!(rest.is_empty());
        // Bytes, not values: a NaN is no NaN's equal.
        prop_assert_eq!(parsed.map(|frame| frame.encode()), Some(bytes));
    }

    #[test]
    fn what_comes_out_of_a_stream_does_not_depend_on_how_it_is_cut(
        stream in stream(),
        pieces in vec(1usize..300, 1..6),
    ) {
        let (expected, _) = frames_in(&stream);
        let mut parser = Parser::new();
        prop_assert_eq!(&parse(&mut parser, &stream, &pieces), &expected);
        prop_assert_eq!(&parse(&mut Parser::new(), &stream, &[1]), &expected);
    }

    #[test]
    fn every_byte_is_delivered_counted_or_held(stream in stream(), piece in 1usize..300) {
        let mut parser = Parser::new();
        let frames = parse(&mut parser, &stream, &[piece]);
        let counters = parser.counters();
        let delivered: usize = frames.iter().map(Vec::len).sum();
        prop_assert_eq!(delivered + counters.bytes_skipped as usize + parser.held(), stream.len());
        prop_assert_eq!(counters.frames_ok as usize, frames.len());
        prop_assert_eq!(stream.len() - parser.held(), frames_in(&stream).1);
    }

    #[test]
    fn a_good_frame_is_found_at_the_latest_one_maximal_frame_behind_garbage(
        garbage in stream(),
        good in plain_frame(),
    ) {
        let copies = 2 + LONGEST_CLAIM / good.len();
        let mut bytes = garbage.clone();
        for _ in 0..copies {
            bytes.extend(&good);
        }
        let frames = parse(&mut Parser::new(), &bytes, &[64]);
        let in_step = frames.iter().rev().take_while(|frame| **frame == good).count();
        let lost = copies.saturating_sub(in_step);
        prop_assert!(lost * good.len() < LONGEST_CLAIM + good.len(), "{lost} of {copies} lost");
        prop_assert_eq!(frames.last(), Some(&good));
    }

    #[test]
    fn giving_up_decides_a_stream_as_if_nothing_followed(stream in stream()) {
        let mut parser = Parser::new();
        let mut frames = parse(&mut parser, &stream, &[17]);
        while parser.held() > 0 {
            parser.give_up();
            frames.extend(parser.frames(&[]).map(|frame| frame.encode().to_vec()));
        }
        prop_assert_eq!(&frames, &frames_in_ended(&stream));
        let delivered: usize = frames.iter().map(Vec::len).sum();
        prop_assert_eq!(delivered + parser.counters().bytes_skipped as usize, stream.len());
    }

    #[test]
    fn a_pose_comes_back_from_the_wire_unchanged(x in -1e3f32..1e3, y in -1e3f32..1e3, yaw in -4f32..4.0) {
        let pose = WorldPose { x, y, yaw };
        prop_assert_eq!(State::from_world(pose).pose(), Ok(pose));
    }

    #[test]
    fn a_correction_turns_by_the_difference_of_the_headings_and_by_half_a_turn_at_most(
        from in -10f32..10.0,
        to in -10f32..10.0,
    ) {
        let at = |yaw| WorldPose { x: 0.0, y: 0.0, yaw };
        let message = InsCorrection::from_world(1, at(from), at(to))?;
        let turn = message.psi_to - message.psi_from;
        prop_assert!(turn.abs() <= PI + 1e-5);
        let missing = (f64::from(turn) - f64::from(from - to)) / (2.0 * std::f64::consts::PI);
        prop_assert!((missing - missing.round()).abs() < 1e-5, "{missing} turns");
    }

    #[test]
    fn a_place_that_no_flight_reaches_gets_neither_past_the_accessors_nor_onto_the_wire(
        // North, east, heading, each of a start and of an end.
        wire in prop::array::uniform6(coordinate()),
    ) {
        let [n, e, psi, to_n, to_e, to_psi] = wire;
        let place = |n: f32, e: f32| n.abs() <= 1000.0 && e.abs() <= 1000.0;
        let heading = |psi: f32| psi.abs() <= 8.0 * PI;
        let start = place(n, e) && heading(psi);
        let both = start && place(to_n, to_e) && heading(to_psi);

        let state = State { ins_e: e, ins_n: n, psi, ..State::default() };
        prop_assert_eq!(state.pose().is_ok(), start);

        let vector = Vector {
            target_e: to_e, target_n: to_n, delta_yaw: psi, start_e: e, start_n: n, source: 0,
        };
        prop_assert_eq!(vector.target().is_ok(), place(to_n, to_e));
        prop_assert_eq!(vector.start().is_ok(), place(n, e));
        prop_assert_eq!(vector.turn().is_ok(), heading(psi));
        let points = [WorldPoint::from_north_east(to_n, to_e), WorldPoint::from_north_east(n, e)];
        let sent = Vector::from_world(points[0], psi, points[1], Source::Visual);
        prop_assert_eq!(sent.is_ok(), place(to_n, to_e) && start);

        let map = Map {
            snapshot_e: e, snapshot_n: n, odometry_e: to_e, odometry_n: to_n, ..Map::default()
        };
        prop_assert_eq!(map.snapshot().is_ok(), place(n, e));
        prop_assert_eq!(map.odometry().is_ok(), place(to_n, to_e));
        let sent = Map::from_world((1, points[0]), (1, points[1]), heapless::Vec::new());
        prop_assert_eq!(sent.is_ok(), place(n, e) && place(to_n, to_e));

        let correction = InsCorrection {
            snapshot_index: 1,
            e_from: e, n_from: n, psi_from: psi, e_to: to_e, n_to: to_n, psi_to: to_psi,
        };
        prop_assert_eq!(correction.poses().is_ok(), both);
    }

    #[test]
    fn what_the_camera_agrees_to_send_the_autopilot_believes(
        wire in prop::array::uniform6(coordinate()),
    ) {
        let [n, e, psi, to_n, to_e, to_psi] = wire;
        let from = WorldPose::from_north_east(n, e, psi);
        let to = WorldPose::from_north_east(to_n, to_e, to_psi);
        if let Ok(correction) = InsCorrection::from_world(1, from, to) {
            prop_assert!(correction.poses().is_ok());
        }
        if let Ok(vector) = Vector::from_world(to.point(), psi, from.point(), Source::Odometry) {
            prop_assert_eq!(vector.target(), Ok(to.point()));
            prop_assert_eq!(vector.start(), Ok(from.point()));
            prop_assert_eq!(vector.turn(), Ok(psi));
        }
    }
}
