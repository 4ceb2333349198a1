//! What the link's parser costs on the core that flies.
//!
//! Nothing but the parser, on the flash of the flight image and with its wait states. A debug probe
//! (or the emulator) writes a stream into [`STREAM`], the length of its pieces into [`PIECE_BYTES`]
//! and its length into [`STREAM_BYTES`]. The length becomes zero when all of it is parsed; the time
//! is that between entry and return of `parse_stream`.
#![no_std]
#![no_main]

#[path = "common/flight_flash.rs"]
mod flight_flash;

use core::hint::black_box;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use cortex_m::asm;
use defmt_rtt as _;
use link::{Event, Parser};
use panic_probe as _;

/// Longest stream.
const CAPACITY: usize = 32 * 1024;

/// The bytes to parse.
#[unsafe(no_mangle)]
static STREAM: [AtomicU8; CAPACITY] = [const { AtomicU8::new(0) }; CAPACITY];

/// In pieces of how many bytes.
#[unsafe(no_mangle)]
static PIECE_BYTES: AtomicU32 = AtomicU32::new(0);

/// How many there are; writing it starts the run.
#[unsafe(no_mangle)]
static STREAM_BYTES: AtomicU32 = AtomicU32::new(0);

/// Frames that the last run delivered.
#[unsafe(no_mangle)]
static DELIVERED: AtomicU32 = AtomicU32::new(0);

/// Start bytes that the last run refused.
#[unsafe(no_mangle)]
static REFUSED: AtomicU32 = AtomicU32::new(0);

#[cortex_m_rt::entry]
fn main() -> ! {
    flight_flash::set_up();
    let mut bytes = [0; CAPACITY];
    loop {
        let length = STREAM_BYTES.load(Ordering::Acquire) as usize;
        let (Some(stream), true) = (bytes.get_mut(..length), length > 0) else {
            asm::nop();
            continue;
        };
        for (byte, source) in stream.iter_mut().zip(&STREAM) {
            *byte = source.load(Ordering::Relaxed);
        }
        let piece = PIECE_BYTES.load(Ordering::Relaxed).max(1) as usize;
        let [delivered, refused] = parse_stream(stream, piece);
        DELIVERED.store(delivered, Ordering::Relaxed);
        REFUSED.store(refused, Ordering::Relaxed);
        STREAM_BYTES.store(0, Ordering::Release);
    }
}

/// Feeds the stream piece by piece, as the receiver task does; how many frames came out and how many
/// start bytes were refused.
#[unsafe(no_mangle)]
#[inline(never)]
fn parse_stream(stream: &[u8], piece_bytes: usize) -> [u32; 2] {
    let mut parser = Parser::new();
    let [mut delivered, mut refused] = [0; 2];
    for mut piece in stream.chunks(piece_bytes) {
        loop {
            let event = parser.next_event(&mut piece);
            match black_box(&event) {
                Some(Event::Frame(_)) => delivered += 1,
                Some(Event::Refused(_)) => refused += 1,
                None => break,
            }
        }
    }
    [delivered, refused]
}
