//! Frames by name: what a board says of each that it does not use.

use crate::common::{Board, SHAPE, grey, wire};
use frames::{Counts, Damage, Event, Pieces, Receiver, Request, Verdict};

fn dropped(number: u32, why: Verdict) -> Event {
    Event::Dropped { number, why }
}

/// The records of a frame.
fn pieces(number: u32) -> Vec<Vec<u8>> {
    Pieces::of(number, &grey(&SHAPE, 3), &SHAPE)
        .map(|piece| piece.to_vec())
        .collect()
}

#[test]
fn a_frame_with_a_piece_missing_is_torn_once_whichever_piece_it_is() {
    let count = pieces(1).len();
    assert!(count > 5);
    for missing in 0..count - 1 {
        let mut sent = pieces(1);
        sent.remove(missing);
        let mut board = Board::new();
        board.hear(&sent.concat(), &[usize::MAX]);
        assert_eq!(
            board.events,
            [dropped(1, Verdict::Torn)],
            "without {missing}"
        );
    }
}

/// Frames that do not fit the steps have the same offsets: the number alone tells their pieces apart.
#[test]
fn the_head_of_one_frame_and_the_tail_of_the_next_are_two_torn_frames() {
    let pieces = |number: u8| -> Vec<Vec<u8>> {
        let frame = vec![number; SHAPE.bytes()];
        let pieces = Pieces::of(u32::from(number), &frame, &SHAPE);
        pieces.map(|piece| piece.to_vec()).collect()
    };
    let stream = [pieces(1)[..9].concat(), pieces(2)[9..].concat()].concat();
    let mut board = Board::new();
    board.hear(&stream, &[usize::MAX]);
    assert_eq!(
        board.events,
        [dropped(1, Verdict::Torn), dropped(2, Verdict::Torn)]
    );
}

#[test]
fn a_frame_without_its_last_piece_is_torn_by_the_next_or_by_silence() {
    let mut sent = pieces(1);
    sent.pop();
    let mut board = Board::new();
    board.hear(&sent.concat(), &[usize::MAX]);
    assert_eq!(board.events, []);
    board.hear(&pieces(2).concat(), &[usize::MAX]);
    assert_eq!(
        board.events,
        [dropped(1, Verdict::Torn), Event::Frame { number: 2 }]
    );

    let mut board = Board::new();
    board.hear(&sent.concat(), &[usize::MAX]);
    board.receiver().give_up();
    board.hear(&[], &[usize::MAX]);
    assert_eq!(board.events, [dropped(1, Verdict::Torn)]);
}

#[test]
fn a_broken_piece_is_counted_and_tears_its_frame() {
    let mut sent = pieces(1);
    sent[2][40] ^= 0x10;
    let mut board = Board::new();
    board.hear(&sent.concat(), &[usize::MAX]);
    assert_eq!(
        board.events,
        [Event::Corrupt(Damage::Sum), dropped(1, Verdict::Torn)]
    );
    let counts = Counts {
        torn: 1,
        corrupt: 1,
        ..Counts::default()
    };
    assert_eq!(board.receiver().counts(), counts);
}

#[test]
fn a_record_that_was_cut_is_told_from_one_whose_bytes_changed() {
    let asked = Request::Begin { fresh_ms: 0x7f7f }.encode();
    let mut cut = asked.to_vec();
    cut.remove(asked.len() - 3);
    let mut board = Board::new();
    board.hear(&cut, &[usize::MAX]);
    assert_eq!(board.events, [Event::Corrupt(Damage::Broken)]);
}

#[test]
fn a_broken_first_piece_of_the_next_frame_does_not_leave_its_bytes_in_this_one() {
    let (this, mut next) = (pieces(1), pieces(2));
    let sum = next[0].len() - 2;
    next[0][sum] ^= 0x01;
    let (head, tail) = this.split_at(4);
    let mut board = Board::new();
    let stream = [head.concat(), next[0].clone(), tail.concat()].concat();
    board.hear(&stream, &[usize::MAX]);
    assert_eq!(
        board.events,
        [Event::Corrupt(Damage::Sum), dropped(1, Verdict::Torn)]
    );
}

#[test]
fn a_broken_record_that_was_not_the_frames_costs_nothing() {
    let mut sent = pieces(1);
    let mut request = Request::Identify.encode().to_vec();
    request[3] ^= 0x40;
    sent.insert(3, request);
    let mut board = Board::new();
    board.hear(&sent.concat(), &[usize::MAX]);
    assert_eq!(
        board.events,
        [Event::Corrupt(Damage::Sum), Event::Frame { number: 1 }]
    );
    assert_eq!(board.frames, [(1, grey(&SHAPE, 3))]);
}

#[test]
fn a_frame_that_was_on_its_way_for_longer_than_the_session_allows_is_late() {
    for (took_ms, late) in [(100, false), (101, true)] {
        let mut board = Board::new();
        // The clock wraps on the way.
        board.now_ms = u32::MAX - 50;
        board.hear(&Request::Begin { fresh_ms: 100 }.encode(), &[usize::MAX]);
        board.events.clear();
        let sent = pieces(1);
        let (head, last) = sent.split_at(sent.len() - 1);
        board.hear(&head.concat(), &[usize::MAX]);
        board.now_ms = board.now_ms.wrapping_add(took_ms);
        board.hear(&last.concat(), &[usize::MAX]);
        let expected = if late {
            dropped(1, Verdict::Late)
        } else {
            Event::Frame { number: 1 }
        };
        assert_eq!(board.events, [expected], "{took_ms} ms");
    }
}

#[test]
fn numbers_wrap_and_a_new_session_forgets_them() {
    let frame = grey(&SHAPE, 5);
    let mut board = Board::new();
    for number in [u32::MAX, 0, u32::MAX] {
        board.hear(&wire(number, &frame), &[usize::MAX]);
    }
    board.hear(&Request::Begin { fresh_ms: 1_000 }.encode(), &[usize::MAX]);
    board.hear(&wire(u32::MAX, &frame), &[usize::MAX]);
    assert_eq!(
        board.events,
        [
            Event::Frame { number: u32::MAX },
            Event::Frame { number: 0 },
            dropped(u32::MAX, Verdict::Late),
            Event::Asked(Request::Begin { fresh_ms: 1_000 }),
            Event::Frame { number: u32::MAX },
        ]
    );
}

#[test]
fn without_a_buffer_a_frame_is_refused_once_and_the_next_is_taken() {
    let mut receiver = Receiver::new(SHAPE);
    let mut buffer = vec![0; SHAPE.bytes()];
    let [first, second] = [1, 2].map(|number| pieces(number).concat());
    let mut bytes = &first[..];
    let busy = dropped(1, Verdict::Busy);
    assert_eq!(receiver.next_event(0, &mut bytes, None), Some(busy));
    assert_eq!(receiver.next_event(0, &mut bytes, None), None);
    let next = receiver.next_event(0, &mut &second[..], Some(&mut buffer));
    assert_eq!(next, Some(Event::Frame { number: 2 }));
}

#[test]
fn a_frame_of_another_size_is_no_frame() {
    let [longer, shorter] = [1, 2].map(|number| {
        let mut frame = grey(&SHAPE, 3);
        frame.resize(if number == 1 { 24_578 } else { 24_574 }, 0x80);
        wire(number, &frame)
    });
    let mut board = Board::new();
    board.hear(
        &[longer, shorter, wire(3, &grey(&SHAPE, 3))].concat(),
        &[usize::MAX],
    );
    let numbers: Vec<u32> = board.frames.iter().map(|(number, _)| *number).collect();
    assert_eq!(numbers, [3]);
}

/// 3 Mbaud are 300,000 bytes a second, and the camera gives 25.64 frames in it.
#[test]
fn a_grey_frame_with_the_sensors_noise_passes_3_megabaud_as_often_as_the_camera_gives_one() {
    let mut frame = grey(&SHAPE, 3);
    let mut state = 1u32;
    // A slope with noise of two units, triangular.
    for (pixel, luma) in frame.iter_mut().skip(1).step_by(2).enumerate() {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = (state >> 24) % 5 + (state >> 16) % 5;
        *luma = (pixel % 128) as u8 + noise as u8;
    }
    let [steps, bytes] = [frame.clone(), {
        frame[0] = 0;
        frame
    }]
    .map(|frame| 300_000.0 / wire(1, &frame).len() as f32);
    assert!(steps > 25.64, "{steps}");
    assert!((11.8..12.3).contains(&bytes), "{bytes}");
}
