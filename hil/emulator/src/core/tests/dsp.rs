//! The DSP extension.

use super::*;

/// The result and the flags of a program of one instruction on R1, R2 and R3.
fn operation(n: u32, m: u32, a: u32, program: &[u16]) -> (u32, String) {
    let mut bench = Bench::with(&[0, n, m, a], program);
    bench.run();
    (bench.r(0), bench.flags())
}

#[test]
fn saturation_clamps_and_remembers_it_in_q() {
    let ssat = &[
        0xf301, 0x0007, // ssat r0, #8, r1
    ];
    assert_eq!(operation(200, 0, 0, ssat), (127, "Q".into()));
    assert_eq!(
        operation(-200i32 as u32, 0, 0, ssat),
        (-128i32 as u32, "Q".into())
    );
    assert_eq!(operation(100, 0, 0, ssat), (100, String::new()));
    let usat = &[
        0xf3a1, 0x1008, // usat r0, #8, r1, asr #4
    ];
    assert_eq!(operation(0x0ff0, 0, 0, usat), (255, String::new()));
    assert_eq!(operation(-16i32 as u32, 0, 0, usat), (0, "Q".into()));
    let halves = &[
        0xf3a1, 0x0004, // usat16 r0, #4, r1
    ];
    assert_eq!(
        operation(0xffff_0010, 0, 0, halves),
        (0x0000_000f, "Q".into())
    );
}

#[test]
fn saturating_additions_stop_at_the_ends_of_the_range() {
    let (max, min) = (0x7fff_ffff, 0x8000_0000);
    assert_eq!(
        operation(
            max,
            1,
            0,
            &[
                0xfa82, 0xf081, // qadd r0, r1, r2
            ]
        ),
        (max, "Q".into())
    );
    assert_eq!(
        operation(
            min,
            1,
            0,
            &[
                0xfa82, 0xf0a1, // qsub r0, r1, r2
            ]
        ),
        (min, "Q".into())
    );
    // QDADD Rd, Rm, Rn: the second operand is doubled, and that may saturate too.
    assert_eq!(
        operation(
            5,
            0x4000_0000,
            0,
            &[
                0xfa82, 0xf091, // qdadd r0, r1, r2
            ]
        ),
        (max, "Q".into())
    );
    assert_eq!(
        operation(
            5,
            10,
            0,
            &[
                0xfa82, 0xf0b1, // qdsub r0, r1, r2
            ]
        ),
        (-15i32 as u32, String::new())
    );
}

#[test]
fn lanes_add_on_their_own() {
    assert_eq!(
        operation(
            0xff01_7f80,
            0x0102_0180,
            0,
            &[
                0xfa81, 0xf042, // uadd8 r0, r1, r2
            ]
        )
        .0,
        0x0003_8000
    );
    assert_eq!(
        operation(
            0x7fff_8000,
            0x0001_ffff,
            0,
            &[
                0xfa91, 0xf012, // qadd16 r0, r1, r2
            ]
        )
        .0,
        0x7fff_8000
    );
    assert_eq!(
        operation(
            0x0003_0005,
            0x0001_0001,
            0,
            &[
                0xfa91, 0xf022, // shadd16 r0, r1, r2
            ]
        )
        .0,
        0x0002_0003
    );
    assert_eq!(
        operation(
            0x10ff_0000,
            0x0101_0000,
            0,
            &[
                0xfa81, 0xf052, // uqadd8 r0, r1, r2
            ]
        )
        .0,
        0x11ff_0000
    );
    assert_eq!(
        operation(
            0x0005_0003,
            0x0007_0001,
            0,
            &[
                0xfad1, 0xf062, // uhsub16 r0, r1, r2
            ]
        )
        .0,
        0xffff_0001
    );
    // SASX: top + bottom, bottom - top. SSAX: the reverse.
    assert_eq!(
        operation(
            0x0010_0020,
            0x0001_0002,
            0,
            &[
                0xfaa1, 0xf002, // sasx r0, r1, r2
            ]
        )
        .0,
        0x0012_001f
    );
    assert_eq!(
        operation(
            0x0010_0020,
            0x0001_0002,
            0,
            &[
                0xfae1, 0xf002, // ssax r0, r1, r2
            ]
        )
        .0,
        0x000e_0021
    );
}

#[test]
fn select_picks_the_bytes_whose_lanes_did_not_go_below() {
    // The greater of each byte: compare with USUB8, select with SEL.
    let maximum = &[
        0xfac1, 0xf042, // usub8 r0, r1, r2
        0xfaa1, 0xf082, // sel r0, r1, r2
    ];
    assert_eq!(
        operation(0x10ff_0320, 0x2001_0321, 0, maximum).0,
        0x20ff_0321
    );
    // A signed halfword addition that is not negative sets both bits of its half.
    let positive = &[
        0xfa91, 0xf002, // sadd16 r0, r1, r2
        0xfaa1, 0xf082, // sel r0, r1, r2
    ];
    assert_eq!(
        operation(0x0001_ffff, 0x0001_0000, 0, positive).0,
        0x0001_0000
    );
}

#[test]
fn halves_multiply_and_accumulate() {
    let (n, m, a) = (0xffff_0003, 0x0005_fffe, 100);
    let wrap = |value: i32| value as u32;
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb11, 0x3002, // smlabb r0, r1, r2, r3
            ]
        )
        .0,
        wrap(100 - 6)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb11, 0x3012, // smlabt r0, r1, r2, r3
            ]
        )
        .0,
        wrap(100 + 15)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb11, 0xf022, // smultb r0, r1, r2
            ]
        )
        .0,
        wrap(2)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb21, 0x3002, // smlad r0, r1, r2, r3
            ]
        )
        .0,
        wrap(100 - 6 - 5)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb21, 0x3012, // smladx r0, r1, r2, r3
            ]
        )
        .0,
        wrap(100 + 15 + 2)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb41, 0x3002, // smlsd r0, r1, r2, r3
            ]
        )
        .0,
        wrap(100 - 6 + 5)
    );
    assert_eq!(
        operation(
            n,
            m,
            a,
            &[
                0xfb41, 0xf012, // smusdx r0, r1, r2
            ]
        )
        .0,
        wrap(15 - 2)
    );
}

#[test]
fn an_accumulation_that_overflows_wraps_and_sets_q() {
    let smlabb = &[
        0xfb11, 0x3002, // smlabb r0, r1, r2, r3
    ];
    assert_eq!(
        operation(2, 3, 0x7fff_ffff, smlabb),
        (0x8000_0005, "Q".into())
    );
    let smuad = &[
        0xfb21, 0xf002, // smuad r0, r1, r2
    ];
    let minimum = 0x8000_8000;
    assert_eq!(
        operation(minimum, minimum, 0, smuad),
        (0x8000_0000, "Q".into())
    );
}

#[test]
fn wide_products_keep_their_top_half() {
    assert_eq!(
        operation(
            0x0001_0000,
            0x0000_0008,
            1,
            &[
                0xfb31, 0x3002, // smlawb r0, r1, r2, r3
            ]
        )
        .0,
        9
    );
    assert_eq!(
        operation(
            0x4000_0000,
            0x0000_0006,
            0,
            &[
                0xfb51, 0xf002, // smmul r0, r1, r2
            ]
        )
        .0,
        1
    );
    assert_eq!(
        operation(
            0x4000_0000,
            0x0000_0006,
            0,
            &[
                0xfb51, 0xf012, // smmulr r0, r1, r2
            ]
        )
        .0,
        2
    );
    assert_eq!(
        operation(
            0x4000_0000,
            0x0000_0006,
            10,
            &[
                0xfb51, 0x3002, // smmla r0, r1, r2, r3
            ]
        )
        .0,
        11
    );
    assert_eq!(
        operation(
            0x4000_0000,
            0x0000_0006,
            10,
            &[
                0xfb61, 0x3002, // smmls r0, r1, r2, r3
            ]
        )
        .0,
        8
    );
}

#[test]
fn long_accumulations_take_both_registers() {
    let program = &[
        0xfbc2, 0x0183, // smlalbb r0, r1, r2, r3
    ];
    assert_eq!(
        result(&[0, 0, 0xffff, 2], program),
        [-2i32 as u32, 0xffff_ffff]
    );
    let dual = &[
        0xfbc2, 0x01c3, // smlald r0, r1, r2, r3
    ];
    assert_eq!(
        result(&[0xffff_ffff, 0, 0x0002_0003, 0x0004_0005], dual),
        [22, 1]
    );
    let subtracted = &[
        0xfbd2, 0x01d3, // smlsldx r0, r1, r2, r3
    ];
    // 3 * 4 - 2 * 5
    assert_eq!(
        result(&[0, 0, 0x0002_0003, 0x0004_0005], subtracted),
        [2, 0]
    );
}

#[test]
fn differences_of_bytes_add_up() {
    let usada8 = &[
        0xfb71, 0x3002, // usada8 r0, r1, r2, r3
    ];
    assert_eq!(
        operation(0x0a14_1e28, 0x0b12_2128, 100, usada8).0,
        100 + 1 + 2 + 3
    );
    assert_eq!(
        operation(
            0xff00_0000,
            0x00ff_0000,
            0,
            &[
                0xfb71, 0xf002, // usad8 r0, r1, r2
            ]
        )
        .0,
        510
    );
}

#[test]
fn halves_are_packed_and_extended() {
    let (n, m) = (0x1111_2222, 0x3333_4444);
    assert_eq!(
        operation(
            n,
            m,
            0,
            &[
                0xeac1, 0x4002, // pkhbt r0, r1, r2, lsl #16
            ]
        )
        .0,
        0x4444_2222
    );
    assert_eq!(
        operation(
            n,
            m,
            0,
            &[
                0xeac1, 0x4022, // pkhtb r0, r1, r2, asr #16
            ]
        )
        .0,
        0x1111_3333
    );
    assert_eq!(
        operation(
            n,
            0x0080_00ff,
            0,
            &[
                0xfa2f, 0xf082, // sxtb16 r0, r2
            ]
        )
        .0,
        0xff80_ffff
    );
    assert_eq!(
        operation(
            n,
            0x0080_00ff,
            0,
            &[
                0xfa31, 0xf082, // uxtab16 r0, r1, r2
            ]
        )
        .0,
        0x1191_2321
    );
}
