//! What holds for every stream of bytes.

use crate::common::{Board, SHAPE, frame, grey_frame, noise, wire};
use frames::{Event, Pieces, Receiver, Replies, Reply, Request, Shape, Verdict};
use proptest::collection::vec;
use proptest::prelude::*;

/// Lengths of pieces of a stream.
fn cuts() -> impl Strategy<Value = Vec<usize>> {
    vec(1usize..700, 1..6)
}

/// What may happen to a stream on its way.
#[derive(Clone, Debug)]
enum Harm {
    Flip { at: usize, bit: u8 },
    Lose { at: usize, bytes: usize },
    Insert { at: usize, bytes: Vec<u8> },
    Repeat { at: usize, bytes: usize },
}

impl Harm {
    fn any() -> impl Strategy<Value = Self> {
        let at = || 0usize..40_000;
        prop_oneof![
            (at(), 0u8..8).prop_map(|(at, bit)| Self::Flip { at, bit }),
            (at(), 1usize..2_500).prop_map(|(at, bytes)| Self::Lose { at, bytes }),
            (at(), noise(300)).prop_map(|(at, bytes)| Self::Insert { at, bytes }),
            (at(), 1usize..5_000).prop_map(|(at, bytes)| Self::Repeat { at, bytes }),
        ]
    }

    fn befall(&self, wire: &mut Vec<u8>) {
        let place = |at: usize| at % wire.len().max(1);
        match self {
            Self::Flip { at, bit } => {
                let at = place(*at);
                if let Some(byte) = wire.get_mut(at) {
                    *byte ^= 1 << bit;
                }
            }
            Self::Lose { at, bytes } => {
                let from = place(*at);
                let to = (from + bytes).min(wire.len());
                wire.drain(from..to);
            }
            Self::Insert { at, bytes } => {
                let at = place(*at);
                wire.splice(at..at, bytes.iter().copied());
            }
            Self::Repeat { at, bytes } => {
                let from = place(*at);
                let to = (from + bytes).min(wire.len());
                let again = wire[from..to].to_vec();
                wire.splice(to..to, again);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_frame_comes_back_bit_for_bit(frame in prop_oneof![frame(), grey_frame()]) {
        let mut board = Board::new();
        board.hear(&wire(7, &frame), &[usize::MAX]);
        prop_assert_eq!(board.frames, vec![(7, frame)]);
    }

    #[test]
    fn events_do_not_depend_on_how_a_stream_is_cut(
        frames in vec(prop_oneof![frame(), grey_frame()], 1..4),
        harms in vec(Harm::any(), 0..4),
        cuts in cuts(),
    ) {
        let mut stream: Vec<u8> = (1..).zip(&frames).flat_map(|(n, frame)| wire(n, frame)).collect();
        harms.iter().for_each(|harm| harm.befall(&mut stream));
        let [mut whole, mut cut] = [Board::new(), Board::new()];
        whole.hear(&stream, &[usize::MAX]);
        cut.hear(&stream, &cuts);
        prop_assert_eq!(whole.events, cut.events);
        prop_assert_eq!(whole.frames, cut.frames);
    }

    #[test]
    fn no_harm_on_the_wire_makes_a_frame_that_was_not_sent(
        frames in vec(prop_oneof![frame(), grey_frame()], 1..5),
        harms in vec(Harm::any(), 1..8),
        cuts in cuts(),
    ) {
        let sent: Vec<(u32, Vec<u8>)> = (1..).zip(frames).collect();
        let mut stream: Vec<u8> = sent.iter().flat_map(|(n, frame)| wire(*n, frame)).collect();
        harms.iter().for_each(|harm| harm.befall(&mut stream));
        let mut board = Board::new();
        board.hear(&stream, &cuts);
        let mut last = 0;
        for frame in &board.frames {
            prop_assert!(sent.contains(frame), "frame {} is another's", frame.0);
            prop_assert!(frame.0 > last, "numbers rise");
            last = frame.0;
        }
        // And the next one is found behind whatever it was.
        let next = (100, sent[0].1.clone());
        board.hear(&wire(next.0, &next.1), &cuts);
        prop_assert_eq!(board.frames.last(), Some(&next));
    }

    #[test]
    fn garbage_alone_makes_no_frame_and_no_request(garbage in noise(5_000), cuts in cuts()) {
        let mut board = Board::new();
        board.hear(&garbage, &cuts);
        prop_assert!(board.events.iter().all(|event| matches!(event, Event::Corrupt(_))));
    }

    #[test]
    fn a_number_is_used_once_and_an_older_one_never(
        numbers in vec(0u32..6, 1..12),
        base in any::<u32>(),
        frame in grey_frame(),
    ) {
        let mut board = Board::new();
        let mut newest = None;
        for number in numbers {
            board.events.clear();
            board.hear(&wire(base.wrapping_add(number), &frame), &[usize::MAX]);
            let sent = base.wrapping_add(number);
            let expected = match newest {
                Some(newest) if number == newest => Event::Dropped { number: sent, why: Verdict::Repeated },
                Some(newest) if number < newest => Event::Dropped { number: sent, why: Verdict::Late },
                _ => {
                    newest = Some(number);
                    Event::Frame { number: sent }
                }
            };
            prop_assert_eq!(&board.events, &vec![expected]);
        }
    }

    #[test]
    fn frames_of_any_size_come_back(
        width in 1u16..40,
        height in 1u16..60,
        bytes_per_pixel in 1u8..4,
        luma in 0u8..4,
        seed in any::<u64>(),
    ) {
        let luma_offset = luma % bytes_per_pixel;
        let shape = Shape { width, height, bytes_per_pixel, luma_offset };
        let frame = crate::common::grey(&shape, seed);
        let mut receiver = Receiver::new(shape);
        let mut buffer = vec![0; shape.bytes()];
        let wire: Vec<u8> = Pieces::of(1, &frame, &shape).flatten().collect();
        let event = receiver.next_event(0, &mut &wire[..], Some(&mut buffer));
        prop_assert_eq!(event, Some(Event::Frame { number: 1 }));
        prop_assert_eq!(buffer, frame);
    }

    #[test]
    fn answers_come_back_and_broken_ones_do_not(
        number in any::<u32>(),
        shutter_lines in any::<u16>(),
        gain in 1.0f32..16.0,
        verdict in 0usize..6,
        harms in vec(Harm::any(), 0..3),
    ) {
        let reply = Reply::Verdict { number, verdict: Verdict::ALL[verdict], shutter_lines, gain };
        let mut stream = reply.encode().to_vec();
        harms.iter().for_each(|harm| harm.befall(&mut stream));
        stream.extend(reply.encode());
        let (mut replies, mut bytes) = (Replies::new(), &stream[..]);
        let mut read = Vec::new();
        while let Some(found) = replies.next_reply(&mut bytes) {
            read.extend(found);
        }
        prop_assert!(read.iter().all(|found| *found == reply));
        prop_assert!(!read.is_empty(), "the one that was not harmed");
    }

    #[test]
    fn requests_come_through_between_pieces(frame in frame(), fresh_ms in any::<u16>()) {
        let requests = [Request::Identify, Request::Count];
        let mut stream = Request::Begin { fresh_ms }.encode().to_vec();
        for piece in Pieces::of(1, &frame, &SHAPE) {
            stream.extend(piece);
            requests.iter().for_each(|request| stream.extend(request.encode()));
        }
        let mut board = Board::new();
        board.hear(&stream, &[17]);
        prop_assert_eq!(&board.events[..2], [
            Event::Asked(Request::Begin { fresh_ms }),
            Event::Asked(Request::Identify),
        ]);
        prop_assert_eq!(&board.frames, &vec![(1, frame)]);
    }
}
