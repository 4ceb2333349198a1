//! Prediction, process noise, the scalar update, bounds and finalise.

use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::busy_state;
use crate::ekf::Parameters;
use crate::ekf::parameters::GRAVITY_M_S2;
use crate::ekf::predict::Motion;
use crate::ekf::state::{ATTITUDE, Covariance, State, VELOCITY};
use crate::ekf::update::Sensitivity;

fn still(flying: bool) -> Motion {
    Motion {
        angular_rate: Vector3::zeros(),
        specific_force: Vector3::new(0.0, 0.0, GRAVITY_M_S2),
        flying,
    }
}

#[test]
fn a_level_drone_carried_by_one_g_keeps_its_velocity() {
    let mut state = State::initial(&Parameters::default());
    state.velocity = Vector3::new(0.5, -0.25, 0.0);
    for _ in 0..100 {
        state.predict(&still(true), 0.01, &Parameters::default());
    }
    assert!((state.velocity - Vector3::new(0.5, -0.25, 0.0)).norm() < 1e-6);
    assert!((state.position - Vector3::new(0.5, -0.25, 0.0)).norm() < 1e-4);
}

#[test]
fn without_force_the_drone_falls_by_half_g_t_squared() {
    let mut state = State::initial(&Parameters::default());
    let falling = Motion {
        specific_force: Vector3::zeros(),
        ..still(true)
    };
    for _ in 0..50 {
        state.predict(&falling, 0.01, &Parameters::default());
    }
    assert!((state.position.z + 0.5 * GRAVITY_M_S2 * 0.25).abs() < 1e-4);
    assert!((state.velocity.z + GRAVITY_M_S2 * 0.5).abs() < 1e-4);
}

#[test]
fn sideways_forces_count_on_the_ground_only() {
    for (flying, gained) in [(false, 0.01), (true, 0.0)] {
        let mut state = State::initial(&Parameters::default());
        let pushed = Motion {
            specific_force: Vector3::new(1.0, 0.0, GRAVITY_M_S2),
            ..still(flying)
        };
        state.predict(&pushed, 0.01, &Parameters::default());
        assert!((state.velocity.x - gained).abs() < 1e-7, "flying {flying}");
    }
}

#[test]
fn velocity_is_carried_in_the_turning_body() {
    // Flying straight on while yawing left, the body sees its velocity turn right.
    let mut state = State::initial(&Parameters::default());
    state.velocity = Vector3::new(1.0, 0.0, 0.0);
    let yawing = Motion {
        angular_rate: Vector3::new(0.0, 0.0, 0.5),
        ..still(true)
    };
    state.predict(&yawing, 0.01, &Parameters::default());
    assert!((state.velocity - Vector3::new(1.0, -0.005, 0.0)).norm() < 1e-7);
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.005);
    assert!(state.attitude.angle_to(&turn) < 1e-5);
}

#[test]
fn the_transition_is_the_derivative_of_the_prediction() {
    // Central differences over position and velocity; the attitude block is linearised by the authors' own formula.
    let motion = Motion {
        angular_rate: Vector3::new(0.3, -0.2, 0.5),
        specific_force: Vector3::new(0.0, 0.0, 9.5),
        flying: true,
    };
    let (dt, step) = (0.01, 0.125);
    let base = busy_state();
    let moved = |axis: usize, by: f32| {
        let mut state = base.clone();
        state.velocity[axis] += by;
        state.predict(&motion, dt, &Parameters::default());
        (state.position, state.velocity)
    };
    for axis in 0..3 {
        let (up, down) = (moved(axis, step), moved(axis, -step));
        let position = (up.0 - down.0) / (2.0 * step);
        let velocity = (up.1 - down.1) / (2.0 * step);
        // A covariance of one state alone comes back as the square of its column.
        let mut probe = base.clone();
        probe.covariance = Covariance::zeros();
        probe.covariance[(VELOCITY + axis, VELOCITY + axis)] = 1.0;
        probe.predict(&motion, dt, &Parameters::default());
        let column = SVector::<f32, 9>::from_iterator(
            position
                .iter()
                .chain(velocity.iter())
                .copied()
                .chain([0.0; 3]),
        );
        let expected = column * column.transpose();
        assert!((probe.covariance - expected).amax() < 2e-5, "axis {axis}");
    }
}

#[test]
fn process_noise_is_the_square_of_a_millisecond_at_a_time() {
    let mut state = State::initial(&Parameters::default());
    let noise = Parameters::default().process_noise;
    for _ in 0..1000 {
        state.add_process_noise(&noise, 0.001);
    }
    // 2.5e-4 (m/s)² and 1e-5 rad² per second on top of 1e-4 each.
    let p = &state.covariance;
    assert!((p[(VELOCITY, VELOCITY)] - 3.5e-4).abs() < 1e-6);
    assert!((p[(VELOCITY + 2, VELOCITY + 2)] - 1.1e-3).abs() < 1e-6);
    assert!((p[(ATTITUDE + 2, ATTITUDE + 2)] - 1.1e-4).abs() < 1e-6);
}

#[test]
fn on_the_ground_a_tilt_decays_with_a_time_constant_of_ten_seconds() {
    let mut state = State::initial(&Parameters::default());
    state.attitude = UnitQuaternion::from_euler_angles(0.1, 0.0, 0.0);
    for _ in 0..1000 {
        state.predict(&still(false), 0.01, &Parameters::default());
    }
    let left = state.attitude.angle() / 0.1;
    assert!((left - (-1.0_f32).exp()).abs() < 2e-3, "left {left}");
}

#[test]
fn bounds_cut_large_and_senseless_entries_and_lift_small_variances() {
    let mut state = busy_state();
    state.covariance[(0, 0)] = 1e4;
    state.covariance[(1, 1)] = f32::NAN;
    state.covariance[(2, 2)] = -1.0;
    state.covariance[(0, 1)] = 1.0;
    state.covariance[(1, 0)] = 3.0;
    state.covariance[(3, 4)] = -500.0;
    state.covariance[(4, 3)] = -500.0;
    state.bound_covariance();
    let p = &state.covariance;
    assert_eq!((p[(0, 0)], p[(1, 1)], p[(2, 2)]), (100.0, 100.0, 1e-6));
    assert_eq!((p[(0, 1)], p[(1, 0)]), (2.0, 2.0));
    assert_eq!(p[(3, 4)], -500.0, "covariances have no lower bound");
}

#[test]
fn the_matrix_stays_level_and_north_until_the_first_finalise() {
    let mut state = State::initial(&Parameters {
        initial_yaw_rad: 0.5,
        ..Parameters::default()
    });
    assert_eq!(state.rotation, Matrix3::identity());
    state.finalise();
    let turned = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.5).to_rotation_matrix();
    assert!((state.rotation - turned.matrix()).amax() < 1e-6);
}

#[test]
fn finalise_folds_the_error_into_attitude_and_covariance() {
    let mut state = busy_state();
    let before = state.clone();
    state.attitude_error = Vector3::new(0.02, -0.03, 0.05);
    state.finalise();
    let expected =
        before.attitude * UnitQuaternion::from_scaled_axis(Vector3::new(0.02, -0.03, 0.05));
    assert!(state.attitude.angle_to(&expected) < 1e-6);
    assert_eq!(state.attitude_error, Vector3::zeros());
    assert_eq!(
        state.rotation,
        state.attitude.to_rotation_matrix().into_inner()
    );
    // To first order the covariance turns back by half the error.
    let half = UnitQuaternion::from_scaled_axis(Vector3::new(-0.01, 0.015, -0.025));
    let turned = half.to_rotation_matrix() * before.covariance.fixed_view::<3, 3>(6, 6);
    let turned = turned * half.inverse().to_rotation_matrix();
    let got = state.covariance.fixed_view::<3, 3>(6, 6);
    assert!((got - turned).amax() < 1e-5);
}

#[test]
fn the_supervisor_looks_at_each_axis_of_position_and_of_body_velocity() {
    let mut state = State::initial(&Parameters::default());
    // Level, turned left by an eighth of a circle.
    state.attitude = UnitQuaternion::from_euler_angles(0.0, 0.0, core::f32::consts::FRAC_PI_4);
    state.finalise();
    for (position, velocity, out) in [
        ([99.0, -99.0, 99.0], [0.0, 0.0, 0.0], false),
        ([0.0, -100.1, 0.0], [0.0, 0.0, 0.0], true),
        // 12.7 m/s along one axis of the world, and 7.4 along two of them.
        ([0.0; 3], [9.0, -9.0, 0.0], false),
        ([0.0; 3], [10.5, 0.0, 0.0], true),
        ([0.0; 3], [0.0, 0.0, -10.1], true),
    ] {
        state.position = position.into();
        state.velocity = velocity.into();
        assert_eq!(state.out_of_bounds(100.0), out, "{position:?} {velocity:?}");
    }
}

#[test]
fn noise_updates_and_finalise_each_leave_the_covariance_within_its_bounds() {
    let beyond = || {
        let mut state = busy_state();
        state.covariance = Covariance::from_diagonal_element(1e-8);
        state.covariance[(0, 0)] = 400.0;
        state
    };
    let assert_bounded = |what: &str, state: &State| {
        let p = &state.covariance;
        assert_eq!((p[(0, 0)], p[(8, 8)]), (100.0, 1e-6), "{what}");
    };
    let mut state = beyond();
    state.add_process_noise(&Parameters::default().process_noise, 0.0);
    assert_bounded("noise", &state);
    let mut state = beyond();
    state.scalar_update(&[Sensitivity::direct(4)], 0.0, 1.0);
    assert_bounded("update", &state);
    let mut state = beyond();
    state.finalise();
    assert_bounded("finalise", &state);
}

#[test]
fn finalise_throws_away_errors_within_the_dead_band_and_beyond_ten() {
    for error in [9.9e-5, 10.5] {
        let mut state = busy_state();
        let attitude = state.attitude;
        state.attitude_error = Vector3::new(error, 0.0, 0.0);
        state.finalise();
        assert_eq!(state.attitude, attitude);
        assert_eq!(state.attitude_error, Vector3::zeros());
    }
}

proptest! {
    #[test]
    fn the_scalar_update_is_the_joseph_form(
        entries in prop::array::uniform32(-0.3_f32..0.3),
        (i, j) in (0_usize..9, 0_usize..9),
        (a, b) in (-3.0_f32..3.0, -3.0_f32..3.0),
        innovation in -1.0_f32..1.0,
        sd in 0.01_f32..1.0,
    ) {
        prop_assume!(i != j);
        let root = Covariance::from_fn(|r, c| entries[(r * 9 + c * 5) % 32]);
        let mut state = State::initial(&Parameters::default());
        state.covariance = root * root.transpose() + Covariance::identity() * 0.01;

        let p: SMatrix<f64, 9, 9> = state.covariance.cast();
        let mut h = SMatrix::<f64, 1, 9>::zeros();
        h[i] = f64::from(a);
        h[j] = f64::from(b);
        let variance = f64::from(sd) * f64::from(sd);
        let k = p * h.transpose() / ((h * p * h.transpose())[0] + variance);
        let shrink = SMatrix::<f64, 9, 9>::identity() - k * h;
        let expected = shrink * p * shrink.transpose() + k * k.transpose() * variance;

        let row = [
            Sensitivity { state: i, slope: a },
            Sensitivity { state: j, slope: b },
        ];
        state.scalar_update(&row, innovation, sd);
        let x = SVector::<f32, 9>::from_iterator(
            state.position.iter().chain(&state.velocity).chain(&state.attitude_error).copied(),
        );
        let moved = k * f64::from(innovation);
        prop_assert!((x.cast::<f64>() - moved).amax() < 1e-4 * (1.0 + moved.amax()));
        prop_assert!((state.covariance.cast::<f64>() - expected).amax() < 1e-4);
    }
}
