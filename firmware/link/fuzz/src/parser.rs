//! The parser against any bytes: what holds for every stream, looked for by libFuzzer.
//!
//! The first byte of an input says in which pieces the rest is delivered. From this folder:
//!
//! ```text
//! cargo run --manifest-path ../Cargo.toml --example fuzz_seeds -- corpus
//! cargo run --release -- corpus -max_len=600 -max_total_time=60
//! ```
#![no_main]

#[path = "../../tests/common/invariants.rs"]
mod invariants;
#[path = "../../tests/common/reference.rs"]
mod reference;

use invariants::Case;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((cut, stream)) = input.split_first() else {
        return;
    };
    // Short and long pieces in turn: 1 to 16 bytes, 1 to 241 bytes.
    let pieces = [1 + usize::from(cut & 0x0f), 1 + usize::from(cut & 0xf0)];
    let case = Case::run(stream, &pieces);
    case.assert_that_cutting_changed_nothing();
    case.assert_that_every_byte_is_accounted_for();
    case.assert_that_giving_up_decides_all();
    Case::run(stream, &pieces).assert_that_good_frames_are_found_again();
});
