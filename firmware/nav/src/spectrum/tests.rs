use proptest::prelude::*;

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

/// The definition, in double precision: c_k = 2/N Σ I_n e^{-ikθ_n}.
fn definition(horizon: &Horizon) -> [Complex<f64>; VIEW_FREQUENCIES] {
    core::array::from_fn(|index| {
        let terms = horizon.luma().into_iter().enumerate().map(|(n, luma)| {
            let angle = ((index + 1) * n) as f64 * (core::f64::consts::TAU / BEARINGS as f64);
            Complex::new(libm::cos(angle), -libm::sin(angle)) * f64::from(luma)
        });
        terms.sum::<Complex<f64>>() * (2.0 / BEARINGS as f64)
    })
}

fn is_near(a: &Complex<f32>, b: &Complex<f64>, tolerance: f64) -> bool {
    (f64::from(a.re) - b.re).abs() < tolerance && (f64::from(a.im) - b.im).abs() < tolerance
}

#[test]
fn the_coefficients_are_those_of_the_definition() {
    for turn in [0.0, 0.01, 1.0, -2.0] {
        let horizon = horizon(turn);
        let view = Spectrum::of(&horizon);
        for (a, b) in view.coefficients().iter().zip(&definition(&horizon)) {
            assert!(is_near(a, b, 1e-3), "{a} {b}");
        }
    }
}

#[test]
fn a_and_b_are_those_of_the_fourier_series() {
    // A horizon that is half bright and half dark: 4/πk in sine for each odd k, but that samples stand
    // for steps; their sum is that of a geometric series, 16 x 4/N / (1 - e^{-ikδ})
    // above the mean.
    let luma = core::array::from_fn(|n| if n < BEARINGS / 2 { 96.0 } else { 80.0 });
    let view = Spectrum::of(&Horizon::new(luma, 0.0));
    for (k, c) in (1_u8..).zip(view.coefficients()) {
        let half_step = 0.5 * f32::from(k) * BEARING_STEP_RAD;
        let (a, b) = match k % 2 {
            0 => (0.0, 0.0),
            // 1 / (1 - e^{-ix}) = ½ (1 - i cot ½x).
            _ => (0.25, 0.25 / libm::tanf(half_step)),
        };
        assert!((c.re - a).abs() < 1e-3 && (-c.im - b).abs() < 1e-3, "{k}");
    }
}

#[test]
fn turning_the_viewer_turns_the_spectrum() {
    let luma = horizon(0.0).luma();
    let view = Spectrum::of(&Horizon::new(luma, 0.0));
    for (steps, rest) in [(6, 0.0), (0, 0.02), (108, -0.024), (32, 0.01)] {
        let turn = steps as f32 * BEARING_STEP_RAD - rest;
        let turned = core::array::from_fn(|n| luma[(n + steps) % BEARINGS]);
        let turned = Spectrum::of(&Horizon::new(turned, rest));
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
    assert!(!Spectrum::of(&Horizon::new([1.0; BEARINGS], f32::NAN)).is_finite());
}

/// The transform of a well-kept library, in single precision, bins 1 to 9.
fn by_fft(horizon: &Horizon) -> [Complex<f32>; VIEW_FREQUENCIES] {
    let mut samples = horizon.luma();
    let bins = microfft::real::rfft_128(&mut samples);
    core::array::from_fn(|index| bins[index + 1] * (2.0 / BEARINGS as f32))
}

proptest! {
    #[test]
    fn folding_gives_what_a_fast_fourier_transform_gives(
        sums in prop::collection::vec(0_u16..=4080, BEARINGS),
    ) {
        let horizon = Horizon::from_sums(sums.try_into().unwrap(), 0.0);
        let view = Spectrum::of(&horizon);
        for (a, b) in view.coefficients().iter().zip(&by_fft(&horizon)) {
            // Factors off by 2^-14 and values of 74 rms: 0.003 at five times the root of 128.
            prop_assert!(libm::sqrtf((a - b).norm_sqr()) < 3e-3, "{a} {b}");
        }
    }
}

#[test]
fn no_horizon_is_too_bright_or_too_steep_for_the_sums() {
    for k in 1..=VIEW_FREQUENCIES {
        for phase in 0..BEARINGS {
            // As steep as can be: white where the wave is positive, black elsewhere.
            let sums = core::array::from_fn(|n| {
                let angle = (k * n + phase) as f32 * BEARING_STEP_RAD;
                if libm::cosf(angle) > 0.0 { 4080 } else { 0 }
            });
            let horizon = Horizon::from_sums(sums, 0.0);
            let view = Spectrum::of(&horizon);
            for (a, b) in view.coefficients().iter().zip(&by_fft(&horizon)) {
                assert!(
                    libm::sqrtf((a - b).norm_sqr()) < 0.01,
                    "{k} {phase}: {a} {b}"
                );
            }
        }
    }
}

#[test]
fn a_unit_is_as_long_as_one_and_points_where_it_should() {
    for thousandths in -4000..=4000 {
        let angle = f64::from(thousandths) * 1e-3;
        let unit = unit(angle as f32);
        let angle = f64::from(angle as f32);
        assert!((f64::from(unit.re) - libm::cos(angle)).abs() < 1.2e-7);
        assert!((f64::from(unit.im) - libm::sin(angle)).abs() < 1.2e-7);
    }
}
