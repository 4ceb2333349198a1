//! What holds for every message and for every stream of bytes.
//!
//! That nothing here allocates needs no test: the crate is `no_std` and does not link `alloc`.

mod common;

use std::f32::consts::PI;

use common::invariants::Case;
use common::{coordinate, frame, stream};
use link::{InsCorrection, Map, Parser, Source, State, Vector, WorldPoint, WorldPose};
use proptest::collection::vec;
use proptest::prelude::*;

/// Lengths of pieces.
fn pieces() -> impl Strategy<Value = Vec<usize>> {
    vec(1usize..300, 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

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
    fn frames_and_refusals_do_not_depend_on_how_a_stream_is_cut(
        stream in stream(),
        pieces in pieces(),
    ) {
        Case::run(&stream, &pieces).assert_that_cutting_changed_nothing();
        Case::run(&stream, &[1]).assert_that_cutting_changed_nothing();
    }

    #[test]
    fn every_byte_is_delivered_counted_or_held(stream in stream(), pieces in pieces()) {
        Case::run(&stream, &pieces).assert_that_every_byte_is_accounted_for();
    }

    #[test]
    fn good_frames_are_found_at_the_latest_one_maximal_frame_behind_garbage(
        garbage in stream(),
        pieces in pieces(),
    ) {
        Case::run(&garbage, &pieces).assert_that_good_frames_are_found_again();
    }

    #[test]
    fn giving_up_decides_a_stream_as_if_nothing_followed(stream in stream(), pieces in pieces()) {
        Case::run(&stream, &pieces).assert_that_giving_up_decides_all();
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
