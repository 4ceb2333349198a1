//! The image that would be flashed, on an emulated STM32F407, with faults at its camera's wires. The
//! image is built first.

use std::ops::RangeInclusive;
use std::sync::OnceLock;

use hil::board::emulated::Firmware;
use hil::camera_faults::{CameraFault, Phase, RECOVERY_LIMIT_MS, Row, soak, suffer, suffer_all};
use hil::image;

/// The image; a machine that cannot build it fails every test here.
fn firmware() -> &'static Firmware {
    static FIRMWARE: OnceLock<Firmware> = OnceLock::new();
    FIRMWARE.get_or_init(|| {
        let path = image::build(&|line| eprintln!("{line}")).expect("the firmware builds");
        let elf = std::fs::read(path).expect("the image is there");
        Firmware::parse(&elf).expect("an image")
    })
}

/// Half a second is 13 frames; the sensor is set up again meanwhile, and 200 ms are 5 frames.
const LONG: RangeInclusive<u64> = 13..=18;

/// The fault is noticed as `name`, costs so many frames, and is over in time; no frame that was not
/// sent whole is looked at.
fn costs(fault: CameraFault, name: &str, frames: RangeInclusive<u64>) {
    let row: Row = suffer(firmware(), fault, Phase::MIDDLE).expect("a board that goes on");
    assert_eq!(row.wrong_frames, 0, "{row:?}");
    assert_eq!(row.detected_as.as_deref(), Some(name), "{row:?}");
    let recovery_ms = row.recovery_ms.expect("a recovery");
    assert!(recovery_ms <= RECOVERY_LIMIT_MS, "{row:?}");
    let lost = row.frames_lost.expect("frames lost");
    assert!(frames.contains(&lost), "{row:?}");
    assert!(row.holds());
}

#[test]
fn a_vsync_lost_for_a_frame_costs_that_frame() {
    costs(CameraFault::LostVsync, "no vsync", 1..=1);
}

#[test]
fn a_vsync_lost_for_good_is_noticed_and_its_return_as_well() {
    // It falls within a frame.
    costs(CameraFault::LostVsyncLong, "missing lines, no vsync", LONG);
}

#[test]
fn of_two_frames_that_run_together_the_second_is_lost() {
    costs(CameraFault::StuckVsync, "no vsync", 1..=1);
}

#[test]
fn a_vsync_that_falls_within_a_frame_costs_that_frame() {
    costs(CameraFault::VsyncGlitch, "missing lines", 1..=1);
}

#[test]
fn a_short_line_costs_its_frame() {
    costs(CameraFault::ShortLine, "short line", 1..=1);
    costs(CameraFault::ShortByByte, "short line", 1..=1);
}

#[test]
fn a_line_that_is_missing_costs_its_frame() {
    costs(CameraFault::MissingLine, "missing lines", 1..=1);
}

#[test]
fn extra_bytes_cost_their_frame() {
    costs(CameraFault::ExtraBytes, "extra bytes", 1..=1);
    costs(CameraFault::ExtraByte, "extra bytes", 1..=1);
}

#[test]
fn a_last_line_that_is_short_or_long_costs_its_frame_and_is_named_once() {
    costs(CameraFault::ShortLastLine, "short line", 1..=1);
    costs(CameraFault::ExtraLastByte, "extra bytes", 1..=1);
}

#[test]
fn extra_bytes_in_every_line_are_noticed_and_over_when_they_are_gone() {
    costs(CameraFault::CodesOn, "extra bytes", LONG);
}

#[test]
fn a_frame_whose_bytes_are_all_there_but_not_in_place_is_lost() {
    costs(CameraFault::ShiftedLines, "short line", 1..=1);
}

#[test]
fn an_overrun_costs_its_frame() {
    costs(CameraFault::Overrun, "overrun", 1..=1);
}

#[test]
fn a_dma_error_costs_its_frame() {
    costs(CameraFault::DmaError, "dma error", 1..=1);
}

#[test]
fn a_dma_error_between_frames_costs_none() {
    costs(CameraFault::DmaErrorBetween, "dma error", 0..=0);
}

#[test]
fn a_frame_in_which_the_clock_stood_is_lost_and_the_next_with_it() {
    costs(CameraFault::StoppedClock, "stopped clock", 2..=2);
}

#[test]
fn a_clock_that_stands_for_long_is_no_signal() {
    costs(CameraFault::StoppedClockLong, "no signal", LONG);
}

#[test]
fn a_camera_that_was_unplugged_is_set_up_again() {
    costs(CameraFault::Unplugged, "no signal", LONG);
}

#[test]
fn a_camera_that_lost_contact_for_a_millisecond_is_set_up_again() {
    costs(CameraFault::UnpluggedBriefly, "no signal", 1..=5);
}

#[test]
fn a_missing_hsync_cuts_its_frame_short_and_is_no_signal() {
    costs(CameraFault::LostHsync, "missing lines, no signal", LONG);
}

#[test]
fn a_camera_recovers_in_time_wherever_in_a_frame_it_was_unplugged_and_whenever_it_returns() {
    for fault in [CameraFault::Unplugged, CameraFault::UnpluggedBriefly] {
        let row = suffer_all(firmware(), fault).expect("a board that goes on");
        assert!(row.holds(), "{row:?}");
    }
}

#[test]
fn every_frame_is_captured_at_30_frames_a_second_while_vision_runs() {
    let soak = soak(firmware(), 0.05, &mut |_| ()).expect("a board that goes on");
    assert!(soak.holds(), "{soak:?}");
    assert!(soak.frames_sent >= 85, "{soak:?}");
    assert!((29.5..=30.5).contains(&soak.fps), "{soak:?}");
}
