//! Claims about the whole machine, made by programs of a few instructions.

mod debug;

use super::*;
use crate::core::Cause;
use crate::memory::{FLASH, SRAM};
use crate::soc::Refusal;
use crate::trace::What;
use crate::wiring::{Pin, Unwired};

/// An image: 128 vectors of which the first two and `interrupt` are set, then `code`.
fn image(interrupt: usize, handler: usize, code: &[u16]) -> Image {
    const CODE: u32 = FLASH + 512;
    let mut words = [0u32; 128];
    words[0] = SRAM + 0x1_0000;
    words[1] = CODE | 1;
    words[16 + interrupt] = (CODE + 2 * handler as u32) | 1;
    let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.extend(code.iter().flat_map(|half| half.to_le_bytes()));
    Image::parse(&elf(&bytes)).unwrap()
}

/// An ELF file for ARM with one segment at the beginning of flash.
fn elf(bytes: &[u8]) -> Vec<u8> {
    let len = bytes.len() as u32;
    let mut file = b"\x7fELF\x01\x01\x01".to_vec();
    file.resize(16, 0);
    // Kind and machine; version, entry and the places of the headers; their sizes and counts.
    file.extend([2u16, 40].iter().flat_map(|half| half.to_le_bytes()));
    file.extend(
        [1u32, 0, 52, 0, 0]
            .iter()
            .flat_map(|word| word.to_le_bytes()),
    );
    file.extend(
        [52u16, 32, 1, 40, 0, 0]
            .iter()
            .flat_map(|half| half.to_le_bytes()),
    );
    let segment = [1, 84, FLASH, FLASH, len, len, 5, 4];
    file.extend(segment.iter().flat_map(|word| word.to_le_bytes()));
    file.extend(bytes);
    file
}

/// MOVW and MOVT: register `r` becomes `value`.
fn load(r: u16, value: u32) -> [u16; 4] {
    let half = |opcode: u16, value: u32| {
        let value = value as u16;
        let first = opcode | (value >> 11 & 1) << 10 | value >> 12;
        [first, (value >> 8 & 7) << 12 | r << 8 | value & 0xff]
    };
    let ([a, b], [c, d]) = (half(0xf240, value & 0xffff), half(0xf2c0, value >> 16));
    [a, b, c, d]
}

/// STR register `r` to the address in register `base`.
fn store(r: u16, base: u16) -> u16 {
    0x6000 | base << 3 | r
}

/// A word stored: registers 0 and 1 are used up.
fn poke(address: u32, value: u32) -> Vec<u16> {
    [&load(0, address)[..], &load(1, value), &[store(1, 0)]].concat()
}

/// WFE for ever.
const SLEEP: [u16; 2] = [0xbf20, 0xe7fd];

const RCC_AHB1ENR: u32 = 0x4002_3830;
const RCC_APB1ENR: u32 = 0x4002_3840;
const RCC_CSR: u32 = 0x4002_3874;
const GPIOD: u32 = 0x4002_0c00;
const DMA2: u32 = 0x4002_6400;
const IWDG_KR: u32 = 0x4000_3000;
const TIM7: u32 = 0x4000_1400;

/// Copies RCC_CSR to the beginning of SRAM, starts the watchdog and sleeps.
fn doomed() -> Image {
    let copy = [
        &load(0, RCC_CSR)[..],
        &[0x6802],
        &load(0, SRAM),
        &[store(2, 0)],
    ]
    .concat();
    image(
        0,
        0,
        &[copy, poke(IWDG_KR, 0xcccc), SLEEP.to_vec()].concat(),
    )
}

#[test]
fn a_firmware_that_sleeps_through_its_watchdog_is_stopped_by_it() {
    let mut machine = Machine::new(&doomed(), 8_000_000, Unwired).unwrap();
    assert_eq!(machine.run_until(Nanos::from_millis(500)), Ok(()));
    assert_eq!(machine.now(), Nanos::from_millis(500));
    let fault = machine.run_until(Nanos::from_millis(600)).unwrap_err();
    assert_eq!(fault.reason, Reason::Chip(Refusal::Watchdog));
    // The count began with the start, a few instructions after power-on.
    assert!(fault.at >= Nanos::from_millis(512) && fault.at < Nanos(512_010_000));
    assert!(machine.idle_cycles() > machine.cycles() - 200);
}

#[test]
fn a_reset_restarts_the_firmware_and_leaves_its_cause_and_the_ram() {
    let mut machine = Machine::new(&doomed(), 8_000_000, Unwired).unwrap();
    machine.run_until(Nanos::from_millis(1)).unwrap();
    assert_eq!(machine.memory().read32(SRAM), Some(0x0e00_0000));
    machine.memory_mut().write32(SRAM + 4, 0x1234_5678).unwrap();
    machine.run_until(Nanos::from_millis(600)).unwrap_err();
    machine.reset(ResetCause::Watchdog);
    let died = machine.now();
    machine.run_until(Nanos::from_millis(600)).unwrap();
    assert_eq!(machine.memory().read32(SRAM), Some(0x2e00_0000));
    assert_eq!(machine.memory().read32(SRAM + 4), Some(0x1234_5678));
    let fault = machine.run_until(Nanos::from_millis(2_000)).unwrap_err();
    assert!(fault.at > died + Nanos::from_millis(512));
}

#[test]
fn a_fault_tells_what_was_asked_of_the_chip_and_where() {
    let code = [&load(0, 0x5006_0800)[..], &[0x6801]].concat();
    let mut machine = Machine::new(&image(0, 0, &code), 8_000_000, Unwired).unwrap();
    let fault = machine.run_until(Nanos::from_millis(1)).unwrap_err();
    assert_eq!(fault.pc, FLASH + 512 + 8);
    let told = fault.to_string();
    assert!(told.starts_with("RNG register at 0x50060800 is not modelled at 0.000"));
    assert!(told.contains("pc 0x08000208"));
}

#[test]
fn a_core_that_cannot_go_on_tells_why() {
    let mut machine = Machine::new(&image(0, 0, &[0xbe07]), 8_000_000, Unwired).unwrap();
    let fault = machine.run_until(Nanos::from_millis(1)).unwrap_err();
    assert_eq!(fault.reason, Reason::Core(Cause::Breakpoint(7)));
}

#[derive(Default)]
struct Led(Option<Nanos>);

impl Wiring for Led {
    fn pin_changed(&mut self, now: Nanos, pin: Pin, high: bool) {
        if high && pin.port == 'D' && pin.number == 12 {
            self.0 = Some(now);
        }
    }
}

#[test]
fn running_while_something_holds_ends_with_the_access_that_changes_it() {
    let code = [
        poke(RCC_AHB1ENR, 1 << 3),
        poke(GPIOD, 1 << 24),
        poke(GPIOD + 0x18, 1 << 12),
        SLEEP.to_vec(),
    ];
    let image = image(0, 0, &code.concat());
    let mut machine = Machine::new(&image, 8_000_000, Led::default()).unwrap();
    let still_dark = machine.run_while(Nanos::from_millis(1), |led| led.0.is_none());
    assert_eq!(still_dark, Ok(false));
    let lit = machine.wiring().0.unwrap();
    assert!(machine.now() >= lit && machine.now() < lit + Nanos(1_000));
    let lit_for_ever = machine.run_while(Nanos::from_millis(1), |led| led.0.is_some());
    assert_eq!(lit_for_ever, Ok(true));
    assert_eq!(machine.now(), Nanos::from_millis(1));
}

/// Counts in a loop in register 4; TIM7 interrupts every 100 cycles and appends the count to a list
/// in SRAM, whose length in bytes is its first word.
fn ticker() -> Image {
    let main = [
        poke(SRAM, 0),
        poke(RCC_APB1ENR, 1 << 5),
        poke(TIM7 + 0x2c, 99),
        poke(TIM7 + 0x0c, 1),
        poke(TIM7, 1),
        // ISER1, interrupt 55.
        poke(0xe000_e104, 1 << 23),
        // MOVS r4, #0; then ADDS r4, #1 and back.
        vec![0x2400, 0x3401, 0xe7fd],
    ]
    .concat();
    let handler = [
        poke(TIM7 + 0x10, 0),
        load(2, SRAM).to_vec(),
        // LDR r3, [r2]; ADDS r3, #4; STR r3, [r2]; STR r4, [r2, r3]; BX lr.
        vec![0x6813, 0x3304, store(3, 2), 0x50d4, 0x4770],
    ]
    .concat();
    image(55, main.len(), &[main, handler].concat())
}

#[test]
fn a_program_runs_the_same_however_it_is_sliced() {
    let run = |slice: u64| {
        let mut machine = Machine::new(&ticker(), 8_000_000, Unwired).unwrap();
        let mut until = 0;
        while until < 1_000_000 {
            until = (until + slice).min(1_000_000);
            machine.run_until(Nanos(until)).unwrap();
        }
        let list = machine.memory().bytes(SRAM, 1_024).unwrap().to_vec();
        (list, machine.cycles(), machine.instructions())
    };
    let whole = run(1_000_000);
    // A millisecond at 16 MHz, an interrupt every 100 cycles.
    let ticks = u32::from_le_bytes([whole.0[0], whole.0[1], whole.0[2], whole.0[3]]) / 4;
    assert!((155..=160).contains(&ticks), "{ticks} ticks");
    for slice in [63, 1_000, 77_777] {
        assert!(run(slice) == whole, "slices of {slice} ns");
    }
}

#[test]
fn instruction_by_instruction_a_program_runs_the_same_and_every_cycle_is_accounted_for() {
    let mut whole = Machine::new(&ticker(), 8_000_000, Unwired).unwrap();
    let mut stepped = Machine::new(&ticker(), 8_000_000, Unwired).unwrap();
    let (mut steps, mut cycles, mut handler) = (0, 0, 0);
    for until in [300_001, 1_000_000].map(Nanos) {
        whole.run_until(until).unwrap();
        let see = |step: Step| {
            steps += 1;
            cycles += step.cycles;
            // Interrupt 55.
            handler += u64::from(step.exception == 71);
        };
        stepped.run_stepwise(until, see).unwrap();
        assert_eq!(stepped.cycles(), whole.cycles());
    }
    let list = |machine: &Machine<Unwired>| machine.memory().bytes(SRAM, 1_024).unwrap().to_vec();
    assert!(list(&stepped) == list(&whole));
    assert_eq!(steps, whole.instructions());
    assert_eq!(cycles, whole.cycles());
    assert!(handler > 0 && handler < steps);
}

#[test]
fn a_trace_tells_every_exception_in_its_order_and_changes_nothing() {
    let mut plain = Machine::new(&ticker(), 8_000_000, Unwired).unwrap();
    let mut traced = Machine::new(&ticker(), 8_000_000, Unwired).unwrap();
    traced.start_trace();
    plain.run_until(Nanos::from_millis(1)).unwrap();
    traced.run_until(Nanos::from_millis(1)).unwrap();
    assert_eq!(traced.cycles(), plain.cycles());
    assert!(plain.take_trace().is_empty());
    let events = traced.take_trace();
    let list_bytes = traced.memory().read32(SRAM).unwrap();
    let entered: Vec<Cycle> = events
        .iter()
        .filter(|event| event.what == What::ExceptionEntered(71))
        .map(|event| event.at)
        .collect();
    assert!((0..=1).contains(&(entered.len() as u32 - list_bytes / 4)));
    // Every 100 cycles, give or take an instruction.
    for pair in entered.windows(2) {
        assert!((95..=105).contains(&(pair[1] - pair[0])), "{pair:?}");
    }
    for pair in events.windows(2) {
        assert!(pair[0].at <= pair[1].at && pair[0].what != pair[1].what);
    }
}

#[test]
fn sleep_is_traced_to_the_cycle() {
    let mut machine = Machine::new(&doomed(), 8_000_000, Unwired).unwrap();
    machine.start_trace();
    machine.run_until(Nanos::from_millis(100)).unwrap();
    machine.run_until(Nanos::from_millis(200)).unwrap();
    let events = machine.take_trace();
    let asleep = |event: &Event| match event.what {
        What::Slept { until } => until - event.at,
        _ => 0,
    };
    let slept: Cycle = events.iter().map(asleep).sum();
    assert_eq!(slept, machine.idle_cycles());
    // Nothing interrupts it: one sleep, whoever looks meanwhile.
    assert_eq!(events.len(), 1);
}

#[test]
fn a_bus_error_from_outside_stops_the_stream_and_shows_in_its_flags() {
    const STREAM_1: u32 = DMA2 + 0x28;
    let code = [
        poke(RCC_AHB1ENR, 1 << 22),
        poke(STREAM_1 + 4, 8),
        poke(STREAM_1 + 8, 0x5005_0028),
        poke(STREAM_1 + 12, SRAM + 0x100),
        // Channel 1, words, memory increments, on.
        poke(STREAM_1, 1 << 25 | 2 << 13 | 2 << 11 | 1 << 10 | 1),
        // For ever: LISR to SRAM, S1CR to the word behind it.
        load(0, DMA2).to_vec(),
        load(1, STREAM_1).to_vec(),
        load(2, SRAM).to_vec(),
        vec![0x6803, store(3, 2), 0x680b, 0x6053, 0xe7fa],
    ]
    .concat();
    let mut machine = Machine::new(&image(0, 0, &code), 8_000_000, Unwired).unwrap();
    let seen = |machine: &mut Machine<Unwired>, until| {
        machine.run_until(Nanos::from_millis(until)).unwrap();
        let word = |address| machine.memory().read32(address).unwrap();
        (word(SRAM), word(SRAM + 4) & 1)
    };
    assert_eq!(seen(&mut machine, 1), (0, 1));
    // A stalled bus is no error.
    machine.stall_dma(2, true);
    assert_eq!(seen(&mut machine, 2), (0, 1));
    machine.stall_dma(2, false);
    machine.fail_dma(2, 1);
    // TEIF1 of LISR (RM0090 §10.5.1).
    assert_eq!(seen(&mut machine, 3), (1 << 9, 0));
}
