//! A filter that listens while the vehicle flies on the truth.

use autopilot::controller::{Controller, ControllerParameters, SetPoint};
use autopilot::ekf::{Ekf, Estimate, Parameters};
use autopilot::vehicle::{Truth, Vehicle, VehicleParameters};
use fake_sensors::motion::{MotionSensors, SensorModel};
use fake_sensors::random::Normal;
use nalgebra::{SVector, Vector3};

use crate::sensing;

/// The filter is reset as the flight app does it, after a second on the ground.
const RESET_MS: u64 = 1000;
/// From here on the filter is told that it flies.
const FLYING_MS: u64 = 1900;
/// Height of the flight, metres.
const HEIGHT_M: f64 = 0.5;
/// Speed along the leg, m/s.
const SPEED_M_S: f64 = 0.5;

/// A flight along x whose estimate nobody flies by: reset at 1 s, half a metre up between 2 and 3 s, and from
/// [`OpenLoop::LEG_START_MS`] on straight ahead at 0.5 m/s, wandering by 2 to 3 cm and a degree.
#[derive(Debug)]
pub struct OpenLoop {
    /// The truth.
    pub vehicle: Vehicle,
    /// The filter that listens to the sensors.
    pub ekf: Ekf,
    controller: Controller,
    sensors: MotionSensors,
    wander: Wander,
    now_ms: u64,
}

impl OpenLoop {
    /// When the leg begins, ms.
    pub const LEG_START_MS: u64 = 6000;

    /// A drone on the ground; `seed` draws the sensors' errors and the wander.
    pub fn new(model: &SensorModel, seed: u64) -> Self {
        Self {
            vehicle: Vehicle::standing_at(VehicleParameters::default(), Vector3::zeros(), 0.0),
            ekf: Ekf::new(Parameters::default(), 0),
            controller: Controller::new(&ControllerParameters::default()),
            sensors: MotionSensors::new(model, seed),
            wander: Wander::new(seed),
            now_ms: 0,
        }
    }

    /// One millisecond.
    pub fn step(&mut self) {
        if self.now_ms == RESET_MS {
            self.ekf.request_reset();
        }
        let readings = self
            .sensors
            .tick(&sensing::motion_truth(self.vehicle.truth()));
        let inertial = sensing::imu_sample(&readings).measurements();
        for measurement in inertial
            .into_iter()
            .chain(sensing::deck_measurements(&readings))
        {
            // At most four in a queue of twenty that every tick empties.
            let _ = self.ekf.enqueue(measurement);
        }
        self.ekf.tick(self.now_ms, self.now_ms >= FLYING_MS);

        let set_point = self.set_point();
        let truth = self.vehicle.truth();
        let gyro = truth.angular_rate_rad_s.map(f64::to_degrees).cast();
        let motors = self
            .controller
            .tick(self.now_ms, &known(truth), &gyro, &set_point);
        self.vehicle.step(&motors);
        self.now_ms += 1;
    }

    /// Steps until `end_ms`.
    pub fn run_until(&mut self, end_ms: u64) {
        while self.now_ms < end_ms {
            self.step();
        }
    }

    /// Estimated less true position, metres.
    pub fn position_error(&self) -> Vector3<f64> {
        self.ekf.estimate().position_m.cast() - self.vehicle.truth().position_m
    }

    /// Estimated less true heading, radians.
    pub fn yaw_error(&self) -> f64 {
        let (_, _, heading) = self.vehicle.truth().attitude.euler_angles();
        f64::from(self.ekf.estimate().yaw_rad()) - heading
    }

    fn set_point(&self) -> SetPoint {
        let t = self.now_ms as f64 / 1000.0;
        let leg_s = self.now_ms.saturating_sub(Self::LEG_START_MS) as f64 / 1000.0;
        let wander = self.wander.at(t);
        let along = Vector3::new(leg_s * SPEED_M_S, 0.0, HEIGHT_M * ramp(t, 2.0, 3.0));
        SetPoint::Hold {
            position_m: (along + wander.shift_m).cast(),
            yaw_rad: wander.yaw_rad as f32,
        }
    }
}

/// Slow sines about the leg, from half a second after take-off on.
#[derive(Debug)]
struct Wander {
    phases_rad: [f64; 3],
}

/// Where the wander is at one instant.
struct Aside {
    shift_m: Vector3<f64>,
    yaw_rad: f64,
}

impl Wander {
    /// Amplitude along x and y, metres: 2.5 cm RMS.
    const SHIFT_M: f64 = 0.035;
    /// Amplitude of the heading, degrees: one degree RMS.
    const YAW_DEG: f64 = 1.4;
    /// Angular frequencies of x, y and heading, rad/s: apart, so that the sum does not repeat itself on the leg.
    const RATES_RAD_S: [f64; 3] = [1.7, 1.3, 0.9];

    fn new(seed: u64) -> Self {
        let mut random = Normal::new(seed, u64::MAX);
        Self {
            phases_rad: [(); 3].map(|()| random.uniform() * core::f64::consts::TAU),
        }
    }

    fn at(&self, t_s: f64) -> Aside {
        let airborne = ramp(t_s, 3.0, 4.0);
        let sine = |axis: usize| {
            airborne * libm::sin(Self::RATES_RAD_S[axis] * t_s + self.phases_rad[axis])
        };
        Aside {
            shift_m: Vector3::new(sine(0), sine(1), 0.0) * Self::SHIFT_M,
            yaw_rad: sine(2) * Self::YAW_DEG.to_radians(),
        }
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

/// From zero at `from_s` to one at `to_s`.
fn ramp(t_s: f64, from_s: f64, to_s: f64) -> f64 {
    ((t_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0)
}
