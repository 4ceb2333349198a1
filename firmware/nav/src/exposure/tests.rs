extern crate std;

use std::collections::VecDeque;
use std::vec::Vec;

use super::*;

/// A sensor that shows a setting some frames after it was written.
struct Sensor {
    /// Luma above black at exposure 1, gamma applied.
    light: f32,
    gamma: f32,
    black: f32,
    pipeline: VecDeque<Exposure>,
}

impl Sensor {
    fn new(light: f32, gamma: f32, latency: usize) -> Self {
        Self {
            light,
            gamma,
            black: 12.0,
            pipeline: VecDeque::from(std::vec![ExposureParameters::DEFAULT.initial; latency]),
        }
    }

    /// The next frame's mean luma, after `written` was written.
    fn frame(&mut self, written: Exposure) -> f32 {
        self.pipeline.push_back(written);
        let shown = self.pipeline.pop_front().unwrap();
        let exposure = self.light * shown.product();
        (self.black + 255.0 * libm::powf(exposure, self.gamma)).min(255.0)
    }
}

fn run(parameters: ExposureParameters, sensor: &mut Sensor, frames: usize) -> Vec<f32> {
    let mut controller = ExposureController::new(parameters);
    (0..frames)
        .map(|_| {
            let luma = sensor.frame(controller.current());
            controller.update(luma);
            luma
        })
        .collect()
}

#[test]
fn it_reaches_80_of_255_and_rests_there_at_any_light_and_latency() {
    for latency in 0..=3 {
        for gamma in [0.55, 1.0] {
            let parameters = ExposureParameters {
                gamma,
                ..ExposureParameters::DEFAULT
            };
            // From a cellar to a window: three decades.
            for light in [1e-4, 1e-3, 1e-2] {
                let mut sensor = Sensor::new(light, gamma, latency);
                let lumas = run(parameters, &mut sensor, 80);
                let resting = &lumas[60..];
                assert!(
                    resting.iter().all(|luma| (luma - 80.0).abs() <= 8.0),
                    "{latency} {gamma} {light}: {resting:?}"
                );
                assert!(resting.windows(2).all(|pair| pair[0] == pair[1]));
            }
        }
    }
}

#[test]
fn it_does_not_oscillate_where_the_gamma_is_not_the_assumed_one() {
    for (assumed, real) in [(0.55, 1.0), (1.0, 0.55)] {
        let parameters = ExposureParameters {
            gamma: assumed,
            ..ExposureParameters::DEFAULT
        };
        let mut sensor = Sensor::new(1e-3, real, 3);
        let lumas = run(parameters, &mut sensor, 120);
        assert!(lumas[80..].iter().all(|luma| (luma - 80.0).abs() <= 4.0));
        assert!(lumas[80..].windows(2).all(|pair| pair[0] == pair[1]));
    }
}

#[test]
fn it_waits_until_a_change_shows() {
    let mut controller = ExposureController::new(ExposureParameters::DEFAULT);
    let changes: Vec<_> = (0..12).map(|_| controller.update(30.0).is_some()).collect();
    let expected = [false, false, false, true].repeat(3);
    assert_eq!(changes, expected);
}

#[test]
fn the_shutter_comes_before_the_gain_and_both_keep_to_their_range() {
    let mut controller = ExposureController::new(ExposureParameters::DEFAULT);
    let mut before = controller.current();
    for _ in 0..100 {
        let Some(next) = controller.update(0.0) else {
            continue;
        };
        assert!(next.gain == 1.0 || next.shutter_lines == 525);
        assert!(next.product() <= 4.01 * before.product());
        before = next;
    }
    assert_eq!((before.shutter_lines, before.gain), (525, 16.0));
    for _ in 0..100 {
        if let Some(next) = controller.update(255.0) {
            before = next;
        }
    }
    assert_eq!((before.shutter_lines, before.gain), (1, 1.0));
}

#[test]
fn a_luma_that_is_not_finite_changes_nothing() {
    let mut controller = ExposureController::new(ExposureParameters::DEFAULT);
    for luma in [f32::NAN, f32::INFINITY].repeat(10) {
        assert_eq!(controller.update(luma), None);
    }
}
