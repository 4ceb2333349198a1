//! Claims about the debug unit.

use super::*;
use crate::core::Special;

/// ADDS r4, #1 in the loop of [`ticker`].
const COUNT: u32 = FLASH + 512 + 2 * 55;
/// The handler of [`ticker`], and in it LDR r3, [r2] and STR r3, [r2].
const HANDLER: u32 = COUNT + 4;
const LOAD: u32 = HANDLER + 2 * 13;
const STORE: u32 = LOAD + 4;
const R4: u8 = 4;
const LIMIT: Nanos = Nanos(200_000);

fn ticking() -> Machine<Unwired> {
    Machine::new(&ticker(), 8_000_000, Unwired).unwrap()
}

fn watch(on: Watched) -> Machine<Unwired> {
    let mut machine = ticking();
    // Behind the word's initialisation.
    machine.run_until(Nanos(10_000)).unwrap();
    machine.debug_unit().set_watchpoint(Watchpoint {
        address: SRAM + 1,
        bytes: 1,
        on,
    });
    machine
}

/// Runs to the limit, whatever pauses it on the way: the places of the pauses.
fn pauses(machine: &mut Machine<Unwired>) -> Vec<u32> {
    let mut places = Vec::new();
    while machine.run_debugged(LIMIT).unwrap() != Pause::Reached {
        places.push(machine.core().pc());
    }
    places
}

fn state(machine: &Machine<Unwired>) -> (Vec<u8>, u64, u64) {
    let list = machine.memory().bytes(SRAM, 1_024).unwrap().to_vec();
    (list, machine.cycles(), machine.instructions())
}

#[test]
fn a_debugged_program_is_at_the_same_place_at_the_same_cycle_as_one_that_is_left_alone() {
    let mut alone = ticking();
    alone.run_until(LIMIT).unwrap();
    let debugged = |prepare: &dyn Fn(&mut DebugUnit)| {
        let mut machine = ticking();
        prepare(machine.debug_unit());
        let paused = pauses(&mut machine).len();
        (state(&machine), paused)
    };
    let (stepped, steps) = debugged(&|unit| unit.steps = true);
    assert_eq!(stepped, state(&alone));
    // Each instruction is a step, and each of the 30 exceptions.
    let entries = steps as u64 - alone.instructions();
    assert!((28..=31).contains(&entries), "{entries} entries");
    let (broken, hits) = debugged(&|unit| unit.set_breakpoint(COUNT));
    assert_eq!(broken, state(&alone));
    assert!(hits > 300, "{hits} hits");
}

#[test]
fn a_breakpoint_pauses_before_its_instruction_every_time_until_it_is_cleared() {
    let mut machine = ticking();
    machine.debug_unit().set_breakpoint(COUNT);
    for count in 0..5 {
        assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Breakpoint));
        assert_eq!(machine.core().pc(), COUNT);
        assert_eq!(machine.core().register(R4), count);
    }
    assert!(machine.debug_unit().clear_breakpoint(COUNT | 1));
    assert!(!machine.debug_unit().clear_breakpoint(COUNT));
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Reached));
}

#[test]
fn a_watchpoint_pauses_before_accesses_of_its_kind_alone() {
    let places = |on| pauses(&mut watch(on));
    let [writes, reads, both] = [Watched::Writes, Watched::Reads, Watched::Accesses].map(places);
    assert!(writes.len() > 20 && writes.iter().all(|pc| *pc == STORE));
    assert!(reads.len() == writes.len() && reads.iter().all(|pc| *pc == LOAD));
    let in_turn = [LOAD, STORE].repeat(writes.len());
    assert_eq!(both, in_turn);
    let mut machine = watch(Watched::Writes);
    let before = machine.memory().read32(SRAM);
    let Ok(Pause::Watchpoint { address, .. }) = machine.run_debugged(LIMIT) else {
        panic!("no pause");
    };
    assert_eq!((address, machine.memory().read32(SRAM)), (SRAM + 1, before));
}

#[test]
fn a_store_that_was_stepped_to_still_pauses_a_run() {
    let mut machine = watch(Watched::Writes);
    machine.debug_unit().set_breakpoint(STORE - 2);
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Breakpoint));
    machine.debug_unit().steps = true;
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Stepped));
    machine.debug_unit().steps = false;
    let paused = machine.run_debugged(LIMIT);
    assert!(matches!(paused, Ok(Pause::Watchpoint { .. })));
    assert_eq!(machine.core().pc(), STORE);
}

#[test]
fn entering_an_exception_is_a_step_and_ends_at_its_first_instruction() {
    let mut machine = ticking();
    machine.debug_unit().steps = true;
    while machine.core().exception() == 0 {
        assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Stepped));
    }
    assert_eq!(machine.core().exception(), 16 + 55);
    assert_eq!(machine.core().pc(), HANDLER);
}

#[test]
fn registers_are_set_and_the_exception_stays_what_it_is() {
    let mut machine = ticking();
    machine.debug_unit().set_breakpoint(HANDLER);
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Breakpoint));
    let core = machine.core();
    core.set_xpsr(0xf000_0003);
    assert_eq!(core.xpsr(), 0xf100_0000 | (16 + 55));
    core.set_float_register(31, 0x3f80_0000);
    assert_eq!(core.float_register(31), 0x3f80_0000);
    core.set_special(Special::Psp, 0x2000_4000);
    assert_eq!(core.special(Special::Psp), 0x2000_4000);
    assert_eq!(core.special(Special::Msp), core.register(13));
    assert!(core.set_fpscr(1 << 31) && !core.set_fpscr(1 << 22));
    assert_eq!(core.fpscr(), 1 << 31);
}

#[test]
fn a_probe_reads_and_writes_memory_and_registers_and_what_the_chip_refuses_stops_nothing() {
    let mut machine = ticking();
    machine.run_until(Nanos(100_000)).unwrap();
    let read = |machine: &mut Machine<Unwired>, address| {
        let mut bytes = [0; 4];
        let read = machine.probe_read(address, &mut bytes);
        (read == 4).then_some(u32::from_le_bytes(bytes))
    };
    // TIM7_ARR, CPUID, the vector table; the random number generator is not modelled.
    assert_eq!(read(&mut machine, TIM7 + 0x2c), Some(99));
    assert_eq!(read(&mut machine, 0xe000_ed00), Some(0x410f_c241));
    assert_eq!(read(&mut machine, FLASH + 4), Some(FLASH + 513));
    assert_eq!(read(&mut machine, 0x5006_0800), None);
    assert!(!machine.probe_write(0x5006_0800, &[0; 4]));
    assert!(machine.probe_write(TIM7 + 0x2c, &200u32.to_le_bytes()));
    assert_eq!(read(&mut machine, TIM7 + 0x2c), Some(200));
    // ADDS r4, #2 in the place of ADDS r4, #1: the code that runs is the code that is there.
    machine.debug_unit().set_breakpoint(COUNT);
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Breakpoint));
    assert!(machine.probe_write(COUNT, &0x3402u16.to_le_bytes()));
    let before = machine.core().register(R4);
    assert_eq!(machine.run_debugged(LIMIT), Ok(Pause::Breakpoint));
    assert_eq!(machine.core().register(R4), before + 2);
}
