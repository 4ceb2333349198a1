extern crate std;

mod model;

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use model::{Band, Sensor};

/// Shutters and gains from one end of the sensor's range to the other.
const SHUTTERS: [u16; 7] = [1, 2, 7, 40, 135, 300, 525];
const GAINS: [f32; 3] = [1.0, 4.0, 16.0];

fn parameters(gamma: f32, shutter_lines: u16, gain: f32) -> ExposureParameters {
    ExposureParameters {
        gamma,
        initial: Exposure {
            shutter_lines,
            gain,
        },
        ..ExposureParameters::DEFAULT
    }
}

/// The band's mean luma on frames 1, 2, ... as the controller sees them.
fn run(mut controller: ExposureController, sensor: &mut Sensor, frames: usize) -> Vec<f32> {
    (0..frames)
        .map(|_| {
            let (mean, histogram) = sensor.frame(controller.current());
            controller.update(mean, || histogram);
            mean
        })
        .collect()
}

fn holds_from_frame_10(lumas: &[f32]) -> bool {
    lumas[9..].iter().all(|luma| (luma - 80.0).abs() <= 3.0)
}

#[test]
fn it_arrives_within_10_frames_from_every_setting_in_light_of_three_decades() {
    let band = Band::of_texture(0.6, 1);
    for latency in 1..=3 {
        for gamma in [0.55, 1.0] {
            for step in 0..=4 {
                let needed = 2.0 * libm::powf(1000.0, 0.25 * step as f32);
                for (lines, gain) in SHUTTERS.iter().flat_map(|l| GAINS.map(|g| (*l, g))) {
                    let parameters = parameters(gamma, lines, gain);
                    let mut sensor = Sensor::new(&band, needed, &parameters, latency);
                    let lumas = run(ExposureController::new(parameters), &mut sensor, 30);
                    assert!(
                        holds_from_frame_10(&lumas),
                        "latency {latency}, gamma {gamma}, {needed} lines are needed, from {lines} x {gain}: {lumas:?}"
                    );
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::default())]

    #[test]
    fn it_arrives_within_10_frames_whatever_the_band_shows(
        contrast in 0.0_f32..1.2,
        bright_share in 0.0_f32..0.2,
        times_brighter in 1.0_f32..20.0,
        decades in 0.0_f32..3.0,
        lines in 1_u16..=525,
        gain in 1.0_f32..16.0,
        latency in 1_usize..=3,
        gamma_is_on: bool,
        seed in 1_u32..1000,
    ) {
        let gamma = if gamma_is_on { 0.55 } else { 1.0 };
        let parameters = parameters(gamma, lines, gain);
        let band = Band::of_texture(contrast, seed).with_bright_part(bright_share, times_brighter);
        let needed = 2.0 * libm::powf(10.0, decades);
        let mut sensor = Sensor::new(&band, needed, &parameters, latency);
        let lumas = run(ExposureController::new(parameters), &mut sensor, 30);
        prop_assert!(holds_from_frame_10(&lumas), "{needed}: {lumas:?}");
    }
}

#[test]
fn the_factor_upwards_is_exact_also_where_samples_clip_on_the_way() {
    // Half of the band at 20 above black, a quarter at 2, a quarter at 100: at k = 1.5 it is
    // (2 x 30 + 3 + 150) / 4 = 53.25 above black; at k = 6 it is (2 x 120 + 12 + 243) / 4 = 123.75.
    let mut histogram = LumaHistogram::new();
    for luma in [32, 32, 14, 112] {
        histogram.add(luma);
    }
    for (wanted, factor) in [(12.0 + 53.25, 1.5), (12.0 + 123.75, 6.0)] {
        let scale = LumaScale {
            black: 12.0,
            clipped_from: 250,
            wanted,
        };
        let found = histogram.correction(&scale).unwrap().factor;
        assert!((found - factor).abs() < 1e-4, "{found} instead of {factor}");
    }
}

#[test]
fn downwards_clipped_samples_count_as_clipped_and_too_many_of_them_ask_for_all() {
    let scale = LumaScale {
        black: 12.0,
        clipped_from: 250,
        wanted: 80.0,
    };
    let factor = |clipped: usize, at_100: usize| {
        let mut histogram = LumaHistogram::new();
        (0..clipped).for_each(|_| histogram.add(255));
        (0..at_100).for_each(|_| histogram.add(112));
        histogram.correction(&scale).unwrap().factor
    };
    // 10 x 68 = 1 x 243 + 9 x k x 100.
    assert!((factor(1, 9) - (680.0 - 243.0) / 900.0).abs() < 1e-5);
    // 10 x 68 < 3 x 243.
    assert_eq!(factor(3, 7), 0.0);
    assert_eq!(factor(10, 0), 0.0);
    assert_eq!(LumaHistogram::new().correction(&scale), None);
}

fn uniform(luma: u8) -> LumaHistogram {
    let mut histogram = LumaHistogram::new();
    (0..768).for_each(|_| histogram.add(luma));
    histogram
}

#[test]
fn it_judges_a_change_when_it_shows_and_not_before() {
    for latency_frames in 1..=3 {
        let mut controller = ExposureController::new(ExposureParameters {
            latency_frames,
            ..ExposureParameters::DEFAULT
        });
        let changes: Vec<usize> = (1..=7)
            .filter(|_| controller.update(75.0, || uniform(75)).is_some())
            .collect();
        let expected: Vec<usize> = (1..=7).step_by(usize::from(latency_frames)).collect();
        assert_eq!(changes, expected);
    }
}

#[test]
fn within_the_dead_band_nothing_moves_and_no_histogram_is_made() {
    let mut controller = ExposureController::new(ExposureParameters::DEFAULT);
    for luma in [78.5, 80.0, 81.5] {
        assert_eq!(
            controller.update(luma, || unreachable!("nobody needs it")),
            None
        );
    }
}

#[test]
fn the_more_is_clipped_the_farther_down_it_goes() {
    let ratio = |clipped: usize| {
        let mut histogram = LumaHistogram::new();
        (0..clipped).for_each(|_| histogram.add(255));
        (clipped..100).for_each(|_| histogram.add(200));
        let controller = ExposureController::new(parameters(1.0, 135, 1.0));
        controller.ratio(&histogram).unwrap()
    };
    assert!((ratio(100) - 0.01).abs() < 1e-6);
    assert!((ratio(50) - libm::powf(100.0, -0.75)).abs() < 1e-6);
    // 188 above black are to be 68.
    assert!((ratio(0) - 68.0 / 188.0).abs() < 1e-6);
}

#[test]
fn an_initial_setting_with_needless_gain_is_exchanged_for_shutter() {
    let mut controller = ExposureController::new(parameters(1.0, 25, 8.0));
    let asked = controller.update(80.0, || uniform(80)).unwrap();
    assert_eq!((asked.shutter_lines, asked.gain), (135, 192.0 / 130.0));
    assert!((0..10).all(|_| controller.update(80.0, || uniform(80)).is_none()));
}

#[test]
fn below_one_period_the_gain_makes_up_for_the_fraction_of_a_line() {
    // 2.6 lines: two lines and 192/148 = 1.297; 100 Hz last 134.6 lines.
    let p = ExposureParameters::DEFAULT;
    let low = setting::setting(&p, 2.6);
    assert_eq!((low.shutter_lines, low.gain), (2, 192.0 / 148.0));
    let whole = setting::setting(&p, 100.0);
    assert_eq!((whole.shutter_lines, whole.gain), (100, 1.0));
}

#[test]
fn above_it_the_shutter_is_whole_periods_until_the_gain_is_at_its_ceiling() {
    // At 50 Hz mains 134.6, 269.2, 403.8 lines; at 60 Hz 112.2, 224.4, 336.5, 448.7.
    for (flicker_hz, product, lines, gain) in [
        (100.0, 135.0, 135, 1.0),
        (100.0, 202.0, 135, 1.5),
        (100.0, 404.0, 404, 1.0),
        (100.0, 808.0, 404, 2.0),
        (100.0, 404.0 * 16.0, 404, 16.0),
        (100.0, 500.0 * 16.0, 500, 16.0),
        (100.0, 1e9, 525, 16.0),
        (120.0, 112.0, 112, 1.0),
        (120.0, 449.0, 449, 1.0),
        (0.0, 500.0, 500, 1.0),
        (0.0, 1050.0, 525, 2.0),
    ] {
        let parameters = ExposureParameters {
            flicker_hz,
            ..ExposureParameters::DEFAULT
        };
        let found = setting::setting(&parameters, product);
        assert_eq!(found.shutter_lines, lines, "{flicker_hz} Hz, {product}");
        assert!((found.gain / gain - 1.0).abs() < 0.005, "{found:?}");
    }
    // At half the line time a period is 269 lines.
    let faster = ExposureParameters {
        line_time_s: 780.0 / 21e6,
        ..ExposureParameters::DEFAULT
    };
    assert_eq!(setting::setting(&faster, 404.0).shutter_lines, 269);
}

#[test]
fn parameters_that_no_sensor_can_have_move_nothing() {
    type Change = fn(&mut ExposureParameters);
    let mistakes: [Change; 16] = [
        |p| p.set_point = f32::NAN,
        |p| p.set_point = 300.0,
        |p| p.dead_band = f32::NAN,
        |p| p.black_level = 90.0,
        |p| p.black_level = f32::NEG_INFINITY,
        |p| p.clipped_from = 60,
        |p| p.gamma = 0.0,
        |p| p.gamma = f32::NAN,
        |p| p.line_time_s = f32::INFINITY,
        |p| p.flicker_hz = -100.0,
        |p| p.shutter_min_lines = 600,
        |p| p.shutter_min_lines = 0,
        |p| p.gain_max = f32::NAN,
        |p| p.gain_unity_code = 0,
        |p| p.ratio_limit = 0.0,
        |p| p.initial.gain = f32::INFINITY,
    ];
    for (index, mistake) in mistakes.iter().enumerate() {
        let mut parameters = ExposureParameters::DEFAULT;
        mistake(&mut parameters);
        let mut controller = ExposureController::new(parameters);
        for luma in [0, 60, 255] {
            let asked = controller.update(f32::from(luma), || uniform(luma));
            assert_eq!(asked, None, "mistake {index}");
        }
    }
}

proptest! {
    #[test]
    fn it_never_leaves_the_sensors_range_whatever_it_is_told(
        frames in prop::collection::vec((any::<f32>(), any::<u8>()), 1..60),
    ) {
        let mut controller = ExposureController::new(ExposureParameters::DEFAULT);
        for (mean, luma) in frames {
            let before = controller.current();
            let asked = controller.update(mean, || uniform(luma));
            let now = controller.current();
            prop_assert!((1..=525).contains(&now.shutter_lines));
            prop_assert!((1.0..=16.0).contains(&now.gain));
            prop_assert!(mean.is_finite() || asked.is_none());
            prop_assert_eq!(asked, (now != before).then_some(now));
        }
    }

    #[test]
    fn a_setting_is_one_that_the_sensor_has_and_as_bright_as_it_was_wanted(
        log_product in 0.0_f32..9.036,
        line_time_s in 20e-6_f32..300e-6,
        flicker_hz in prop::sample::select(std::vec![0.0_f32, 100.0, 120.0]),
    ) {
        let parameters = ExposureParameters {
            line_time_s,
            flicker_hz,
            ..ExposureParameters::DEFAULT
        };
        let product = libm::expf(log_product);
        let found = setting::setting(&parameters, product);
        let code = 192.0 / found.gain;
        prop_assert!((code - libm::roundf(code)).abs() < 1e-3);
        // Half a line, or where a line is much, half a step of the gain.
        let error = (found.product() - product).abs();
        prop_assert!(error <= (0.5 * found.gain).max(0.003 * product) * 1.001, "{:?}", found);
    }

    #[test]
    fn the_brighter_the_band_the_shorter_the_exposure(
        lumas in prop::collection::vec(0_u8..255, 40),
        brighter in 1_u8..60,
        which in 0_usize..40,
    ) {
        let scale = LumaScale { black: 12.0, clipped_from: 250, wanted: 80.0 };
        let factor = |lumas: &[u8]| {
            let mut histogram = LumaHistogram::new();
            lumas.iter().for_each(|luma| histogram.add(*luma));
            histogram.correction(&scale).unwrap().factor
        };
        let mut other = lumas.clone();
        other[which] = other[which].saturating_add(brighter);
        prop_assert!(factor(&other) <= factor(&lumas) * 1.000_01);
    }
}
