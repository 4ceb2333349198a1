//! Claims of RM0090 §10, on the registers.

use proptest::prelude::*;

use super::*;
use crate::memory::{CCM, SRAM};

/// S_CR.
const ENABLE: u32 = 1 << 0;
const CIRCULAR: u32 = 1 << 8;
const MEMORY_INCREMENT: u32 = 1 << 10;
const DOUBLE_BUFFER: u32 = 1 << 18;
const CURRENT_TARGET: u32 = 1 << 19;

/// ISR, of stream 0.
const TRANSFER_ERROR: u32 = 1 << 3;
const HALF_TRANSFER: u32 = 1 << 4;
const TRANSFER_COMPLETE: u32 = 1 << 5;

/// DMA2 stream 1: S_CR of the stream.
const S1: u32 = 0x10 + 0x18;
const DCMI_DR: u32 = 0x5005_0028;
const WORDS: u32 = 2 << 13 | 2 << 11;
const DCMI_STREAM: u32 = 1 << 25 | WORDS | MEMORY_INCREMENT;
const TC_S1: u32 = TRANSFER_COMPLETE << 6;
const HT_S1: u32 = HALF_TRANSFER << 6;

/// DMA2 stream 1, ready for `count` words from the camera, enabled with `cr`.
fn camera_stream(count: u32, cr: u32) -> (Dma, Memory) {
    let mut dma = Dma::new();
    for (register, value) in [
        (S1 + 4, count),
        (S1 + 8, DCMI_DR),
        (S1 + 12, SRAM),
        (S1 + 16, SRAM + 0x100),
        (S1, DCMI_STREAM | cr),
        (S1, DCMI_STREAM | cr | ENABLE),
    ] {
        dma.write(2, register, value).unwrap();
    }
    (dma, Memory::new())
}

#[test]
fn a_stream_counts_down_raises_half_and_complete_and_stops() {
    let (mut dma, mut memory) = camera_stream(4, 0);
    let mut flags = Vec::new();
    for word in 0..4 {
        assert!(dma.store(&mut memory, Request::Dcmi, 0x100 + word));
        flags.push(dma.read(2, 0).unwrap());
    }
    assert_eq!(flags, [0, HT_S1, HT_S1, HT_S1 | TC_S1]);
    assert_eq!(dma.read(2, S1).unwrap() & ENABLE, 0);
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 0);
    assert_eq!(memory.read32(SRAM + 12), Some(0x103));
    assert!(!dma.store(&mut memory, Request::Dcmi, 0));
}

#[test]
fn a_circular_stream_begins_again_at_its_address() {
    let (mut dma, mut memory) = camera_stream(2, CIRCULAR);
    for word in 0..3 {
        dma.store(&mut memory, Request::Dcmi, word);
    }
    assert_eq!(memory.read32(SRAM), Some(2));
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 1);
}

#[test]
fn double_buffering_toggles_the_target_and_raises_complete_at_each_end() {
    let (mut dma, mut memory) = camera_stream(2, DOUBLE_BUFFER);
    let target = |dma: &Dma| dma.read(2, S1).unwrap() & CURRENT_TARGET != 0;
    assert!(!target(&dma));
    for word in 1..=2 {
        dma.store(&mut memory, Request::Dcmi, word);
    }
    assert!(target(&dma));
    assert_ne!(dma.read(2, 0).unwrap() & TC_S1, 0);
    dma.write(2, 0x08, TC_S1 | HT_S1).unwrap();
    assert_eq!(dma.read(2, 0).unwrap(), 0);
    for word in 3..=4 {
        dma.store(&mut memory, Request::Dcmi, word);
    }
    assert!(!target(&dma));
    assert_ne!(dma.read(2, 0).unwrap() & TC_S1, 0);
    let words = [SRAM, SRAM + 4, SRAM + 0x100, SRAM + 0x104].map(|at| memory.read32(at).unwrap());
    assert_eq!(words, [1, 2, 3, 4]);
}

#[test]
fn only_the_idle_one_of_two_buffers_may_be_moved_while_the_stream_runs() {
    let (mut dma, _) = camera_stream(2, DOUBLE_BUFFER);
    dma.write(2, S1 + 16, SRAM + 0x200).unwrap();
    assert_eq!(dma.read(2, S1 + 16).unwrap(), SRAM + 0x200);
    dma.write(2, S1 + 12, SRAM + 0x300).unwrap();
    assert_eq!(dma.read(2, S1 + 12).unwrap(), SRAM);
    assert_eq!(dma.read(2, 0).unwrap(), TRANSFER_ERROR << 6);
    assert_eq!(dma.read(2, S1).unwrap() & ENABLE, 0);
}

#[test]
fn core_coupled_memory_is_out_of_reach_and_raises_a_transfer_error() {
    let (mut dma, mut memory) = camera_stream(2, 0);
    dma.write(2, S1, 0).unwrap();
    dma.write(2, 0x08, u32::MAX).unwrap();
    dma.write(2, S1 + 12, CCM).unwrap();
    dma.write(2, S1, DCMI_STREAM | ENABLE | 1 << 2).unwrap();
    assert!(!dma.store(&mut memory, Request::Dcmi, 7));
    assert_eq!(dma.read(2, 0).unwrap(), TRANSFER_ERROR << 6);
    let mut lines = Lines::default();
    dma.drive(&mut lines);
    assert!(lines.is_high(57));
}

#[test]
fn a_stream_on_another_channel_does_not_serve_the_request() {
    let mut dma = Dma::new();
    // DMA2 stream 2, channel 5: USART6_RX, not USART1_RX (channel 4).
    let s2 = 0x10 + 2 * 0x18;
    dma.write(2, s2 + 4, 8).unwrap();
    dma.write(2, s2 + 8, 0x4001_1404).unwrap();
    dma.write(2, s2 + 12, SRAM).unwrap();
    dma.write(2, s2, 5 << 25 | MEMORY_INCREMENT | ENABLE)
        .unwrap();
    let mut memory = Memory::new();
    assert!(!dma.store(&mut memory, Request::UsartReceive(1), 1));
    assert!(dma.store(&mut memory, Request::UsartReceive(6), 1));
}

#[test]
fn a_stream_that_points_at_another_register_is_refused() {
    let mut dma = Dma::new();
    dma.write(2, S1 + 4, 8).unwrap();
    dma.write(2, S1 + 8, 0x4001_1404).unwrap();
    let refused = dma.write(2, S1, DCMI_STREAM | ENABLE);
    assert_eq!(
        refused,
        Err(Refusal::DmaAddress {
            controller: 2,
            stream: 1,
            peripheral_address: 0x4001_1404,
            data_register: DCMI_DR,
        })
    );
}

#[test]
fn switching_a_stream_off_raises_complete_and_keeps_the_count() {
    let (mut dma, mut memory) = camera_stream(8, 0);
    dma.store(&mut memory, Request::Dcmi, 1);
    dma.write(2, S1, DCMI_STREAM).unwrap();
    assert_eq!(dma.read(2, 0).unwrap(), TC_S1);
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 7);
}

#[test]
fn settings_of_a_running_stream_are_locked() {
    let (mut dma, _) = camera_stream(8, 0);
    dma.write(2, S1 + 4, 3).unwrap();
    dma.write(2, S1, ENABLE | 1 << 4).unwrap();
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 8);
    assert_eq!(dma.read(2, S1).unwrap(), DCMI_STREAM | ENABLE | 1 << 4);
}

#[test]
fn a_refused_transfer_stops_the_stream_and_keeps_the_count() {
    let (mut dma, mut memory) = camera_stream(8, DOUBLE_BUFFER | 1 << 2);
    dma.store(&mut memory, Request::Dcmi, 1);
    dma.fail(2, 1);
    assert_eq!(dma.read(2, S1).unwrap() & ENABLE, 0);
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 7);
    assert_eq!(dma.read(2, 0).unwrap(), TRANSFER_ERROR << 6);
    let mut lines = Lines::default();
    dma.drive(&mut lines);
    assert!(lines.is_high(57));
    assert!(!dma.store(&mut memory, Request::Dcmi, 2));
}

#[test]
fn a_stream_that_is_off_has_no_transfer_to_refuse() {
    let mut dma = Dma::new();
    dma.fail(2, 1);
    dma.fail(2, 8);
    assert_eq!(dma.read(2, 0).unwrap(), 0);
}

#[test]
fn a_stalled_controller_serves_nobody_and_forgets_nothing() {
    let (mut dma, mut memory) = camera_stream(8, 0);
    dma.stall(2, true);
    assert!(!dma.store(&mut memory, Request::Dcmi, 1));
    assert_eq!(dma.read(2, S1 + 4).unwrap(), 8);
    dma.stall(2, false);
    assert!(dma.store(&mut memory, Request::Dcmi, 1));
}

proptest! {
    #[test]
    fn words_at_once_leave_what_words_one_by_one_leave(
        count in 1..12_u32,
        cr in prop::sample::select(vec![0, CIRCULAR, DOUBLE_BUFFER]),
        lines in prop::collection::vec(0..9_usize, 0..6),
    ) {
        let (mut one_by_one, mut memory) = camera_stream(count, cr);
        let (mut at_once, mut other_memory) = camera_stream(count, cr);
        for (line, words) in (1..).zip(lines) {
            let bytes: Vec<u8> = (0..4 * words as u8).map(|byte| 32 * line + byte).collect();
            let mut rest = &bytes[..];
            while let Some((word, behind)) = rest.split_first_chunk() {
                let stored = at_once.store_words(&mut other_memory, Request::Dcmi, rest);
                if stored > 0 {
                    rest = &rest[stored..];
                } else {
                    let word = u32::from_le_bytes(*word);
                    at_once.store(&mut other_memory, Request::Dcmi, word);
                    rest = behind;
                }
            }
            for word in bytes.as_chunks().0 {
                one_by_one.store(&mut memory, Request::Dcmi, u32::from_le_bytes(*word));
            }
            for register in (0..0x40).step_by(4) {
                prop_assert_eq!(one_by_one.read(2, register), at_once.read(2, register));
            }
            prop_assert!(memory.sram() == other_memory.sram());
        }
    }
}

#[test]
fn a_line_of_words_is_moved_at_once_up_to_the_next_flag() {
    let (mut dma, mut memory) = camera_stream(12, 0);
    // Half of twelve: the sixth word raises a flag.
    assert_eq!(dma.store_words(&mut memory, Request::Dcmi, &[7; 40]), 20);
    assert_eq!(dma.store_words(&mut memory, Request::Dcmi, &[7; 40]), 0);
}
