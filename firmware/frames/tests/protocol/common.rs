//! Frames, streams and a board to hear them.

use frames::{Event, Pieces, Receiver, Shape};
use proptest::collection::vec;
use proptest::prelude::*;

/// The flight board's frames.
pub const SHAPE: Shape = Shape {
    width: 128,
    height: 96,
    bytes_per_pixel: 2,
    luma_offset: 1,
};

/// Bytes out of nothing (the multiplier of Knuth's MMIX generator).
fn bytes(seed: u64, len: usize) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 56) as u8
    };
    (0..len).map(|_| next()).collect()
}

/// A frame without colour: smooth luma with some noise, and a jump now and then.
pub fn grey(shape: &Shape, seed: u64) -> Vec<u8> {
    let noise = bytes(seed, shape.bytes());
    let size = usize::from(shape.bytes_per_pixel);
    let mut luma = 0u8;
    let mut at = 0;
    noise
        .into_iter()
        .map(|noise| {
            let offset = at % size;
            at += 1;
            if offset != usize::from(shape.luma_offset) {
                return 0x80;
            }
            luma = if noise < 8 {
                noise.wrapping_mul(37)
            } else {
                luma.wrapping_add(noise % 19).wrapping_sub(9)
            };
            luma
        })
        .collect()
}

/// Any frame without colour.
pub fn grey_frame() -> impl Strategy<Value = Vec<u8>> {
    any::<u64>().prop_map(|seed| grey(&SHAPE, seed))
}

/// Any frame.
pub fn frame() -> impl Strategy<Value = Vec<u8>> {
    any::<u64>().prop_map(|seed| bytes(seed, SHAPE.bytes()))
}

/// Bytes with many delimiters among them.
pub fn noise(len: usize) -> impl Strategy<Value = Vec<u8>> {
    vec(
        prop_oneof![4 => any::<u8>(), 1 => Just(0), 1 => 1u8..8],
        0..len,
    )
}

/// A frame on the wire.
pub fn wire(number: u32, frame: &[u8]) -> Vec<u8> {
    Pieces::of(number, frame, &SHAPE).flatten().collect()
}

/// A board that keeps the frames it is sent.
pub struct Board {
    receiver: Receiver,
    buffer: Vec<u8>,
    /// All that it was told.
    pub events: Vec<Event>,
    /// The whole frames, with their numbers.
    pub frames: Vec<(u32, Vec<u8>)>,
    /// Its clock, milliseconds.
    pub now_ms: u32,
}

impl Board {
    /// A board that has heard nothing.
    pub fn new() -> Self {
        Self {
            receiver: Receiver::new(SHAPE),
            buffer: vec![0xee; SHAPE.bytes()],
            events: Vec::new(),
            frames: Vec::new(),
            now_ms: 0,
        }
    }

    /// Takes a stream in pieces of these lengths, over and over.
    pub fn hear(&mut self, mut stream: &[u8], cuts: &[usize]) {
        for cut in cuts.iter().cycle() {
            let (mut piece, rest) = stream.split_at((*cut).min(stream.len()));
            stream = rest;
            while let Some(event) =
                self.receiver
                    .next_event(self.now_ms, &mut piece, Some(&mut self.buffer))
            {
                self.events.push(event);
                if let Event::Frame { number } = event {
                    self.frames.push((number, self.buffer.clone()));
                    self.buffer.fill(0xee);
                }
            }
            if stream.is_empty() {
                return;
            }
        }
    }

    /// The receiver itself.
    pub fn receiver(&mut self) -> &mut Receiver {
        &mut self.receiver
    }
}
