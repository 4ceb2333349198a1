//! Flights on the drone's own estimates.

use autopilot::controller::SetPoint;
use fake_sensors::motion::SensorModel;
use hil::steps::Stand;
use nalgebra::Vector3;

use super::{hold, ramp};

/// In the air above the start.
fn airborne(seed: u64) -> Stand {
    let mut flight = Stand::new(&SensorModel::default(), seed);
    flight.take_off();
    flight
}

#[test]
fn a_drone_takes_off_hovers_flies_five_metres_and_lands_on_its_own_estimates() {
    for seed in 0..5 {
        let mut flight = airborne(seed);
        let (mut steepest, mut lowest, mut highest) = (0.0_f64, f64::MAX, 0.0_f64);
        let mut watch = |flight: &Stand| {
            steepest = steepest.max(flight.tilt_deg());
            lowest = lowest.min(flight.truth().position_m.z);
            highest = highest.max(flight.truth().position_m.z);
        };
        flight.fly(6.0, |_| hold(0.0, 0.0, 0.5, 0.0), &mut watch);
        let line = |t| hold(5.0 * ramp(t, 6.0, 16.0), 0.0, 0.5, 0.0);
        flight.fly(18.0, line, &mut watch);
        assert!(steepest < 15.0, "seed {seed}: tilt {steepest} deg");
        assert!(
            lowest > 0.4 && highest < 0.6,
            "seed {seed}: {lowest}..{highest} m"
        );

        let estimate = flight.estimate().position_m;
        let missed = (estimate - Vector3::new(5.0, 0.0, 0.5)).norm();
        assert!(
            missed < 0.1,
            "seed {seed}: {missed} m from the set-point by its own estimate"
        );
        // Four times the drift of the open loop's statistics.
        let off = flight.truth().position_m - Vector3::new(5.0, 0.0, 0.5);
        assert!(off.norm() < 1.2, "seed {seed}: off by {off}");

        let descent = |t| hold(5.0, 0.0, 0.5 - 0.6 * ramp(t, 18.0, 20.0), 0.0);
        flight.fly(20.5, descent, |_| ());
        flight.fly(21.0, |_| SetPoint::MotorsOff, |_| ());
        assert!(flight.on_ground(), "seed {seed} has not landed");
        assert_eq!(flight.stabiliser().ekf().resets(), 1, "seed {seed}");
        assert_eq!(flight.stabiliser().measurements_lost(), 0);
    }
}

#[test]
fn a_step_of_the_set_point_is_reached_without_a_wild_tilt() {
    // The flight app gives its goals as steps.
    let mut flight = airborne(3);
    let mut steepest = 0.0_f64;
    flight.fly(
        10.0,
        |_| hold(1.0, -0.5, 0.5, 0.3),
        |flight| {
            steepest = steepest.max(flight.tilt_deg());
        },
    );
    assert!(steepest < 30.0, "tilt {steepest} deg");
    let estimate = flight.estimate();
    assert!((estimate.position_m - Vector3::new(1.0, -0.5, 0.5)).norm() < 0.1);
    assert!((estimate.yaw_rad() - 0.3).abs() < 0.05);
}

#[test]
fn a_seed_flies_the_same_flight_to_the_bit() {
    let trace = |seed| {
        let mut flight = airborne(seed);
        let mut bits: Vec<u64> = Vec::new();
        flight.fly(
            6.0,
            |_| hold(1.0, 0.0, 0.5, 0.0),
            |flight| {
                bits.extend(flight.truth().position_m.map(f64::to_bits).iter());
            },
        );
        (bits, flight.estimate().position_m.map(f32::to_bits))
    };
    assert_eq!(trace(5), trace(5));
    assert_ne!(trace(5), trace(6));
}
