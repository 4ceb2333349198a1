//! What holds for any stream of bytes, cut into any pieces: for the property tests and the fuzz
//! target alike. Each panics where it does not hold.

use link::{Counters, Event, MAX_FRAME_LEN, Parser, Refusal, Refused};

use super::reference::{frames_in, frames_in_ended};

/// Longest a false start can hold up what follows.
const LONGEST_CLAIM: usize = MAX_FRAME_LEN - 1;

/// A STATE of zeros: no byte of it but the first is a start byte.
const GOOD: [u8; 28] = {
    let mut frame = [0; 28];
    [frame[0], frame[1], frame[4], frame[5]] = [0x99, 28, 5, 10];
    // A runs 1c 1c 1c 21 2b and stays; B is 1c + 1c + 1c + 21 + 21 times 2b.
    [frame[26], frame[27]] = [0x2b, 0xfc];
    frame
};

/// An event, with a frame as the bytes that it is encoded to: a NaN is no NaN's equal.
#[derive(Debug, PartialEq)]
enum Told {
    Frame(Vec<u8>),
    Refused(Refused),
}

impl Told {
    fn frame(&self) -> Option<&Vec<u8>> {
        match self {
            Self::Frame(bytes) => Some(bytes),
            Self::Refused(_) => None,
        }
    }

    fn is_good(&self) -> bool {
        self.frame().is_some_and(|frame| *frame == GOOD)
    }
}

/// Takes all events out of `bytes`.
fn drain(parser: &mut Parser, mut bytes: &[u8], told: &mut Vec<Told>) {
    while let Some(event) = parser.next_event(&mut bytes) {
        told.push(match event {
            Event::Frame(frame) => Told::Frame(frame.encode().to_vec()),
            Event::Refused(refused) => Told::Refused(refused),
        });
    }
    assert!(bytes.is_empty(), "all is taken");
    assert!(parser.held() <= LONGEST_CLAIM, "more than a frame is held");
}

/// A stream, cut into pieces of certain lengths over and over, and what the parser made of it.
pub struct Case<'a> {
    stream: &'a [u8],
    pieces: &'a [usize],
    parser: Parser,
    told: Vec<Told>,
}

impl<'a> Case<'a> {
    /// Feeds `stream` to a parser.
    pub fn run(stream: &'a [u8], pieces: &'a [usize]) -> Self {
        let (mut parser, mut told) = (Parser::new(), Vec::new());
        let mut lengths = pieces.iter().cycle();
        let mut rest = stream;
        while !rest.is_empty() {
            let len = lengths.next().map_or(1, |len| *len).clamp(1, rest.len());
            let (piece, behind) = rest.split_at(len);
            drain(&mut parser, piece, &mut told);
            rest = behind;
        }
        Self {
            stream,
            pieces,
            parser,
            told,
        }
    }

    /// The frames are those that stand in the stream, byte for byte; and they and the refusals are
    /// the same in one piece.
    pub fn assert_that_cutting_changed_nothing(&self) {
        assert!(self.frames().eq(&frames_in(self.stream).0));
        let in_one = [self.stream.len()];
        let whole = Case::run(self.stream, &in_one);
        assert_eq!(self.told, whole.told, "in pieces of {:?}", self.pieces);
    }

    /// Every byte is part of a delivered frame, counted as skipped, or held; and every event is
    /// counted under its name.
    pub fn assert_that_every_byte_is_accounted_for(&self) {
        let counters = self.parser.counters();
        let delivered: usize = self.frames().map(Vec::len).sum();
        let decided = delivered + counters.bytes_skipped as usize;
        assert_eq!(decided + self.parser.held(), self.stream.len());
        assert_eq!(decided, frames_in(self.stream).1);
        assert_counts(counters, &self.told);
    }

    /// What is held when the wire falls silent is decided as if nothing followed; nothing is left,
    /// and the parser is ready for more.
    pub fn assert_that_giving_up_decides_all(mut self) {
        self.parser.give_up();
        drain(&mut self.parser, &[], &mut self.told);
        assert_eq!(self.parser.held(), 0);
        assert!(self.frames().eq(&frames_in_ended(self.stream)));
        let counters = self.parser.counters();
        let delivered: usize = self.frames().map(Vec::len).sum();
        assert_eq!(
            delivered + counters.bytes_skipped as usize,
            self.stream.len()
        );
        assert_counts(counters, &self.told);

        // The sender goes on later.
        let (beginning, end) = GOOD.split_at(17);
        drain(&mut self.parser, beginning, &mut self.told);
        drain(&mut self.parser, end, &mut self.told);
        assert!(self.told.last().is_some_and(Told::is_good));
    }

    /// Behind any stream, good frames come out again after one maximal frame at the latest.
    pub fn assert_that_good_frames_are_found_again(mut self) {
        let copies = LONGEST_CLAIM / GOOD.len() + 2;
        drain(&mut self.parser, &GOOD.repeat(copies), &mut self.told);
        let newest_first = self.told.iter().rev();
        let in_step = newest_first.take_while(|told| told.is_good()).count();
        let lost = copies.saturating_sub(in_step);
        assert!(
            lost * GOOD.len() < LONGEST_CLAIM + GOOD.len(),
            "{lost} lost"
        );
        assert_eq!(self.parser.held(), 0);
    }

    fn frames(&self) -> impl Iterator<Item = &Vec<u8>> {
        frames(&self.told)
    }
}

fn frames(told: &[Told]) -> impl Iterator<Item = &Vec<u8>> {
    told.iter().filter_map(Told::frame)
}

fn assert_counts(counters: Counters, told: &[Told]) {
    let refusals = |why| {
        let same = |told: &&Told| matches!(told, Told::Refused(refused) if refused.why == why);
        told.iter().filter(same).count() as u32
    };
    let expected = Counters {
        frames_ok: frames(told).count() as u32,
        bytes_skipped: counters.bytes_skipped,
        bad_length: refusals(Refusal::BadLength),
        wrong_class: refusals(Refusal::WrongClass),
        unknown_message: refusals(Refusal::UnknownMessage),
        wrong_size: refusals(Refusal::WrongSize),
        bad_checksum: refusals(Refusal::BadChecksum),
        cut_short: refusals(Refusal::CutShort),
    };
    assert_eq!(counters, expected);
}
