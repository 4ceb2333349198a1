//! The FPU.

use super::*;

/// The result of a program of one instruction on S0 (also the result), S1 and S2.
fn operation(d: f32, n: f32, m: f32, program: &[u16]) -> f32 {
    let bits = [d, n, m].map(f32::to_bits);
    let mut whole: Vec<u16> = Vec::from(&[
        0xee00, 0x0a10, // vmov s0, r0
        0xee00, 0x1a90, // vmov s1, r1
        0xee01, 0x2a10, // vmov s2, r2
    ]);
    whole.extend(program);
    let mut bench = Bench::with(&bits, &whole);
    bench.run();
    bench.s(0)
}

#[test]
fn arithmetic_is_that_of_ieee_754() {
    assert_eq!(
        operation(
            0.0,
            1.5,
            2.25,
            &[
                0xee30, 0x0a81, // vadd.f32 s0, s1, s2
            ]
        ),
        3.75
    );
    assert_eq!(
        operation(
            0.0,
            1.5,
            2.25,
            &[
                0xee30, 0x0ac1, // vsub.f32 s0, s1, s2
            ]
        ),
        -0.75
    );
    assert_eq!(
        operation(
            0.0,
            1.5,
            2.0,
            &[
                0xee20, 0x0a81, // vmul.f32 s0, s1, s2
            ]
        ),
        3.0
    );
    assert_eq!(
        operation(
            0.0,
            1.5,
            2.0,
            &[
                0xee20, 0x0ac1, // vnmul.f32 s0, s1, s2
            ]
        ),
        -3.0
    );
    assert_eq!(
        operation(
            0.0,
            1.0,
            3.0,
            &[
                0xee80, 0x0a81, // vdiv.f32 s0, s1, s2
            ]
        ),
        1.0 / 3.0
    );
    assert_eq!(
        operation(
            0.0,
            0.0,
            2.0,
            &[
                0xeeb1, 0x0ac1, // vsqrt.f32 s0, s2
            ]
        ),
        2f32.sqrt()
    );
    assert_eq!(
        operation(
            0.0,
            0.0,
            -2.0,
            &[
                0xeeb0, 0x0ac1, // vabs.f32 s0, s2
            ]
        ),
        2.0
    );
    assert_eq!(
        operation(
            0.0,
            0.0,
            2.0,
            &[
                0xeeb1, 0x0a41, // vneg.f32 s0, s2
            ]
        ),
        -2.0
    );
    assert_eq!(
        operation(
            0.0,
            0.0,
            0.0,
            &[
                0xeebd, 0x0a0c, // vmov.f32 s0, #-0.4375
            ]
        ),
        -0.4375
    );
}

#[test]
fn multiply_and_add_comes_with_all_signs() {
    let (d, n, m) = (10.0, 2.0, 3.0);
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee00, 0x0a81, // vmla.f32 s0, s1, s2
            ]
        ),
        16.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee00, 0x0ac1, // vmls.f32 s0, s1, s2
            ]
        ),
        4.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee10, 0x0ac1, // vnmla.f32 s0, s1, s2
            ]
        ),
        -16.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee10, 0x0a81, // vnmls.f32 s0, s1, s2
            ]
        ),
        -4.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xeea0, 0x0a81, // vfma.f32 s0, s1, s2
            ]
        ),
        16.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xeea0, 0x0ac1, // vfms.f32 s0, s1, s2
            ]
        ),
        4.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee90, 0x0ac1, // vfnma.f32 s0, s1, s2
            ]
        ),
        -16.0
    );
    assert_eq!(
        operation(
            d,
            n,
            m,
            &[
                0xee90, 0x0a81, // vfnms.f32 s0, s1, s2
            ]
        ),
        -4.0
    );
}

#[test]
fn only_the_fused_multiply_add_keeps_the_whole_product() {
    // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24, minus 1 + 2^-11.
    let factor = 1.0 + 2f32.powi(-12);
    let minus = -(1.0 + 2f32.powi(-11));
    assert_eq!(
        operation(
            minus,
            factor,
            factor,
            &[
                0xee00, 0x0a81, // vmla.f32 s0, s1, s2
            ]
        ),
        0.0
    );
    assert_eq!(
        operation(
            minus,
            factor,
            factor,
            &[
                0xeea0, 0x0a81, // vfma.f32 s0, s1, s2
            ]
        ),
        2f32.powi(-24)
    );
}

#[test]
fn comparisons_reach_the_flags_by_way_of_the_status_register() {
    let program = &[
        0xee00, 0x1a90, // vmov s1, r1
        0xee01, 0x2a10, // vmov s2, r2
        0xeef4, 0x0a41, // vcmp.f32 s1, s2
        0xeef1, 0xfa10, // vmrs APSR_nzcv, fpscr
    ];
    let flags = |a: f32, b: f32| flags_after(&[0, a.to_bits(), b.to_bits()], program);
    assert_eq!(flags(1.0, 2.0), "N");
    assert_eq!(flags(2.0, 2.0), "ZC");
    assert_eq!(flags(3.0, 2.0), "C");
    assert_eq!(flags(f32::NAN, 2.0), "CV");
    assert_eq!(flags(0.0, -0.0), "ZC");
    let zero = &[
        0xee00, 0x1a90, // vmov s1, r1
        0xeef5, 0x0a40, // vcmp.f32 s1, #0
        0xeef1, 0xfa10, // vmrs APSR_nzcv, fpscr
    ];
    assert_eq!(flags_after(&[0, (-1f32).to_bits()], zero), "N");
}

#[test]
fn conversions_to_integers_truncate_and_saturate() {
    let program = &[
        0xee00, 0x0a10, // vmov s0, r0
        0xeefd, 0x0ac0, // vcvt.s32.f32 s1, s0
        0xeebc, 0x1ac0, // vcvt.u32.f32 s2, s0
        0xee10, 0x1a90, // vmov r1, s1
        0xee11, 0x2a10, // vmov r2, s2
    ];
    let convert = |x: f32| {
        let [_, signed, unsigned] = result(&[x.to_bits()], program);
        (signed as i32, unsigned)
    };
    assert_eq!(convert(2.9), (2, 2));
    assert_eq!(convert(-2.9), (-2, 0));
    assert_eq!(convert(3e9), (i32::MAX, 3_000_000_000));
    assert_eq!(convert(1e10), (i32::MAX, u32::MAX));
    assert_eq!(convert(f32::NAN), (0, 0));
}

#[test]
fn conversions_by_the_rounding_mode_go_to_the_nearest_even() {
    let program = &[
        0xee00, 0x0a10, // vmov s0, r0
        0xeefd, 0x0a40, // vcvtr.s32.f32 s1, s0
        0xee10, 0x1a90, // vmov r1, s1
    ];
    let convert = |x: f32| result::<2>(&[x.to_bits()], program)[1] as i32;
    assert_eq!(
        [convert(0.5), convert(1.5), convert(-2.5), convert(2.7)],
        [0, 2, -2, 3]
    );
}

#[test]
fn conversions_from_integers_round_to_nearest() {
    let program = &[
        0xee00, 0x0a10, // vmov s0, r0
        0xeef8, 0x0ac0, // vcvt.f32.s32 s1, s0
        0xeeb8, 0x1a40, // vcvt.f32.u32 s2, s0
    ];
    let mut bench = Bench::with(&[0xffff_ffff], program);
    bench.run();
    assert_eq!((bench.s(1), bench.s(2)), (-1.0, 4_294_967_296.0));
}

#[test]
fn fixed_point_and_half_precision_convert_in_place() {
    let program = &[
        0xee00, 0x0a10, // vmov s0, r0
        0xeeba, 0x0acc, // vcvt.f32.s32 s0, s0, #8
        0xee00, 0x1a90, // vmov s1, r1
        0xeeff, 0x0a46, // vcvt.u16.f32 s1, s1, #4
        0xeeb2, 0x1a61, // vcvtb.f32.f16 s2, s3
        0xeef3, 0x1ac0, // vcvtt.f16.f32 s3, s0
    ];
    let mut bench = Bench::with(&[(-640i32) as u32, 2.5f32.to_bits()], program);
    bench.run();
    assert_eq!(bench.s(0), -2.5);
    assert_eq!(bench.core.float_register(1), 40);
    assert_eq!(
        bench.core.float_register(3),
        0xc100_0000,
        "-2.5 in the top half"
    );
}

#[test]
fn floats_load_and_store_in_ones_pairs_and_lists() {
    let program = &[
        0xed90, 0x0a00, // vldr s0, [r0]
        0xed90, 0x1b01, // vldr d1, [r0, #4]
        0xeca1, 0x0a04, // vstmia r1!, {s0-s3}
        0xed2d, 0x0b04, // vpush {d0, d1}
        0xecbd, 0x4a04, // vpop {s8-s11}
        0xec53, 0x2a14, // vmov r2, r3, s8, s9
        0xec43, 0x2b18, // vmov d8, r2, r3
    ];
    let mut bench = Bench::with(&[DATA, DATA + 0x40], program);
    for (at, value) in [(0, 1.0f32), (4, 2.0), (8, 3.0)] {
        bench.memory.write32(DATA + at, value.to_bits()).unwrap();
    }
    bench.run();
    assert_eq!([bench.s(0), bench.s(2), bench.s(3)], [1.0, 2.0, 3.0]);
    assert_eq!([bench.s(8), bench.s(10), bench.s(11)], [1.0, 2.0, 3.0]);
    assert_eq!(bench.s(16), 1.0);
    assert_eq!(bench.r(1), DATA + 0x50);
    assert_eq!(bench.memory.read32(DATA + 0x48), Some(2f32.to_bits()));
    assert_eq!(bench.r(13), STACK);
}

#[test]
fn floating_point_costs_what_the_manual_says() {
    let cost = |program| Bench::with(&[DATA], program).run();
    assert_eq!(
        cost(&[
            0xee30, 0x0a81, // vadd.f32 s0, s1, s2
        ]),
        1
    );
    assert_eq!(
        cost(&[
            0xee00, 0x0a81, // vmla.f32 s0, s1, s2
        ]),
        3
    );
    assert_eq!(
        cost(&[
            0xee80, 0x0a81, // vdiv.f32 s0, s1, s2
        ]),
        14
    );
    assert_eq!(
        cost(&[
            0xed90, 0x0a00, // vldr s0, [r0]
        ]),
        2
    );
    assert_eq!(
        cost(&[
            0xec90, 0x0a08, // vldmia r0, {s0-s7}
        ]),
        9
    );
}

#[test]
fn the_fpu_has_to_be_switched_on_and_other_modes_are_refused() {
    let mut bench = Bench::new(&[
        0xee30, 0x0a81, // vadd.f32 s0, s1, s2
    ]);
    bench.core.write_cpacr(0);
    assert_eq!(bench.stop().cause, Cause::FpuOff);
    let round_to_zero = 3 << 22;
    let mut bench = Bench::with(
        &[round_to_zero],
        &[
            0xeee1, 0x0a10, // vmsr fpscr, r0
        ],
    );
    assert_eq!(bench.stop().cause, Cause::FpuMode(round_to_zero));
}

#[test]
fn a_result_that_the_next_instruction_needs_costs_a_cycle_but_an_addend_does_not() {
    const ADD: [u16; 2] = [0xee30, 0x0a81]; // vadd.f32 s0, s1, s2
    let cases: [(&str, &[u16], Cycle); 8] = [
        ("vadd.f32 s3, s0, s0", &[0xee70, 0x1a00], 1 + 1),
        ("vadd.f32 s3, s1, s2", &[0xee70, 0x1a81], 1),
        ("nop; vadd.f32 s3, s0, s0", &[0xbf00, 0xee70, 0x1a00], 2),
        ("vmla.f32 s3, s0, s1", &[0xee40, 0x1a20], 3 + 1),
        ("vmla.f32 s0, s1, s2", &[0xee00, 0x0a81], 3),
        ("vmov r1, s0", &[0xee10, 0x1a10], 1 + 1),
        ("vcmp.f32 s0, s1", &[0xeeb4, 0x0a60], 1 + 1),
        (
            "vmov.f32 s0, s1; vadd.f32 s3, s0, s0",
            &[0xeeb0, 0x0a60, 0xee70, 0x1a00],
            2,
        ),
    ];
    for (name, next, cycles) in cases {
        let program = [&ADD[..], next].concat();
        assert_eq!(Bench::new(&program).run(), 1 + cycles, "{name}");
    }
}
