//! Claims about the chip as a whole, made on its bus.

use super::*;
use crate::core::{Bus, Width};
use crate::memory::SRAM;
use crate::wiring::{CameraSignal, Pin};

const RCC: u32 = 0x4002_3800;
const FLASH: u32 = 0x4002_3c00;
const GPIOA: u32 = 0x4002_0000;
const TIM3: u32 = 0x4000_0400;
const TIM12: u32 = 0x4000_1800;
const USART2: u32 = 0x4000_4400;
const DMA1: u32 = 0x4002_6000;
const DMA2: u32 = 0x4002_6400;
const DCMI: u32 = 0x5005_0000;
const IWDG: u32 = 0x4000_3000;

/// A camera with lines of 8 bytes, 4 lines a frame, an edge every 10 µs; and a log of the rest.
#[derive(Default)]
struct Board {
    camera: Option<(Nanos, u32)>,
    line: [u8; 8],
    clocks: Vec<(Nanos, Pin, Option<f64>)>,
    pins: Vec<(Nanos, Pin, bool)>,
}

impl Wiring for Board {
    fn pin_changed(&mut self, now: Nanos, pin: Pin, high: bool) {
        self.pins.push((now, pin, high));
    }

    fn clock_changed(&mut self, now: Nanos, pin: Pin, hertz: Option<f64>) {
        self.clocks.push((now, pin, hertz));
    }

    fn camera_next(&self) -> Option<Nanos> {
        self.camera.map(|(due, _)| due)
    }

    fn camera_signal(&mut self, now: Nanos) -> Option<CameraSignal<'_>> {
        let (_, edge) = self.camera?;
        self.camera = Some((now + Nanos(10_000), edge + 1));
        self.line = [edge as u8; 8];
        Some(match edge % 6 {
            0 => CameraSignal::FrameStart,
            5 => CameraSignal::FrameEnd,
            _ => CameraSignal::Line(&self.line),
        })
    }
}

struct Bench {
    soc: Soc<Board>,
    memory: Memory,
    now: Cycle,
}

impl Bench {
    fn new() -> Self {
        Self {
            soc: Soc::new(8_000_000, Board::default()),
            memory: Memory::new(),
            now: 0,
        }
    }

    /// A chip at 168 MHz with every modelled block clocked.
    fn at_full_speed() -> Self {
        let mut bench = Self::new();
        bench.write(RCC, 0x0001_0083);
        bench.pass(Nanos::from_millis(2));
        bench.write(RCC + 4, 1 << 22 | 168 << 6 | 4 | 7 << 24);
        bench.write(RCC, 0x0101_0083);
        bench.pass(Nanos::from_millis(1));
        bench.write(FLASH, 5);
        bench.write(RCC + 8, 2 | 5 << 10 | 4 << 13);
        for enable in [0x30, 0x34, 0x40, 0x44] {
            bench.write(RCC + enable, u32::MAX);
        }
        bench
    }

    fn access(&mut self, address: u32, width: Width, value: Option<u32>) -> Result<u32, Refusal> {
        let Self { soc, memory, now } = self;
        let done = match value {
            Some(value) => soc.write(memory, *now, address, width, value).map(|()| 0),
            None => soc.read(memory, *now, address, width),
        };
        done.map_err(|_| soc.refusal.take().expect("a bus fault has its reason"))
    }

    fn write(&mut self, address: u32, value: u32) {
        self.access(address, Width::Word, Some(value)).unwrap();
    }

    fn read(&mut self, address: u32) -> u32 {
        self.access(address, Width::Word, None).unwrap()
    }

    fn pass(&mut self, span: Nanos) {
        let until = self.soc.time().nanos(self.now) + span;
        self.now = self.soc.time().cycle_at(until);
        self.soc.advance(&mut self.memory, self.now);
    }

    /// A stream of `controller`: count, peripheral, memory, S_CR.
    fn stream(&mut self, controller: u32, number: u32, [count, par, m0, cr]: [u32; 4]) {
        let base = controller + 0x10 + 0x18 * number;
        self.write(base + 4, count);
        self.write(base + 8, par);
        self.write(base + 12, m0);
        self.write(base + 16, m0 + 0x100);
        self.write(base, cr | 1);
    }
}

#[test]
fn the_usual_set_up_reaches_168_mhz_and_time_counts_both_clocks() {
    let mut bench = Bench::at_full_speed();
    assert_eq!(bench.soc.time().hertz(), 168_000_000);
    assert_eq!(bench.read(RCC + 8) >> 2 & 3, 2);
    // Three milliseconds at 16 MHz, then one at 168 MHz.
    assert_eq!(bench.now, 48_000);
    bench.pass(Nanos::from_millis(1));
    assert_eq!(bench.now, 48_000 + 168_000);
    assert_eq!(bench.soc.time().nanos(bench.now), Nanos::from_millis(4));
}

#[test]
fn a_faster_clock_than_the_wait_states_allow_is_refused() {
    let mut bench = Bench::at_full_speed();
    let refused = bench.access(FLASH, Width::Word, Some(4));
    assert_eq!(
        refused,
        Err(Refusal::WaitStates {
            hertz: 168_000_000,
            wait_states: 4
        })
    );
}

#[test]
fn tim3_channel_2_clocks_the_sensor_at_21_mhz_on_pa7() {
    let mut bench = Bench::at_full_speed();
    bench.write(TIM3 + 0x2c, 3);
    bench.write(TIM3 + 0x38, 2);
    bench.write(TIM3 + 0x18, 0x6800);
    bench.write(TIM3 + 0x20, 1 << 4);
    bench.write(TIM3 + 0x14, 1);
    bench.write(TIM3, 1);
    assert_eq!(bench.soc.wiring().clocks, []);
    let moder = bench.read(GPIOA);
    bench.write(GPIOA + 0x20, 2 << 28);
    bench.write(GPIOA, moder | 2 << 14);
    bench.write(TIM3, 0);
    let pin = Pin {
        port: 'A',
        number: 7,
    };
    let now = bench.soc.time().nanos(bench.now);
    let expected = [(now, pin, Some(21e6)), (now, pin, None)];
    assert_eq!(bench.soc.wiring().clocks, expected);
}

#[test]
fn mco1_gives_the_internal_oscillator_on_pa8() {
    let mut bench = Bench::at_full_speed();
    let moder = bench.read(GPIOA);
    bench.write(GPIOA, moder | 2 << 16);
    let (_, pin, hertz) = bench.soc.wiring().clocks[0];
    assert_eq!((pin.port, pin.number, hertz), ('A', 8, Some(16e6)));
}

#[test]
fn a_new_timer_reload_takes_effect_at_the_overflow_and_is_reported_then() {
    let mut bench = Bench::at_full_speed();
    let moder = bench.read(GPIOA);
    bench.write(GPIOA + 0x20, 2 << 28);
    bench.write(GPIOA, moder | 2 << 14);
    // ARPE, 84 MHz / 8400.
    for (offset, value) in [(0x2c, 8399), (0x38, 4), (0x18, 0x6000), (0x20, 1 << 4)] {
        bench.write(TIM3 + offset, value);
    }
    bench.write(TIM3, 1 | 1 << 7);
    let started = bench.soc.time().nanos(bench.now);
    bench.pass(Nanos(30_000));
    bench.write(TIM3 + 0x2c, 4199);
    bench.pass(Nanos::from_millis(1));
    let told: Vec<_> = bench
        .soc
        .wiring()
        .clocks
        .iter()
        .map(|c| (c.0, c.2))
        .collect();
    let overflow = started + Nanos(100_000);
    assert_eq!(told, [(started, Some(1e4)), (overflow, Some(2e4))]);
}

#[test]
fn a_block_without_a_clock_reads_as_zero_and_a_write_that_matters_is_refused() {
    let mut bench = Bench::new();
    assert_eq!(bench.read(USART2), 0);
    bench.write(USART2 + 12, 0);
    let refused = bench.access(USART2 + 12, Width::Word, Some(1 << 13));
    assert_eq!(
        refused,
        Err(Refusal::ClockOff {
            block: Block::Usart(2),
            address: USART2 + 12
        })
    );
}

#[test]
fn what_the_model_does_not_have_is_refused_by_name() {
    let mut bench = Bench::at_full_speed();
    let rng = bench.access(0x5006_0800, Width::Word, None).unwrap_err();
    assert_eq!(
        rng.to_string(),
        "RNG register at 0x50060800 is not modelled"
    );
    let nothing = bench.access(0x4002_3400, Width::Word, Some(0)).unwrap_err();
    assert_eq!(nothing.to_string(), "nothing is mapped at 0x40023400");
    let crooked = bench.access(RCC + 2, Width::Word, None).unwrap_err();
    assert!(matches!(crooked, Refusal::Unaligned { .. }));
}

#[test]
fn bytes_written_to_a_port_keep_the_other_lanes() {
    let mut bench = Bench::at_full_speed();
    bench.write(GPIOA + 0x14, 0xff00);
    bench.access(GPIOA + 0x14, Width::Byte, Some(0x5a)).unwrap();
    assert_eq!(bench.read(GPIOA + 0x14), 0xff5a);
    let high = bench.access(GPIOA + 0x15, Width::Byte, None).unwrap();
    assert_eq!(high, 0xff);
}

#[test]
fn a_half_word_written_behind_the_apb_bridge_is_repeated() {
    let mut bench = Bench::at_full_speed();
    // TIM2 has a 32-bit reload register.
    bench
        .access(0x4000_002c, Width::Half, Some(0x1234))
        .unwrap();
    assert_eq!(bench.read(0x4000_002c), 0x1234_1234);
}

#[test]
fn dma_registers_take_whole_words_only() {
    let mut bench = Bench::at_full_speed();
    let refused = bench.access(DMA2 + 0x10, Width::Byte, Some(0));
    assert!(matches!(refused, Err(Refusal::WordOnly { .. })));
}

#[test]
fn a_reset_bit_in_the_rcc_resets_its_block_alone() {
    let mut bench = Bench::at_full_speed();
    bench.write(TIM3 + 0x2c, 99);
    bench.write(TIM12 + 0x2c, 77);
    bench.write(RCC + 0x20, 1 << 1);
    bench.write(RCC + 0x20, 0);
    assert_eq!(bench.read(TIM3 + 0x2c), 0xffff);
    assert_eq!(bench.read(TIM12 + 0x2c), 77);
}

#[test]
fn a_starved_watchdog_ends_the_run_at_its_instant() {
    let mut bench = Bench::new();
    bench.write(IWDG, 0xcccc);
    bench.pass(Nanos(511_999_900));
    assert_eq!(bench.soc.refusal(), None);
    assert_eq!(bench.soc.next_event(), 512 * 16_000);
    bench.pass(Nanos(100));
    assert_eq!(bench.soc.refusal(), Some(&Refusal::Watchdog));
}

#[test]
fn a_camera_that_has_nothing_to_say_is_asked_again_only_later() {
    struct Mute;
    impl Wiring for Mute {
        fn camera_next(&self) -> Option<Nanos> {
            Some(Nanos(500))
        }
    }
    let mut soc = Soc::new(8_000_000, Mute);
    soc.advance(&mut Memory::new(), 1_000);
    assert_eq!(soc.next_event(), NEVER);
}

/// Everything a run leaves behind.
#[derive(PartialEq)]
struct Remains {
    sram: Vec<u8>,
    sent: Vec<(Nanos, u8)>,
    frames: DcmiCounters,
    bytes: UsartCounters,
    count: u32,
}

/// A millisecond of camera, serial line and timer, in slices of `slice` cycles.
fn busy_run(slice: Cycle) -> Remains {
    let mut bench = Bench::at_full_speed();
    let start = bench.now;
    let words = 2 << 13 | 2 << 11;
    bench.stream(
        DMA2,
        1,
        [8, DCMI + 0x28, SRAM, 1 << 25 | words | 1 << 18 | 1 << 10],
    );
    bench.write(DCMI, 1 << 14 | 1);
    bench.write(USART2 + 8, 46);
    bench.write(USART2 + 20, 1 << 7 | 1 << 6);
    bench.stream(
        DMA1,
        5,
        [7, USART2 + 4, SRAM + 0x400, 4 << 25 | 1 << 10 | 1 << 8],
    );
    bench.stream(DMA1, 6, [32, USART2 + 4, SRAM, 4 << 25 | 1 << 10 | 1 << 6]);
    bench.write(TIM12 + 0x2c, 999);
    bench.write(TIM12 + 0x0c, 1);
    bench.write(TIM12, 1);
    bench.write(USART2 + 12, 1 << 13 | 3 << 2);
    let now = bench.soc.time().nanos(start);
    bench.soc.wiring_mut().camera = Some((now + Nanos(1), 0));
    bench
        .soc
        .usart_send(2, now + Nanos(5_000), b"a longer message");
    while bench.now < start + 168_000 {
        bench.now = (bench.now + slice).min(start + 168_000);
        bench.soc.advance(&mut bench.memory, bench.now);
    }
    Remains {
        count: bench.read(TIM12 + 0x24),
        sram: bench.memory.bytes(SRAM, 0x800).unwrap().to_vec(),
        sent: bench.soc.usart_received(2),
        frames: bench.soc.dcmi_counters(),
        bytes: bench.soc.usart_counters(2),
    }
}

#[test]
fn a_run_does_not_depend_on_how_it_is_sliced() {
    let whole = busy_run(168_000);
    // 101 edges in a millisecond: 17 frames begun, 16 of them ended.
    assert_eq!(whole.frames.frames_captured, 16);
    assert_eq!(whole.sent.len(), 32);
    assert_eq!(whole.bytes.received, 16);
    for slice in [1, 77, 1_000, 41_999] {
        assert!(busy_run(slice) == whole, "slices of {slice} cycles");
    }
}

#[test]
fn bytes_for_a_usart_that_nobody_has_set_up_are_lost_and_counted() {
    let mut bench = Bench::at_full_speed();
    let now = bench.soc.time().nanos(bench.now);
    bench.soc.usart_send(3, now, b"nobody listens");
    bench.pass(Nanos::from_millis(5));
    let counters = bench.soc.usart_counters(3);
    assert_eq!((counters.lost, counters.received), (14, 0));
}
