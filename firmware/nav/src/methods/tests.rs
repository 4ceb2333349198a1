use core::f64::consts::{PI, TAU};

use nalgebra::Complex;
use proptest::prelude::*;

use super::*;

/// A place whose view has waves of 25 / k luma, k = 1..=12, round a mean of 90.
struct Place([f64; 12]);

impl Place {
    /// Random phases.
    fn new(seed: u64) -> Self {
        let mut state = seed;
        Self(core::array::from_fn(|_| {
            // Knuth's MMIX generator; its upper bits are the good ones.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            TAU * (state >> 32) as f64 / f64::from(u32::MAX)
        }))
    }

    /// The exact view after a move by h on the unit circle and a turn of the viewer:
    /// I_h(θ) = I(θ - asin(x sin θ - y cos θ)).
    fn view(&self, [x, y]: [f64; 2], turn: f64) -> Luma {
        core::array::from_fn(|n| {
            let theta = TAU * n as f64 / 128.0 + turn;
            let seen = theta - libm::asin(x * libm::sin(theta) - y * libm::cos(theta));
            let waves = (1_u8..).zip(&self.0).map(|(k, phase)| {
                let k = f64::from(k);
                25.0 / k * libm::cos(k * seen + phase)
            });
            (90.0 + waves.sum::<f64>()) as f32
        })
    }
}

const HERE: [f64; 2] = [0.0, 0.0];
const SEEDS: core::ops::Range<u64> = 1..15;

fn code(frequencies: u8, bits: u8) -> CoefficientCode {
    CoefficientCode {
        frequencies,
        bits,
        range: 1.0,
    }
}

fn fourier(iterations: u8, unknowns: Unknowns) -> Fourier {
    Fourier::new(FourierParameters {
        code: code(8, 8),
        power: 0.0,
        iterations,
        next_term: true,
        unknowns,
        alignment: Alignment::None,
    })
}

fn search(resolution: Resolution) -> Search {
    Search::new(SearchParameters {
        pixels: 32,
        low_pass: u8::MAX,
        directions: 36,
        distances: 3,
        farthest: 0.09,
        rotations: 0,
        resolution,
    })
}

fn mfdid(slope: Slope) -> Mfdid {
    Mfdid::new(MfdidParameters {
        pixels: 32,
        low_pass: 8,
        slope,
    })
}

fn warps(rotations: u8, polish: bool) -> WarpSearch {
    WarpSearch::new(WarpParameters {
        code: code(8, 8),
        power: 0.0,
        farthest: 0.8,
        rotations,
        rotation_step: 2,
        polish,
    })
}

/// The way from one view to another.
fn way<M: HomingMethod>(method: &M, current: &Luma, goal: &Luma) -> Homeward {
    let memory = method.remember(goal);
    assert_eq!(memory.len(), method.bytes());
    method.home(&method.see(current), &memory).unwrap()
}

/// Degrees between two vectors.
fn off(found: Vector2<f32>, [x, y]: [f64; 2]) -> f32 {
    found.angle(&Vector2::new(x as f32, y as f32)).to_degrees()
}

#[test]
fn three_iterations_of_fourier_homing_find_a_twentieth_of_the_distance() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let goal = place.view([0.05, -0.03], 0.0);
        let way = way(&fourier(3, Unknowns::Move), &place.view(HERE, 0.0), &goal);
        let error = way.displacement - Vector2::new(0.05, -0.03);
        // Second order of the linear model and half a count of each coefficient.
        assert!(error.norm() < 0.008, "seed {seed}: {way:?}");
    }
}

#[test]
fn with_a_third_unknown_a_turn_is_told_from_the_move() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let goal = place.view([0.05, -0.03], 0.1);
        let way = way(
            &fourier(5, Unknowns::MoveAndTurn),
            &place.view(HERE, 0.0),
            &goal,
        );
        let error = way.displacement - Vector2::new(0.05, -0.03);
        assert!(error.norm() < 0.012, "seed {seed}: {way:?}");
        assert!((way.rotation - 0.1).abs() < 0.012, "seed {seed}: {way:?}");
    }
}

#[test]
fn at_eight_frequencies_of_eight_bits_it_is_the_homing_that_flies() {
    use crate::homing::{self, HomingParameters};
    use crate::{Horizon, Snapshot, Spectrum};
    for seed in SEEDS {
        let place = Place::new(seed);
        let horizons = [HERE, [0.1, 0.05]].map(|h| Horizon::new(place.view(h, 0.0), 0.0));
        let [seen, stored] = horizons.each_ref().map(Spectrum::of);
        let [here, goal] = horizons.map(|horizon| horizon.luma());
        let parameters = HomingParameters {
            rotation_bound: 0,
            ..HomingParameters::DEFAULT
        };
        let flown = homing::home(&seen, &Snapshot::quantise(&stored), &parameters).unwrap();
        let here = way(&fourier(1, Unknowns::MoveAndTurn), &here, &goal);
        // The damping alone differs.
        assert!((here.displacement - flown.displacement).norm() < 1e-3);
        assert!((here.rotation - flown.rotation).abs() < 1e-3);
    }
}

#[test]
fn the_search_returns_the_nearest_of_its_guesses() {
    // 0.0583 at -31 degrees: among 0.03, 0.06, 0.09 and steps of 10 degrees that is 0.06 at -30.
    for resolution in [Resolution::Memory, Resolution::Full] {
        for seed in SEEDS {
            let place = Place::new(seed);
            let goal = place.view([0.05, -0.03], 0.0);
            let way = way(&search(resolution), &place.view(HERE, 0.0), &goal);
            let error = way.displacement - Vector2::new(0.052, -0.030);
            assert!(error.norm() < 0.012, "seed {seed}, {resolution:?}: {way:?}");
        }
    }
}

#[test]
fn a_filter_that_keeps_all_frequencies_takes_the_mean_alone() {
    for count in [4, 7, 10, 32] {
        let pixels: grey::Pixels = (0..count).map(|n| (37 * n % 29) as f32).collect();
        let mean = pixels.iter().sum::<f32>() / count as f32;
        let filtered = grey::LowPass::new(count, u8::MAX).curve(&pixels).value;
        for (before, after) in pixels.iter().zip(&filtered) {
            assert!(
                (before - mean - after).abs() < 1e-3,
                "{count}: {filtered:?}"
            );
        }
    }
}

#[test]
fn the_search_finds_a_turn_among_those_it_tries() {
    let place = Place::new(3);
    let turning = Search::new(SearchParameters {
        rotations: 3,
        ..search(Resolution::Full).parameters()
    });
    let goal = place.view([0.05, -0.03], 20_f64.to_radians());
    let way = way(&turning, &place.view(HERE, 0.0), &goal);
    assert!((way.rotation.to_degrees() - 20.0).abs() < 0.1, "{way:?}");
    assert!(off(way.displacement, [0.05, -0.03]) < 15.0, "{way:?}");
}

#[test]
fn gauss_newton_points_home_and_the_plain_gradient_less_so() {
    let mean_error = |slope| {
        let errors = SEEDS.map(|seed| {
            let place = Place::new(seed);
            let goal = place.view([0.05, -0.03], 0.0);
            let way = way(&mfdid(slope), &place.view(HERE, 0.0), &goal);
            off(way.displacement, [0.05, -0.03])
        });
        errors.sum::<f32>() / SEEDS.count() as f32
    };
    // The gradient is bent towards where the contrast is.
    let [descent, gauss_newton, newton] =
        [Slope::Descent, Slope::GaussNewton, Slope::Newton].map(mean_error);
    assert!(
        gauss_newton < 8.0 && newton < 8.0,
        "{gauss_newton}, {newton}"
    );
    assert!(descent > 1.5 * gauss_newton, "{descent}, {gauss_newton}");
    assert!(descent < 45.0, "{descent}");
}

#[test]
fn a_warp_in_coefficients_is_the_exact_warp_of_the_view() {
    let place = Place::new(5);
    let search = warps(0, false);
    let here = Harmonics::of(&place.view(HERE, 0.0));
    for (index, distance) in search.distances().into_iter().enumerate() {
        let exact = Harmonics::of(&place.view([f64::from(distance), 0.0], 0.0));
        let warped = search.warped(&here, index);
        for (k, (warped, exact)) in warped.0.iter().zip(&exact.0).enumerate().take(8) {
            // The 128 samples of the exact view fold its highest frequencies back; the warp has none
            // beyond 24, and its factors are rounded.
            assert!(
                (warped - exact).l1_norm() < 0.03,
                "{distance}, {k}: {warped} {exact}"
            );
        }
    }
}

/// Σ |c'_k - t_k|² k^-power of a view moved by `distance` towards every tenth degree from the first
/// `compared` frequencies of a stored one: the definition, integrals, sums and all, in double precision.
fn differences_in_plain_sums(
    [view, stored]: [&Harmonics; 2],
    distance: f32,
    [compared, power]: [i32; 2],
) -> [f64; 36] {
    let wide = |c: &Complex<f32>| Complex::new(f64::from(c.re), f64::from(c.im));
    let turned = |c: Complex<f64>, angle: f64| c * Complex::new(libm::cos(angle), libm::sin(angle));
    let g = |k: i32, m: i32| {
        let integrand = |n: i32| {
            let theta = PI * (f64::from(n) + 0.5) / 256.0;
            let psi = theta - libm::asin(f64::from(distance) * libm::sin(theta));
            libm::cos(f64::from(m) * psi - f64::from(k) * theta)
        };
        (0..256).map(integrand).sum::<f64>() / 256.0
    };
    let mut differences = [0.0; 36];
    for k in 1..=compared {
        let factors: [[f64; 2]; 20] =
            core::array::from_fn(|m| [1, -1].map(|sign| g(k, sign * (m as i32 + 1))));
        for (direction, difference) in differences.iter_mut().enumerate() {
            let alpha = TAU * direction as f64 / 36.0;
            let mut moved = -turned(wide(&stored.0[k as usize - 1]), alpha * f64::from(k));
            for ((m, c), [plain, conjugate]) in (1..=20).zip(&view.0).zip(factors) {
                let c = turned(wide(c), alpha * f64::from(m));
                moved += c * plain + c.conj() * conjugate;
            }
            *difference += moved.norm_sqr() / f64::from(k).powi(power);
        }
    }
    differences
}

#[test]
fn the_differences_in_fixed_point_are_those_of_plain_sums() {
    for (seed, frequencies, power) in [(1, 8, 0_u8), (2, 3, 1), (3, 16, 2)] {
        let place = Place::new(seed);
        let search = WarpSearch::new(WarpParameters {
            code: code(frequencies, 8),
            power: f32::from(power),
            ..warps(0, false).parameters()
        });
        let here = Harmonics::of(&place.view(HERE, 0.0));
        // Also a view of another contrast.
        let goal = Harmonics::of(&place.view([0.4, -0.2], 0.0).map(|luma| 0.6 * luma));
        let stored = search
            .parameters()
            .code
            .decode(&search.parameters().code.encode(&goal));
        let powers =
            [&here, &stored].map(|view| f64::from(2.0 * view.variance(frequencies.into())));
        for index in [0, 4, 7] {
            let plain = differences_in_plain_sums(
                [&here, &stored],
                search.distances()[index],
                [frequencies.into(), power.into()],
            );
            let fixed = search.differences(&here, &stored, index);
            for (fixed, plain) in fixed.into_iter().zip(plain) {
                let error = (f64::from(fixed) - plain) / (powers[0] + powers[1]);
                assert!(error.abs() < 1e-3, "{seed}, {index}: {fixed} {plain}");
            }
        }
    }
}

#[test]
fn a_search_with_a_turn_compares_the_turned_memory() {
    // What a turn of the memory is to the search, a turn of the place is to one without.
    let place = Place::new(6);
    let here = place.view(HERE, 0.0);
    let turn = f64::from(2.0 * 2.0 * crate::horizon::BEARING_STEP_RAD);
    let turned = way(&warps(2, false), &here, &place.view([0.3, 0.1], turn));
    let straight = way(&warps(0, false), &here, &place.view([0.3, 0.1], 0.0));
    assert_eq!(turned.displacement, straight.displacement);
    assert!((f64::from(turned.rotation) - turn).abs() < 1e-6);
}

#[test]
fn the_warp_search_finds_its_way_from_half_the_distance() {
    for seed in SEEDS {
        let place = Place::new(seed);
        for goal in [[0.5, 0.0], [-0.2, 0.45], [0.05, -0.03], [-0.3, -0.3]] {
            let way = way(
                &warps(0, true),
                &place.view(HERE, 0.0),
                &place.view(goal, 0.0),
            );
            let error = way.displacement - Vector2::new(goal[0] as f32, goal[1] as f32);
            assert!(error.norm() < 0.03, "seed {seed}, {goal:?}: {way:?}");
        }
    }
}

#[test]
fn next_to_the_goal_the_default_is_as_exact_as_fourier_homing() {
    let default = WarpSearch::new(presets::default(32, 0));
    let fourier = Fourier::new(FourierParameters {
        power: 0.0,
        ..presets::fourier(32)
    });
    let [mut searched, mut stepped] = [0.0; 2];
    for seed in SEEDS {
        let place = Place::new(seed);
        let (here, goal) = (place.view(HERE, 0.0), place.view([0.01, -0.02], 0.0));
        let home = Vector2::new(0.01, -0.02);
        searched += (way(&default, &here, &goal).displacement - home).norm();
        stepped += (way(&fourier, &here, &goal).displacement - home).norm();
    }
    assert!(searched < 1.1 * stepped, "{searched} {stepped}");
}

#[test]
fn a_search_that_adopts_parameters_is_one_that_was_made_with_them() {
    let place = Place::new(7);
    let [here, goal] = [HERE, [0.3, 0.1]].map(|h| place.view(h, 0.0));
    let parameters = WarpParameters {
        farthest: 0.5,
        power: 1.0,
        ..presets::default(10, 0)
    };
    let mut adopting = warps(4, false);
    adopting.adopt(parameters);
    let made = WarpSearch::new(parameters);
    assert_eq!(way(&adopting, &here, &goal), way(&made, &here, &goal));
}

#[test]
fn a_preset_takes_no_more_bytes_than_it_is_for() {
    for bytes in [4, 6, 8, 10, 12, 16, 20, 24, 28, 32] {
        let default = WarpSearch::new(presets::default(bytes, 0)).bytes();
        let fourier = Fourier::new(presets::fourier(bytes)).bytes();
        let mfdid = Mfdid::new(presets::mfdid(bytes)).bytes();
        let search = Search::new(presets::search(bytes, Resolution::Full)).bytes();
        for taken in [default, fourier, mfdid, search] {
            assert!(taken <= usize::from(bytes), "{taken} of {bytes}");
            assert!(taken + 2 > usize::from(bytes), "{taken} of {bytes}");
        }
    }
}

#[test]
fn the_warp_search_finds_the_turn_as_well() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let goal = place.view([0.3, 0.1], 0.3);
        let way = way(&warps(5, true), &place.view(HERE, 0.0), &goal);
        assert!((way.rotation - 0.3).abs() < 0.05, "seed {seed}: {way:?}");
        assert!(
            off(way.displacement, [0.3, 0.1]) < 10.0,
            "seed {seed}: {way:?}"
        );
    }
}

#[test]
fn the_phases_find_a_turn_without_a_move() {
    let phases = Fourier::new(FourierParameters {
        alignment: Alignment::Phases,
        ..fourier(1, Unknowns::Move).parameters()
    });
    let tried = Fourier::new(FourierParameters {
        alignment: Alignment::Tried(64),
        ..fourier(1, Unknowns::Move).parameters()
    });
    for seed in SEEDS {
        let place = Place::new(seed);
        for turn in [0.5, -1.2, 2.5] {
            let [here, goal] = [0.0, turn].map(|turn| place.view(HERE, turn));
            let by_phases = way(&phases, &here, &goal).rotation;
            assert!(
                (f64::from(by_phases) - turn).abs() < 0.05,
                "{by_phases} {turn}"
            );
            let by_trial = way(&tried, &here, &goal).rotation;
            // Half a step of the search.
            assert!(
                (f64::from(by_trial) - turn).abs() < 0.03,
                "{by_trial} {turn}"
            );
        }
    }
}

#[test]
fn a_code_keeps_each_coefficient_to_half_a_count() {
    for bits in 2..=8 {
        let code = code(5, bits);
        assert_eq!(code.bytes(), (10 * usize::from(bits)).div_ceil(8));
        let view = Harmonics::of(&Place::new(2).view(HERE, 0.0));
        let back = code.decode(&code.encode(&view));
        let mut count = 76.2 / ((1 << (bits - 1)) - 1) as f32;
        for (kept, seen) in back.0.iter().zip(&view.0).take(5) {
            assert!((kept.re - seen.re).abs() <= 0.5001 * count, "{bits}");
            assert!((kept.im - seen.im).abs() <= 0.5001 * count, "{bits}");
            count *= 0.826;
        }
        assert_eq!(back.0[5], Complex::new(0.0, 0.0));
    }
}

#[test]
fn a_place_is_recognised_and_a_uniform_view_tells_nothing() {
    fn check<M: HomingMethod>(method: &M) {
        let here = Place::new(4).view(HERE, 0.0);
        assert!(way(method, &here, &here).displacement.norm() < 0.15);
        let wall = [80.0; BEARINGS];
        let lost = method.home(&method.see(&wall), &method.remember(&wall));
        assert_eq!(lost, Err(NoVectorReason::NoContrast));
        let broken = method.home(&method.see(&[f32::NAN; BEARINGS]), &method.remember(&here));
        assert!(broken.is_err(), "{broken:?}");
    }
    check(&fourier(1, Unknowns::Move));
    check(&search(Resolution::Memory));
    check(&search(Resolution::Full));
    check(&mfdid(Slope::Newton));
    check(&warps(0, true));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn a_vector_is_finite_whatever_is_seen_and_remembered(
        view in prop::collection::vec(any::<f32>(), BEARINGS),
        bytes in prop::collection::vec(any::<u8>(), 0..=MOST_BYTES),
        tame in any::<bool>(),
    ) {
        let view = core::array::from_fn(|n| if tame { view[n] % 255.0 } else { view[n] });
        let memory: Memory = bytes.into_iter().collect();
        fn check<M: HomingMethod>(method: &M, view: &Luma, memory: &Memory) {
            if let Ok(way) = method.home(&method.see(view), memory) {
                assert!(way.displacement.norm().is_finite() && way.rotation.is_finite());
                assert!((0.0..=1.0).contains(&way.quality), "{way:?}");
            }
            assert_eq!(method.remember(view).len(), method.bytes());
        }
        check(&fourier(3, Unknowns::MoveAndTurn), &view, &memory);
        check(&search(Resolution::Memory), &view, &memory);
        check(&mfdid(Slope::Newton), &view, &memory);
        check(&warps(2, true), &view, &memory);
    }
}
