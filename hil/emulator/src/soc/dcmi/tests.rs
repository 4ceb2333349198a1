//! Claims of RM0090 §15, on the registers.

use super::*;
use crate::memory::SRAM;

const CONTINUOUS: u32 = ENABLE | CAPTURE;
const DMA_TO_MEMORY: u32 = 1 << 25 | 2 << 13 | 2 << 11 | 1 << 10;
const DMA_DOUBLE_BUFFER: u32 = 1 << 18;

struct Bench {
    dcmi: Dcmi,
    dma: Dma,
    memory: Memory,
}

impl Bench {
    fn new(cr: u32, words: u32, stream: u32) -> Self {
        let mut dma = Dma::new();
        for (register, value) in [
            (0x2c, words),
            (0x30, 0x5005_0028),
            (0x34, SRAM),
            (0x38, SRAM + 4 * words),
            (0x28, DMA_TO_MEMORY | stream | 1),
        ] {
            dma.write(2, register, value).unwrap();
        }
        let mut dcmi = Dcmi::new();
        dcmi.write(CR, cr).unwrap();
        Self {
            dcmi,
            dma,
            memory: Memory::new(),
        }
    }

    fn signal(&mut self, signal: CameraSignal<'_>) {
        self.dcmi.signal(signal, &mut self.memory, &mut self.dma);
    }

    /// A frame of 4 lines of 8 bytes: byte x of line y is `16 y + x + base`.
    fn frame(&mut self, base: u8) {
        self.signal(CameraSignal::FrameStart);
        for y in 0..4u8 {
            let line: Vec<u8> = (0..8).map(|x| 16 * y + x + base).collect();
            self.signal(CameraSignal::Line(&line));
        }
        self.signal(CameraSignal::FrameEnd);
    }

    fn flags(&mut self) -> u32 {
        let flags = self.dcmi.read(RIS).unwrap();
        self.dcmi.write(ICR, flags).unwrap();
        flags
    }
}

#[test]
fn four_bytes_make_a_word_with_the_first_lowest() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.frame(0);
    assert_eq!(bench.memory.read32(SRAM), Some(0x0302_0100));
    assert_eq!(bench.memory.read32(SRAM + 28), Some(0x3736_3534));
    assert_eq!(bench.flags(), FRAME | VSYNC | LINE);
    assert_eq!(bench.dcmi.counters().frames_captured, 1);
}

#[test]
fn capture_waits_for_the_next_frame_start() {
    let mut bench = Bench::new(ENABLE, 8, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.dcmi.write(CR, CONTINUOUS).unwrap();
    bench.signal(CameraSignal::Line(&[1; 8]));
    bench.signal(CameraSignal::FrameEnd);
    assert_eq!(bench.memory.read32(SRAM), Some(0));
    assert_eq!(bench.flags(), VSYNC | LINE);
    bench.frame(0);
    assert_eq!(bench.flags(), FRAME | VSYNC | LINE);
}

#[test]
fn a_snapshot_takes_one_frame_and_clears_capture() {
    let mut bench = Bench::new(CONTINUOUS | SNAPSHOT, 8, 0);
    bench.frame(0);
    assert_eq!(bench.dcmi.read(CR).unwrap() & CAPTURE, 0);
    bench.frame(0);
    let counters = bench.dcmi.counters();
    assert_eq!((counters.frames_started, counters.frames_captured), (2, 1));
    assert_eq!(counters.frames_missed, 1);
}

#[test]
fn continuous_capture_fills_two_buffers_in_turn() {
    let mut bench = Bench::new(CONTINUOUS, 8, DMA_DOUBLE_BUFFER);
    for base in [0, 1, 2] {
        bench.frame(base);
    }
    assert_eq!(bench.memory.read8(SRAM), Some(2));
    assert_eq!(bench.memory.read8(SRAM + 32), Some(1));
    assert_eq!(bench.dcmi.counters().frames_captured, 3);
    assert_eq!(bench.dcmi.counters().overruns, 0);
}

#[test]
fn cropping_keeps_the_window_and_ends_the_frame_with_its_last_line() {
    let mut bench = Bench::new(CONTINUOUS | CROP, 2, 0);
    bench.dcmi.write(CWSTRT, 1 << 16 | 2).unwrap();
    bench.dcmi.write(CWSIZE, 1 << 16 | 3).unwrap();
    bench.signal(CameraSignal::FrameStart);
    let line = |y: u8| [0, 1, 2, 3, 4, 5, 6, 7].map(|x| 16 * y + x);
    for y in 0..2 {
        bench.signal(CameraSignal::Line(&line(y)));
    }
    assert_eq!(bench.flags() & FRAME, 0);
    bench.signal(CameraSignal::Line(&line(2)));
    assert_eq!(bench.flags() & FRAME, FRAME);
    bench.signal(CameraSignal::Line(&line(3)));
    bench.signal(CameraSignal::FrameEnd);
    assert_eq!(bench.flags(), VSYNC | LINE);
    let words = [SRAM, SRAM + 4].map(|address| bench.memory.read32(address).unwrap());
    assert_eq!(words, [0x1514_1312, 0x2524_2322]);
    assert_eq!(bench.dcmi.counters().frames_captured, 1);
}

#[test]
fn a_frame_that_ends_inside_the_window_is_still_reported() {
    let mut bench = Bench::new(CONTINUOUS | CROP, 64, 0);
    bench.dcmi.write(CWSIZE, 99 << 16 | 7).unwrap();
    bench.frame(0);
    assert_eq!(bench.flags() & FRAME, FRAME);
}

#[test]
fn without_dma_the_fifo_overruns_at_its_fifth_word_and_the_frame_is_lost() {
    let mut bench = Bench::new(CONTINUOUS, 3, 0);
    bench.frame(0);
    assert_eq!(bench.flags(), OVERRUN | VSYNC | LINE);
    assert_eq!(bench.dcmi.counters().overruns, 1);
    assert_eq!(bench.dcmi.counters().frames_captured, 0);
    // The FIFO was reset, and continuous capture goes on with the next frame.
    assert_eq!(bench.dcmi.read(SR).unwrap() >> 2 & 1, 0);
    assert_eq!(bench.dcmi.read(CR).unwrap() & CAPTURE, CAPTURE);
}

#[test]
fn an_overrun_ends_a_snapshot() {
    let mut bench = Bench::new(CONTINUOUS | SNAPSHOT, 3, 0);
    bench.frame(0);
    assert_eq!(bench.flags(), OVERRUN | VSYNC | LINE);
    assert_eq!(bench.dcmi.read(CR).unwrap() & CAPTURE, 0);
}

#[test]
fn clearing_capture_takes_effect_at_the_end_of_the_frame() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.dcmi.write(CR, ENABLE).unwrap();
    assert_eq!(bench.dcmi.read(CR).unwrap() & CAPTURE, CAPTURE);
    for _ in 0..4 {
        bench.signal(CameraSignal::Line(&[9; 8]));
    }
    bench.signal(CameraSignal::FrameEnd);
    assert_eq!(bench.dcmi.read(CR).unwrap() & CAPTURE, 0);
    assert_eq!(bench.flags() & FRAME, FRAME);
    assert_eq!(bench.dcmi.counters().frames_captured, 1);
}

#[test]
fn every_second_frame_is_taken_with_fcrc_1() {
    let mut bench = Bench::new(CONTINUOUS | 1 << 8, 8, 1 << 8);
    for _ in 0..5 {
        bench.frame(0);
    }
    let counters = bench.dcmi.counters();
    assert_eq!((counters.frames_captured, counters.frames_missed), (3, 0));
}

#[test]
fn the_wrong_vsync_polarity_captures_empty_frames() {
    let mut bench = Bench::new(CONTINUOUS | VSYNC_HIGH_IS_BLANKING, 8, 0);
    bench.frame(1);
    bench.frame(1);
    assert_eq!(bench.memory.read32(SRAM), Some(0));
    assert_eq!(bench.flags() & FRAME, FRAME);
    assert_eq!(bench.dcmi.counters().frames_captured, 0);
}

#[test]
fn the_interrupt_line_follows_the_enabled_flags() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.dcmi.write(IER, FRAME).unwrap();
    bench.frame(0);
    let high = |dcmi: &Dcmi| {
        let mut lines = Lines::default();
        dcmi.drive(&mut lines);
        lines.is_high(78)
    };
    assert!(high(&bench.dcmi));
    bench.dcmi.write(ICR, FRAME).unwrap();
    assert!(!high(&bench.dcmi));
}

#[test]
fn a_disabled_interface_drops_what_is_in_its_fifo() {
    let mut bench = Bench::new(CONTINUOUS, 0, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.signal(CameraSignal::Line(&[1; 8]));
    assert_eq!(bench.dcmi.read(SR).unwrap() >> 2 & 1, 1);
    bench.dcmi.write(CR, 0).unwrap();
    assert_eq!(bench.dcmi.read(SR).unwrap() >> 2 & 1, 0);
}

#[test]
fn the_processor_may_read_the_fifo_itself() {
    let mut bench = Bench::new(CONTINUOUS, 0, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.signal(CameraSignal::Line(&[1, 2, 3, 4, 5, 6, 7, 8]));
    assert_eq!(bench.dcmi.read(DR).unwrap(), 0x0403_0201);
    assert_eq!(bench.dcmi.read(DR).unwrap(), 0x0807_0605);
    assert_eq!(bench.dcmi.read(SR).unwrap() >> 2 & 1, 0);
}

#[test]
fn a_line_between_frames_raises_its_flag_and_is_not_captured() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.signal(CameraSignal::Line(&[1; 8]));
    assert_eq!(bench.flags(), LINE);
    assert_eq!(bench.memory.read32(SRAM), Some(0));
}

#[test]
fn a_frame_that_was_broken_off_ends_before_the_next_begins() {
    let mut bench = Bench::new(CONTINUOUS, 16, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.signal(CameraSignal::Line(&[9; 8]));
    assert_eq!(bench.flags(), LINE);
    bench.signal(CameraSignal::FrameStart);
    assert_eq!(bench.flags(), FRAME | VSYNC);
    for _ in 0..4 {
        bench.signal(CameraSignal::Line(&[1; 8]));
    }
    bench.signal(CameraSignal::FrameEnd);
    assert_eq!(bench.flags(), FRAME | VSYNC | LINE);
}

#[test]
fn a_stalled_bus_starves_the_fifo_until_it_overruns() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.signal(CameraSignal::Line(&[1; 8]));
    bench.dma.stall(2, true);
    bench.signal(CameraSignal::Line(&[2; 8]));
    bench.signal(CameraSignal::Line(&[3; 8]));
    assert_eq!(bench.flags(), LINE);
    bench.signal(CameraSignal::Line(&[4; 8]));
    assert_eq!(bench.flags(), LINE | OVERRUN);
    assert_eq!(bench.memory.read32(SRAM + 8), Some(0));
}

#[test]
fn a_bus_that_stalls_for_less_than_four_words_loses_nothing() {
    let mut bench = Bench::new(CONTINUOUS, 8, 0);
    bench.signal(CameraSignal::FrameStart);
    bench.dma.stall(2, true);
    bench.signal(CameraSignal::Line(&[2; 8]));
    bench.signal(CameraSignal::Line(&[3; 8]));
    assert_eq!(bench.memory.read32(SRAM), Some(0));
    bench.dma.stall(2, false);
    bench.dcmi.serve(&mut bench.memory, &mut bench.dma);
    let words = [SRAM, SRAM + 12].map(|address| bench.memory.read32(address).unwrap());
    assert_eq!(words, [0x0202_0202, 0x0303_0303]);
    assert_eq!(bench.flags(), LINE);
}
