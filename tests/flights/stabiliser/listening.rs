//! A filter that listens while the vehicle flies on the truth.

use autopilot::controller::{Controller, ControllerParameters, SetPoint};
use autopilot::ekf::{Ekf, Estimate, Parameters};
use autopilot::vehicle::{Truth, Vehicle};
use fake_sensors::motion::{MotionSensors, SensorModel};
use fake_sensors::random::Normal;
use nalgebra::{SVector, Vector3};

use crate::{hold, imu, measurements, ramp, sensed, standing};

/// The vehicle flies on the truth while the filter listens: filter reset at 1 s, flying from 1.9 s, half a metre up
/// between 2 and 3 s, a straight leg at 0.5 m/s from 6 s on, wandering by 2 to 3 cm and a degree.
pub struct Listening {
    pub vehicle: Vehicle,
    controller: Controller,
    sensors: MotionSensors,
    pub ekf: Ekf,
    wander: Wander,
    now_ms: u64,
}

impl Listening {
    pub const LEG_START_MS: u64 = 6000;
    const SPEED_M_S: f64 = 0.5;

    pub fn new(model: &SensorModel, seed: u64) -> Self {
        Self {
            vehicle: standing(),
            controller: Controller::new(&ControllerParameters::default()),
            sensors: MotionSensors::new(model, seed),
            ekf: Ekf::new(Parameters::default(), 0),
            wander: Wander::new(seed),
            now_ms: 0,
        }
    }

    pub fn step(&mut self) {
        if self.now_ms == 1000 {
            self.ekf.request_reset();
        }
        let readings = self.sensors.tick(&sensed(self.vehicle.truth()));
        let inertial = imu(&readings).measurements();
        for measurement in inertial.into_iter().chain(measurements(&readings)) {
            self.ekf.enqueue(measurement).expect("room for six");
        }
        self.ekf.tick(self.now_ms, self.now_ms >= 1900);

        let t = self.now_ms as f64 / 1000.0;
        let x = self.now_ms.saturating_sub(Self::LEG_START_MS) as f64 / 1000.0 * Self::SPEED_M_S;
        let set_point = self.wander.around(t, x, 0.5 * ramp(t, 2.0, 3.0));
        let truth = self.vehicle.truth();
        let gyro = truth.angular_rate_rad_s.map(f64::to_degrees).cast();
        let motors = self
            .controller
            .tick(self.now_ms, &known(truth), &gyro, &set_point);
        self.vehicle.step(&motors);
        self.now_ms += 1;
    }

    pub fn run_until(&mut self, end_ms: u64) {
        while self.now_ms < end_ms {
            self.step();
        }
    }

    /// Estimated less true position, m.
    pub fn error(&self) -> Vector3<f64> {
        self.ekf.estimate().position_m.cast() - self.vehicle.truth().position_m
    }
}

/// Slow sines about the leg.
struct Wander([f64; 3]);

impl Wander {
    fn new(seed: u64) -> Self {
        let mut random = Normal::new(seed, u64::MAX);
        Self([(); 3].map(|()| random.uniform() * core::f64::consts::TAU))
    }

    fn around(&self, t: f64, x: f64, z: f64) -> SetPoint {
        let airborne = ramp(t, 3.0, 4.0);
        let [a, b, c] = self.0;
        hold(
            x + airborne * 0.035 * libm::sin(1.7 * t + a),
            airborne * 0.035 * libm::sin(1.3 * t + b),
            z,
            airborne * 1.4_f64.to_radians() * libm::sin(0.9 * t + c),
        )
    }
}

/// The truth in an estimate's clothes.
fn known(truth: &Truth) -> Estimate {
    Estimate {
        position_m: truth.position_m.cast(),
        velocity_m_s: truth.velocity_m_s.cast(),
        velocity_body_m_s: truth
            .attitude
            .inverse_transform_vector(&truth.velocity_m_s)
            .cast(),
        attitude: truth.attitude.cast(),
        variances: SVector::zeros(),
    }
}
