//! One condition: the emulated chip and the firmware's pilot, frame by frame.

use fake_sensors::camera::tcm8230::{Edge, GAMMA, OUTPUT, SYNC, Tcm8230};
use fake_sensors::camera::{Exposure, FRAME_BYTES, HEIGHT, ImageSensor, PanoramicLens};
use nav::{CalibrationError, ExposureParameters};
use pilot::{Parameters, Pilot};
use sensor::tcm8230::SETTLING_FRAMES;

use super::scene::{Band, SEED, form};
use super::{Condition, FRAMES, Outcome, SET_POINT, Scene, TOLERANCE};
use crate::board::native::EXTCLK_HZ;

/// When reset is released, and when the driver writes its registers, nanoseconds.
const RELEASE_NS: u64 = 1_000_000;
const SET_UP_NS: u64 = 6_000_000;
/// The chip's gamma (data sheet, GAMSW).
const GAMMA_ON: f32 = 0.55;
/// The settings at the ends of the sensor's range.
const DARKEST: Exposure = Exposure {
    lines: 1,
    gain: 1.0,
};
const BRIGHTEST: Exposure = Exposure {
    lines: 525,
    gain: 16.0,
};

/// Looks at a scene in a condition for [`FRAMES`] frames.
///
/// # Errors
/// [`CalibrationError`] if the pilot refuses its default lens.
pub fn expose(condition: &Condition, scene: &Scene) -> Result<Outcome, CalibrationError> {
    let mut pilot = Pilot::new(&Parameters {
        exposure: exposure_parameters(condition),
        ..Parameters::DEFAULT
    })?;
    let mut chip = set_up(condition);
    let mut sensor = ImageSensor::new(&PanoramicLens::default(), SEED);
    sensor.set_light(scene.light(condition.needs_lines));
    let band = Band::new();
    let mut frame = Box::new([0; FRAME_BYTES]);
    let mut settling = SETTLING_FRAMES;
    let mut lumas = Vec::new();
    while let (true, Some(due_ns)) = (lumas.len() < FRAMES, chip.next_edge()) {
        match chip.take_edge(due_ns) {
            Some(Edge::FrameStart { number }) => {
                sensor.set_tuning(chip.tuning());
                form(
                    &mut sensor,
                    scene.radiance(),
                    chip.exposure(),
                    number,
                    &mut frame,
                );
            }
            Some(Edge::Line(row)) if row + 1 == HEIGHT => {
                if settling > 0 {
                    settling -= 1;
                    continue;
                }
                lumas.push(band.luma(&frame));
                if let Some(wanted) = pilot.on_frame(&frame).exposure {
                    chip.write_exposure(due_ns, wanted.shutter_lines, wanted.gain);
                }
            }
            _ => {}
        }
    }
    let mut luma = |exposure| {
        form(&mut sensor, scene.radiance(), exposure, 0, &mut frame);
        band.luma(&frame)
    };
    Ok(Outcome {
        condition: condition.clone(),
        is_reachable: luma(DARKEST) < SET_POINT + TOLERANCE
            && luma(BRIGHTEST) > SET_POINT - TOLERANCE,
        lumas,
    })
}

/// What the firmware flies with, but for what the condition says of gamma and start.
fn exposure_parameters(condition: &Condition) -> ExposureParameters {
    ExposureParameters {
        gamma: if condition.gamma { GAMMA_ON } else { 1.0 },
        initial: nav::Exposure {
            shutter_lines: condition.initial_lines,
            gain: condition.initial_gain,
        },
        ..Parameters::DEFAULT.exposure
    }
}

/// A chip as a driver brings it up; gamma is the condition's, all else as after reset.
fn set_up(condition: &Condition) -> Tcm8230 {
    let mut chip = Tcm8230::new(condition.exposure_latency());
    chip.set_clock(0, Some(EXTCLK_HZ));
    chip.set_reset(RELEASE_NS, true);
    let gamma = if condition.gamma { 0x00 } else { 0x80 };
    for (register, value) in [(SYNC, 0x48), (GAMMA, gamma)] {
        chip.write_register(SET_UP_NS, register, value);
    }
    let initial = condition.initial();
    chip.write_exposure(SET_UP_NS, initial.lines, initial.gain);
    chip.write_register(SET_UP_NS, OUTPUT, 0x20);
    chip
}
