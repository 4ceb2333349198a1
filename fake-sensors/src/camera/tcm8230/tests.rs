use super::super::HEIGHT;
use super::super::TestPattern;
use super::*;

const EXTCLK_HZ: u32 = 21_000_000;
const FRAME_NS: u64 = 39_000_000;
/// Reset is released here in every test.
const RELEASE_NS: u64 = 1_000_000;
/// The first frame that starts after the driver's writes at `READY_NS`.
const FIRST_NS: u64 = RELEASE_NS + FRAME_NS;
const READY_NS: u64 = RELEASE_NS + 5_000_000;

fn released(latency: ExposureLatency) -> Tcm8230 {
    let mut chip = Tcm8230::new(latency);
    chip.set_clock(0, Some(EXTCLK_HZ));
    chip.set_reset(RELEASE_NS, true);
    chip
}

/// One write transfer; true: every byte was acknowledged.
fn transfer(chip: &mut Tcm8230, now_ns: u64, bytes: &[u8]) -> bool {
    let mut acknowledged = chip.i2c_start(now_ns, I2C_ADDRESS, false);
    for &byte in bytes {
        acknowledged &= chip.i2c_write(now_ns, byte);
    }
    chip.i2c_stop(now_ns);
    acknowledged
}

fn read(chip: &mut Tcm8230, now_ns: u64, address: u8, count: usize) -> Vec<u8> {
    transfer(chip, now_ns, &[address]);
    chip.i2c_start(now_ns, I2C_ADDRESS, true);
    let bytes = (0..count).map(|_| chip.i2c_read(now_ns)).collect();
    chip.i2c_stop(now_ns);
    bytes
}

fn enabled(latency: ExposureLatency) -> Tcm8230 {
    let mut chip = released(latency);
    assert!(transfer(&mut chip, READY_NS, &[OUTPUT, 0x20]));
    chip
}

fn next(chip: &mut Tcm8230) -> (u64, Edge) {
    let due_ns = chip.next_edge().unwrap();
    (due_ns, chip.take_edge(due_ns).unwrap())
}

/// Takes edges up to and with the next frame start.
fn next_frame(chip: &mut Tcm8230) -> (u64, u32) {
    loop {
        if let (at_ns, Edge::FrameStart { number }) = next(chip) {
            return (at_ns, number);
        }
    }
}

#[test]
fn the_bus_answers_2000_clocks_after_reset_and_not_before() {
    let mut chip = released(ExposureLatency::default());
    // 2000 / 21 MHz = 95.238 us.
    assert!(!chip.i2c_start(RELEASE_NS + 95_238, I2C_ADDRESS, false));
    assert!(chip.i2c_start(RELEASE_NS + 95_239, I2C_ADDRESS, false));
}

#[test]
fn the_bus_is_dead_in_reset_without_a_clock_and_at_other_addresses() {
    let mut chip = released(ExposureLatency::default());
    assert!(!chip.i2c_start(READY_NS, 0x30, false));
    chip.set_clock(READY_NS, None);
    assert!(!chip.i2c_start(READY_NS + 1, I2C_ADDRESS, false));
    chip.set_clock(READY_NS + 2, Some(EXTCLK_HZ));
    assert!(chip.i2c_start(READY_NS + 3, I2C_ADDRESS, false));
    chip.set_reset(READY_NS + 4, false);
    assert!(!chip.i2c_start(READY_NS + 5, I2C_ADDRESS, false));
}

#[test]
fn a_reset_pulse_of_less_than_100_clocks_leaves_the_chip_hung() {
    let mut chip = released(ExposureLatency::default());
    chip.set_reset(READY_NS, false);
    chip.set_reset(READY_NS + 4_000, true);
    assert!(!transfer(&mut chip, READY_NS + FRAME_NS, &[OUTPUT]));
    chip.set_reset(2 * FRAME_NS, false);
    chip.set_reset(2 * FRAME_NS + 5_000, true);
    assert!(transfer(&mut chip, 3 * FRAME_NS, &[OUTPUT]));
}

#[test]
fn registers_hold_the_data_sheets_defaults_and_the_pointer_moves_on() {
    let mut chip = released(ExposureLatency::default());
    let first = read(&mut chip, READY_NS, 0x00, 8);
    assert_eq!(first, [0x70, 0x10, 0x40, 0x80, 0x0f, 0x02, 0x0d, 0xc0]);
    assert_eq!(read(&mut chip, READY_NS, SYNC, 1), [0x68]);
    assert!(transfer(
        &mut chip,
        READY_NS,
        &[SHUTTER_HIGH, 0x81, 0x23, 0x60]
    ));
    assert_eq!(
        read(&mut chip, READY_NS, SHUTTER_HIGH, 3),
        [0x81, 0x23, 0x60]
    );
}

#[test]
fn a_soft_reset_restores_the_defaults_and_clears_itself() {
    let mut chip = released(ExposureLatency::default());
    transfer(&mut chip, READY_NS, &[GAMMA, 0x80]);
    transfer(&mut chip, READY_NS, &[RESET, 0x40]);
    assert_eq!(read(&mut chip, READY_NS, GAMMA, 1), [0x00]);
    assert_eq!(read(&mut chip, READY_NS, RESET, 1), [0x00]);
}

#[test]
fn nothing_comes_out_until_the_output_is_switched_on() {
    let mut chip = released(ExposureLatency::default());
    assert_eq!(chip.next_edge(), None);
    // Mid-frame: the first edge is the start of the next frame on the free-running grid.
    let late_ns = RELEASE_NS + 5 * FRAME_NS + FRAME_NS / 2;
    transfer(&mut chip, late_ns, &[OUTPUT, 0x20]);
    let start = Edge::FrameStart { number: 0 };
    assert_eq!(next(&mut chip), (RELEASE_NS + 6 * FRAME_NS, start));
}

#[test]
fn a_frame_is_a_start_96_lines_and_an_end_and_repeats_after_39_ms() {
    let mut chip = enabled(ExposureLatency::default());
    assert_eq!(next(&mut chip), (FIRST_NS, Edge::FrameStart { number: 0 }));
    for line in 0..HEIGHT {
        let (at_ns, edge) = next(&mut chip);
        let due = line_offset_ns(line, EXTCLK_HZ) + line_burst_ns(EXTCLK_HZ);
        assert_eq!(edge, Edge::Line(line));
        assert!(at_ns.abs_diff(FIRST_NS + due) <= 1);
    }
    let end_ns = FIRST_NS + frame_active_ns(EXTCLK_HZ);
    assert_eq!(next(&mut chip), (end_ns, Edge::FrameEnd));
    let start = Edge::FrameStart { number: 1 };
    assert_eq!(next(&mut chip), (FIRST_NS + FRAME_NS, start));
}

#[test]
fn frames_keep_their_grid_for_hours() {
    let mut chip = Tcm8230::streaming(0, EXTCLK_HZ, 100, 1.0);
    for number in 0..100_000_u64 {
        assert_eq!(next_frame(&mut chip), (number * FRAME_NS, number as u32));
        chip.engine.break_off();
    }
}

#[test]
fn half_rate_doubles_the_frame_period() {
    let mut chip = released(ExposureLatency::default());
    transfer(&mut chip, READY_NS, &[CLOCK, 0xc0, 0x20]);
    let (first_ns, _) = next_frame(&mut chip);
    assert_eq!(next_frame(&mut chip).0 - first_ns, 2 * FRAME_NS);
}

#[test]
fn the_first_frame_is_black_and_the_next_is_not() {
    let mut chip = enabled(ExposureLatency::default());
    next_frame(&mut chip);
    assert!(chip.black());
    next_frame(&mut chip);
    assert!(!chip.black());
}

#[test]
fn switching_the_output_off_stops_the_frame_in_progress() {
    let mut chip = enabled(ExposureLatency::default());
    next_frame(&mut chip);
    next(&mut chip);
    transfer(&mut chip, FIRST_NS + 1_000_000, &[OUTPUT, 0xa0]);
    assert_eq!(chip.next_edge(), None);
    transfer(&mut chip, FIRST_NS + 2_000_000, &[OUTPUT, 0x20]);
    let start = Edge::FrameStart { number: 1 };
    assert_eq!(next(&mut chip), (FIRST_NS + FRAME_NS, start));
}

#[test]
fn without_a_clock_the_frame_stands_still_and_goes_on_with_it() {
    let mut chip = enabled(ExposureLatency::default());
    next_frame(&mut chip);
    let due_ns = chip.next_edge().unwrap();
    chip.set_clock(FIRST_NS + 10_000, None);
    assert_eq!(chip.next_edge(), None);
    chip.set_clock(FIRST_NS + 1_010_000, Some(EXTCLK_HZ));
    assert_eq!(chip.next_edge(), Some(due_ns + 1_000_000));
}

#[test]
fn frames_go_on_counting_across_a_reset() {
    let mut chip = enabled(ExposureLatency::default());
    next_frame(&mut chip);
    chip.set_reset(FIRST_NS + 1_000_000, false);
    assert_eq!(chip.next_edge(), None);
    chip.set_reset(FIRST_NS + 2_000_000, true);
    chip.write_register(FIRST_NS + 3_000_000, OUTPUT, 0x20);
    assert_eq!(next_frame(&mut chip).1, 1);
}

/// Frame starts after a write until the frame that shows it.
fn frames_until_effect(latency: ExposureLatency) -> usize {
    let mut chip = enabled(latency);
    next_frame(&mut chip);
    chip.write_exposure(FIRST_NS + 1_000_000, 100, 2.0);
    let shows = |chip: &Tcm8230| chip.exposure().lines == 100 && chip.exposure().gain == 2.0;
    assert!(!shows(&chip));
    let mut frames = 0;
    while !shows(&chip) {
        next_frame(&mut chip);
        frames += 1;
    }
    frames
}

#[test]
fn a_new_shutter_shows_on_the_second_frame_after_the_write_unless_set_otherwise() {
    assert_eq!(frames_until_effect(ExposureLatency::default()), 2);
    assert_eq!(frames_until_effect(ExposureLatency::One), 1);
    assert_eq!(frames_until_effect(ExposureLatency::Three), 3);
}

#[test]
fn a_shutter_written_in_two_parts_across_vertical_sync_tears() {
    let mut chip = enabled(ExposureLatency::One);
    chip.write_exposure(READY_NS, 0x0ff, 1.0);
    next_frame(&mut chip);
    assert_eq!(chip.exposure().lines, 0x0ff);
    transfer(&mut chip, FIRST_NS + 1_000_000, &[SHUTTER_HIGH, 0x81]);
    next_frame(&mut chip);
    assert_eq!(chip.exposure().lines, 0x1ff);
    transfer(&mut chip, FIRST_NS + FRAME_NS + 1, &[SHUTTER_LOW, 0x00]);
    next_frame(&mut chip);
    assert_eq!(chip.exposure().lines, 0x100);
}

#[test]
fn writing_an_exposure_is_the_same_as_a_burst_on_the_bus() {
    let (mut direct, mut bus) = (enabled(ExposureLatency::One), enabled(ExposureLatency::One));
    direct.write_exposure(READY_NS, 0x123, 4.0);
    transfer(&mut bus, READY_NS, &[SHUTTER_HIGH, 0x81, 0x23, 0x30]);
    next_frame(&mut direct);
    next_frame(&mut bus);
    assert_eq!(direct.exposure(), bus.exposure());
    assert_eq!(
        read(&mut direct, FIRST_NS, 0x05, 3),
        read(&mut bus, FIRST_NS, 0x05, 3)
    );
}

#[test]
fn a_streaming_chip_is_what_a_driver_leaves_behind() {
    let mut chip = Tcm8230::streaming(0, EXTCLK_HZ, 135, 1.0);
    assert_eq!(chip.tuning(), ImageTuning::default());
    next_frame(&mut chip);
    assert_eq!(
        chip.exposure(),
        Exposure {
            lines: 135,
            gain: 1.0
        }
    );
}

#[test]
fn gain_codes_are_those_of_the_data_sheet() {
    for (code, gain) in [
        (0xc0, 1.0),
        (0x60, 2.0),
        (0x30, 4.0),
        (0x18, 8.0),
        (0x0c, 16.0),
    ] {
        assert_eq!(gain_of_code(code), gain);
        assert_eq!(code_of_gain(gain), code);
    }
    assert_eq!(code_of_gain(0.5), 0xc0);
    assert_eq!(code_of_gain(f32::NAN), 0xc0);
    assert_eq!(code_of_gain(100.0), 0x0c);
}

#[test]
fn a_reset_line_that_stays_high_changes_nothing() {
    let mut chip = enabled(ExposureLatency::default());
    next_frame(&mut chip);
    let due_ns = chip.next_edge();
    chip.set_reset(FIRST_NS + 10_000, true);
    assert_eq!(chip.next_edge(), due_ns);
}

#[test]
fn test_pictures_and_the_correction_of_bad_pixels_are_switched_by_their_bits() {
    let mut chip = enabled(ExposureLatency::default());
    assert_eq!(chip.tuning().test_pattern, None);
    assert!(chip.tuning().blemish_correction);
    for (sync, pattern) in [
        (0x4c, TestPattern::Bars),
        (0x4d, TestPattern::Ramp),
        (0x4e, TestPattern::RampBeforeGamma),
    ] {
        chip.write_register(FIRST_NS, SYNC, sync);
        assert_eq!(chip.tuning().test_pattern, Some(pattern));
    }
    chip.write_register(FIRST_NS, BLEMISH, 0x03);
    assert!(!chip.tuning().blemish_correction);
}
