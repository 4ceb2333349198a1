//! Fourier homing against 200 problems solved independently in double precision.
//!
//! Each record is a view of a textured room of 10 x 10 m, a snapshot taken up to 1.1 m away with the
//! viewer turned, and the solution (from the equations of Stürzl & Mallot 2006).

use std::f32::consts::TAU;

use nav::homing::{FLAT_WEIGHTS, ImageDifference, align_within, align128, home};
use nav::spectrum::StoredCoefficients;
use nav::{HomingParameters, Horizon, Snapshot, Spectrum};
use serde::Deserialize;

/// One homing problem with its solution.
#[derive(Deserialize)]
struct Problem {
    horizon: Vec<f32>,
    a: Vec<f32>,
    b: Vec<f32>,
    snapshot_a: [i8; 8],
    snapshot_b: [i8; 8],
    align128: u8,
    align_within_11: i8,
    h3: [f32; 3],
    h3_without_k9: [f32; 3],
    h2: [f32; 2],
    difference: f32,
    true_displacement_m: [f32; 2],
    true_yaw_rad: f32,
}

impl Problem {
    fn view(&self) -> Spectrum {
        let luma = self.horizon[..].try_into().expect("128 bearings");
        Spectrum::of(&Horizon::new(luma, 0.0))
    }

    fn snapshot(&self) -> Snapshot {
        let counts = [self.snapshot_a, self.snapshot_b].concat();
        Snapshot(counts[..].try_into().expect("16 bytes"))
    }

    /// The snapshot turned back by the coarse alignment.
    fn turned(&self) -> StoredCoefficients {
        let angle = f32::from(self.align_within_11) * TAU / 128.0;
        let mut stored = self.snapshot().dequantise();
        for (k, c) in (1_u8..).zip(&mut stored) {
            let (sin, cos) = (-f32::from(k) * angle).sin_cos();
            let (re, im) = (c.re * cos - c.im * sin, c.re * sin + c.im * cos);
            (c.re, c.im) = (re, im);
        }
        stored
    }
}

fn problems() -> Vec<Problem> {
    let problems: Vec<_> = include_str!("data/homing.jsonl")
        .lines()
        .map(|line| serde_json::from_str(line).expect("a golden record"))
        .collect();
    assert_eq!(problems.len(), 200);
    problems
}

#[track_caller]
fn assert_close(found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let bound = tolerance * expected.abs().max(1.0);
        assert!(
            (found - expected).abs() <= bound,
            "{found} is not {expected}"
        );
    }
}

#[test]
fn coefficients_are_those_of_the_fourier_transform() {
    for problem in problems() {
        let view = problem.view();
        let a: Vec<_> = view.coefficients().iter().map(|c| c.re).collect();
        let b: Vec<_> = view.coefficients().iter().map(|c| -c.im).collect();
        assert_close(&a, &problem.a, 1e-3);
        assert_close(&b, &problem.b, 1e-3);
    }
}

#[test]
fn the_coarse_rotation_is_the_same_everywhere() {
    for problem in problems() {
        let (view, stored) = (problem.view(), problem.snapshot().dequantise());
        assert_eq!(align128(&view, &stored, &FLAT_WEIGHTS), problem.align128);
        let within = align_within(&view, &stored, &FLAT_WEIGHTS, 11);
        assert_eq!(within, problem.align_within_11);
    }
}

#[test]
fn the_three_by_three_system_has_the_same_solution() {
    for problem in problems() {
        let (view, stored) = (problem.view(), problem.turned());
        let whole = ImageDifference::between(&view, &stored, &FLAT_WEIGHTS);
        let minimum = whole.minimum().expect("well conditioned");
        assert_close(minimum.as_slice(), &problem.h3, 1e-3);
        assert_close(&[whole.constant()], &[problem.difference], 1e-3);

        let truncated = ImageDifference::between(&view.truncated(), &stored, &FLAT_WEIGHTS);
        let minimum = truncated.minimum().expect("well conditioned");
        assert_close(minimum.as_slice(), &problem.h3_without_k9, 1e-3);
    }
}

#[test]
fn the_two_by_two_system_has_the_same_solution() {
    for problem in problems() {
        let whole = ImageDifference::between(&problem.view(), &problem.turned(), &FLAT_WEIGHTS);
        let minimum = whole.minimum_without_turn().expect("well conditioned");
        assert_close(minimum.as_slice(), &problem.h2, 1e-3);
    }
}

#[test]
fn homing_points_less_than_a_right_angle_away_from_the_snapshot() {
    for problem in problems() {
        let vector = home(
            &problem.view(),
            &problem.snapshot(),
            &HomingParameters::DEFAULT,
        )
        .expect("a vector");
        let [x, y] = problem.true_displacement_m;
        assert!(vector.displacement.x * x + vector.displacement.y * y > 0.0);
        assert_close(vector.displacement.as_slice(), &problem.h3[..2], 1e-3);
    }
}

#[test]
fn homing_tells_how_far_the_viewer_of_the_snapshot_was_turned() {
    for problem in problems() {
        let vector = home(
            &problem.view(),
            &problem.snapshot(),
            &HomingParameters::DEFAULT,
        )
        .expect("a vector");
        let error = vector.rotation - problem.true_yaw_rad;
        // With the wrong sign of the residual turn the worst error would be 13.5 degrees.
        assert!(error.abs() < 8_f32.to_radians(), "{error} rad");
    }
}
