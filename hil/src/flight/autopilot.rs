//! What a restart of the autopilot takes away: filter, controllers and flight app.

use autopilot::app::{FlightApp, Phase, Script, Settings};
use autopilot::controller::{ControllerParameters, MotorCommands, SetPoint};
use autopilot::ekf::{self, Ekf, Estimate, Measurement};
use autopilot::{FlyingDetector, Stabiliser};
use fake_sensors::motion::MotionReadings;
use link::WorldPoint;

use crate::record::PlanarPose;
use crate::sensing::{deck_measurements, imu_sample};

/// A Crazyflie's processor from power-on.
#[derive(Debug)]
pub struct Autopilot {
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
}

impl Autopilot {
    /// One that starts at `now_ms`, and will fly `script`.
    pub fn new(script: Script, settings: Settings, now_ms: u64) -> Self {
        let usual = ekf::Parameters::default();
        let filter = ekf::Parameters {
            // Within the fence of a long route the filter does not start afresh.
            max_position_m: usual.max_position_m.max(settings.max_distance_m),
            ..usual
        };
        Self {
            stabiliser: Stabiliser::new(filter, &ControllerParameters::default(), now_ms),
            app: FlightApp::new(script, settings),
            uncorrected: Ekf::new(filter, now_ms),
            flying: FlyingDetector::default(),
            motors: MotorCommands::STOPPED,
            measurements: Vec::new(),
            reset_filter: false,
            set_point: SetPoint::MotorsOff,
        }
    }

    /// One millisecond: `received` is what came from the camera board since the last call. Returns
    /// what goes to it.
    pub fn tick(&mut self, now_ms: u64, readings: &MotionReadings, received: &[u8]) -> Vec<u8> {
        self.filter(now_ms, readings);
        let output = self.app.tick(now_ms, &self.stabiliser.estimate(), received);
        self.measurements = output.measurements;
        self.reset_filter = output.reset_filter;
        self.set_point = output.set_point;
        output.transmit
    }

    /// Sensors, filter and controllers.
    fn filter(&mut self, now_ms: u64, readings: &MotionReadings) {
        if std::mem::take(&mut self.reset_filter) {
            self.stabiliser.request_filter_reset();
            self.uncorrected.request_reset();
        }
        let imu = imu_sample(readings);
        let mut measurements: Vec<_> = deck_measurements(readings).collect();
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

    /// What the motors are to do.
    pub fn motors(&self) -> &MotorCommands {
        &self.motors
    }

    /// The flight app.
    pub fn app(&mut self) -> &mut FlightApp {
        &mut self.app
    }

    /// What the app is doing.
    pub fn phase(&self) -> Phase {
        self.app.phase()
    }

    /// How often the filter was reset.
    pub fn filter_resets(&self) -> u32 {
        self.stabiliser.ekf().resets()
    }

    /// Where the filter believes the drone is, in its own coordinates.
    pub fn estimate(&self) -> PlanarPose {
        planar(&self.stabiliser.estimate())
    }

    /// Where the filter would believe the drone is without the camera's corrections.
    pub fn uncorrected(&self) -> PlanarPose {
        planar(&self.uncorrected.estimate())
    }

    /// Where the app lets the drone fly, if it flies.
    pub fn set_point(&self) -> Option<WorldPoint> {
        match self.set_point {
            SetPoint::MotorsOff => None,
            SetPoint::Hold { position_m, .. } | SetPoint::GoTo { position_m } => Some(WorldPoint {
                x: position_m.x,
                y: position_m.y,
            }),
        }
    }

    /// The correction that the app has told the filter of in this millisecond, if any: the shift of the
    /// position, x north, y west, metres, and the turn, counter-clockwise, radians.
    pub fn correction(&self) -> Option<([f32; 2], f32)> {
        let believed = self.stabiliser.estimate().position_m;
        self.measurements.windows(2).find_map(|pair| match pair {
            [Measurement::Position(place), Measurement::YawError(yaw)] => {
                let shift = place.position_m - believed;
                Some(([shift.x, shift.y], -yaw.error_rad))
            }
            _ => None,
        })
    }
}

fn planar(estimate: &Estimate) -> PlanarPose {
    PlanarPose {
        x: estimate.position_m.x.into(),
        y: estimate.position_m.y.into(),
        yaw: estimate.yaw_rad().into(),
    }
}
