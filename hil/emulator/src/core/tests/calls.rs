//! The call tracer.

use super::*;

#[test]
fn a_traced_function_is_measured_from_its_first_instruction_to_its_return() {
    let program = &[
        0xf000, 0xf804, // bl 1f
        0xbf00, // nop
        0xf000, 0xf801, // bl 1f
        0xe003, // b 2f
        0xb510, // push {r4, lr}
        0xbf00, // nop
        0xbf00, // nop
        0xbd10, // pop {r4, pc}
        0xbf00, // nop
    ];
    let function = CODE + 12;
    let mut bench = Bench::new(program);
    bench.core.trace_calls(function | 1);
    bench.run();
    let calls = bench.core.take_calls();
    // PUSH 3, two NOPs, POP 4.
    let cost: Vec<_> = calls
        .iter()
        .map(|call| call.returned - call.entered)
        .collect();
    assert_eq!(cost, [9, 9]);
    assert_eq!((calls[0].address, calls[0].entered), (function, 3));
    assert!(bench.core.take_calls().is_empty());
}

#[test]
fn recursion_is_measured_call_by_call() {
    // f(r0): push {lr}; subs r0, #1; beq out; bl f; out: pop {pc}
    let program = &[
        0x2003, // movs r0, #3
        0xf000, 0xf801, // bl 1f
        0xe005, // b 3f
        0xb500, // push {lr}
        0x3801, // subs r0, #1
        0xd001, // beq 2f
        0xf7ff, 0xfffb, // bl 1b
        0xbd00, // pop {pc}
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program);
    bench.core.trace_calls(CODE + 8);
    bench.run();
    let costs: Vec<_> = bench
        .core
        .take_calls()
        .iter()
        .map(|c| c.returned - c.entered)
        .collect();
    // The innermost: PUSH 2, SUBS 1, BEQ 3, POP 3. Those around it: 2 + 1 + 1 + 3 + inner + 3.
    assert_eq!(costs, [9, 19, 29]);
}

#[test]
fn a_loop_to_the_first_instruction_is_not_another_call() {
    let program = &[
        0x2003, // movs r0, #3
        0xf000, 0xf801, // bl 1f
        0xe002, // b 2f
        0x3801, // subs r0, #1
        0xd1fd, // bne 1b
        0x4770, // bx lr
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program);
    bench.core.trace_calls(CODE + 8);
    bench.run();
    assert_eq!(bench.core.take_calls().len(), 1);
}

#[test]
fn tracing_changes_no_cycle() {
    let program = &[
        0x2003, // movs r0, #3
        0xf000, 0xf801, // bl 1f
        0xe002, // b 2f
        0x3801, // subs r0, #1
        0xd1fd, // bne 1b
        0x4770, // bx lr
        0xbf00, // nop
    ];
    let plain = Bench::new(program).run();
    let mut traced = Bench::new(program);
    traced.core.trace_calls(CODE + 8);
    assert_eq!(traced.run(), plain);
}

#[test]
fn a_call_is_traced_where_it_begins_and_where_it_has_returned() {
    let program = &[
        0xf000, 0xf801, // bl 1f
        0xe002, // b 2f
        0xbf00, // nop
        0x4770, // bx lr
        0xbf00, // nop
    ];
    let mut bench = Bench::new(program);
    bench.core.trace_calls(CODE + 6);
    bench.core.start_trace();
    bench.run();
    let mut events = Vec::new();
    bench.core.take_trace(&mut events);
    let function = CODE + 6;
    let expected = [(3, What::Entered(function)), (7, What::Returned(function))];
    assert_eq!(events, expected.map(|(at, what)| Event { at, what }));
}
