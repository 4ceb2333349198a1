//! All that flies and is not the camera board: vehicle, motion sensors, filter, controllers and the
//! flight app.

use core::f64::consts::TAU;

use autopilot::app::{self, FlightApp, Script, Settings};
use autopilot::controller::{ControllerParameters, MotorCommands, SetPoint};
use autopilot::ekf::{self, Ekf, Estimate, Measurement};
use autopilot::vehicle::{PAPER_MASS_KG, Truth, Vehicle, VehicleParameters};
use autopilot::{FlyingDetector, Stabiliser};
use fake_sensors::camera;
use fake_sensors::motion::{MotionReadings, MotionSensors, SensorModel};
use fake_sensors::random::Normal;
use fake_sensors::wind::{Wind, WindModel};
use link::Message;
use nalgebra::{UnitQuaternion, Vector3};

use crate::record::PlanarPose;
use crate::recorder::Glimpse;
use crate::scenario::{Conditions, Scenario};
use crate::sensing;

/// How high the camera looks out above the drone's feet, metres.
const CAMERA_HEIGHT_M: f32 = 0.04;

/// Stream of the seed that draws where the wind comes from, clear of the sensors'.
const WIND_DIRECTION_STREAM: u64 = u64::from_be_bytes(*b"windfrom");

/// A Crazyflie without its camera board.
#[derive(Debug)]
pub struct Aircraft {
    vehicle: Vehicle,
    sensors: MotionSensors,
    stabiliser: Stabiliser,
    app: FlightApp,
    /// The filter's twin: fed with the same sensors, never corrected.
    uncorrected: Ekf,
    flying: FlyingDetector,
    motors: MotorCommands,
    /// What the app asked of the filter, for its next tick.
    measurements: Vec<Measurement>,
    reset_filter: bool,
    set_point: SetPoint,
    wind: Option<Wind>,
}

impl Aircraft {
    /// On the ground at the start of the route, facing north.
    pub fn new(scenario: &Scenario, route: &app::Route) -> Self {
        let filter = ekf::Parameters::default();
        let spacing = [scenario.spacing.decimetres()];
        let script = Script::record_and_return(route, scenario.homing.record(), &spacing);
        Self {
            vehicle: Vehicle::standing_at(
                VehicleParameters::crazyflie_brushless(PAPER_MASS_KG),
                Vector3::zeros(),
                0.0,
            ),
            sensors: MotionSensors::new(&SensorModel::default(), scenario.seed),
            stabiliser: Stabiliser::new(filter, &ControllerParameters::default(), 0),
            app: FlightApp::new(script, settings(&scenario.conditions)),
            uncorrected: Ekf::new(filter, 0),
            flying: FlyingDetector::default(),
            motors: MotorCommands::STOPPED,
            measurements: Vec::new(),
            reset_filter: false,
            set_point: SetPoint::MotorsOff,
            wind: wind(scenario),
        }
    }

    /// One millisecond: `received` is what came from the camera board since the last call. Returns
    /// what goes to it.
    pub fn tick(&mut self, now_ms: u64, received: &[u8]) -> Vec<u8> {
        let readings = self
            .sensors
            .tick(&sensing::motion_truth(self.vehicle.truth()));
        self.filter(now_ms, &readings);
        let output = self.app.tick(now_ms, &self.stabiliser.estimate(), received);
        self.measurements = output.measurements;
        self.reset_filter = output.reset_filter;
        self.set_point = output.set_point;
        if let Some(wind) = &mut self.wind {
            self.vehicle.set_wind(wind.tick());
        }
        self.vehicle.step(&self.motors);
        output.transmit
    }

    /// Sensors, filter and controllers.
    fn filter(&mut self, now_ms: u64, readings: &MotionReadings) {
        if std::mem::take(&mut self.reset_filter) {
            self.stabiliser.request_filter_reset();
            self.uncorrected.request_reset();
        }
        let imu = sensing::imu_sample(readings);
        let mut measurements: Vec<Measurement> = sensing::deck_measurements(readings).collect();
        // The same rule on the same commands as in the filter that is corrected.
        let flying = self.flying.update(now_ms, &self.motors);
        for measurement in imu.measurements().iter().chain(&measurements) {
            // Three or four of twenty places: the queue is drained every tick.
            let _ = self.uncorrected.enqueue(*measurement);
        }
        self.uncorrected.tick(now_ms, flying);
        measurements.append(&mut self.measurements);
        self.motors = self
            .stabiliser
            .tick(now_ms, &imu, &measurements, &self.set_point);
    }

    /// Where the camera is.
    pub fn camera_pose(&self) -> camera::Pose {
        let truth = self.vehicle.truth();
        camera_pose(&truth.position_m, &truth.attitude)
    }

    /// Where the drone really is, and how it moves.
    pub fn truth(&self) -> &Truth {
        self.vehicle.truth()
    }

    /// What the app is doing.
    pub fn phase(&self) -> app::Phase {
        self.app.phase()
    }

    /// The messages that the app has taken from its UART since the last call.
    pub fn take_received(&mut self) -> impl Iterator<Item = Message> + use<> {
        self.app
            .take_received()
            .into_iter()
            .map(|received| received.message)
    }

    /// Where things stand.
    pub fn glimpse(&self) -> Glimpse {
        let truth = self.vehicle.truth();
        Glimpse {
            truth: PlanarPose {
                x: truth.position_m.x,
                y: truth.position_m.y,
                yaw: yaw(&truth.attitude),
            },
            estimate: planar(&self.stabiliser.estimate()),
            uncorrected: planar(&self.uncorrected.estimate()),
            height_m: truth.position_m.z,
        }
    }
}

/// The camera of a drone whose feet are at `position_m`.
pub fn camera_pose(position_m: &Vector3<f64>, attitude: &UnitQuaternion<f64>) -> camera::Pose {
    let attitude = attitude.cast::<f32>();
    let above_feet = Vector3::new(0.0, 0.0, CAMERA_HEIGHT_M);
    camera::Pose {
        position_m: position_m.cast() + attitude * above_feet,
        attitude,
    }
}

/// The app's settings in a flight.
fn settings(conditions: &Conditions) -> Settings {
    Settings {
        quirks: conditions.quirks,
        correction: conditions.correction.sd(),
        ..Settings::default()
    }
}

/// The air, if it moves.
fn wind(scenario: &Scenario) -> Option<Wind> {
    let wind = scenario.conditions.wind?;
    let from_rad = TAU * Normal::new(scenario.seed, WIND_DIRECTION_STREAM).uniform();
    let model = WindModel::new(wind.mean_m_s, from_rad, wind.turbulence);
    Some(Wind::new(&model, scenario.seed))
}

/// The camera of a drone that stands at the start of the route, facing north.
pub fn pose_on_the_ground() -> camera::Pose {
    camera::Pose {
        position_m: Vector3::new(0.0, 0.0, CAMERA_HEIGHT_M),
        attitude: UnitQuaternion::identity(),
    }
}

fn planar(estimate: &Estimate) -> PlanarPose {
    PlanarPose {
        x: estimate.position_m.x.into(),
        y: estimate.position_m.y.into(),
        yaw: estimate.yaw_rad().into(),
    }
}

/// Heading of an attitude, radians, counter-clockwise from north.
fn yaw(attitude: &UnitQuaternion<f64>) -> f64 {
    let forward = attitude * Vector3::x();
    libm::atan2(forward.y, forward.x)
}
