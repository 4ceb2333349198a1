//! Claims about the vehicle from mechanics.

use nalgebra::Vector3;

use super::{GRAVITY_M_S2, PAPER_MASS_KG, STEP_S, STOCK_MASS_KG, Vehicle, VehicleParameters};
use crate::controller::MotorCommands;

const HOVER: MotorCommands = MotorCommands([30_000; 4]);

fn standing() -> Vehicle {
    Vehicle::standing_at(VehicleParameters::default(), Vector3::zeros(), 0.0)
}

/// In the air at hover thrust with settled motors.
fn hovering() -> Vehicle {
    let mut vehicle = standing();
    vehicle.truth.position_m.z = 1.0;
    for _ in 0..1000 {
        vehicle.motors.step(&HOVER);
    }
    vehicle
}

fn run(vehicle: &mut Vehicle, commands: MotorCommands, steps: usize) {
    for _ in 0..steps {
        vehicle.step(&commands);
    }
}

#[test]
fn the_base_thrust_carries_drones_of_either_mass() {
    for mass_kg in [PAPER_MASS_KG, STOCK_MASS_KG] {
        let parameters = VehicleParameters::crazyflie_brushless(mass_kg);
        let lift = 4.0 * parameters.full_thrust_n * 30_000.0 / 65_535.0;
        assert!((lift - mass_kg * GRAVITY_M_S2).abs() < 1e-9);
    }
    // The stock motors' 0.2 N and the identified inertia come out of the scaling.
    let stock = VehicleParameters::crazyflie_brushless(STOCK_MASS_KG);
    assert!((stock.full_thrust_n - 0.2).abs() < 0.02);
    let identified = VehicleParameters::crazyflie_brushless(0.043_38).inertia_kg_m2;
    assert!((identified - Vector3::new(25e-6, 28e-6, 49e-6)).norm() < 1e-12);
    let paper = VehicleParameters::crazyflie_brushless(PAPER_MASS_KG).inertia_kg_m2;
    assert!((paper / PAPER_MASS_KG - identified / 0.043_38).norm() < 1e-12);
}

#[test]
fn at_rest_on_the_ground_the_accelerometer_reads_one_g_and_nothing_moves() {
    let mut vehicle = standing();
    let before = *vehicle.truth();
    run(&mut vehicle, MotorCommands([20_000; 4]), 500);
    assert_eq!(*vehicle.truth(), before);
    assert!(vehicle.on_ground());
}

#[test]
fn thrust_follows_its_command_with_the_motors_time_constant() {
    let mut vehicle = standing();
    run(&mut vehicle, HOVER, 25);
    let share = vehicle.motors.total_thrust_n() / (PAPER_MASS_KG * GRAVITY_M_S2);
    assert!((share - (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
}

#[test]
fn hover_thrust_holds_a_hovering_drone() {
    let mut vehicle = hovering();
    run(&mut vehicle, HOVER, 1000);
    let truth = vehicle.truth();
    assert!((truth.position_m - Vector3::new(0.0, 0.0, 1.0)).norm() < 1e-6);
    assert!((truth.specific_force_m_s2 - Vector3::z() * GRAVITY_M_S2).norm() < 1e-6);
}

#[test]
fn a_falling_drone_feels_only_its_drag() {
    let mut vehicle = standing();
    vehicle.truth.position_m.z = 10.0;
    run(&mut vehicle, MotorCommands::STOPPED, 1000);
    let truth = vehicle.truth();
    // v' = -g - c v from rest: v(1 s) = -(g/c) (1 - e^-c).
    let c: f64 = 0.22;
    let expected = -GRAVITY_M_S2 / c * (1.0 - (-c).exp());
    assert!((truth.velocity_m_s.z - expected).abs() < 0.01);
    assert!((truth.specific_force_m_s2.z + c * truth.velocity_m_s.z).abs() < 0.01);
}

#[test]
fn motors_turn_the_body_the_way_the_mixer_means() {
    let turned = |commands| {
        let mut vehicle = hovering();
        run(&mut vehicle, MotorCommands(commands), 20);
        vehicle.truth().angular_rate_rad_s
    };
    let roll = turned([29_000, 29_000, 31_000, 31_000]);
    assert!(roll.x > 0.01 && roll.y.abs() < 1e-9 && roll.z.abs() < 1e-9);
    let nose_up = turned([31_000, 29_000, 29_000, 31_000]);
    assert!(nose_up.y < -0.01 && nose_up.x.abs() < 1e-9);
    let left = turned([29_000, 31_000, 29_000, 31_000]);
    assert!(left.z > 0.001 && left.x.abs() < 1e-9);
}

#[test]
fn wind_carries_a_hovering_drone_along() {
    let mut vehicle = hovering();
    vehicle.set_wind(Vector3::new(0.0, 2.0, 0.0));
    run(&mut vehicle, HOVER, 1000);
    let expected = 2.0 * (1.0 - (-0.22_f64).exp());
    assert!((vehicle.truth().velocity_m_s.y - expected).abs() < 1e-3);
}

#[test]
fn a_landing_stops_the_drone_and_levels_it() {
    let mut vehicle = standing();
    vehicle.truth.position_m.z = 0.05;
    vehicle.truth.turn(Vector3::new(0.2, 0.0, 0.3));
    run(&mut vehicle, MotorCommands::STOPPED, 110);
    assert!(vehicle.on_ground());
    run(&mut vehicle, MotorCommands::STOPPED, 500);
    let truth = vehicle.truth();
    assert_eq!(truth.velocity_m_s, Vector3::zeros());
    assert!(truth.up_in_body().z > 0.999_999);
    let (_, _, yaw) = truth.attitude.euler_angles();
    assert!((yaw - 0.3).abs() < 0.05, "the heading stays: {yaw}");
}

#[test]
fn specific_force_integrates_to_the_velocity() {
    let mut vehicle = hovering();
    vehicle.set_wind(Vector3::new(1.0, -0.5, 0.2));
    let mut velocity = Vector3::zeros();
    for step in 0..2000_u16 {
        let lean = 200 * u16::from(step % 100 < 50);
        vehicle.step(&MotorCommands([30_100, 30_000 + lean, 30_100, 30_000]));
        let truth = vehicle.truth();
        let felt = truth.attitude.transform_vector(&truth.specific_force_m_s2);
        velocity += (felt - Vector3::z() * GRAVITY_M_S2) * STEP_S;
    }
    assert!((velocity - vehicle.truth().velocity_m_s).norm() < 1e-9);
}

#[test]
fn unequal_thrusts_turn_the_body_as_fast_as_its_inertia_allows() {
    // The motors' lag is over after a second. Arms of 50 mm at 45 degrees; two motors on each side.
    let parameters = VehicleParameters::default();
    let per_count = parameters.full_thrust_n / 65_535.0;
    let arm = 0.05 * core::f64::consts::FRAC_1_SQRT_2;
    let spread = 4.0 * 100.0 * per_count;
    for (commands, expected) in [
        (
            [29_900, 29_900, 30_100, 30_100],
            Vector3::x() * (spread * arm / parameters.inertia_kg_m2.x),
        ),
        (
            [30_100, 29_900, 29_900, 30_100],
            Vector3::y() * (-spread * arm / parameters.inertia_kg_m2.y),
        ),
        (
            [29_900, 30_100, 29_900, 30_100],
            Vector3::z() * (spread * 0.005_94 / parameters.inertia_kg_m2.z),
        ),
    ] {
        let commands = MotorCommands(commands);
        let mut vehicle = hovering();
        for _ in 0..1000 {
            vehicle.motors.step(&commands);
        }
        run(&mut vehicle, commands, 100);
        let found = vehicle.truth().angular_rate_rad_s / 0.1;
        assert!(
            (found - expected).norm() < 1e-4 * expected.norm(),
            "{found} against {expected}"
        );
    }
}

#[test]
fn a_free_tumble_keeps_its_angular_momentum() {
    let mut vehicle = hovering();
    vehicle.truth.position_m.z = 100.0;
    vehicle.truth.angular_rate_rad_s = Vector3::new(3.0, -2.0, 4.0);
    let momentum = |vehicle: &Vehicle| {
        let truth = vehicle.truth();
        let inertia = vehicle.parameters.inertia_kg_m2;
        truth
            .attitude
            .transform_vector(&inertia.component_mul(&truth.angular_rate_rad_s))
    };
    let before = momentum(&vehicle);
    run(&mut vehicle, HOVER, 1000);
    let lost = (momentum(&vehicle) - before).norm() / before.norm();
    assert!(lost < 0.005, "lost {lost}");
    // Without the gyroscopic torque the body rate itself would stay.
    let turned = vehicle.truth().angular_rate_rad_s - Vector3::new(3.0, -2.0, 4.0);
    assert!(turned.norm() > 0.5, "{turned}");
}
