//! Claims about the cascade: signs, limits, rates. Expected values are worked out from the gains.

mod attitude;
mod mixer;
mod modes;
mod position;

use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::{Controller, ControllerParameters, MotorCommands, SetPoint};
use crate::ekf::Estimate;

const STILL: Vector3<f32> = Vector3::new(0.0, 0.0, 0.0);

fn level() -> Estimate {
    Estimate {
        position_m: Vector3::new(0.0, 0.0, 0.5),
        velocity_m_s: STILL,
        velocity_body_m_s: STILL,
        attitude: UnitQuaternion::identity(),
        variances: SVector::zeros(),
    }
}

fn hold(x: f32, y: f32, z: f32, yaw_rad: f32) -> SetPoint {
    SetPoint::Hold {
        position_m: Vector3::new(x, y, z),
        yaw_rad,
    }
}

/// The four motors' first answer.
fn answer(estimate: &Estimate, gyro_deg_s: &Vector3<f32>, set_point: &SetPoint) -> [i32; 4] {
    let mut controller = Controller::new(&ControllerParameters::default());
    controller
        .tick(0, estimate, gyro_deg_s, set_point)
        .0
        .map(i32::from)
}

#[test]
fn on_target_all_motors_give_the_base_thrust() {
    assert_eq!(
        answer(&level(), &STILL, &hold(0.0, 0.0, 0.5, 0.0)),
        [30_000; 4]
    );
}

#[test]
fn a_target_ahead_lowers_the_nose_and_one_to_the_left_raises_the_right_side() {
    let [m1, m2, m3, m4] = answer(&level(), &STILL, &hold(1.0, 0.0, 0.5, 0.0));
    assert!(m1 < m2 && m4 < m3, "front motors give way");
    assert_eq!((m1, m2), (m4, m3));
    let [m1, m2, m3, m4] = answer(&level(), &STILL, &hold(0.0, 1.0, 0.5, 0.0));
    assert!(m4 < m1 && m3 < m2, "left motors give way");
    assert_eq!((m1, m4), (m2, m3));
}

#[test]
fn a_heading_to_the_left_speeds_up_the_motors_that_push_that_way() {
    let [m1, m2, m3, m4] = answer(&level(), &STILL, &hold(0.0, 0.0, 0.5, 0.5));
    assert!(m2 > m1 && m4 > m3);
    assert_eq!((m1, m2), (m3, m4));
}

#[test]
fn a_turned_drone_takes_a_northern_target_for_one_on_its_right() {
    // Heading west, north is to the right: the left side comes up.
    let facing_west = Estimate {
        attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, core::f32::consts::FRAC_PI_2),
        ..level()
    };
    let west = core::f32::consts::FRAC_PI_2;
    let [m1, _, _, m4] = answer(&facing_west, &STILL, &hold(1.0, 0.0, 0.5, west));
    assert!(m4 > m1 + 100);
}

#[test]
fn a_measured_rate_is_resisted() {
    let target = hold(0.0, 0.0, 0.5, 0.0);
    let [m1, _, m3, m4] = answer(&level(), &Vector3::new(10.0, 0.0, 0.0), &target);
    assert!(m4 < m1, "rolling left side up lowers the left");
    // 10 deg/s with 200 per deg/s and 400 per degree over 2 ms, half of it on each side.
    assert_eq!(m1 - m4, 2000 + 8);
    assert_eq!(m3, m4);
    let [m1, m2, ..] = answer(&level(), &Vector3::new(0.0, 10.0, 0.0), &target);
    assert!(m1 > m2, "a dropping nose is lifted");
}

#[test]
fn a_climb_of_half_a_metre_asks_for_a_metre_per_second() {
    let set_point = hold(0.0, 0.0, 1.0, 0.0);
    let [m1, ..] = answer(&level(), &STILL, &set_point);
    // 2.0 and 0.5 s on 0.5 m; 25 and 15 s on the speed; thousands of counts; the first 10 ms of each integral.
    let speed = 2.0 * 0.5 + 0.5 * 0.5 * 0.01;
    let thrust = 30_000.0 + 1000.0 * (25.0 * speed + 15.0 * speed * 0.01);
    assert!(
        (f64::from(m1) - thrust).abs() <= 1.0,
        "{m1} against {thrust}"
    );
}

#[test]
fn attitude_and_rate_loops_run_every_other_millisecond() {
    let mut controller = Controller::new(&ControllerParameters::default());
    let mut last = MotorCommands::STOPPED;
    for now_ms in 0..100 {
        let gyro = Vector3::new(now_ms as f32, 0.0, 0.0);
        let motors = controller.tick(now_ms, &level(), &gyro, &hold(0.0, 0.0, 0.5, 0.0));
        assert_eq!(motors != last, now_ms % 2 == 0, "at {now_ms} ms");
        last = motors;
    }
}

#[test]
fn position_and_velocity_loops_run_every_tenth_millisecond() {
    let mut controller = Controller::new(&ControllerParameters::default());
    let mean = |motors: MotorCommands| motors.0.map(u32::from).iter().sum::<u32>();
    let mut last = 0;
    for now_ms in 0..100 {
        let rising = hold(0.0, 0.0, 0.5 + 0.001 * now_ms as f32, 0.0);
        let motors = controller.tick(now_ms, &level(), &STILL, &rising);
        assert_eq!(mean(motors) != last, now_ms % 10 == 0, "at {now_ms} ms");
        last = mean(motors);
    }
}
