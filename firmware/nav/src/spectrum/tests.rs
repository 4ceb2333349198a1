use core::f32::consts::TAU;

use super::*;
use crate::horizon::BEARING_STEP_RAD;

fn signal(bearing: f32) -> f32 {
    let waves = (1_u8..=12).map(|k| {
        let k = f32::from(k);
        (30.0 / k) * libm::cosf(k * bearing + k * k)
    });
    90.0 + waves.sum::<f32>()
}

fn horizon(turn: f32) -> Horizon {
    let luma = core::array::from_fn(|n| signal(n as f32 * BEARING_STEP_RAD + turn));
    Horizon::new(luma, 0.0)
}

#[test]
fn a_and_b_are_those_of_the_fourier_series() {
    let view = Spectrum::of(&horizon(0.0));
    for (k, c) in (1_u8..).zip(view.coefficients()) {
        let k = f32::from(k);
        // cos(kθ + k²) = cos k² cos kθ - sin k² sin kθ.
        let (a, b) = (30.0 / k * libm::cosf(k * k), -30.0 / k * libm::sinf(k * k));
        assert!((c.re - a).abs() < 1e-3 && (-c.im - b).abs() < 1e-3);
    }
}

#[test]
fn turning_the_viewer_turns_the_spectrum() {
    let view = Spectrum::of(&horizon(0.0));
    for turn in [0.3, -1.0, 0.25 * TAU] {
        let turned = Spectrum::of(&horizon(turn));
        for (a, b) in view
            .rotated(turn)
            .coefficients()
            .iter()
            .zip(turned.coefficients())
        {
            assert!((a - b).l1_norm() < 1e-3);
        }
    }
}

#[test]
fn brightness_alone_is_nothing() {
    let view = Spectrum::of(&Horizon::new([200.0; BEARINGS], 0.0));
    assert!(view.coefficients().iter().all(|c| c.l1_norm() < 1e-4));
}

#[test]
fn a_nan_does_not_stay_hidden() {
    assert!(Spectrum::of(&horizon(0.0)).is_finite());
    assert!(!Spectrum::of(&Horizon::new([f32::NAN; BEARINGS], 0.0)).is_finite());
    assert!(!Spectrum::of(&Horizon::new([1.0; BEARINGS], f32::NAN)).is_finite());
}
