//! What a received byte costs the core: the link's parser alone, on the emulated Cortex-M4 with the
//! flash and the wait states of the flight.
//!
//! The table is printed with `cargo test --test cycles link -- --nocapture`.

mod bench;
mod streams;

use bench::{Bench, Cost};
use link::{Event, Parser};
use streams::Stream;
use tests::Budgets;

/// Pieces in which the receiver task takes bytes out of the DMA's ring.
const DMA_PIECE: usize = 128;

/// What the same parser makes of a stream here: frames delivered, start bytes refused.
fn outcome(stream: &[u8]) -> [u32; 2] {
    let (mut parser, mut bytes) = (Parser::new(), stream);
    let mut counts = [0; 2];
    while let Some(event) = parser.next_event(&mut bytes) {
        counts[usize::from(matches!(event, Event::Refused(_)))] += 1;
    }
    counts
}

fn cost(bench: &mut Bench, stream: &Stream, piece: usize) -> f64 {
    let Cost {
        outcome: [delivered, refused],
        cycles,
    } = bench.parse(&stream.bytes, piece);
    assert_eq!(
        [delivered, refused],
        outcome(&stream.bytes),
        "{}",
        stream.name
    );
    let per_byte = cycles as f64 / stream.bytes.len() as f64;
    println!(
        "{:<34}{piece:>6}{delivered:>10}{refused:>9}{per_byte:>13.1}",
        stream.name
    );
    per_byte
}

#[test]
fn a_received_byte_costs_the_core_less_than_its_budget() {
    let budgets = Budgets::load();
    let mut bench = Bench::boot();
    println!(
        "{:<34}{:>6}{:>10}{:>9}{:>13}",
        "stream", "piece", "delivered", "refused", "cycles/byte"
    );
    for stream in streams::expected() {
        let cycles = cost(&mut bench, &stream, DMA_PIECE);
        budgets.hold("parser_cycles_per_byte", cycles);
    }
    for stream in streams::hostile() {
        let cycles = cost(&mut bench, &stream, DMA_PIECE);
        budgets.hold("parser_cycles_per_byte_at_worst", cycles);
    }
    for stream in streams::expected().into_iter().chain(streams::hostile()) {
        let cycles = cost(&mut bench, &stream, 1);
        budgets.hold("parser_cycles_per_byte_at_worst", cycles);
    }
}
