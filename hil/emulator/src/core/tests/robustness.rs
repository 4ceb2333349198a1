//! Whatever is executed, the core stops or goes on; it never panics.

use super::*;
use proptest::prelude::*;

fn code() -> impl Strategy<Value = Vec<u16>> {
    // Half of all first halfwords begin a 32-bit instruction.
    let half = prop_oneof![any::<u16>(), 0xe800u16..=0xffff];
    prop::collection::vec(half, 1..200)
}

fn register() -> impl Strategy<Value = u32> {
    prop_oneof![
        any::<u32>(),
        SRAM..SRAM + 0x2_0000,
        FLASH..FLASH + 0x1000,
        0xe000_e000u32..0xe000_f000,
        SPY..SPY + 0x200,
        Just(0xffff_fff9u32),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn random_instructions_never_panic(
        code in code(),
        registers in prop::collection::vec(register(), 15),
        lines in prop::collection::vec(any::<u8>(), 10),
        wait_states in 0u32..8,
    ) {
        let mut bench = Bench::with(&registers, &code).handler(16 + 3, &code).handler(11, &code);
        bench.core.set_flash_timing(wait_states, true, wait_states & 1 != 0, wait_states & 2 != 0);
        bench.core.nvic.enable(0, u32::MAX);
        bench.core.trace_calls(CODE + 4);
        for (turn, line) in (1..).zip(&lines) {
            bench.core.set_interrupt_line(*line, true);
            bench.core.take_pending_exceptions(&mut bench.memory);
            if bench.core.is_sleeping() && !bench.core.try_wake() {
                bench.core.advance_to(turn * 1000);
            }
            let exit = bench.core.run(&mut bench.memory, &mut bench.bus, turn * 1000);
            if let Exit::Stopped(stop) = exit {
                prop_assert!(!stop.to_string().is_empty());
                bench.core.set_register(15, CODE + 2 * turn as u32);
            }
            bench.core.set_interrupt_line(*line, false);
            prop_assert_eq!(bench.core.registers.r[15], 0, "decoders rely on it");
        }
    }
}
