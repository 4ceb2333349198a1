//! Exceptions: entry, return, nesting and frames.

use super::*;

/// Enables an interrupt at a priority, from outside the program.
fn enable(bench: &mut Bench, irq: u8, priority: u8) {
    bench
        .core
        .nvic
        .enable(usize::from(irq / 32), 1 << (irq % 32));
    bench
        .core
        .nvic
        .set_priority(16 + usize::from(irq), priority);
}

/// Executes exactly one instruction.
fn step(bench: &mut Bench) -> Exit {
    let until = bench.core.cycles() + 1;
    bench.core.run(&mut bench.memory, &mut bench.bus, until)
}

#[test]
fn an_interrupt_stacks_eight_words_and_returns_to_where_it_came_from() {
    let program = &[
        0xbf00, // nop
        0x4280, // cmp r0, r0
        0xbf00, // nop
        0x2707, // movs r7, #7
    ];
    let handler = &[
        0x2001, // movs r0, #1
        0x2102, // movs r1, #2
        0x2606, // movs r6, #6
        0x4770, // bx lr
    ];
    let mut bench = Bench::with(&[10, 11, 12, 13], program).handler(16 + 5, handler);
    enable(&mut bench, 5, 0x40);
    step(&mut bench);
    step(&mut bench);
    bench.core.set_register(12, 0x12);
    bench.core.set_register(14, 0xfff1);
    bench.core.set_interrupt_line(5, true);
    let before = bench.core.cycles();
    bench.core.take_pending_exceptions(&mut bench.memory);
    assert_eq!(bench.core.cycles() - before, 12);
    assert_eq!(bench.r(14), 0xffff_fff9);
    assert_eq!(bench.core.xpsr() & 0x1ff, 21);
    let frame: Vec<_> = (0..8)
        .map(|word| bench.memory.read32(STACK - 32 + 4 * word))
        .collect();
    let xpsr = 0x6100_0000; // Z, C and Thumb
    let expected = [10, 11, 12, 13, 0x12, 0xfff1, CODE + 4, xpsr].map(Some);
    assert_eq!(frame, expected);
    bench.core.set_interrupt_line(5, false);
    bench.run();
    assert_eq!(
        [bench.r(0), bench.r(1), bench.r(6), bench.r(7)],
        [10, 11, 6, 7]
    );
    assert_eq!((bench.r(13), bench.r(14)), (STACK, 0xfff1));
    assert_eq!(bench.core.xpsr() & 0x1ff, 0);
    // Two of the program, 12 in, 3 + 3 in the handler, 10 out, two more.
    assert_eq!(bench.core.cycles() - 1, 2 + 12 + 6 + 10 + 2);
}

#[test]
fn an_unaligned_stack_is_aligned_for_the_frame_and_restored() {
    let mut bench = Bench::new(&[
        0xbf00, // nop
        0xbf00, // nop
    ])
    .handler(
        16,
        &[
            0x466d, // mov r5, sp
            0x4770, // bx lr
        ],
    );
    enable(&mut bench, 0, 0);
    bench.core.set_register(13, STACK - 4);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!(bench.r(5), STACK - 40);
    assert_eq!(bench.r(13), STACK - 4);
}

#[test]
fn a_level_that_stays_high_runs_its_handler_again_tail_chained() {
    let handler = &[
        0x3601, // adds r6, #1
        0x6821, // ldr r1, [r4]
        0x2e03, // cmp r6, #3
        0xbf08, // it eq
        0x6029, // streq r1, [r5]
        0x4770, // bx lr
    ];
    let mut bench = Bench::new(&[
        0xbf00, // nop
        0xbf00, // nop
    ])
    .handler(16 + 3, handler);
    bench.core.set_register(4, DATA);
    bench.core.set_register(5, SPY);
    enable(&mut bench, 3, 0);
    bench.core.set_interrupt_line(3, true);
    // The handler touches the peripheral the third time: that is when the line falls.
    let mut fell_at = 0;
    loop {
        bench
            .core
            .set_interrupt_line(3, bench.bus.accesses.is_empty());
        if !bench.bus.accesses.is_empty() && fell_at == 0 {
            fell_at = bench.core.register(6);
        }
        bench.core.take_pending_exceptions(&mut bench.memory);
        let exit = bench
            .core
            .run(&mut bench.memory, &mut bench.bus, Cycle::MAX);
        if let Exit::Stopped(stop) = exit {
            assert_eq!(stop.cause, Cause::Breakpoint(0));
            break;
        }
    }
    assert_eq!((bench.r(6), fell_at), (3, 3));
    // In once (12), three handlers of 8 (ADDS, LDR 2, CMP, IT, STR or nothing, BX 3 = 9), two tail
    // chains (6), out once (10), two NOPs.
    assert_eq!(bench.core.cycles() - 1, 12 + 3 * 9 + 2 * 6 + 10 + 2);
}

#[test]
fn a_higher_priority_preempts_a_handler_and_an_equal_one_waits() {
    let outer = &[
        0x3601, // adds r6, #1
        0xbf00, // nop
        0xbf00, // nop
        0x4635, // mov r5, r6
        0x4770, // bx lr
    ];
    let inner = &[
        0x360a, // adds r6, #10
        0x4770, // bx lr
    ];
    let run = |inner_priority| {
        let program = &[
            0xbf00, // nop
            0xbf00, // nop
        ];
        let mut bench = Bench::new(program).handler(17, outer).handler(18, inner);
        enable(&mut bench, 1, 0x80);
        enable(&mut bench, 2, inner_priority);
        bench.core.set_interrupt_line(1, true);
        bench.core.take_pending_exceptions(&mut bench.memory);
        bench.core.set_interrupt_line(1, false);
        step(&mut bench);
        bench.core.set_interrupt_line(2, true);
        bench.core.take_pending_exceptions(&mut bench.memory);
        let nested = bench.r(14) == 0xffff_fff1;
        bench.core.set_interrupt_line(2, false);
        bench.run();
        (nested, bench.r(5), bench.r(6))
    };
    assert_eq!(run(0x40), (true, 11, 11));
    assert_eq!(run(0x80), (false, 1, 11));
}

#[test]
fn primask_holds_an_interrupt_back_until_it_is_cleared() {
    let program = &[
        0xb672, // cpsid i
        0x2001, // movs r0, #1
        0xb662, // cpsie i
        0x2101, // movs r1, #1
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program).handler(
        16,
        &[
            0x4605, // mov r5, r0
            0x460e, // mov r6, r1
            0x4770, // bx lr
        ],
    );
    enable(&mut bench, 0, 0);
    step(&mut bench);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!((bench.r(5), bench.r(6)), (1, 0), "taken right behind CPSIE");
}

#[test]
fn basepri_masks_priorities_from_its_own_down() {
    let program = &[
        0xf380, 0x8811, // msr basepri, r0
        0xbf00, // nop
        0x2101, // movs r1, #1
        0xf382, 0x8811, // msr basepri, r2
        0xbf00, // nop
    ];
    let mut bench = Bench::with(&[0x40], program).handler(
        16,
        &[
            0x460d, // mov r5, r1
            0x4770, // bx lr
        ],
    );
    bench.core.set_register(5, 99);
    enable(&mut bench, 0, 0x40);
    step(&mut bench);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!(bench.r(5), 1);
}

#[test]
fn a_supervisor_call_is_taken_before_the_next_instruction() {
    let program = &[
        0x2001, // movs r0, #1
        0xdf07, // svc #7
        0x2002, // movs r0, #2
    ];
    let mut bench = Bench::new(program).handler(
        11,
        &[
            0x4605, // mov r5, r0
            0x9c06, // ldr r4, [sp, #24]
            0x4770, // bx lr
        ],
    );
    bench.run();
    assert_eq!((bench.r(5), bench.r(0)), (1, 2));
    assert_eq!(bench.r(4), CODE + 4, "returns behind the SVC");
    let mut masked = Bench::new(&[
        0xb672, // cpsid i
        0xdf07, // svc #7
    ]);
    assert_eq!(masked.stop().cause, Cause::MaskedSvc(7));
}

#[test]
fn a_pended_pendsv_runs_at_once_in_thread_mode() {
    let program = &[
        0x6001, // str r1, [r0]
        0x2201, // movs r2, #1
    ];
    let icsr = 0xe000_ed04;
    let mut bench = Bench::with(&[icsr, 1 << 28], program).handler(
        14,
        &[
            0x4615, // mov r5, r2
            0x4770, // bx lr
        ],
    );
    bench.core.set_register(5, 99);
    bench.run();
    assert_eq!((bench.r(5), bench.r(2)), (0, 1));
}

#[test]
fn a_handler_that_uses_the_fpu_saves_the_registers_of_the_code_below_it() {
    let program = &[
        0xeeb7, 0x0a00, // vmov.f32 s0, #1.0
        0xeef0, 0x7a00, // vmov.f32 s15, #2.0
        0xbf00, // nop
        0xbf00, // nop
        0xee70, 0x0a27, // vadd.f32 s1, s0, s15
    ];
    let handler = &[
        0xeeb2, 0x0a00, // vmov.f32 s0, #8.0
        0xeef2, 0x7a00, // vmov.f32 s15, #8.0
        0x4770, // bx lr
    ];
    let mut bench = Bench::new(program).handler(16, handler);
    enable(&mut bench, 0, 0);
    step(&mut bench);
    step(&mut bench);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    assert_eq!(bench.r(14), 0xffff_ffe9, "an extended frame");
    assert_eq!(bench.r(13), STACK - 0x68);
    let saved = STACK - 0x68 + 0x20;
    assert_eq!(bench.memory.read32(saved), Some(0), "not stored yet");
    step(&mut bench);
    assert_eq!(
        bench.memory.read32(saved),
        Some(1f32.to_bits()),
        "stored by the first use"
    );
    bench.run();
    assert_eq!(bench.s(1), 3.0);
    // 2 in front, entry 12, save 17, handler 2 + 3, return 10, restore 17, 3 behind.
    assert_eq!(bench.core.cycles() - 1, 2 + 12 + 17 + 5 + 10 + 17 + 3);
}

#[test]
fn a_handler_without_floats_leaves_the_registers_where_they_are() {
    let program = &[
        0xeeb7, 0x0a00, // vmov.f32 s0, #1.0
        0xbf00, // nop
        0xee10, 0x0a10, // vmov r0, s0
    ];
    let mut bench = Bench::new(program).handler(
        16,
        &[
            0xbf00, // nop
            0x4770, // bx lr
        ],
    );
    enable(&mut bench, 0, 0);
    step(&mut bench);
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!(bench.r(0), 1f32.to_bits());
    assert_eq!(
        bench.core.cycles() - 1,
        1 + 12 + 4 + 10 + 2,
        "nothing was saved or restored"
    );
}

#[test]
fn a_nested_handler_saves_floats_into_the_outermost_frame() {
    let program = &[
        0xeeb7, 0x0a00, // vmov.f32 s0, #1.0
        0xbf00, // nop
        0xee10, 0x0a10, // vmov r0, s0
    ];
    let outer = &[
        0xbf00, // nop
        0xbf00, // nop
        0x4770, // bx lr
    ];
    let inner = &[
        0xeeb2, 0x0a00, // vmov.f32 s0, #8.0
        0x4770, // bx lr
    ];
    let mut bench = Bench::new(program).handler(16, outer).handler(17, inner);
    enable(&mut bench, 0, 0x80);
    enable(&mut bench, 1, 0x40);
    step(&mut bench);
    for irq in [0, 1] {
        bench.core.set_interrupt_line(irq, true);
        bench.core.take_pending_exceptions(&mut bench.memory);
        bench.core.set_interrupt_line(irq, false);
    }
    assert_eq!(
        bench.r(14),
        0xffff_fff1,
        "a basic frame: the outer handler used no floats"
    );
    bench.run();
    assert_eq!(bench.r(0), 1f32.to_bits());
}

#[test]
fn threads_on_the_process_stack_get_their_frames_there() {
    let program = &[
        0xf380, 0x8809, // msr psp, r0
        0x2102, // movs r1, #2
        0xf381, 0x8814, // msr control, r1
        0x466a, // mov r2, sp
        0xbf00, // nop
        0xbf00, // nop
    ];
    let mut bench = Bench::with(&[STACK - 0x1000], program).handler(
        16,
        &[
            0x466d, // mov r5, sp
            0x4770, // bx lr
        ],
    );
    enable(&mut bench, 0, 0);
    for _ in 0..4 {
        step(&mut bench);
    }
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    assert_eq!(bench.r(14), 0xffff_fffd);
    bench.run();
    assert_eq!((bench.r(2), bench.r(5)), (STACK - 0x1000, STACK));
    assert_eq!(bench.r(13), STACK - 0x1000);
}

#[test]
fn an_exception_breaks_into_an_it_block_and_the_rest_still_executes() {
    let program = &[
        0x4280, // cmp r0, r0
        0xbf02, // ittt eq
        0x3101, // addeq r1, #1
        0x3102, // addeq r1, #2
        0x3104, // addeq r1, #4
        0xbf00, // nop
    ];
    let handler = &[
        0x2e63, // cmp r6, #99
        0x4770, // bx lr
    ];
    let mut bench = Bench::with(&[0, 0], program).handler(16, handler);
    enable(&mut bench, 0, 0);
    for _ in 0..3 {
        step(&mut bench);
    }
    bench.core.set_interrupt_line(0, true);
    bench.core.take_pending_exceptions(&mut bench.memory);
    bench.core.set_interrupt_line(0, false);
    bench.run();
    assert_eq!(bench.r(1), 7);
}

#[test]
fn a_return_to_nowhere_stops_the_run() {
    let handler = &[
        0x2000, // movs r0, #0
        0x43c0, // mvns r0, r0
        0x4700, // bx r0
    ];
    let mut bench = Bench::new(&[
        0xbf00, // nop
    ])
    .handler(16, handler);
    enable(&mut bench, 0, 0);
    bench.core.set_interrupt_line(0, true);
    assert_eq!(bench.stop().cause, Cause::ExceptionReturn(0xffff_ffff));
    let handler = &[
        0x4670, // mov r0, lr
        0xf020, 0x0008, // bic r0, r0, #8
        0x4700, // bx r0
    ];
    let mut bench = Bench::new(&[
        0xbf00, // nop
    ])
    .handler(16, handler);
    enable(&mut bench, 0, 0);
    bench.core.set_interrupt_line(0, true);
    assert_eq!(
        bench.stop().cause,
        Cause::ExceptionReturn(0xffff_fff1),
        "no handler below"
    );
}

#[test]
fn a_stack_without_memory_stops_the_run_at_the_interrupted_instruction() {
    let mut bench = Bench::new(&[
        0xbf00, // nop
        0xbf00, // nop
    ])
    .handler(
        16,
        &[
            0x4770, // bx lr
        ],
    );
    enable(&mut bench, 0, 0);
    bench.core.set_register(13, 0x1000);
    bench.core.set_interrupt_line(0, true);
    let stop = bench.stop();
    let (address, write) = (0x1000 - 32, true);
    assert_eq!(stop.cause, Cause::BusFault { address, write });
    assert_eq!(stop.pc, CODE);
}
