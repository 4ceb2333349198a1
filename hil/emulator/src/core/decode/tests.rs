use super::*;
use crate::core::instruction::{Guard, SP};
use proptest::prelude::*;

const ADDRESS: u32 = 0x0800_0102;

fn operation(first: u16, second: u16) -> Operation {
    decode(ADDRESS, first, second, Place::Plain).operation
}

#[test]
fn an_instruction_knows_its_length() {
    assert_eq!(decode(ADDRESS, 0x4608, 0, Place::Plain).length, 2);
    assert_eq!(decode(ADDRESS, 0xea4f, 0x0001, Place::Plain).length, 4);
    assert!(
        !is_wide(0xe7fe),
        "the 16-bit branch is the last of the short ones"
    );
    assert!(is_wide(0xe800));
}

#[test]
fn literals_and_branch_targets_are_absolute() {
    // ldr r0, [pc, #8]: from the program counter rounded down to 4
    let load = decode(ADDRESS, 0x4802, 0, Place::Plain);
    assert_eq!(load.immediate, 0x0800_0104 + 8);
    // b with an offset of -4: to itself
    assert_eq!(decode(ADDRESS, 0xe7fe, 0, Place::Plain).immediate, ADDRESS);
    // ldrb.w r1, [pc, #-6]
    let byte = decode(ADDRESS, 0xf81f, 0x1006, Place::Plain);
    assert_eq!((byte.n, byte.immediate), (PC, 0x0800_0104 - 6));
}

#[test]
fn long_branches_reach_sixteen_megabytes_both_ways() {
    let target = |first, second| decode(0, first, second, Place::Plain).immediate;
    assert_eq!(target(0xf3ff, 0xd7ff), 4 + 0x00ff_fffe, "bl forwards");
    assert_eq!(
        target(0xf400, 0xd000),
        4u32.wrapping_sub(0x0100_0000),
        "bl backwards"
    );
}

#[test]
fn sixteen_bit_arithmetic_sets_flags_only_outside_it_blocks() {
    let adds = |place| decode(ADDRESS, 0x1840, 0, place);
    assert_eq!(adds(Place::Plain).operation, Operation::Adds);
    let inside = adds(Place::InItBlock(1));
    assert_eq!(inside.operation, Operation::Add);
    assert_eq!(inside.guard, Guard::NONE.on_condition(1));
}

#[test]
fn an_it_block_takes_no_branch_with_a_condition_of_its_own() {
    for first in [0xd0fe, 0xb100, 0xbf08] {
        let inside = decode(ADDRESS, first, 0, Place::InItBlock(0));
        assert_eq!(inside.operation, Operation::Unpredictable, "{first:#x}");
    }
    let breakpoint = decode(ADDRESS, 0xbe00, 0, Place::InItBlock(0));
    assert_eq!(breakpoint.guard, Guard::NONE, "BKPT ignores the condition");
}

#[test]
fn pushes_and_pops_are_found_in_the_long_list_transfers() {
    assert_eq!(operation(0xe92d, 0x4ff0), Operation::Push); // push.w {r4-r11, lr}
    assert_eq!(operation(0xe8bd, 0x8ff0), Operation::Pop); // pop.w {r4-r11, pc}
    let negative = decode(ADDRESS, 0xb082, 0, Place::Plain); // sub sp, #8
    assert_eq!((negative.d, negative.immediate), (SP, 8));
}

#[test]
fn encodings_without_a_meaning_are_undefined() {
    for (first, second) in [
        (0xde00, 0),      // udf
        (0xba80, 0),      // between REV16 and REVSH
        (0xb600, 0),      // SETEND belongs to other profiles
        (0xee00, 0x0b00), // double-precision arithmetic
        (0xed10, 0x0f00), // a coprocessor that is not there
        (0xec51, 0x0c10), // MRRC of one
        (0xf7f0, 0xa000), // udf.w
        (0xea00, 0x8000), // a bit that must be zero
    ] {
        let refused = operation(first, second);
        let expected = matches!(refused, Operation::Undefined | Operation::Unpredictable);
        assert!(expected, "{first:#06x} {second:#06x}: {refused:?}");
    }
}

#[test]
fn registers_that_the_manual_forbids_are_unpredictable() {
    for (first, second) in [
        (0xbc00, 0),      // pop {}
        (0xc000, 0),      // stm r0!, {}
        (0x44ff, 0),      // add pc, pc
        (0x47f8, 0),      // blx pc
        (0xeb00, 0x0f01), // add.w pc, r0, r1
        (0xfb90, 0xf0ff), // sdiv r0, r0, pc
        (0xfbc0, 0x1100), // smlal r1, r1, r0, r0
        (0xe8bd, 0xc000), // pop.w {lr, pc}
        (0xe9d0, 0x1100), // ldrd r1, r1, [r0]
        (0xf8c0, 0xf000), // str pc, [r0]
        (0xf361, 0x1003), // bfi with its end below its start
    ] {
        let refused = operation(first, second);
        assert_eq!(
            refused,
            Operation::Unpredictable,
            "{first:#06x} {second:#06x}"
        );
    }
}

proptest! {
    #[test]
    fn every_encoding_decodes_to_something_with_a_cost(
        first in any::<u16>(),
        second in any::<u16>(),
        address in any::<u32>(),
        condition in 0u8..14,
    ) {
        for place in [Place::Plain, Place::InItBlock(condition)] {
            let instruction = decode(address & !1, first, second, place);
            prop_assert!(instruction.cycles > 0);
            prop_assert!(matches!(instruction.length, 2 | 4));
            prop_assert_ne!(instruction.operation, Operation::Undecoded);
        }
    }
}
