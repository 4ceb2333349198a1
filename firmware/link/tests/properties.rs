//! What holds for every message and for every stream of bytes.

mod common;

use std::f32::consts::PI;

use common::{LONGEST_CLAIM, frame, frames_in, frames_in_ended, message, stream};
use link::{InsCorrection, Message, Parser, State, WorldPose};
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
    fn no_coordinate_that_is_no_number_gets_past_the_accessors(message in message()) {
        match message {
            Message::State(state) => {
                let wire = [state.ins_e, state.ins_n, state.psi];
                prop_assert_eq!(state.pose().is_ok(), wire.iter().all(|c| c.is_finite()));
            }
            Message::Vector(vector) => {
                let wire = [vector.target_e, vector.target_n];
                prop_assert_eq!(vector.target().is_ok(), wire.iter().all(|c| c.is_finite()));
            }
            Message::InsCorrection(c) => {
                let wire = [c.e_from, c.n_from, c.psi_from, c.e_to, c.n_to, c.psi_to];
                prop_assert_eq!(c.poses().is_ok(), wire.iter().all(|c| c.is_finite()));
            }
            _ => {}
        }
    }
}
