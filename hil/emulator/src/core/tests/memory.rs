//! Loads and stores.

use super::*;

#[test]
fn loads_extend_and_stores_truncate() {
    let program = &[
        0x6030, // str r0, [r6]
        0x7871, // ldrb r1, [r6, #1]
        0xf996, 0x2001, // ldrsb.w r2, [r6, #1]
        0x8873, // ldrh r3, [r6, #2]
        0xf9b6, 0x4002, // ldrsh.w r4, [r6, #2]
        0x70f0, // strb r0, [r6, #3]
        0x6835, // ldr r5, [r6]
    ];
    let registers = [0x8765_f321, 0, 0, 0, 0, 0, DATA];
    let expected = [
        0x8765_f321,
        0xf3,
        0xffff_fff3,
        0x8765,
        0xffff_8765,
        0x2165_f321,
    ];
    assert_eq!(result(&registers, program), expected);
}

#[test]
fn words_and_halves_may_lie_anywhere_in_ram() {
    let program = &[
        0xf8c2, 0x0001, // str.w r0, [r2, #1]
        0xf8b2, 0x1003, // ldrh.w r1, [r2, #3]
    ];
    assert_eq!(
        result(&[0x1234_5678, 0, DATA], program),
        [0x1234_5678, 0x1234]
    );
}

#[test]
fn pre_and_post_indexing_update_their_base() {
    let program = &[
        0xf842, 0x0b04, // str r0, [r2], #4
        0xf842, 0x1f04, // str r1, [r2, #4]!
        0xf852, 0x3d08, // ldr r3, [r2, #-8]!
    ];
    let [_, _, base, value] = result(&[11, 22, DATA], program);
    assert_eq!((base, value), (DATA, 11));
}

#[test]
fn a_scaled_index_is_shifted() {
    let program = &[
        0xf841, 0x0032, // str.w r0, [r1, r2, lsl #3]
        0x6a8b, // ldr r3, [r1, #40]
    ];
    let [.., value] = result::<4>(&[77, DATA, 5], program);
    assert_eq!(value, 77);
}

#[test]
fn literals_are_found_from_the_aligned_program_counter() {
    // ldr r0, [pc, #4] at an address that is 2 mod 4.
    let mut program: Vec<u16> = vec![0xbf00, 0x4801, BKPT, 0xbf00];
    program.extend([0x5678, 0x1234]);
    assert_eq!(result(&[], &program), [0x1234_5678]);
}

#[test]
fn a_push_and_a_pop_keep_registers_in_order_of_their_numbers() {
    let program = &[
        0xb503, // push {r0, r1, lr}
        0xbc1c, // pop {r2, r3, r4}
        0xb401, // push {r0}
        0x466d, // mov r5, sp
        0xbc40, // pop {r6}
    ];
    let mut bench = Bench::with(&[1, 2], program);
    bench.core.set_register(14, 0x55);
    bench.run();
    assert_eq!([bench.r(2), bench.r(3), bench.r(4)], [1, 2, 0x55]);
    assert_eq!((bench.r(5), bench.r(6)), (STACK - 4, 1));
    assert_eq!(bench.r(13), STACK);
}

#[test]
fn a_pop_to_the_program_counter_branches() {
    let program = &[
        0xf000, 0xf801, // bl 1f
        0xe002, // b 2f
        0xb510, // push {r4, lr}
        0x2004, // movs r0, #4
        0xbd10, // pop {r4, pc}
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program);
    // BL 3, PUSH 3, MOVS 1, POP 1 + 1 + 2, B 3, NOP 1
    assert_eq!(bench.run(), 3 + 3 + 1 + 4 + 3 + 1);
    assert_eq!(bench.r(0), 4);
}

#[test]
fn multiple_transfers_go_up_from_or_down_to_the_base() {
    let program = &[
        0xc00e, // stmia r0!, {r1, r2, r3}
        0xe910, 0x0030, // ldmdb.w r0, {r4, r5}
        0xe920, 0x000c, // stmdb.w r0!, {r2, r3}
        0x6806, // ldr r6, [r0]
    ];
    let mut bench = Bench::with(&[DATA, 1, 2, 3], program);
    bench.run();
    assert_eq!(bench.r(0), DATA + 4);
    assert_eq!([bench.r(4), bench.r(5), bench.r(6)], [2, 3, 2]);
}

#[test]
fn doubles_transfer_two_registers() {
    let program = &[
        0xe9e2, 0x0102, // strd r0, r1, [r2, #8]!
        0xe872, 0x3402, // ldrd r3, r4, [r2], #-8
        0xbf00, // nop
    ];
    let [_, _, base, first, second] = result(&[5, 6, DATA], program);
    assert_eq!((base, first, second), (DATA, 5, 6));
}

#[test]
fn an_exclusive_store_succeeds_once_after_an_exclusive_load() {
    let program = &[
        0xe850, 0x1f00, // ldrex r1, [r0]
        0xe840, 0x4200, // strex r2, r4, [r0]
        0xe840, 0x4300, // strex r3, r4, [r0]
        0x6801, // ldr r1, [r0]
    ];
    assert_eq!(result(&[DATA, 0, 9, 9, 42], program), [DATA, 42, 0, 1]);
    let cleared = &[
        0xe8d0, 0x1f4f, // ldrexb r1, [r0]
        0xf3bf, 0x8f2f, // clrex
        0xe8c0, 0x4f42, // strexb r2, r4, [r0]
    ];
    assert_eq!(result(&[DATA, 0, 9], cleared), [DATA, 0, 1]);
}

#[test]
fn consecutive_loads_overlap_and_stores_do_not_wait() {
    let loads = &[
        0x6801, // ldr r1, [r0]
        0x6802, // ldr r2, [r0]
        0x6803, // ldr r3, [r0]
    ];
    assert_eq!(Bench::with(&[DATA], loads).run(), 2 + 1 + 1);
    let apart = &[
        0x6801, // ldr r1, [r0]
        0xbf00, // nop
        0x6802, // ldr r2, [r0]
    ];
    assert_eq!(Bench::with(&[DATA], apart).run(), 2 + 1 + 2);
    let stores = &[
        0x6001, // str r1, [r0]
        0x6002, // str r2, [r0]
    ];
    assert_eq!(Bench::with(&[DATA], stores).run(), 2);
}

#[test]
fn constants_in_flash_wait_for_it_and_ram_does_not() {
    let program = &[
        0x6801, // ldr r1, [r0]
        0xbf00, // nop
        0x6801, // ldr r1, [r0]
        0xbf00, // nop
    ];
    let cost = |address, cached| {
        let mut bench = Bench::with(&[address], program);
        bench.core.set_flash_timing(5, true, true, cached);
        bench.run()
    };
    let in_ram = cost(DATA, true);
    assert_eq!(
        cost(FLASH, true),
        in_ram + 5,
        "the second read hits the data cache"
    );
    assert_eq!(cost(FLASH, false), in_ram + 10);
}

#[test]
fn a_peripheral_sees_the_width_the_value_and_the_cycle_of_an_access() {
    let program = &[
        0xbf00, // nop
        0x70c1, // strb r1, [r0, #3]
        0x8842, // ldrh r2, [r0, #2]
        0x6041, // str r1, [r0, #4]
    ];
    let mut bench = Bench::with(&[SPY, 0x1_2345], program);
    bench.run();
    assert_eq!(bench.r(2), SPY_VALUE & 0xffff);
    let accesses: Vec<_> = bench.bus.accesses.iter().map(|a| (a.1, a.2, a.3)).collect();
    assert_eq!(
        accesses,
        [
            (SPY + 3, Width::Byte, Some(0x45)),
            (SPY + 2, Width::Half, None),
            (SPY + 4, Width::Word, Some(0x1_2345)),
        ]
    );
    let cycles: Vec<_> = bench.bus.accesses.iter().map(|a| a.0).collect();
    assert_eq!(cycles, [2, 3, 4]);
}

#[test]
fn a_peripheral_access_ends_the_run() {
    let program = &[
        0x6001, // str r1, [r0]
        0xbf00, // nop
    ];
    let mut bench = Bench::with(&[SPY], program);
    let exit = bench.core.run(&mut bench.memory, &mut bench.bus, 1000);
    assert_eq!(exit, Exit::Synchronise);
    assert_eq!(bench.r(15), CODE + 2);
}

#[test]
fn a_bit_band_alias_is_one_bit_of_its_word() {
    let alias = 0x2200_0000 + (DATA - SRAM) * 32 + 9 * 4;
    let program = &[
        0x6001, // str r1, [r0]
        0x6802, // ldr r2, [r0]
        0x6823, // ldr r3, [r4]
    ];
    let [.., set, word] = result::<4>(&[alias, 1, 0, 0, DATA], program);
    assert_eq!((set, word), (1, 1 << 9));
    let peripheral = 0x4200_0000 + 4 * 32 + 5 * 4;
    let mut bench = Bench::with(
        &[peripheral, 0],
        &[
            0x6001, // str r1, [r0]
        ],
    );
    bench.run();
    let last = bench.bus.accesses.last().map(|a| (a.1, a.2, a.3));
    assert_eq!(
        last,
        Some((SPY + 4, Width::Word, Some(SPY_VALUE & !(1 << 5))))
    );
}

#[test]
fn accesses_that_nothing_answers_stop_the_run_with_their_address() {
    let mut bench = Bench::with(
        &[0x6000_0000],
        &[
            0xbf00, // nop
            0x6881, // ldr r1, [r0, #8]
        ],
    );
    let stop = bench.stop();
    let (address, write) = (0x6000_0008, false);
    assert_eq!(stop.cause, Cause::BusFault { address, write });
    assert_eq!(stop.pc, CODE + 2);
    let mut bench = Bench::with(
        &[FLASH],
        &[
            0x6001, // str r1, [r0]
        ],
    );
    let (address, write) = (FLASH, true);
    assert_eq!(bench.stop().cause, Cause::BusFault { address, write });
}

#[test]
fn what_must_be_aligned_and_is_not_stops_the_run() {
    let cause = |program| Bench::with(&[DATA + 2], program).stop().cause;
    let unaligned = Cause::Unaligned(DATA + 2);
    assert_eq!(
        cause(&[
            0xc806, // ldmia r0!, {r1, r2}
        ]),
        unaligned
    );
    assert_eq!(
        cause(&[
            0xe9c0, 0x1200, // strd r1, r2, [r0]
        ]),
        unaligned
    );
    assert_eq!(
        cause(&[
            0xed90, 0x0a00, // vldr s0, [r0]
        ]),
        unaligned
    );
    assert_eq!(
        cause(&[
            0xe850, 0x1f00, // ldrex r1, [r0]
        ]),
        unaligned
    );
    let at_peripheral = Bench::with(
        &[SPY + 1],
        &[
            0x6801, // ldr r1, [r0]
        ],
    )
    .stop();
    assert_eq!(at_peripheral.cause, Cause::Unaligned(SPY + 1));
}

#[test]
fn a_slow_bus_keeps_the_core_waiting() {
    let program = &[
        0x6801, // ldr r1, [r0]
        0x6001, // str r1, [r0]
    ];
    let quick = Bench::with(&[SPY], program).run();
    let mut bench = Bench::with(&[SPY], program);
    bench.bus.delay = 9;
    assert_eq!(bench.run(), quick + 2 * 9);
}
