//! Sleep, timers and the registers of the core.

use super::*;

const SYST_CSR: u32 = 0xe000_e010;
const DWT_CTRL: u32 = 0xe000_1000;
const DEMCR: u32 = 0xe000_edfc;

#[test]
fn wfe_sleeps_unless_an_event_came_first() {
    let program = &[
        0xbf40, // sev
        0xbf20, // wfe
        0x2001, // movs r0, #1
        0xbf20, // wfe
        0x2002, // movs r0, #2
    ];
    let mut bench = Bench::new(program);
    let exit = bench.core.run(&mut bench.memory, &mut bench.bus, 1000);
    assert_eq!((exit, bench.r(0)), (Exit::Asleep, 1));
    assert!(!bench.core.try_wake());
    assert!(bench.core.is_sleeping());
}

#[test]
fn an_interrupt_wakes_wfe_and_leaves_an_event_behind() {
    let program = &[
        0xbf20, // wfe
        0x2001, // movs r0, #1
        0xbf20, // wfe
        0x2002, // movs r0, #2
        0xbf20, // wfe
    ];
    let mut bench = Bench::new(program).handler(
        16,
        &[
            0x2505, // movs r5, #5
            0x4770, // bx lr
        ],
    );
    bench.core.nvic.enable(0, 1);
    assert_eq!(
        bench.core.run(&mut bench.memory, &mut bench.bus, 1000),
        Exit::Asleep
    );
    bench.core.advance_to(500);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    assert!(!bench.core.is_sleeping());
    assert_eq!(bench.core.cycles(), 512);
    assert_eq!(
        bench.core.run(&mut bench.memory, &mut bench.bus, 1000),
        Exit::Asleep
    );
    assert_eq!(
        (bench.r(5), bench.r(0)),
        (5, 2),
        "the event let the second WFE pass"
    );
}

#[test]
fn wfi_wakes_for_an_interrupt_that_primask_holds_back() {
    let program = &[
        0xb672, // cpsid i
        0xbf30, // wfi
        0x2001, // movs r0, #1
        0xb662, // cpsie i
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program).handler(
        16,
        &[
            0x4605, // mov r5, r0
            0x4770, // bx lr
        ],
    );
    bench.core.nvic.enable(0, 1);
    assert_eq!(
        bench.core.run(&mut bench.memory, &mut bench.bus, 1000),
        Exit::Asleep
    );
    assert!(!bench.core.try_wake());
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    assert!(bench.core.is_sleeping(), "it is not taken");
    assert!(bench.core.try_wake());
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!(bench.r(5), 1);
}

#[test]
fn sleep_on_exit_goes_back_to_sleep_behind_the_handler() {
    let program = &[
        0x6001, // str r1, [r0]
        0xbf30, // wfi
        0x2202, // movs r2, #2
    ];
    let scr = 0xe000_ed10;
    let mut bench = Bench::with(&[scr, 2], program).handler(
        16,
        &[
            0x3601, // adds r6, #1
            0x4770, // bx lr
        ],
    );
    bench.core.nvic.enable(0, 1);
    while bench.core.run(&mut bench.memory, &mut bench.bus, 1000) != Exit::Asleep {}
    for _ in 0..2 {
        bench.core.set_interrupt_line(0, true);
        bench.core.take_pending_exceptions(&mut bench.memory);
        bench.core.set_interrupt_line(0, false);
        assert_eq!(
            bench.core.run(&mut bench.memory, &mut bench.bus, 1000),
            Exit::Asleep
        );
    }
    assert_eq!((bench.r(6), bench.r(2)), (2, 0));
}

#[test]
fn systick_wakes_the_core_at_its_cycle() {
    // RVR = 99, CSR = core clock, interrupt, enable.
    let program = &[
        0x6041, // str r1, [r0, #4]
        0x6082, // str r2, [r0, #8]
        0x6003, // str r3, [r0]
        0xbf30, // wfi
        0x2606, // movs r6, #6
    ];
    let mut bench = Bench::with(&[SYST_CSR, 99, 0, 7], program);
    bench = bench.handler(
        15,
        &[
            0x2505, // movs r5, #5
            0x4770, // bx lr
        ],
    );
    bench.run();
    assert_eq!((bench.r(5), bench.r(6)), (5, 6));
    // Enabled by the third store, at cycle 3; the first zero is 100 ticks later; 12 in, 4, 10 out, 1.
    assert_eq!(bench.core.cycles() - 1, 3 + 100 + 12 + 4 + 10 + 1);
}

#[test]
fn a_polled_systick_sets_its_count_flag_once_per_period() {
    let program = &[
        0x6041, // str r1, [r0, #4]
        0x6082, // str r2, [r0, #8]
        0x6003, // str r3, [r0]
        0x6804, // ldr r4, [r0]
        0x03e4, // lsls r4, r4, #15
        0xd5fc, // bpl 1b
        0x6805, // ldr r5, [r0]
    ];
    let mut bench = Bench::with(&[SYST_CSR, 49, 0, 5], program);
    let cycles = bench.run();
    assert!((53..65).contains(&cycles), "{cycles}");
    assert_eq!(bench.r(5), 5, "the flag is cleared by reading it");
}

#[test]
fn the_cycle_counter_measures_the_code_between_two_reads() {
    let program = &[
        0x6001, // str r1, [r0]
        0x6013, // str r3, [r2]
        0x6854, // ldr r4, [r2, #4]
        0xbf00, // nop
        0xbf00, // nop
        0xbf00, // nop
        0x6855, // ldr r5, [r2, #4]
        0x1b2d, // subs r5, r5, r4
    ];
    let mut bench = Bench::with(&[DEMCR, 1 << 24, DWT_CTRL, 1], program);
    bench.run();
    assert_eq!(bench.r(5), 3 + 2);
}

#[test]
fn the_cycle_counter_can_be_read_without_leaving_the_run() {
    let program = &[
        0x6841, // ldr r1, [r0, #4]
        0x2201, // movs r2, #1
    ];
    let mut bench = Bench::with(&[DWT_CTRL], program);
    let exit = bench.core.run(&mut bench.memory, &mut bench.bus, 3);
    assert_eq!((exit, bench.r(2)), (Exit::Reached, 1));
}

#[test]
fn interrupts_are_enabled_pended_and_ranked_through_their_registers() {
    let iser1 = 0xe000_e104;
    let program = &[
        0x6001, // str r1, [r0]
        0x6802, // ldr r2, [r0]
        0xf884, 0x3000, // strb.w r3, [r4]
        0xf894, 0x5000, // ldrb.w r5, [r4]
        0x6031, // str r1, [r6]
        0xbf00, // nop
    ];
    let ipr_37 = 0xe000_e400 + 37;
    let ispr1 = 0xe000_e204;
    let registers = [iser1, 1 << 5, 0, 0x5f, ipr_37, 0, ispr1];
    let mut bench = Bench::with(&registers, program).handler(
        16 + 37,
        &[
            0x2707, // movs r7, #7
            0x4770, // bx lr
        ],
    );
    bench.run();
    assert_eq!(bench.r(2), 1 << 5);
    assert_eq!(bench.r(5), 0x50, "four bits of priority exist");
    assert_eq!(bench.r(7), 7);
}

#[test]
fn special_registers_read_back_what_was_written() {
    let program = &[
        0xf380, 0x8810, // msr primask, r0
        0xf3ef, 0x8110, // mrs r1, primask
        0xf382, 0x8811, // msr basepri, r2
        0xf3ef, 0x8311, // mrs r3, basepri
        0xf384, 0x8800, // msr APSR_nzcvq, r4
        0xf3ef, 0x8500, // mrs r5, apsr
        0xf3ef, 0x8614, // mrs r6, control
    ];
    let mut bench = Bench::with(&[1, 0, 0x7f, 0, 0xa800_0000], program);
    bench.run();
    assert_eq!([bench.r(1), bench.r(3), bench.r(5)], [1, 0x70, 0xa800_0000]);
    assert_eq!(bench.r(6), 0);
}

#[test]
fn core_registers_that_are_not_modelled_stop_the_run() {
    let cause = |address, program| Bench::with(&[address, 1], program).stop().cause;
    let mpu_rbar = 0xe000_ed9c;
    let (address, write) = (mpu_rbar, false);
    let expected = Cause::CoreRegister { address, write };
    assert_eq!(
        cause(
            mpu_rbar,
            &[
                0x6802, // ldr r2, [r0]
            ]
        ),
        expected
    );
    let mpu_ctrl = 0xe000_ed94;
    let (address, write) = (mpu_ctrl, true);
    let expected = Cause::CoreRegister { address, write };
    assert_eq!(
        cause(
            mpu_ctrl,
            &[
                0x6001, // str r1, [r0]
            ]
        ),
        expected
    );
}

#[test]
fn the_software_can_ask_for_a_reset() {
    let aircr = 0xe000_ed0c;
    let program = &[
        0x6001, // str r1, [r0]
    ];
    let mut bench = Bench::with(&[aircr, 0x05fa_0004], program);
    assert_eq!(bench.stop().cause, Cause::ResetRequested);
    let mut without_key = Bench::with(&[aircr, 0x0000_0004], program);
    without_key.run();
}

#[test]
fn a_reset_keeps_the_time_and_forgets_the_rest() {
    let mut bench = Bench::new(&[
        0x2001, // movs r0, #1
        0xbf00, // nop
        0xbf00, // nop
    ]);
    bench.run();
    let cycles = bench.core.cycles();
    bench.core.reset(&bench.memory);
    assert_eq!(bench.core.cycles(), cycles);
    assert_eq!((bench.r(0), bench.r(13), bench.r(15)), (0, STACK, CODE));
}

#[test]
fn an_event_on_pend_wakes_wfe_without_the_interrupt_being_taken() {
    let program = &[
        0xb672, // cpsid i
        0x6001, // str r1, [r0]
        0xbf20, // wfe
        0x2202, // movs r2, #2
    ];
    let scr = 0xe000_ed10;
    let mut bench = Bench::with(&[scr, 1 << 4], program);
    while bench.core.run(&mut bench.memory, &mut bench.bus, 1000) != Exit::Asleep {}
    bench.core.set_interrupt_line(9, true);
    assert!(bench.core.try_wake());
    bench.run();
    assert_eq!(bench.r(2), 2);
}
