//! What may come over the wire, good and bad.

use std::fs;

use link::{Command, Message, State};
use serde::Deserialize;

/// How long each stream is at least.
const STREAM_BYTES: usize = 16 * 1024;

/// Bytes from the wire.
pub struct Stream {
    /// What they are.
    pub name: &'static str,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// What a link carries: frames, and the noise of one that is open.
pub fn expected() -> Vec<Stream> {
    vec![
        stream("STATE ten times, COMMAND once", &second()),
        stream("golden frames", &golden("valid/")),
        stream("golden broken streams", &golden("adv/")),
        stream("noise", &[noise()]),
    ]
}

/// What costs most.
pub fn hostile() -> Vec<Stream> {
    vec![
        stream("golden frames, cut", &cut(golden("valid/"))),
        stream("golden frames, a bit flipped", &flipped(golden("valid/"))),
        stream("start bytes", &[vec![0x99; 16]]),
        stream("claims in claims", &[CLAIMS.to_vec()]),
    ]
}

/// Two headers of MAP in eight bytes, the first from byte 0 and the second from byte 2. Repeated,
/// each claims more than twenty of the same kind: 182 bytes with an array of 0x99, found 26 bytes on
/// in byte 2, and 242 with one of 0xd5, found in byte 4. Both lengths are right, so that only the
/// checksum shows that they are none. No denser pattern claims as much: four bytes behind a start
/// byte a class ends in 5, behind it an id that is no start byte either.
const CLAIMS: [u8; 8] = [0x99, 182, 0x99, 242, 0xd5, 11, 0x05, 11];

/// Pieces over and over, until the stream is long enough.
fn stream(name: &'static str, pieces: &[Vec<u8>]) -> Stream {
    let mut bytes = Vec::new();
    let mut pieces = pieces.iter().cycle();
    while bytes.len() < STREAM_BYTES {
        bytes.extend(pieces.next().expect("pieces"));
    }
    Stream { name, bytes }
}

/// What the autopilot sends in a second: its pose ten times, and a command.
fn second() -> Vec<Vec<u8>> {
    let command = Message::Command(Command {
        command: 0x12,
        ..Command::default()
    });
    let state = |step: u8| {
        Message::State(State {
            ins_e: -1.25,
            ins_n: f32::from(step) * 0.05,
            psi: 0.3,
            ..State::default()
        })
    };
    let messages = (0..10).map(state).chain([command]);
    messages.map(|message| message.encode().to_vec()).collect()
}

/// One line of the golden file.
#[derive(Deserialize)]
struct Record {
    name: String,
    hex: String,
}

/// The streams of the golden file whose names begin so.
fn golden(prefix: &str) -> Vec<Vec<u8>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/data/pprzlink.jsonl");
    let lines = fs::read_to_string(path).expect("the golden file is part of the project");
    let records = lines
        .lines()
        .map(|line| serde_json::from_str::<Record>(line).expect("one record a line"));
    records
        .filter(|record| record.name.starts_with(prefix))
        .map(|record| bytes(&record.hex))
        .collect()
}

fn bytes(hex: &str) -> Vec<u8> {
    let pairs = (0..hex.len()).step_by(2);
    pairs
        .map(|at| u8::from_str_radix(&hex[at..at + 2], 16).expect("hex digits"))
        .collect()
}

/// Each frame without its end, from the first byte on later and later.
fn cut(frames: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    let shorten = |(number, mut frame): (usize, Vec<u8>)| {
        frame.truncate(1 + number * 7 % (frame.len() - 1));
        frame
    };
    frames.into_iter().enumerate().map(shorten).collect()
}

/// Each frame with one bit wrong, in a byte and at a place that wander.
fn flipped(frames: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    let flip = |(number, mut frame): (usize, Vec<u8>)| {
        let at = number * 7 % frame.len();
        frame[at] ^= 1 << (number % 8);
        frame
    };
    frames.into_iter().enumerate().map(flip).collect()
}

/// The upper eight bits of a linear congruential generator (Numerical Recipes §7.1).
fn noise() -> Vec<u8> {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    (0..STREAM_BYTES).map(|_| next()).collect()
}
