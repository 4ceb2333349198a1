//! Branches and IT blocks.

use super::*;

#[test]
fn a_loop_runs_its_count_and_pays_for_each_taken_branch() {
    let program = &[
        0x2005, // movs r0, #5
        0x2100, // movs r1, #0
        0x3103, // adds r1, #3
        0x3801, // subs r0, #1
        0xd1fc, // bne 1b
    ];
    let mut bench = Bench::new(program);
    // 2 moves, 5 passes of 2, 4 branches taken at 1 + 2, one not taken.
    assert_eq!(bench.run(), 2 + 10 + 12 + 1);
    assert_eq!(bench.r(1), 15);
    assert_eq!(bench.core.instructions(), 2 + 15 + 1);
}

#[test]
fn a_call_leaves_the_return_address_in_the_link_register() {
    let program = &[
        0xf000, 0xf802, // bl 1f
        0x2101, // movs r1, #1
        0xe001, // b 2f
        0x2007, // movs r0, #7
        0x4770, // bx lr
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program);
    bench.run();
    assert_eq!((bench.r(0), bench.r(1)), (7, 1));
    assert_eq!(bench.r(14), CODE + 4 + 1);
}

#[test]
fn a_call_by_register_returns_behind_itself() {
    let program = &[
        0x4780, // blx r0
        0x2202, // movs r2, #2
        0xe002, // b 2f
        0xbf00, // nop
        0x2101, // movs r1, #1
        0x4770, // bx lr
        0xbf00, // nop
    ];
    let mut bench = Bench::with(&[CODE + 8 + 1], program);
    bench.run();
    assert_eq!((bench.r(1), bench.r(2)), (1, 2));
}

#[test]
fn an_it_block_executes_then_and_else_by_the_flags_at_their_time() {
    let program = &[
        0x2803, // cmp r0, #3
        0xbf0b, // itete eq
        0x2101, // moveq r1, #1
        0x2102, // movne r1, #2
        0x3201, // addeq r2, #1
        0x3a01, // subne r2, #1
        0x2309, // movs r3, #9
    ];
    assert_eq!(result(&[3, 0, 10], program), [3, 1, 11, 9]);
    assert_eq!(result(&[4, 0, 10], program), [4, 2, 9, 9]);
}

#[test]
fn inside_an_it_block_only_comparisons_set_flags() {
    let kept = &[
        0x4280, // cmp r0, r0
        0xbf04, // itt eq
        0x3101, // addeq r1, #1
        0x0049, // lsleq r1, r1, #1
    ];
    assert_eq!(flags_after(&[0, 0xffff_ffff], kept), "ZC");
    let compared = &[
        0x4280, // cmp r0, r0
        0xbf04, // itt eq
        0x2901, // cmpeq r1, #1
        0x2207, // moveq r2, #7
    ];
    let mut bench = Bench::with(&[0, 5, 0], compared);
    bench.run();
    assert_eq!(bench.flags(), "C");
    assert_eq!(
        bench.r(2),
        0,
        "the comparison made the rest of the block fail"
    );
}

#[test]
fn a_skipped_instruction_takes_one_cycle() {
    let program = &[
        0x2801, // cmp r0, #1
        0xbf08, // it eq
        0x6811, // ldreq r1, [r2]
    ];
    assert_eq!(Bench::with(&[0], program).run(), 3);
}

#[test]
fn compare_and_branch_leaves_the_flags_alone() {
    let program = &[
        0x4289, // cmp r1, r1
        0xb100, // cbz r0, 1f
        0x2201, // movs r2, #1
        0xb901, // cbnz r1, 2f
        0x2300, // movs r3, #0
        0xbf00, // nop
    ];
    let mut bench = Bench::with(&[0, 5, 0, 7], program);
    bench.run();
    assert_eq!((bench.r(2), bench.r(3)), (0, 7));
    assert_eq!(bench.flags(), "ZC");
}

#[test]
fn table_branches_jump_twice_the_entry_behind_themselves() {
    // tbb [pc, r0] with the table 2, 4; movs r1, #5; bkpt; movs r1, #6
    let bytes = [0xe8df, 0xf000, 0x0402, 0, 0x2105, BKPT, 0x2106];
    assert_eq!(result(&[0], &bytes), [0, 5]);
    assert_eq!(result(&[1], &bytes), [1, 6]);
    // tbh [pc, r0, lsl #1] with the table 2, 4
    let halves = [0xe8df, 0xf010, 2, 4, 0x2105, BKPT, 0x2106];
    assert_eq!(result(&[0], &halves), [0, 5]);
    assert_eq!(result(&[1], &halves), [1, 6]);
}

#[test]
fn a_branch_to_the_next_instruction_costs_a_branch_and_goes_on() {
    // b to the very next instruction; movs r0, #1
    let mut bench = Bench::new(&[0xe7ff, 0x2001]);
    assert_eq!(bench.run(), 3 + 1);
    assert_eq!(bench.r(0), 1);
}

#[test]
fn code_in_ram_runs_its_it_blocks_too() {
    let program = &[
        0x2803, // cmp r0, #3
        0xbf0a, // itet eq
        0x2101, // moveq r1, #1
        0x2102, // movne r1, #2
        0x2208, // moveq r2, #8
        0xbe00, // bkpt #0
    ];
    let mut bench = Bench::with(&[3], program);
    place(&mut bench.memory, DATA, program);
    bench.core.set_register(15, DATA);
    bench.run();
    assert_eq!((bench.r(1), bench.r(2)), (1, 8));
    assert_eq!(bench.r(15), DATA + 10);
}

#[test]
fn code_is_also_visible_at_address_zero() {
    let mut bench = Bench::new(&[
        0x2001, // movs r0, #1
        0x3002, // adds r0, #2
    ]);
    bench.core.set_register(15, CODE - FLASH);
    bench.run();
    assert_eq!(bench.r(0), 3);
}

#[test]
fn what_is_no_instruction_stops_the_run_where_it_is() {
    let cause = |program: &[u16]| Bench::new(program).stop();
    let stop = cause(&[0xbf00, 0xde01]); // nop; udf #1
    assert_eq!(stop.cause, Cause::UndefinedInstruction(0xde01));
    assert_eq!(stop.pc, CODE + 2);
    let stop = cause(&[0xf7f0, 0xa000]); // udf.w #0
    assert_eq!(stop.cause, Cause::UndefinedInstruction(0xf7f0_a000));
    let stop = cause(&[0xbc00]); // pop {}
    assert_eq!(stop.cause, Cause::Unpredictable(0xbc00));
    let stop = cause(&[
        0x2000, // movs r0, #0
        0x4700, // bx r0
    ]);
    assert_eq!((stop.cause, stop.pc), (Cause::ArmState(0), CODE + 2));
    let stop = Bench::with(
        &[0x3000_0001],
        &[
            0x4700, // bx r0
        ],
    )
    .stop();
    assert_eq!(
        (stop.cause, stop.pc),
        (Cause::Fetch(0x3000_0000), 0x3000_0000)
    );
    assert_eq!(cause(&[0xbe2a]).cause, Cause::Breakpoint(42));
}

#[test]
fn a_run_stops_at_its_cycle_and_goes_on_from_there() {
    let mut whole = Bench::new(&[
        0x2000, // movs r0, #0
        0x3001, // adds r0, #1
        0x28c8, // cmp r0, #200
        0xd1fc, // bne 1b
    ]);
    let mut sliced = Bench::new(&[
        0x2000, // movs r0, #0
        0x3001, // adds r0, #1
        0x28c8, // cmp r0, #200
        0xd1fc, // bne 1b
    ]);
    whole.run();
    let mut until = 0;
    while sliced.core.register(0) < 200 || sliced.core.cycles() < whole.core.cycles() {
        until += 7;
        if let Exit::Stopped(_) = sliced.core.run(&mut sliced.memory, &mut sliced.bus, until) {
            break;
        }
        assert!(sliced.core.cycles() >= until);
    }
    assert_eq!(sliced.core.cycles(), whole.core.cycles());
    assert_eq!(sliced.core.instructions(), whole.core.instructions());
}

#[test]
fn a_taken_branch_costs_what_the_model_says() {
    let program = &[
        0x2005, // movs r0, #5
        0x3801, // 1: subs r0, #1
        0xd1fd, // bne 1b
        0xe7ff, // b (to the next)
    ];
    for refill in 1..=3 {
        let mut bench = Bench::new(program);
        let model = CycleModel::default().with_branch_refill(refill);
        bench.core.set_cycle_model(model.expect("1 to 3"));
        // Five branches are taken.
        assert_eq!(bench.run(), 1 + 5 * 2 + 1 + 5 * Cycle::from(refill));
    }
    assert_eq!(CycleModel::default().with_branch_refill(0), None);
    assert_eq!(CycleModel::default().with_branch_refill(4), None);
}
