//! The lens record on its page of flash, as the firmware finds it at boot.

use std::sync::OnceLock;

use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::camera::{PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use hil::board::camera::Camera;
use hil::board::emulated::{Emulated, Firmware};
use hil::board::native::{EXTCLK_HZ, Native};
use hil::board::{Board, FirmwareLog};
use hil::image;
use hil::scenario::LensPage;
use nalgebra::{UnitQuaternion, Vector3};
use nav::LensCalibration;
use pilot::{Parameters, Pilot};

/// Long enough for three frames after those that a sensor needs to settle.
const LOOK_MS: u32 = 300;

/// The chip's sector 11 (RM0090 table 5): what users are told to program.
const LAST_SECTOR: u32 = 0x080e_0000;

fn elf() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| {
        let path = image::build(&|line| eprintln!("{line}")).expect("the firmware builds");
        std::fs::read(path).expect("the image is there")
    })
}

fn camera(chip: Tcm8230) -> Camera {
    let world = World::named("arena-panels", 1).expect("a world");
    let optics = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let pose = Pose {
        position_m: Vector3::new(-1.0, 0.4, 0.5),
        attitude: UnitQuaternion::identity(),
    };
    Camera::new(chip, optics, pose)
}

/// What the board logs from power-on.
fn log_of(board: &mut dyn Board) -> Vec<FirmwareLog> {
    let mut log = Vec::new();
    for _ in 0..LOOK_MS {
        board.advance().expect("the board goes on");
    }
    board.drain_log(&mut log);
    log
}

fn emulated(page: Option<LensPage>) -> Vec<FirmwareLog> {
    let firmware = Firmware::parse(elf()).expect("an image").with_lens(page);
    let mut board = Emulated::boot(&firmware, camera(Tcm8230::default())).expect("a boot");
    log_of(&mut board)
}

fn native(lens: LensCalibration) -> Vec<FirmwareLog> {
    let parameters = Parameters {
        lens,
        ..Parameters::DEFAULT
    };
    let pilot = Pilot::new(&parameters).expect("a lens");
    let first = pilot.exposure();
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, first.shutter_lines, first.gain);
    log_of(&mut Native::new(pilot, camera(chip)))
}

/// What the log says of the lens record: level and text.
fn lens_lines(log: &[FirmwareLog]) -> Vec<(&'static str, &str)> {
    let lines = log.iter().filter_map(|record| match record {
        FirmwareLog::Line { level, text, .. } => {
            Some((*level, text.strip_prefix("lens record: ")?))
        }
        _ => None,
    });
    lines.collect()
}

/// The bits of the mean luma of every frame.
fn lumas(log: &[FirmwareLog]) -> Vec<u32> {
    let frames = log.iter().filter_map(|record| match record {
        FirmwareLog::Frame(frame) => Some(frame.luma.to_bits()),
        _ => None,
    });
    let lumas: Vec<u32> = frames.collect();
    assert!(lumas.len() >= 3, "{} frames", lumas.len());
    lumas
}

/// Far enough from the default that every frame shows it.
fn other_lens() -> LensCalibration {
    LensCalibration {
        centre_px: (66.0, 49.0),
        outer_radius_px: 38.5,
        ..LensCalibration::DEFAULT
    }
}

#[test]
fn a_good_record_is_the_lens_that_flies_and_the_log_has_its_figures() {
    let log = emulated(Some(LensPage::of(&other_lens())));
    let said = "centre 66.0 49.0 px, band 18.0 to 38.5 px, horizon 30.0 px";
    assert_eq!(lens_lines(&log), [("info", said)]);
    let seen = lumas(&log);
    assert_eq!(seen, lumas(&native(other_lens())));
    assert_ne!(seen, lumas(&native(LensCalibration::DEFAULT)));
}

#[test]
fn an_erased_page_means_the_default_lens_and_the_log_says_so() {
    let log = emulated(None);
    let said = "none, the default lens is taken";
    assert_eq!(lens_lines(&log), [("info", said)]);
    assert_eq!(lumas(&log), lumas(&native(LensCalibration::DEFAULT)));
}

#[test]
fn a_damaged_record_means_the_default_lens_and_the_log_warns() {
    let mut bytes = *LensPage::of(&other_lens()).bytes();
    bytes[17] ^= 0x10;
    let log = emulated(Some(LensPage::new(bytes)));
    let said = "Damaged, the default lens is taken";
    assert_eq!(lens_lines(&log), [("warn", said)]);
    assert_eq!(lumas(&log), lumas(&native(LensCalibration::DEFAULT)));
}

#[test]
fn an_impossible_lens_under_a_good_checksum_is_not_taken_either() {
    let lens = LensCalibration {
        centre_px: (64.0, 60.0),
        ..LensCalibration::DEFAULT
    };
    let log = emulated(Some(LensPage::of(&lens)));
    let said = "Impossible(RingOutsideFrame), the default lens is taken";
    assert_eq!(lens_lines(&log), [("warn", said)]);
    assert_eq!(lumas(&log), lumas(&native(LensCalibration::DEFAULT)));
}

#[test]
fn the_page_is_the_chips_last_sector() {
    let firmware = Firmware::parse(elf()).expect("an image");
    assert_eq!(firmware.lens_page_address().expect("a page"), LAST_SECTOR);
}
