//! Data processing: results and flags.

use super::*;

#[test]
fn an_addition_sets_carry_on_unsigned_and_overflow_on_signed_wrap() {
    let adds = &[
        0x1840, // adds r0, r0, r1
    ];
    assert_eq!(flags_after(&[0xffff_ffff, 1], adds), "ZC");
    assert_eq!(flags_after(&[0x7fff_ffff, 1], adds), "NV");
    assert_eq!(flags_after(&[0x8000_0000, 0x8000_0000], adds), "ZCV");
    assert_eq!(flags_after(&[1, 2], adds), "");
}

#[test]
fn a_comparison_sets_carry_where_nothing_was_borrowed() {
    let cmp = &[
        0x4288, // cmp r0, r1
    ];
    assert_eq!(flags_after(&[5, 5], cmp), "ZC");
    assert_eq!(flags_after(&[4, 5], cmp), "N");
    assert_eq!(flags_after(&[0x8000_0000, 1], cmp), "CV");
    assert_eq!(flags_after(&[0, 0x8000_0000], cmp), "NV");
}

#[test]
fn carries_chain_through_64_bit_additions_and_subtractions() {
    let sum = result(
        &[0xffff_ffff, 0x0000_0001, 0x0000_0001, 0x0000_0002],
        &[
            0x1880, // adds r0, r0, r2
            0xeb41, 0x0103, // adc.w r1, r1, r3
        ],
    );
    assert_eq!(sum, [0, 4]);
    let difference = result(
        &[0, 5, 1, 2],
        &[
            0x1a80, // subs r0, r0, r2
            0xeb61, 0x0103, // sbc.w r1, r1, r3
        ],
    );
    assert_eq!(difference, [0xffff_ffff, 2]);
}

#[test]
fn modified_immediates_expand_and_rotate() {
    let program = &[
        0xf04f, 0x10ab, // mov.w r0, #0x00ab00ab
        0xf04f, 0x21ab, // mov.w r1, #0xab00ab00
        0xf04f, 0x32ab, // mov.w r2, #0xabababab
        0xf04f, 0x437f, // mov.w r3, #0xff000000
        0xf241, 0x2434, // movw r4, #0x1234
        0xf6ca, 0x34cd, // movt r4, #0xabcd
    ];
    let expected = [
        0x00ab_00ab,
        0xab00_ab00,
        0xabab_abab,
        0xff00_0000,
        0xabcd_1234,
    ];
    assert_eq!(result(&[], program), expected);
}

#[test]
fn a_rotated_immediate_puts_its_top_bit_into_carry_and_a_plain_one_keeps_it() {
    let rotated = &[
        0xf05f, 0x4000, // movs.w r0, #0x80000000
    ];
    assert_eq!(flags_after(&[], rotated), "NC");
    let cleared = &[
        0x4280, // cmp r0, r0
        0xf011, 0x4f80, // tst.w r1, #0x40000000
    ];
    assert_eq!(
        flags_after(&[0, 0x4000_0000], cleared),
        "",
        "carry was set, 0x40000000 clears it"
    );
    let kept = &[
        0x4280, // cmp r0, r0
        0xf011, 0x0101, // ands.w r1, r1, #1
    ];
    assert_eq!(flags_after(&[0, 1], kept), "C");
}

#[test]
fn shifts_by_a_constant_carry_out_the_last_bit() {
    assert_eq!(
        flags_after(
            &[0x8000_0001],
            &[
                0x0040, // lsls r0, r0, #1
            ]
        ),
        "C"
    );
    assert_eq!(
        flags_after(
            &[0x8000_0001],
            &[
                0x0840, // lsrs r0, r0, #1
            ]
        ),
        "C"
    );
    assert_eq!(
        flags_after(
            &[0x8000_0000],
            &[
                0x1000, // asrs r0, r0, #32
            ]
        ),
        "NC"
    );
    assert_eq!(
        flags_after(
            &[0x8000_0000],
            &[
                0x0800, // lsrs r0, r0, #32
            ]
        ),
        "ZC"
    );
    let [rotated] = result(
        &[3],
        &[
            0x4280, // cmp r0, r0
            0xea4f, 0x0030, // rrx r0, r0
        ],
    );
    assert_eq!(rotated, 0x8000_0001, "RRX shifts the carry in at the top");
}

#[test]
fn shifts_by_a_register_use_its_low_byte_and_zero_changes_no_carry() {
    let lsl = &[
        0x4292, // cmp r2, r2
        0x4088, // lsls r0, r1
    ];
    assert_eq!(
        flags_after(&[1, 0x100], lsl),
        "C",
        "a shift by 256 is one by zero"
    );
    assert_eq!(flags_after(&[1, 32], lsl), "ZC");
    assert_eq!(flags_after(&[1, 33], lsl), "Z");
    let [value] = result(
        &[0x8000_0000, 200],
        &[
            0x4108, // asrs r0, r1
        ],
    );
    assert_eq!(value, 0xffff_ffff);
    let [value] = result(
        &[0x0000_00f1, 36],
        &[
            0x41c8, // rors r0, r1
        ],
    );
    assert_eq!(value, 0x1000_000f);
}

#[test]
fn second_operands_are_shifted_before_they_are_used() {
    let program = &[
        0xeb03, 0x00c4, // add.w r0, r3, r4, lsl #3
        0xebc3, 0x0154, // rsb r1, r3, r4, lsr #1
        0xea63, 0x72e4, // orn r2, r3, r4, asr #31
    ];
    assert_eq!(
        result(&[0, 0, 0, 100, 7], program),
        [156, 3u32.wrapping_sub(100), 0xffff_ffff]
    );
}

#[test]
fn mvn_and_rsb_negate() {
    let program = &[
        0x43d0, // mvns r0, r2
        0x4251, // rsbs r1, r2, #0
    ];
    assert_eq!(result(&[0, 0, 5], program), [!5, 5u32.wrapping_neg()]);
}

#[test]
fn products_of_64_bits_split_into_low_and_high() {
    let unsigned = &[
        0xfba2, 0x0103, // umull r0, r1, r2, r3
    ];
    assert_eq!(
        result(&[0, 0, 0xffff_ffff, 0xffff_ffff], unsigned),
        [1, 0xffff_fffe]
    );
    let signed = &[
        0xfb82, 0x0103, // smull r0, r1, r2, r3
    ];
    assert_eq!(
        result(&[0, 0, 0xffff_ffff, 5], signed),
        [0xffff_fffb, 0xffff_ffff]
    );
    let accumulated = &[
        0xfbe2, 0x0103, // umlal r0, r1, r2, r3
    ];
    assert_eq!(result(&[0xffff_ffff, 1, 2, 3], accumulated), [5, 2]);
    let twice = &[
        0xfbe2, 0x0163, // umaal r0, r1, r2, r3
    ];
    let all_ones = 0xffff_ffff;
    assert_eq!(result(&[all_ones; 4], twice), [all_ones, all_ones]);
}

#[test]
fn multiply_and_subtract_takes_the_product_off_the_accumulator() {
    let program = &[
        0xfb02, 0x4003, // mla r0, r2, r3, r4
        0xfb02, 0x4113, // mls r1, r2, r3, r4
    ];
    assert_eq!(result(&[0, 0, 6, 7, 100], program), [142, 58]);
}

#[test]
fn divisions_truncate_and_by_zero_give_zero() {
    let sdiv = &[
        0xfb90, 0xf0f1, // sdiv r0, r0, r1
    ];
    assert_eq!(
        result(&[7u32.wrapping_neg(), 2], sdiv),
        [3u32.wrapping_neg()]
    );
    assert_eq!(result(&[0x8000_0000, 0xffff_ffff], sdiv), [0x8000_0000]);
    assert_eq!(result(&[7, 0], sdiv), [0]);
    assert_eq!(
        result(
            &[0xffff_ffff, 16],
            &[
                0xfbb0, 0xf0f1, // udiv r0, r0, r1
            ]
        ),
        [0x0fff_ffff]
    );
}

#[test]
fn a_division_takes_two_to_twelve_cycles() {
    let udiv = &[
        0xfbb0, 0xf0f1, // udiv r0, r0, r1
    ];
    assert_eq!(Bench::with(&[1, 2], udiv).run(), 2);
    assert_eq!(Bench::with(&[u32::MAX, 1], udiv).run(), 12);
}

#[test]
fn bit_fields_are_cut_out_sign_extended_inserted_and_cleared() {
    let program = &[
        0xf3c4, 0x1007, // ubfx r0, r4, #4, #8
        0xf344, 0x2107, // sbfx r1, r4, #8, #8
        0xf364, 0x721f, // bfi r2, r4, #28, #4
        0xf36f, 0x030f, // bfc r3, #0, #16
    ];
    let registers = [0, 0, 0x0123_4567, 0xffff_ffff, 0x0000_8f21];
    let expected = [0xf2, 0xffff_ff8f, 0x1123_4567, 0xffff_0000];
    assert_eq!(result(&registers, program), expected);
    let whole = &[
        0xf3c2, 0x001f, // ubfx r0, r2, #0, #32
        0xf342, 0x71c0, // sbfx r1, r2, #31, #1
    ];
    assert_eq!(
        result(&[0, 0, 0x8000_0001], whole),
        [0x8000_0001, 0xffff_ffff]
    );
}

#[test]
fn extensions_rotate_first_and_add() {
    let program = &[
        0xfa5f, 0xf094, // uxtb.w r0, r4, ror #8
        0xb221, // sxth r1, r4
        0xfa45, 0xf2a4, // sxtab r2, r5, r4, ror #16
        0xfa15, 0xf384, // uxtah r3, r5, r4
    ];
    let registers = [0, 0, 0, 0, 0x1280_ff00, 1000];
    let expected = [0xff, 0xffff_ff00, 1000 - 128, 1000 + 0xff00];
    assert_eq!(result(&registers, program), expected);
}

#[test]
fn bits_and_bytes_are_counted_and_reversed() {
    let program = &[
        0xfab5, 0xf085, // clz r0, r5
        0xfa95, 0xf1a5, // rbit r1, r5
        0xba2a, // rev r2, r5
        0xba6b, // rev16 r3, r5
        0xbaec, // revsh r4, r5
    ];
    let registers = [0, 0, 0, 0, 0, 0x1232_ef80];
    let expected = [3, 0x01f7_4c48, 0x80ef_3212, 0x3212_80ef, 0xffff_80ef];
    assert_eq!(result(&registers, program), expected);
}

#[test]
fn the_program_counter_reads_as_the_instruction_plus_four() {
    let program = &[
        0x4678, // mov r0, pc
        0x4479, // add r1, pc
        0xf2af, 0x0208, // adr.w r2, #-8
    ];
    let expected = [CODE + 4, CODE + 6, (CODE + 8) - 8];
    assert_eq!(result(&[0, 0], program), expected);
}
