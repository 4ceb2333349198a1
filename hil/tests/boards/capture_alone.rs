//! The capture without the rest of the firmware: an image that reads slowly, drops futures and drops
//! the capture, on the emulated board. The image is built first.

use emulator::time::Nanos;
use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::camera::{PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use hil::board::FirmwareLog;
use hil::board::camera::Camera;
use hil::board::emulated::Firmware;
use hil::board::native::EXTCLK_HZ;
use hil::board::sabotage::Sabotaged;
use hil::image;
use nalgebra::{UnitQuaternion, Vector3};

/// Longer than the image needs.
const PATIENCE: Nanos = Nanos::from_millis(1_500);

/// A camera that sends since time zero.
fn camera() -> Sabotaged {
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, 135, 1.0);
    let world = World::named("arena", 1).expect("a world");
    let optics = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let pose = Pose {
        position_m: Vector3::new(0.0, 0.0, 1.0),
        attitude: UnitQuaternion::identity(),
    };
    Sabotaged::new(Camera::new(chip, optics, pose), None)
}

/// What the image said, and how many frames the interface had taken whole when it said it.
fn told() -> Vec<(String, u64)> {
    let elf = image::build_example("capture_alone", &|line| eprintln!("{line}"));
    let elf = std::fs::read(elf.expect("the example builds")).expect("the image is there");
    let firmware = Firmware::parse(&elf).expect("an image");
    let mut machine = firmware.machine(camera()).expect("a board");
    let mut probe = firmware.probe().expect("a log");
    let (mut told, mut log) = (Vec::new(), Vec::new());
    while machine.now() < PATIENCE {
        let next = machine.now() + Nanos::from_millis(1);
        machine.run_until(next).expect("an image that goes on");
        probe.read(&mut machine, &mut log).expect("a log");
        for record in log.drain(..) {
            let text = match record {
                FirmwareLog::Line { text, .. } => text,
                other => format!("{other:?}"),
            };
            told.push((text, machine.dcmi_counters().frames_captured));
        }
    }
    told
}

#[test]
fn readers_are_told_the_truth_nothing_is_lost_by_cancelling_and_a_dropped_capture_is_still() {
    let told = told();
    let texts: Vec<&str> = told.iter().map(|(text, _)| text.as_str()).collect();
    assert_eq!(
        texts,
        [
            "quick: newest true, changed false, intact true",
            "steady: newest true, changed false, intact true",
            "slow: newest true, changed true, intact false",
            "missed true",
            "cancelled, then the next true",
            "dropped",
            "still",
            "again: newest true, changed false, intact true",
        ]
    );
    let captured = |text: &str| {
        told.iter()
            .find(|(told, _)| told == text)
            .map(|told| told.1)
    };
    assert_eq!(captured("dropped"), captured("still"));
}
