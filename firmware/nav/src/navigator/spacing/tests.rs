extern crate std;

use core::f64::consts::{SQRT_2, TAU};
use std::vec::Vec;

use super::*;
use crate::homing::FLAT_WEIGHTS;
use crate::horizon::{BEARINGS, Horizon};

/// SplitMix64, and Box and Muller's normal numbers from it.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self, sd: f32) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.uniform()));
        f64::from(sd) * radius * libm::cos(TAU * self.uniform())
    }
}

/// Flies a way step by step by an odometry that is off as the model says; the error at its end.
fn flown(drift: &Drift, way_m: f64, time_s: f64, random: &mut Random) -> [f64; 2] {
    const STEPS: u32 = 20;
    let (dx, dt) = (way_m / f64::from(STEPS), time_s / f64::from(STEPS));
    let (scale, bias) = (
        random.normal(drift.scale),
        random.normal(drift.turn_rad_per_s),
    );
    let mut heading = random.normal(drift.heading_rad);
    let mut error = [random.normal(drift.fix_m), random.normal(drift.fix_m)];
    let walk = libm::sqrt(f64::from(drift.walk_m2_per_s) * dt) as f32;
    for _ in 0..STEPS {
        heading += 0.5 * bias * dt;
        error[0] += dx * scale + random.normal(walk);
        error[1] += dx * heading + random.normal(walk);
        heading += 0.5 * bias * dt;
    }
    error
}

#[test]
fn the_deviations_are_rayleighs_quantiles() {
    // r² = -2 ln(1 - p): 39.35 % lie within one deviation, 86.47 % within two, 98.89 % within three.
    for (probability, deviations) in [(0.393_469, 1.0), (0.864_665, 2.0), (0.988_891, 3.0)] {
        assert!((deviations_within(probability) - deviations).abs() < 1e-3);
    }
    assert!((deviations_within(0.99) - 3.0349).abs() < 1e-3);
}

#[test]
fn of_ten_thousand_legs_no_more_end_outside_than_the_probability_leaves() {
    let mut random = Random(6);
    for (way_m, time_s) in [(0.5, 2.0), (2.0, 8.0), (5.0, 20.0), (9.0, 60.0)] {
        for probability in [0.9_f32, 0.99] {
            let radius =
                Drift::DEFAULT.sd_m(way_m as f32, time_s as f32) * deviations_within(probability);
            let legs = 10_000;
            let outside = (0..legs)
                .filter(|_| {
                    let error = flown(&Drift::DEFAULT, way_m, time_s, &mut random);
                    libm::hypot(error[0], error[1]) > f64::from(radius)
                })
                .count();
            // Three standard errors of the count.
            let expected = f64::from(legs) * (1.0 - f64::from(probability));
            assert!(
                (outside as f64) < expected + 3.0 * libm::sqrt(expected),
                "{way_m} m: {outside}"
            );
            assert!(
                outside as f64 > 0.2 * expected,
                "{way_m} m: {outside}, the bound is too wide"
            );
        }
    }
}

#[test]
fn the_deviation_along_the_worse_axis_is_that_of_the_legs() {
    let mut random = Random(7);
    for (way_m, time_s) in [(2.0, 8.0), (5.0, 10.0), (5.0, 60.0)] {
        let ends: Vec<_> = (0..10_000)
            .map(|_| flown(&Drift::DEFAULT, way_m, time_s, &mut random))
            .collect();
        let rms = |axis: usize| {
            let sum: f64 = ends.iter().map(|end| end[axis] * end[axis]).sum();
            libm::sqrt(sum / ends.len() as f64)
        };
        let worse = rms(0).max(rms(1));
        let said = f64::from(Drift::DEFAULT.sd_m(way_m as f32, time_s as f32));
        // A standard deviation from 10 000 draws is off by 0.7 %.
        assert!((said / worse - 1.0).abs() < 0.03, "{said} m, {worse} m");
    }
}

/// A view of one wave k on a circle of radius 1.
fn wave(k: f64) -> Spectrum {
    Spectrum::of(&Horizon::new(
        core::array::from_fn(|n| {
            (100.0 + 40.0 * libm::cos(k * n as f64 * TAU / BEARINGS as f64)) as f32
        }),
        0.0,
    ))
}

#[test]
fn the_catchment_of_a_wave_is_nearly_a_quarter_of_its_length() {
    // A move h along an axis shifts a cos(kθ) by h sin(θ): E = k² a² h² / 2, so that λ = k² a²; E∞ = 2 a².
    for k in [3.0, 5.0, 6.0] {
        let expected = (SQRT_2 / k) as f32;
        let found = catchment(&wave(k), &FLAT_WEIGHTS);
        assert!(
            (found / expected - 1.0).abs() < 0.02,
            "{k}: {found}, {expected}"
        );
    }
}

#[test]
fn a_view_of_broad_strokes_is_found_from_farther_away_and_darkness_from_nowhere() {
    let catchments: Vec<_> = [2.0, 3.0, 4.0, 5.0, 6.0]
        .map(|k| catchment(&wave(k), &FLAT_WEIGHTS))
        .into();
    assert!(
        catchments.windows(2).all(|pair| pair[0] >= pair[1]),
        "{catchments:?}"
    );
    assert!(
        catchments
            .iter()
            .all(|catchment| (0.0..=1.0).contains(catchment))
    );
    let dark = Spectrum::from_coefficients(Default::default());
    assert_eq!(catchment(&dark, &FLAT_WEIGHTS), 0.0);
}
