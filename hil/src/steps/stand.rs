//! A drone without camera, link and app.

use autopilot::Stabiliser;
use autopilot::controller::{ControllerParameters, SetPoint};
use autopilot::ekf::{Estimate, Measurement, Parameters};
use autopilot::vehicle::{Truth, Vehicle, VehicleParameters};
use fake_sensors::motion::{MotionSensors, SensorModel};
use fake_sensors::wind::{Wind, WindModel};
use nalgebra::Vector3;

use crate::sensing;

/// Flies set-points on its own estimates, from the ground at the origin, facing north.
#[derive(Clone, Debug)]
pub struct Stand {
    vehicle: Vehicle,
    sensors: MotionSensors,
    stabiliser: Stabiliser,
    wind: Wind,
    now_ms: u64,
}

impl Stand {
    /// Where a [take-off](Stand::take_off) ends, metres above the ground.
    pub const HEIGHT_M: f32 = 0.5;

    /// The paper's drone in still air; `seed` draws the errors of its sensors.
    pub fn new(model: &SensorModel, seed: u64) -> Self {
        Self::in_wind(
            VehicleParameters::default(),
            model,
            &WindModel::calm(),
            seed,
        )
    }

    /// Any drone in any air.
    pub fn in_wind(
        parameters: VehicleParameters,
        model: &SensorModel,
        wind: &WindModel,
        seed: u64,
    ) -> Self {
        Self {
            vehicle: Vehicle::standing_at(parameters, Vector3::zeros(), 0.0),
            sensors: MotionSensors::new(model, seed),
            stabiliser: Stabiliser::new(Parameters::default(), &ControllerParameters::default(), 0),
            wind: Wind::new(wind, seed),
            now_ms: 0,
        }
    }

    /// One millisecond.
    pub fn step(&mut self, set_point: &SetPoint) {
        let readings = self
            .sensors
            .tick(&sensing::motion_truth(self.vehicle.truth()));
        let imu = sensing::imu_sample(&readings);
        let measurements: Vec<Measurement> = sensing::deck_measurements(&readings).collect();
        let motors = self
            .stabiliser
            .tick(self.now_ms, &imu, &measurements, set_point);
        self.vehicle.set_wind(self.wind.tick());
        self.vehicle.step(&motors);
        self.now_ms += 1;
    }

    /// Flies until `end_s` along set-points given as a function of time; `watch` sees every step.
    pub fn fly(
        &mut self,
        end_s: f64,
        set_point: impl Fn(f64) -> SetPoint,
        mut watch: impl FnMut(&Self),
    ) {
        while self.now_s() < end_s {
            self.step(&set_point(self.now_s()));
            watch(self);
        }
    }

    /// A second on the ground, a reset as the flight app does it, half a metre up in a second, a second and a half to
    /// settle: four seconds in all.
    pub fn take_off(&mut self) {
        self.fly(1.0, |_| SetPoint::MotorsOff, |_| ());
        self.stabiliser.request_filter_reset();
        self.fly(1.5, |_| SetPoint::MotorsOff, |_| ());
        let climb = |now_s: f64| {
            let share = (now_s - 1.5).clamp(0.0, 1.0) as f32;
            hold(Vector3::z() * (share * Self::HEIGHT_M), 0.0)
        };
        self.fly(4.0, climb, |_| ());
    }

    /// Time since the start, seconds.
    pub fn now_s(&self) -> f64 {
        self.now_ms as f64 / 1000.0
    }

    /// What the drone does.
    pub fn truth(&self) -> &Truth {
        self.vehicle.truth()
    }

    /// What its filter believes.
    pub fn estimate(&self) -> Estimate {
        self.stabiliser.estimate()
    }

    /// Filter and controllers, to count resets and losses.
    pub fn stabiliser(&self) -> &Stabiliser {
        &self.stabiliser
    }

    /// Whether it stands on its feet.
    pub fn on_ground(&self) -> bool {
        self.vehicle.on_ground()
    }

    /// Angle between the body's up and the world's, degrees.
    pub fn tilt_deg(&self) -> f64 {
        let up = self.truth().attitude.transform_vector(&Vector3::z());
        libm::acos(up.z.min(1.0)).to_degrees()
    }
}

/// The set-point that holds a position and a heading.
pub fn hold(position_m: Vector3<f32>, yaw_rad: f32) -> SetPoint {
    SetPoint::Hold {
        position_m,
        yaw_rad,
    }
}
