//! What the watchpoints are told of an instruction is what it then does.

use super::*;
use proptest::prelude::*;

/// In the midst of what answers.
const BASE: u32 = SPY + 0x40;

/// Instructions of a case: a bench is dearer than they are.
const PER_CASE: usize = 200;

/// Loads and stores among the narrow and the wide encodings (ARM DDI0403 §A5.2, §A5.3), and others.
fn encoding() -> impl Strategy<Value = [u16; 2]> {
    let first = prop_oneof![
        0x4800u16..0xa000,
        0xb400u16..0xb600,
        0xbc00u16..0xbe00,
        0xc000u16..0xd000,
        0xe800u16..0xea00,
        0xec00u16..0xee00,
        0xf800u16..0xfa00,
        0x0000u16..0x4600,
    ];
    (first, any::<u16>()).prop_map(|(first, second)| [first, second])
}

/// What the next instruction was told to access, and what it accessed: address, bytes and direction
/// of each transfer. Whether it executed to its end.
fn told_and_done(bench: &mut Bench) -> (Option<Access>, Vec<(u32, u32, bool)>, bool) {
    let told = bench.core.next_access(&bench.memory);
    let until = bench.core.cycles() + 1;
    let exit = bench.core.run(&mut bench.memory, &mut bench.bus, until);
    let done = bench.bus.accesses.drain(..);
    let done =
        done.map(|(_, address, width, value)| (address, width.bytes() as u32, value.is_some()));
    (told, done.collect(), !matches!(exit, Exit::Stopped(_)))
}

/// Holds what the next instruction was told to access against what it did.
fn hold(bench: &mut Bench) -> Result<(), TestCaseError> {
    let (told, done, whole) = told_and_done(bench);
    let is_on_bus = |access: &Access| SPY_RANGE.contains(&access.address);
    match (told, done.first()) {
        (Some(told), Some(&(address, _, write))) => {
            prop_assert_eq!((told.address, told.write), (address, write));
            let bytes: u32 = done.iter().map(|(_, bytes, _)| bytes).sum();
            prop_assert!(!whole || bytes == told.bytes, "{bytes} of {told:?}");
        }
        (Some(told), None) => prop_assert!(!whole || !is_on_bus(&told), "{told:?}"),
        (None, _) => prop_assert_eq!(done, vec![]),
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    #[test]
    fn the_next_access_is_foretold(
        encodings in prop::collection::vec((encoding(), any::<bool>()), PER_CASE)
    ) {
        let program: Vec<u16> = encodings
            .iter()
            .flat_map(|([first, second], _)| [*first, *second, BKPT, BKPT])
            .collect();
        let mut bench = Bench::new(&program);
        for (place, (encoding, exclusive)) in (CODE..).step_by(8).zip(&encodings) {
            (0..=14).for_each(|number| bench.core.set_register(number, BASE));
            bench.core.set_register(15, place);
            bench.core.exclusive = *exclusive;
            hold(&mut bench)
                .map_err(|error| TestCaseError::fail(format!("{encoding:x?}: {error}")))?;
        }
    }
}

#[test]
fn an_access_whose_condition_fails_is_none() {
    // CMP r0, r0; IT NE; STRNE r0, [r1], and the same with EQ.
    for (it, stores) in [(0xbf18, false), (0xbf08, true)] {
        let mut bench = Bench::with(&[BASE; 2], &[0x4280, it, 0x6008]);
        for _ in 0..2 {
            assert_eq!(told_and_done(&mut bench).0, None);
        }
        let (told, done, _) = told_and_done(&mut bench);
        assert_eq!((told.is_some(), !done.is_empty()), (stores, stores));
    }
}
