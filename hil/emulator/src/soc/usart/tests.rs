//! Claims of RM0090 §30, on the registers of USART2: PCLK1 42 MHz under HCLK 168 MHz.

use super::*;
use crate::memory::{Memory, SRAM};
use crate::soc::dma::Dma;
use crate::soc::timeline::Timeline;

/// 42 MHz / 921 600 Bd = 45.57, rounded to 46 bus clocks a bit.
const BRR_921600: u32 = 46;
/// Ten bits of 46 bus clocks of four HCLK cycles.
const CHARACTER: Cycle = 10 * 46 * 4;

struct Bench {
    usart: Usart,
    dma: Dma,
    memory: Memory,
    time: Timeline,
}

fn bench(cr1: u32, cr3: u32) -> Bench {
    let mut usart = Usart::new(2);
    usart.set_clock(4);
    usart.write(BRR, BRR_921600).unwrap();
    usart.write(CR1, ENABLE | cr1).unwrap();
    usart.write(CR3, cr3).unwrap();
    Bench {
        usart,
        dma: Dma::new(),
        memory: Memory::new(),
        time: Timeline::new(168_000_000),
    }
}

impl Bench {
    /// Runs all events up to and including `until`; returns the cycles of the events.
    fn run(&mut self, until: Cycle) -> Vec<Cycle> {
        let mut events = Vec::new();
        loop {
            let next = self.usart.next(&self.time);
            if next > until {
                return events;
            }
            self.usart
                .advance(next, &self.time, &mut self.memory, &mut self.dma);
            events.push(next);
        }
    }

    fn write(&mut self, now: Cycle, offset: u32, value: u32) {
        self.usart.write(offset, value).unwrap();
        self.usart.serve(now, &mut self.memory, &mut self.dma);
    }

    fn line(&self) -> bool {
        let mut lines = Lines::default();
        self.usart.drive(&mut lines);
        lines.is_high(38)
    }

    /// DMA1 stream 5 (RX) or 6 (TX), channel 4.
    fn stream(&mut self, number: u32, count: u32, cr: u32) {
        let base = 0x10 + 0x18 * number;
        for (register, value) in [(4, count), (8, 0x4000_4404), (12, SRAM), (0, cr | 1)] {
            self.dma.write(1, base + register, value).unwrap();
        }
    }
}

const CHANNEL_4: u32 = 4 << 25 | 1 << 10;
const RX_CIRCULAR: u32 = CHANNEL_4 | 1 << 8;
const TX: u32 = CHANNEL_4 | 1 << 6;

#[test]
fn after_reset_the_transmitter_is_empty_and_complete() {
    assert_eq!(Usart::new(2).read(SR).unwrap(), 0xc0);
}

#[test]
fn a_byte_at_921600_baud_arrives_ten_bits_after_its_start() {
    let mut bench = bench(RECEIVER, 0);
    bench.usart.send(Nanos(1_000), &[0x5a]);
    bench.run(168 + CHARACTER - 1);
    assert_eq!(bench.usart.read(SR).unwrap() & RECEIVED, 0);
    bench.run(168 + CHARACTER);
    assert_eq!(bench.usart.read(SR).unwrap() & RECEIVED, RECEIVED);
    assert_eq!(bench.usart.read(DR).unwrap(), 0x5a);
    assert_eq!(bench.usart.read(SR).unwrap() & RECEIVED, 0);
}

#[test]
fn idle_rises_one_character_after_the_last_byte_and_clears_by_sr_then_dr() {
    let mut bench = bench(RECEIVER | IDLE, 0);
    bench.usart.send(Nanos(0), &[1, 2]);
    bench.run(2 * CHARACTER);
    bench.usart.read(DR).unwrap();
    bench.run(3 * CHARACTER - 1);
    assert_eq!(bench.usart.read(SR).unwrap() & IDLE, 0);
    assert!(!bench.line());
    bench.run(3 * CHARACTER);
    assert!(bench.line());
    // A read of DR alone does not clear it: this read of SR came before the flag.
    bench.usart.read(DR).unwrap();
    assert_eq!(bench.usart.read(SR).unwrap() & IDLE, IDLE);
    bench.usart.read(DR).unwrap();
    assert_eq!(bench.usart.read(SR).unwrap() & IDLE, 0);
    assert_eq!(bench.run(100 * CHARACTER), []);
}

#[test]
fn bytes_that_follow_at_once_are_no_idle_line() {
    let mut bench = bench(RECEIVER, CR3_DMA_RECEIVE);
    bench.stream(5, 64, RX_CIRCULAR);
    bench.usart.send(Nanos(0), &[0; 20]);
    bench.run(20 * CHARACTER);
    assert_eq!(bench.usart.read(SR).unwrap() & (IDLE | OVERRUN), 0);
    assert_eq!(bench.usart.counters().received, 20);
}

#[test]
fn dma_takes_every_byte_into_its_ring() {
    let mut bench = bench(RECEIVER, CR3_DMA_RECEIVE);
    bench.stream(5, 4, RX_CIRCULAR);
    bench.usart.send(Nanos(0), &[1, 2, 3, 4, 5]);
    bench.run(5 * CHARACTER);
    assert_eq!(bench.memory.bytes(SRAM, 4), Some(&[5, 2, 3, 4][..]));
    assert_eq!(bench.usart.read(SR).unwrap() & (RECEIVED | OVERRUN), 0);
}

#[test]
fn an_unread_byte_makes_the_next_one_an_overrun_and_is_kept() {
    let mut bench = bench(RECEIVER | RECEIVED, 0);
    bench.usart.send(Nanos(0), &[7, 8]);
    bench.run(2 * CHARACTER);
    assert_eq!(bench.usart.read(SR).unwrap() & OVERRUN, OVERRUN);
    assert_eq!(bench.usart.read(DR).unwrap(), 7);
    assert_eq!(bench.usart.read(SR).unwrap() & OVERRUN, 0);
    assert_eq!(bench.usart.counters().overruns, 1);
}

#[test]
fn bytes_sent_to_a_receiver_that_is_off_are_lost_and_counted() {
    let mut bench = bench(TRANSMITTER, 0);
    bench.usart.send(Nanos(0), &[7, 8]);
    bench.run(CHARACTER);
    assert_eq!(bench.usart.counters().lost, 2);
}

#[test]
fn two_bytes_written_by_hand_leave_back_to_back_and_complete_rises_at_the_end() {
    let mut bench = bench(TRANSMITTER, 0);
    bench.write(100, DR, 0x11);
    assert_eq!(bench.usart.read(SR).unwrap() & (EMPTY | COMPLETE), EMPTY);
    bench.write(200, DR, 0x22);
    assert_eq!(bench.usart.read(SR).unwrap() & (EMPTY | COMPLETE), 0);
    bench.run(100 + 2 * CHARACTER - 1);
    assert_eq!(bench.usart.read(SR).unwrap() & (EMPTY | COMPLETE), EMPTY);
    bench.run(100 + 2 * CHARACTER);
    assert_eq!(
        bench.usart.read(SR).unwrap() & (EMPTY | COMPLETE),
        EMPTY | COMPLETE
    );
    let ends = [100 + CHARACTER, 100 + 2 * CHARACTER].map(|cycle| bench.time.nanos(cycle));
    assert_eq!(bench.usart.take_sent(), [(ends[0], 0x11), (ends[1], 0x22)]);
}

#[test]
fn dma_feeds_the_transmitter_without_gaps() {
    let mut bench = bench(TRANSMITTER, CR3_DMA_SEND);
    for (offset, byte) in (0..).zip([9, 8, 7]) {
        bench.memory.write8(SRAM + offset, byte).unwrap();
    }
    bench.stream(6, 3, TX);
    bench.write(0, SR, !COMPLETE);
    let events = bench.run(10 * CHARACTER);
    assert_eq!(events, [CHARACTER, 2 * CHARACTER, 3 * CHARACTER]);
    let bytes: Vec<u8> = bench.usart.take_sent().iter().map(|sent| sent.1).collect();
    assert_eq!(bytes, [9, 8, 7]);
}

#[test]
fn the_dmas_read_of_dr_completes_a_clearing_sequence() {
    let mut bench = bench(RECEIVER, CR3_DMA_RECEIVE);
    bench.stream(5, 8, RX_CIRCULAR);
    bench.usart.send(Nanos(0), &[1]);
    bench.run(2 * CHARACTER);
    assert_eq!(bench.usart.read(SR).unwrap() & IDLE, IDLE);
    bench.usart.send(Nanos(1_000_000), &[2]);
    bench.run(168_000 + CHARACTER);
    assert_eq!(bench.usart.read(SR).unwrap() & IDLE, 0);
}

#[test]
fn oversampling_by_eight_uses_three_fraction_bits() {
    let mut bench = bench(RECEIVER | OVERSAMPLE_BY_8, 0);
    // 5 6/8: 46 bus clocks a bit again.
    bench.usart.write(BRR, 0x56).unwrap();
    bench.usart.send(Nanos(0), &[1]);
    bench.run(CHARACTER);
    assert_eq!(bench.usart.counters().received, 1);
}
