//! Flights on the drone's own estimates.

use autopilot::Stabiliser;
use autopilot::controller::{ControllerParameters, SetPoint};
use autopilot::ekf::Parameters;
use autopilot::vehicle::{Truth, Vehicle};
use fake_sensors::motion::{MotionSensors, SensorModel};
use hil::sensing;
use nalgebra::Vector3;

use crate::{hold, ramp, standing};

/// A drone that flies on its own estimates.
struct ClosedLoop {
    vehicle: Vehicle,
    sensors: MotionSensors,
    stabiliser: Stabiliser,
    now_ms: u64,
}

impl ClosedLoop {
    fn new(seed: u64) -> Self {
        Self {
            vehicle: standing(),
            sensors: MotionSensors::new(&SensorModel::default(), seed),
            stabiliser: Stabiliser::new(Parameters::default(), &ControllerParameters::default(), 0),
            now_ms: 0,
        }
    }

    /// Flies until `until_s` along set-points given as a function of time; `watch` sees the truth of every step.
    fn fly(
        &mut self,
        until_s: f64,
        set_point: impl Fn(f64) -> SetPoint,
        mut watch: impl FnMut(&Truth),
    ) {
        while (self.now_ms as f64) < until_s * 1000.0 {
            let readings = self
                .sensors
                .tick(&sensing::motion_truth(self.vehicle.truth()));
            let measurements: Vec<_> = sensing::deck_measurements(&readings).collect();
            let motors = self.stabiliser.tick(
                self.now_ms,
                &sensing::imu_sample(&readings),
                &measurements,
                &set_point(self.now_ms as f64 / 1000.0),
            );
            self.vehicle.step(&motors);
            watch(self.vehicle.truth());
            self.now_ms += 1;
        }
    }

    /// A second on the ground, a reset as the flight app does it, half a metre up in a second, a second to settle.
    fn take_off(&mut self) {
        self.fly(1.0, |_| SetPoint::MotorsOff, |_| ());
        self.stabiliser.request_filter_reset();
        let climb = |t| hold(0.0, 0.0, 0.5 * ramp(t, 1.5, 2.5), 0.0);
        self.fly(1.5, |_| SetPoint::MotorsOff, |_| ());
        self.fly(4.0, climb, |_| ());
    }
}

fn tilt_deg(truth: &Truth) -> f64 {
    let up = truth.attitude.transform_vector(&Vector3::z());
    libm::acos(up.z.min(1.0)).to_degrees()
}

#[test]
fn a_drone_takes_off_hovers_flies_five_metres_and_lands_on_its_own_estimates() {
    for seed in 0..5 {
        let mut flight = ClosedLoop::new(seed);
        flight.take_off();
        let (mut steepest, mut lowest, mut highest) = (0.0_f64, f64::MAX, 0.0_f64);
        let mut watch = |truth: &Truth| {
            steepest = steepest.max(tilt_deg(truth));
            lowest = lowest.min(truth.position_m.z);
            highest = highest.max(truth.position_m.z);
        };
        flight.fly(6.0, |_| hold(0.0, 0.0, 0.5, 0.0), &mut watch);
        let line = |t| hold(5.0 * ramp(t, 6.0, 16.0), 0.0, 0.5, 0.0);
        flight.fly(18.0, line, &mut watch);
        assert!(steepest < 15.0, "seed {seed}: tilt {steepest} deg");
        assert!(
            lowest > 0.4 && highest < 0.6,
            "seed {seed}: {lowest}..{highest} m"
        );

        let estimate = flight.stabiliser.estimate().position_m;
        let missed = (estimate - Vector3::new(5.0, 0.0, 0.5)).norm();
        assert!(
            missed < 0.1,
            "seed {seed}: {missed} m from the set-point by its own estimate"
        );
        // Four times the drift of the open loop's statistics.
        let off = flight.vehicle.truth().position_m - Vector3::new(5.0, 0.0, 0.5);
        assert!(off.norm() < 1.2, "seed {seed}: off by {off}");

        let descent = |t| hold(5.0, 0.0, 0.5 - 0.6 * ramp(t, 18.0, 20.0), 0.0);
        flight.fly(20.5, descent, |_| ());
        flight.fly(21.0, |_| SetPoint::MotorsOff, |_| ());
        assert!(flight.vehicle.on_ground(), "seed {seed} has not landed");
        assert_eq!(flight.stabiliser.ekf().resets(), 1, "seed {seed}");
        assert_eq!(flight.stabiliser.measurements_lost(), 0);
    }
}

#[test]
fn a_step_of_the_set_point_is_reached_without_a_wild_tilt() {
    // The flight app gives its goals as steps.
    let mut flight = ClosedLoop::new(3);
    flight.take_off();
    let mut steepest = 0.0_f64;
    flight.fly(
        10.0,
        |_| hold(1.0, -0.5, 0.5, 0.3),
        |truth| {
            steepest = steepest.max(tilt_deg(truth));
        },
    );
    assert!(steepest < 30.0, "tilt {steepest} deg");
    let estimate = flight.stabiliser.estimate();
    assert!((estimate.position_m - Vector3::new(1.0, -0.5, 0.5)).norm() < 0.1);
    assert!((estimate.yaw_rad() - 0.3).abs() < 0.05);
}

#[test]
fn a_seed_flies_the_same_flight_to_the_bit() {
    let trace = |seed| {
        let mut flight = ClosedLoop::new(seed);
        let mut bits: Vec<u64> = Vec::new();
        flight.take_off();
        flight.fly(
            6.0,
            |_| hold(1.0, 0.0, 0.5, 0.0),
            |truth| {
                bits.extend(truth.position_m.map(f64::to_bits).iter());
            },
        );
        (
            bits,
            flight.stabiliser.estimate().position_m.map(f32::to_bits),
        )
    };
    assert_eq!(trace(5), trace(5));
    assert_ne!(trace(5), trace(6));
}
