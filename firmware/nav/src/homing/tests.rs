use core::f64::consts::TAU;

use nalgebra::Complex;
use proptest::prelude::*;

use super::*;
use crate::spectrum::{StoredCoefficients, VIEW_FREQUENCIES};

/// A view with c_k of order 70 / k (so that quantisation costs little), amplitude and phase by frequency.
struct Place([(f64, f64); VIEW_FREQUENCIES]);

impl Place {
    /// Random phases.
    fn new(seed: u64) -> Self {
        let mut state = seed;
        Self(core::array::from_fn(|index| {
            // Knuth's MMIX generator; its upper bits are the good ones.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let uniform = (state >> 32) as f64 / f64::from(u32::MAX);
            (70.0 / (index + 1) as f64, TAU * uniform)
        }))
    }

    fn luma(&self, bearing: f64) -> f64 {
        let waves = (1_u8..).zip(&self.0);
        waves
            .map(|(k, (amplitude, phase))| amplitude * libm::cos(f64::from(k) * bearing + phase))
            .sum()
    }

    /// The exact view after a move by h on the unit circle and a turn of the viewer:
    /// I_h(θ) = I(θ - asin(x sin θ - y cos θ)).
    fn view(&self, h: [f64; 2], turn: f64) -> Spectrum {
        let mut coefficients = [Complex::new(0.0_f64, 0.0); VIEW_FREQUENCIES];
        const SAMPLES: usize = 1024;
        for n in 0..SAMPLES {
            let theta = n as f64 * TAU / SAMPLES as f64;
            let seen = theta + turn;
            let shift = libm::asin(h[0] * libm::sin(seen) - h[1] * libm::cos(seen));
            let luma = self.luma(seen - shift);
            for (k, c) in (1_u8..).zip(&mut coefficients) {
                let phase = f64::from(k) * theta;
                *c += Complex::new(libm::cos(phase), -libm::sin(phase)) * luma;
            }
        }
        let scale = 2.0 / SAMPLES as f64;
        Spectrum::from_coefficients(
            coefficients.map(|c| Complex::new((c.re * scale) as f32, (c.im * scale) as f32)),
        )
    }
}

const SEEDS: core::ops::Range<u64> = 1..20;

fn stored(view: &Spectrum) -> StoredCoefficients {
    core::array::from_fn(|index| view.coefficients()[index])
}

/// What the linear model leaves of a move by 0.058: its second order is (0.058 k)² / 2, a tenth at
/// k = 8; with quantisation, an eighth.
const MODEL_ERROR: f32 = 0.058 / 8.0;

fn parameters(iterations: u8) -> HomingParameters {
    HomingParameters {
        iterations,
        ..HomingParameters::DEFAULT
    }
}

#[test]
fn the_gradient_is_that_of_the_exact_warp_on_the_unit_circle() {
    let place = Place::new(1);
    let here = place.view([0.0, 0.0], 0.0);
    for h in [[1e-3, 0.0], [0.0, 1e-3], [-7e-4, 7e-4]] {
        let exact = place.view(h, 0.0);
        let linear = difference::moved(&here, Vector2::new(h[0] as f32, h[1] as f32));
        // The move changes the coefficients by some 0.07; what is left is of second order.
        for (a, b) in stored(&exact).iter().zip(&stored(&linear)) {
            assert!((a - b).l1_norm() < 1e-3);
        }
    }
}

#[test]
fn three_iterations_find_a_move_by_a_twentieth_of_the_distance() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let here = place.view([0.0, 0.0], 0.0);
        let snapshot = Snapshot::quantise(&place.view([0.05, -0.03], 0.0));
        let vector = home(&here, &snapshot, &parameters(3)).unwrap();
        assert!((vector.displacement - Vector2::new(0.05, -0.03)).norm() < MODEL_ERROR);
        assert!(vector.rotation.abs() < 0.01);
    }
}

#[test]
fn a_turn_is_told_from_a_move() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let here = place.view([0.0, 0.0], 0.0);
        for turn in [0.1_f64, -0.1, 0.4, -0.4] {
            let snapshot = Snapshot::quantise(&place.view([0.05, -0.03], turn));
            let vector = home(&here, &snapshot, &parameters(5)).unwrap();
            assert!((vector.displacement - Vector2::new(0.05, -0.03)).norm() < MODEL_ERROR);
            assert!((f64::from(vector.rotation) - turn).abs() < 0.01);
        }
    }
}

#[test]
fn the_vector_vanishes_at_the_snapshot() {
    let here = Place::new(2).view([0.0, 0.0], 0.0);
    let vector = home(&here, &Snapshot::quantise(&here), &parameters(1)).unwrap();
    assert!(vector.displacement.norm() < 5e-3);
    assert!(vector.rotation.abs() < 5e-3);
    // Half a count of each of 16 numbers is the most that quantisation costs.
    assert!(vector.difference < 16.0 * 0.3 * 0.3);
}

#[test]
fn the_rotation_search_keeps_to_its_bound() {
    let place = Place::new(1);
    let here = place.view([0.0, 0.0], 0.0);
    let behind = stored(&place.view([0.0, 0.0], 2.0));
    let free = align128(&here, &behind, &FLAT_WEIGHTS);
    assert_eq!(free, libm::round(2.0 * 128.0 / TAU) as u8);
    let bounded = align_within(&here, &behind, &FLAT_WEIGHTS, 11);
    assert!((-11..=11).contains(&bounded));
    // Any bound is safe.
    let _ = align_within(&here, &behind, &FLAT_WEIGHTS, u8::MAX);
}

#[test]
fn darkness_gives_no_vector() {
    let here = Place::new(1).view([0.0, 0.0], 0.0);
    let dark = Spectrum::from_coefficients([Complex::new(0.1, 0.0); VIEW_FREQUENCIES]);
    let parameters = HomingParameters::DEFAULT;
    let snapshot = Snapshot::quantise(&here);
    assert_eq!(
        home(&dark, &snapshot, &parameters),
        Err(NoVectorReason::NoContrast)
    );
    assert_eq!(
        home(&here, &Snapshot::default(), &parameters),
        Err(NoVectorReason::NoContrast)
    );
}

#[test]
fn a_view_that_is_not_finite_gives_no_vector() {
    let here = Place::new(1).view([0.0, 0.0], 0.0);
    let snapshot = Snapshot::quantise(&here);
    for bad in [f32::NAN, f32::INFINITY] {
        let mut coefficients = *here.coefficients();
        coefficients[4].im = bad;
        let view = Spectrum::from_coefficients(coefficients);
        let result = home(&view, &snapshot, &HomingParameters::DEFAULT);
        assert_eq!(result, Err(NoVectorReason::NotFinite));
        // The ninth term only feeds the gradient.
        let mut coefficients = *here.coefficients();
        coefficients[8].re = bad;
        let view = Spectrum::from_coefficients(coefficients);
        assert!(home(&view, &snapshot, &HomingParameters::DEFAULT).is_err());
    }
}

#[test]
fn a_corridor_with_uniform_walls_gives_no_vector() {
    // Bright ends north and south, nothing else: the view of a long corridor, which a move along it
    // does not change. Only even frequencies; the ends as narrow as eight frequencies allow.
    let coefficients = core::array::from_fn(|index| {
        let even = index % 2 == 1;
        Complex::new(if even { 20.0 } else { 0.0 }, 0.0)
    });
    let view = Spectrum::from_coefficients(coefficients);
    let result = home(
        &view,
        &Snapshot::quantise(&view),
        &HomingParameters::DEFAULT,
    );
    assert_eq!(result, Err(NoVectorReason::IllConditioned));
}

proptest! {
    #[test]
    fn a_vector_is_finite_and_bounded_whatever_is_seen(
        parts in prop::array::uniform9((any::<f32>(), any::<f32>())),
        scale in prop::sample::select(&[0_u32, 0x3F80_0000][..]),
        counts in prop::array::uniform16(any::<i8>()),
        iterations in 0_u8..4,
    ) {
        // Both the full range of floats and views of ordinary size.
        let shrink = |value: f32| if scale == 0 { value } else { value % 60.0 };
        let view = Spectrum::from_coefficients(
            parts.map(|(re, im)| Complex::new(shrink(re), shrink(im))),
        );
        if let Ok(vector) = home(&view, &Snapshot(counts), &parameters(iterations)) {
            prop_assert!(vector.displacement.norm() <= 0.3001);
            prop_assert!(vector.rotation.is_finite() && vector.difference.is_finite());
        }
    }
}

#[test]
fn a_place_resembles_itself_from_a_fifth_of_the_distance_and_no_other_place() {
    for seed in SEEDS {
        let place = Place::new(seed);
        let snapshot = Snapshot::quantise(&place.view([0.0, 0.0], 0.0));
        let seen = |view: &Spectrum| Resemblance::of(view, &snapshot, &HomingParameters::DEFAULT);
        let same = seen(&place.view([0.0, 0.0], 0.0)).unwrap();
        assert!(same.difference < 0.001);
        // From 0.2 to the south and turned to the left: the place lies 0.2 to the north.
        let near = seen(&place.view([-0.2, 0.0], 0.3)).unwrap();
        assert!(near.difference < 0.1, "seed {seed}: {near:?}");
        assert!((near.rotation + 0.3).abs() < 0.1, "seed {seed}: {near:?}");
        assert!(
            (0.1..0.3).contains(&near.displacement.x),
            "seed {seed}: {near:?}"
        );
        let other = Place::new(seed + 100).view([0.0, 0.0], 0.0);
        // Where the views contradict each other too much there is no vector at all.
        assert!(seen(&other).is_err() || seen(&other).unwrap().difference > 0.2);
    }
}
