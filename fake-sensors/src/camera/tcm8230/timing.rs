//! The TCM8230MD's frame timing: pure functions of the external clock.
//!
//! The chip has no PLL, so everything scales with EXTCLK (data sheet, timing charts). Sub-QCIF is a
//! low-power mode: one output line slot lasts two scan lines (2 H), and a 4/5 vertical filter
//! leaves every fifth odd slot empty. Slots are counted from the rising edge of VD.
//!
//! With register 0x02 bit 7 (FPS) set the chip halves its pixel clock: pass half of EXTCLK.

use super::super::HEIGHT;

/// EXTCLK cycles per pixel clock (PCK = EXTCLK/2 with FPS = 0).
const EXTCLK_PER_PCK: u64 = 2;
/// Pixel clocks per scan line (1 H).
const PCK_PER_H: u64 = 780;
/// Scan lines per frame: an odd number, so a frame lasts 262.5 slots.
const H_PER_FRAME: u64 = 525;
/// EXTCLK cycles of one output line slot: 2 H.
const SLOT_CYCLES: u64 = 2 * PCK_PER_H * EXTCLK_PER_PCK;
/// Slots for which VD is high.
const ACTIVE_SLOTS: u64 = 254;
/// DCLK periods for which HD is high: two bytes per pixel, 128 pixels.
const DCLK_PER_LINE: u64 = 256;
/// EXTCLK cycles from the first byte of a line to the end of its last: DCLK = PCK in this mode.
const BURST_CYCLES: u64 = DCLK_PER_LINE * EXTCLK_PER_PCK;

/// EXTCLK cycles from one frame start to the next.
pub(super) const FRAME_CYCLES: u64 = H_PER_FRAME * PCK_PER_H * EXTCLK_PER_PCK;
/// EXTCLK cycles from frame start (VD rises) to frame end (VD falls).
pub(super) const ACTIVE_CYCLES: u64 = ACTIVE_SLOTS * SLOT_CYCLES;

/// The slot that carries image line `line` (0..96): 1, 3, 5, 7, (9 skipped), 11, ... 237.
#[must_use]
pub const fn line_slot(line: usize) -> u64 {
    let line = line as u64;
    1 + 10 * (line / 4) + 2 * (line % 4)
}

/// EXTCLK cycles from frame start to the end of the last byte of `line`.
pub(super) const fn line_end_cycles(line: usize) -> u64 {
    line_slot(line) * SLOT_CYCLES + BURST_CYCLES
}

/// Nanoseconds from frame start (VD rises) to the first byte of image line `line` (0..96).
#[must_use]
pub const fn line_offset_ns(line: usize, extclk_hz: u32) -> u64 {
    debug_assert!(line < HEIGHT);
    cycles_to_ns(line_slot(line) * SLOT_CYCLES, extclk_hz)
}

/// Nanoseconds for which one line's 256 bytes are clocked out.
#[must_use]
pub const fn line_burst_ns(extclk_hz: u32) -> u64 {
    cycles_to_ns(BURST_CYCLES, extclk_hz)
}

/// Nanoseconds from frame start to frame end: VD high.
#[must_use]
pub const fn frame_active_ns(extclk_hz: u32) -> u64 {
    cycles_to_ns(ACTIVE_CYCLES, extclk_hz)
}

/// Nanoseconds from one frame start to the next: 39.000 ms at 21 MHz.
#[must_use]
pub const fn frame_period_ns(extclk_hz: u32) -> u64 {
    cycles_to_ns(FRAME_CYCLES, extclk_hz)
}

/// Nanoseconds of one scan line (1 H), the unit of the shutter register.
#[must_use]
pub const fn exposure_line_ns(extclk_hz: u32) -> u64 {
    cycles_to_ns(PCK_PER_H * EXTCLK_PER_PCK, extclk_hz)
}

/// The time of the `cycles`-th clock edge, rounded up: an edge is never early.
pub(super) const fn cycles_to_ns(cycles: u64, extclk_hz: u32) -> u64 {
    (cycles as u128 * 1_000_000_000).div_ceil(extclk_hz as u128) as u64
}

/// Whole clock cycles within `ns`.
pub(super) const fn ns_to_cycles(ns: u64, extclk_hz: u32) -> u64 {
    (ns as u128 * extclk_hz as u128 / 1_000_000_000) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTCLK: u32 = 21_000_000;

    #[test]
    fn a_frame_lasts_39_ms_at_21_mhz() {
        assert_eq!(frame_period_ns(EXTCLK), 39_000_000);
    }

    #[test]
    fn a_line_of_exposure_lasts_74_3_us_at_21_mhz() {
        assert_eq!(exposure_line_ns(EXTCLK), 74_286);
    }

    #[test]
    fn ninety_six_lines_fill_the_slots_of_the_vertical_chart() {
        let slots: Vec<u64> = (0..HEIGHT).map(line_slot).collect();
        assert_eq!(slots[..9], [1, 3, 5, 7, 11, 13, 15, 17, 21]);
        assert_eq!(slots.len(), 96);
        assert_eq!(slots[95], 237);
        assert!(slots.iter().all(|slot| slot % 10 != 9));
    }

    #[test]
    fn first_to_last_line_takes_35_1_ms_and_the_gap_3_9_ms_at_21_mhz() {
        let skew = line_offset_ns(95, EXTCLK) - line_offset_ns(0, EXTCLK);
        assert_eq!(skew / 100_000, 350);
        let gap = frame_period_ns(EXTCLK) - skew;
        assert_eq!(gap / 100_000, 39);
    }

    #[test]
    fn a_line_of_256_bytes_is_clocked_out_in_24_4_us_at_21_mhz() {
        assert_eq!(line_burst_ns(EXTCLK), 24_381);
    }

    #[test]
    fn vertical_sync_is_low_for_eight_and_a_half_slots() {
        let low = frame_period_ns(EXTCLK) - frame_active_ns(EXTCLK);
        let slot_ns = 148_571;
        assert_eq!(low / (slot_ns / 2), 17);
    }

    #[test]
    fn converting_cycles_to_time_and_back_loses_nothing() {
        for hz in [12_000_000, 16_000_000, EXTCLK, 24_570_000] {
            for cycles in [0, 1, 2_000, 819_000, 123_456_789_012] {
                assert_eq!(ns_to_cycles(cycles_to_ns(cycles, hz), hz), cycles);
            }
        }
    }
}
