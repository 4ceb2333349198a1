//! The measurement models.

use nalgebra::{UnitQuaternion, Vector3};

use super::busy_state;
use crate::ekf::state::{Covariance, State};
use crate::ekf::{AbsoluteHeight, Flow, Parameters, Pose, Position, Range, YawError};

const NO_RATE: Vector3<f32> = Vector3::new(0.0, 0.0, 0.0);

/// Level, half a metre up, sure of everything but the velocity.
fn level_at_half_a_metre() -> State {
    let mut state = State::initial(&Parameters::default());
    state.position.z = 0.5;
    state.covariance *= 0.0;
    for axis in 3..5 {
        state.covariance[(axis, axis)] = 1.0;
    }
    state
}

#[test]
fn flow_reads_488_counts_per_radian() {
    // 0.5 m/s at 0.5 m for 10 ms: 0.01 rad, 4.88 counts.
    let mut state = level_at_half_a_metre();
    let flow = Flow {
        counts: [4.883, -4.883],
        dt_s: 0.01,
        sd_counts: 1e-3,
    };
    flow.correct(&mut state, &NO_RATE, &Parameters::default().flow);
    assert!(
        (state.velocity.x - 0.5).abs() < 1e-3,
        "{}",
        state.velocity.x
    );
    assert!(
        (state.velocity.y + 0.5).abs() < 1e-3,
        "{}",
        state.velocity.y
    );
}

#[test]
fn flow_of_a_turning_drone_is_not_taken_for_motion() {
    // Rolling about +x moves the image as motion along +y does, pitching about +y against motion along +x.
    let mut state = level_at_half_a_metre();
    let flow = Flow {
        counts: [-0.2 * 4.883, 0.1 * 4.883],
        dt_s: 0.01,
        sd_counts: 1e-3,
    };
    let rate = Vector3::new(0.1, 0.2, 0.7);
    flow.correct(&mut state, &rate, &Parameters::default().flow);
    assert!(state.velocity.norm() < 1e-4, "{}", state.velocity);
}

#[test]
fn the_second_flow_update_predicts_with_what_the_first_had_read() {
    // The x update moves y's velocity and the height through the covariance; the y innovation must not see it.
    let geometry = Parameters::default().flow;
    let start = busy_state();
    let flow = |counts| Flow {
        counts,
        dt_s: 0.01,
        sd_counts: 2.0,
    };
    let scale = 0.01 * geometry.pixels / geometry.field_of_view_rad;
    let cos = start.rotation[(2, 2)];
    let predicted = |velocity: f32| scale * velocity * cos / start.position.z / 0.1;
    // Counts that agree with the state at the start on y and differ on x.
    let counts = [
        predicted(start.velocity.x) + 30.0,
        predicted(start.velocity.y),
    ];
    let mut both = start.clone();
    flow(counts).correct(&mut both, &NO_RATE, &geometry);
    let mut agreeing = start.clone();
    flow([predicted(start.velocity.x), counts[1]]).correct(&mut agreeing, &NO_RATE, &geometry);
    // With no y innovation, the state moves by the x gain alone and the covariances stay the same.
    assert!((both.covariance - agreeing.covariance).amax() < 1e-6);
    let moved = both.velocity - start.velocity;
    assert!(
        moved.y.abs() > 1e-3,
        "the x update must touch vy for this test"
    );
    let gain = moved / (30.0 * geometry.pixels_per_count);
    let p = &start.covariance;
    let h = |z: f32, v: f32| {
        z * -scale * start.velocity.x * cos / start.position.z.powi(2)
            + v * scale * cos / start.position.z
    };
    let cross = Vector3::from_fn(|i, _| h(p[(3 + i, 2)], p[(3 + i, 3)]));
    let total = h(h(p[(2, 2)], p[(2, 3)]), h(p[(3, 2)], p[(3, 3)])) + 0.04;
    assert!((gain - cross / total).amax() < 1e-4);
}

#[test]
fn flow_near_the_ground_divides_by_ten_centimetres_at_least() {
    let mut state = level_at_half_a_metre();
    state.position.z = 0.02;
    let flow = Flow {
        counts: [4.883, 0.0],
        dt_s: 0.01,
        sd_counts: 1e-3,
    };
    flow.correct(&mut state, &NO_RATE, &Parameters::default().flow);
    assert!((state.velocity.x - 0.1).abs() < 1e-3);
}

#[test]
fn a_tilt_within_the_cone_does_not_lengthen_the_range() {
    for (tilt_deg, longer) in [
        (0.0_f32, 1.0),
        (7.0, 1.0),
        (20.0, 1.0 / 12.5_f32.to_radians().cos()),
    ] {
        let mut state = State::initial(&Parameters::default());
        state.attitude = UnitQuaternion::from_euler_angles(0.0, tilt_deg.to_radians(), 0.0);
        state.finalise();
        let range = Range {
            distance_m: 0.5 * longer,
            sd_m: 1e-4,
        };
        range.correct(&mut state, &Parameters::default().range);
        assert!((state.position.z - 0.5).abs() < 1e-4, "tilt {tilt_deg}");
    }
}

#[test]
fn a_range_is_ignored_when_the_drone_lies_on_its_side() {
    let mut state = State::initial(&Parameters::default());
    state.attitude = UnitQuaternion::from_euler_angles(85.0_f32.to_radians(), 0.0, 0.0);
    state.finalise();
    let range = Range {
        distance_m: 1.0,
        sd_m: 0.001,
    };
    range.correct(&mut state, &Parameters::default().range);
    assert_eq!(state.position.z, 0.0);
}

#[test]
fn one_long_range_moves_the_height_for_want_of_a_gate() {
    // In a settled hover the height's sd is 1.5 mm: 2.0 m read at 0.5 m with 3.1 mm moves it by a fifth.
    let mut state = level_at_half_a_metre();
    state.covariance[(2, 2)] = 0.0015 * 0.0015;
    let range = Range {
        distance_m: 2.0,
        sd_m: 0.0031,
    };
    range.correct(&mut state, &Parameters::default().range);
    let share = 0.0015_f32.powi(2) / (0.0015_f32.powi(2) + 0.0031_f32.powi(2));
    assert!((state.position.z - 0.5 - 1.5 * share).abs() < 1e-4);
}

#[test]
fn an_absolute_height_moves_the_height_by_its_gain() {
    let mut state = State::initial(&Parameters::default());
    let height = AbsoluteHeight {
        height_m: 2.0,
        sd_m: 1.0,
    };
    // Variance 1 against 1: half the way.
    height.correct(&mut state);
    assert!((state.position.z - 1.0).abs() < 1e-6);
    assert!((state.covariance[(2, 2)] - 0.5).abs() < 1e-6);
}

#[test]
fn soft_fixes_after_a_reset_average() {
    // The prior is 10 m wide, so the first fix is taken whole and the n-th by 1/n.
    let mut state = State::initial(&Parameters::default());
    state.bound_covariance();
    let mut sum = 0.0;
    for (n, x) in (1_u8..).zip([0.2, 0.4, -0.1, 0.3]) {
        let fix = Position {
            position_m: Vector3::new(x, 0.0, 0.0),
            sd_m: 0.5,
        };
        fix.correct(&mut state);
        sum += x;
        let mean = sum / f32::from(n);
        assert!((state.position.x - mean).abs() < 2e-3, "fix {n}");
    }
}

#[test]
fn a_pose_turns_the_estimate_onto_the_measured_attitude() {
    let mut state = busy_state();
    // No correlation: the position must not turn the attitude first, for the residual would not notice.
    state.covariance = Covariance::identity() * 0.01;
    let truth = state.attitude * UnitQuaternion::from_scaled_axis(Vector3::new(0.01, -0.02, 0.03));
    let pose = Pose {
        position_m: Vector3::new(1.5, -2.5, 0.7),
        attitude: truth,
        sd_position_m: 1e-4,
        sd_attitude_rad: 1e-4,
    };
    pose.correct(&mut state);
    state.finalise();
    // 2 tan(θ/2) for θ is off by θ³/12, the gain by 1e-6.
    assert!(state.attitude.angle_to(&truth) < 1e-5);
    assert!((state.position - pose.position_m).norm() < 1e-5);
}

#[test]
fn a_pose_measured_with_the_opposite_quaternion_is_the_same_pose() {
    let start = State::initial(&Parameters::default());
    let truth = UnitQuaternion::from_scaled_axis(Vector3::new(0.01, -0.02, 0.03));
    let opposite = UnitQuaternion::new_unchecked(-truth.into_inner());
    let corrected = |attitude| {
        let mut state = start.clone();
        Pose {
            position_m: Vector3::zeros(),
            attitude,
            sd_position_m: 0.01,
            sd_attitude_rad: 4.5e-3,
        }
        .correct(&mut state);
        state.attitude_error
    };
    assert!((corrected(truth) - corrected(opposite)).norm() < 1e-7);
}

#[test]
fn a_positive_yaw_error_turns_the_estimate_clockwise() {
    let mut state = State::initial(&Parameters::default());
    let error = YawError {
        error_rad: 0.1,
        sd_rad: 1e-4,
    };
    error.correct(&mut state);
    assert!((state.attitude_error.z + 0.1).abs() < 1e-4);
}

#[test]
fn a_second_yaw_error_in_one_tick_doubles_the_first_instead_of_removing_it() {
    // Zero error measured with d2 = -0.1 pending: a Kalman filter's innovation would be +0.1, the firmware's is -0.1.
    let mut state = State::initial(&Parameters::default());
    state.attitude_error.z = -0.1;
    let sd_rad = 0.01;
    // Variance 1e-4 against 1e-4: half of the innovation.
    let error = YawError {
        error_rad: 0.0,
        sd_rad,
    };
    error.correct(&mut state);
    assert!((state.attitude_error.z + 0.15).abs() < 1e-6);
}
