//! Claims about the wind from the spectra's closed forms.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector3;
use proptest::prelude::*;

use super::{Gust, Scales, Wind, WindModel};

/// The first `seconds` of wind, as deviations from its mean: along, across, up. The wind blows to the north.
fn turbulence(model: &WindModel, seed: u64, seconds: usize) -> Vec<[f64; 3]> {
    let mut wind = Wind::new(model, seed);
    (0..seconds * 1000)
        .map(|_| (wind.tick() - model.mean_m_s).into())
        .collect()
}

/// Mean of the product of values `lag` milliseconds apart.
fn correlation(values: &[[f64; 3]], axis: usize, lag: usize) -> f64 {
    let n = values.len() - lag;
    (0..n)
        .map(|k| values[k][axis] * values[k + lag][axis])
        .sum::<f64>()
        / n as f64
}

fn mean_and_error(values: Vec<f64>) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    (mean, (variance / n).sqrt())
}

/// To the north, 2 m/s.
fn breeze() -> WindModel {
    WindModel::new(2.0, PI, 0.2)
}

#[test]
fn the_scales_are_those_of_the_low_altitude_model() {
    // At 1000 ft the horizontal and the vertical components agree: 0.177 + 0.823 = 1.
    let top = Scales::at_height(304.8);
    assert!((top.horizontal_m - 304.8).abs() < 1e-9);
    assert!((top.vertical_share - 1.0).abs() < 1e-12);
    // At 10 ft: 10 / 0.18523^1.2 ft and 0.18523^0.4.
    let low = Scales::at_height(3.048);
    assert!((low.horizontal_m - 75.64 * 0.3048).abs() < 0.01);
    assert!((low.vertical_share - 0.5094).abs() < 1e-4);
    assert_eq!(low.vertical_m, 3.048);
}

#[test]
fn variances_and_correlations_are_the_closed_forms() {
    const SEEDS: u64 = 300;
    let model = breeze();
    let scales = Scales::at_height(model.height_m);
    let runs: Vec<_> = (0..SEEDS)
        .map(|seed| turbulence(&model, seed, 10))
        .collect();
    let (long_s, short_s) = (scales.horizontal_m / 2.0, scales.vertical_m / 2.0);
    let across = |t: f64, tau: f64| (-t / tau).exp() * (1.0 - t / (2.0 * tau));
    let sigma = 0.4_f64;
    let vertical = sigma * scales.vertical_share;
    for lag_ms in [0, 100, 500, 2000, 5000] {
        let t = lag_ms as f64 / 1000.0;
        let expected = [
            sigma.powi(2) * (-t / long_s).exp(),
            sigma.powi(2) * across(t, long_s),
            vertical.powi(2) * across(t, short_s),
        ];
        for (axis, expected) in expected.into_iter().enumerate() {
            let found = runs.iter().map(|run| correlation(run, axis, lag_ms));
            let (mean, error) = mean_and_error(found.collect());
            assert!(
                (mean - expected).abs() < 4.0 * error,
                "axis {axis}, {t} s: {mean} against {expected}, give or take {error}"
            );
        }
    }
}

#[test]
fn turbulence_is_in_full_swing_from_the_start() {
    const SEEDS: u64 = 4000;
    let model = breeze();
    let firsts: Vec<Vector3<f64>> = (0..SEEDS)
        .map(|seed| Wind::new(&model, seed).tick() - model.mean_m_s)
        .collect();
    let vertical = 0.4 * Scales::at_height(model.height_m).vertical_share;
    for (axis, sigma) in [0.4, 0.4, vertical].into_iter().enumerate() {
        let squares = firsts.iter().map(|first| first[axis] * first[axis]);
        let variance = squares.sum::<f64>() / SEEDS as f64;
        // Four standard errors of a variance: 4 sqrt(2 / n).
        assert!(
            (variance / (sigma * sigma) - 1.0).abs() < 0.09,
            "axis {axis}: {variance} against {sigma} squared"
        );
    }
}

#[test]
fn a_millisecond_changes_the_wind_by_what_the_correlation_allows() {
    let model = breeze();
    let scales = Scales::at_height(model.height_m);
    let values = turbulence(&model, 1, 300);
    let vertical = 0.4 * scales.vertical_share;
    // E (w(t + T) - w(t))² = 2 σ² (1 - ρ(T)): T/τ along and 3T/2τ across, for a short T.
    let expected = [
        2.0 * 0.16 * 0.002 / scales.horizontal_m,
        3.0 * 0.16 * 0.002 / scales.horizontal_m,
        3.0 * vertical * vertical * 0.002 / scales.vertical_m,
    ];
    for (axis, expected) in expected.into_iter().enumerate() {
        let steps = values.windows(2).map(|w| (w[1][axis] - w[0][axis]).powi(2));
        let (mean, _) = mean_and_error(steps.collect());
        // The next order is T/τ, a few thousandths; the mean of 300 000 squares is good to a quarter per cent.
        assert!(
            (mean / expected - 1.0).abs() < 0.015,
            "axis {axis}: {mean} against {expected}"
        );
    }
}

#[test]
fn wind_comes_from_where_it_is_said_to() {
    let from_the_west = WindModel::new(3.0, FRAC_PI_2, 0.0);
    assert!((from_the_west.mean_m_s - Vector3::new(0.0, -3.0, 0.0)).norm() < 1e-12);
    assert_eq!(Wind::new(&from_the_west, 1).tick(), from_the_west.mean_m_s);
}

#[test]
fn turbulence_turns_with_the_wind() {
    let to_the_north = turbulence(&breeze(), 7, 1);
    let to_the_west = turbulence(&WindModel::new(2.0, -FRAC_PI_2, 0.2), 7, 1);
    for ([x, y, z], [turned_x, turned_y, turned_z]) in to_the_north.into_iter().zip(to_the_west) {
        assert!((turned_y - x).abs() < 1e-12 && (turned_x + y).abs() < 1e-12);
        assert!((turned_z - z).abs() < 1e-12);
    }
}

#[test]
fn another_seed_is_another_wind() {
    assert_ne!(turbulence(&breeze(), 1, 1), turbulence(&breeze(), 2, 1));
}

#[test]
fn calm_air_stands_still() {
    let mut calm = Wind::new(&WindModel::calm(), 3);
    let mut windless = Wind::new(&WindModel::new(0.0, 1.0, 0.2), 3);
    for _ in 0..1000 {
        assert_eq!(calm.tick(), Vector3::zeros());
        assert_eq!(windless.tick().norm(), 0.0);
    }
}

#[test]
fn a_gust_rises_to_its_peak_and_is_gone() {
    let peak = Vector3::new(0.0, 2.0, 0.0);
    let gust = Gust {
        peak_m_s: peak,
        from_s: 1.0,
        rise_s: 0.5,
    };
    let mut wind = Wind::new(&WindModel::new(1.0, PI, 0.0).with_gust(gust), 1);
    let felt: Vec<_> = (0..2500)
        .map(|_| wind.tick() - Vector3::new(1.0, 0.0, 0.0))
        .collect();
    let at = |ms: usize| felt[ms].y;
    assert!(at(1000).abs() < 1e-12 && at(2000).abs() < 1e-12 && at(2499).abs() < 1e-12);
    assert!((at(1500) - 2.0).abs() < 1e-12);
    assert!((at(1250) - 1.0).abs() < 1e-12 && (at(1750) - 1.0).abs() < 1e-12);
}

proptest! {
    #[test]
    fn a_seed_repeats_every_bit_and_no_wind_is_absurd(
        speed in 0.0..10.0_f64,
        from in -PI..PI,
        intensity in 0.0..1.0_f64,
        height_m in 0.1..300.0_f64,
        seed: u64,
    ) {
        let model = WindModel { height_m, ..WindModel::new(speed, from, intensity) };
        let (mut one, mut other) = (Wind::new(&model, seed), Wind::new(&model, seed));
        for _ in 0..200 {
            let wind = one.tick();
            prop_assert_eq!(wind.map(f64::to_bits), other.tick().map(f64::to_bits));
            // Eight standard deviations.
            prop_assert!((wind - model.mean_m_s).amax() <= 8.0 * intensity * speed + 1e-9);
        }
    }
}
