//! A Crazyflie in front of the native board, with a wire in between that a test can touch.

use autopilot::Stabiliser;
use autopilot::app::{Counters, Dropped, FlightApp, Outcome, Phase, Script, Settings};
use autopilot::controller::{ControllerParameters, SetPoint};
use autopilot::ekf::{Measurement, Parameters};
use autopilot::vehicle::{PAPER_MASS_KG, Vehicle, VehicleParameters};
use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::camera::{PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::motion::{MotionSensors, SensorModel};
use fake_sensors::world::World;
use hil::board::Board;
use hil::board::camera::Camera;
use hil::board::native::{EXTCLK_HZ, Native};
use hil::sensing;
use link::{Message, Parser};
use nalgebra::{Point2, Vector3};
use pilot::Pilot;

const SEED: u64 = 1;
/// How high the camera looks out above the drone's feet, m.
const CAMERA_HEIGHT_M: f32 = 0.04;
/// No flight here takes longer, ms.
const PATIENCE_MS: u64 = 900_000;

/// Which way bytes go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    App,
    Camera,
}

/// What is on the wire in one millisecond.
#[derive(Debug)]
pub struct Wire<'a> {
    pub now_ms: u64,
    pub to: To,
    /// What the app is doing.
    pub phase: Phase,
    pub bytes: &'a mut Vec<u8>,
}

impl Wire<'_> {
    /// Puts messages in front of what is there.
    pub fn precede_with(&mut self, messages: &[Message]) {
        let frames = messages.iter().flat_map(Message::encode);
        self.bytes.splice(..0, frames);
    }
}

/// A flight that has ended.
#[derive(Debug)]
pub struct Flown {
    pub outcome: Outcome,
    /// Where the drone was ten times a second: time in ms, phase, place in the frame of the take-off, m.
    pub track: Vec<(u64, Phase, Point2<f64>)>,
    /// When each command was heard by the camera, ms, and its byte.
    pub heard: Vec<(u64, u8)>,
    /// What the app handled.
    pub received: Vec<Message>,
    pub dropped: Vec<Dropped>,
    pub counters: Counters,
    /// Whether every set-point was a number.
    pub finite: bool,
}

impl Flown {
    /// Where the drone was at a time, m.
    pub fn at(&self, now_ms: u64) -> Point2<f64> {
        let index = usize::try_from(now_ms / 100).expect("a short flight");
        self.track[index].2
    }

    /// Where it ended, m.
    pub fn end(&self) -> Point2<f64> {
        self.track.last().expect("a flight").2
    }

    /// When the camera first heard a command, ms.
    pub fn first_heard(&self, byte: u8) -> u64 {
        let mut heard = self.heard.iter().filter(|heard| heard.1 == byte);
        heard.next().expect("the command is sent").0
    }

    /// How far from where recording began it ended, m.
    pub fn home_error_m(&self, record: u8) -> f64 {
        (self.end() - self.at(self.first_heard(record))).norm()
    }
}

/// Flies a script from `start`, metres north and west in the arena.
pub fn fly(
    script: Script,
    settings: Settings,
    (world, start): (&str, [f64; 2]),
    mut touch: impl FnMut(&mut Wire<'_>),
) -> Flown {
    let mut rig = Rig::new(script, settings, world, start);
    let mut flown = Flown {
        outcome: Outcome::TimedOut,
        track: Vec::new(),
        heard: Vec::new(),
        received: Vec::new(),
        dropped: Vec::new(),
        counters: Counters::default(),
        finite: true,
    };
    while rig.now_ms < PATIENCE_MS {
        if rig.now_ms.is_multiple_of(100) {
            let place = rig.vehicle.truth().position_m.xy() - Vector3::from(rig.start_m).xy();
            flown
                .track
                .push((rig.now_ms, rig.app.phase(), Point2::from(place)));
        }
        rig.tick(&mut flown, &mut touch);
        if let Phase::Landed(outcome) = rig.app.phase() {
            flown.outcome = outcome;
            break;
        }
    }
    flown.counters = rig.app.counters();
    flown
}

struct Rig {
    vehicle: Vehicle,
    sensors: MotionSensors,
    stabiliser: Stabiliser,
    app: FlightApp,
    board: Native,
    /// Reads along what the camera hears.
    ear: Parser,
    start_m: Vector3<f64>,
    set_point: SetPoint,
    measurements: Vec<Measurement>,
    from_board: Vec<u8>,
    now_ms: u64,
}

impl Rig {
    fn new(script: Script, settings: Settings, world: &str, [north, west]: [f64; 2]) -> Self {
        let start_m = Vector3::new(north, west, 0.0);
        let parameters = VehicleParameters::crazyflie_brushless(PAPER_MASS_KG);
        let vehicle = Vehicle::standing_at(parameters, start_m, 0.0);
        let board = board(world, camera_pose(&vehicle));
        Self {
            vehicle,
            sensors: MotionSensors::new(&SensorModel::default(), SEED),
            stabiliser: Stabiliser::new(Parameters::default(), &ControllerParameters::default(), 0),
            app: FlightApp::new(script, settings),
            board,
            ear: Parser::new(),
            start_m,
            set_point: SetPoint::MotorsOff,
            measurements: Vec::new(),
            from_board: Vec::new(),
            now_ms: 0,
        }
    }

    fn tick(&mut self, flown: &mut Flown, touch: &mut impl FnMut(&mut Wire<'_>)) {
        let now_ms = self.now_ms;
        self.board.look_from(camera_pose(&self.vehicle));
        self.vehicle_tick(flown);
        let phase = self.app.phase();
        let mut carry = |to, bytes: &mut Vec<u8>| {
            touch(&mut Wire {
                now_ms,
                to,
                phase,
                bytes,
            });
        };
        let mut from_board = std::mem::take(&mut self.from_board);
        carry(To::App, &mut from_board);
        let estimate = self.stabiliser.estimate();
        let mut output = self.app.tick(now_ms, &estimate, &from_board);
        carry(To::Camera, &mut output.transmit);
        for frame in self.ear.frames(&output.transmit) {
            if let Message::Command(command) = frame.message {
                flown.heard.push((now_ms, command.command));
            }
        }
        self.board.transmit(&output.transmit);
        self.board.advance().expect("the native board never fails");
        self.board.receive(&mut self.from_board);
        if output.reset_filter {
            self.stabiliser.request_filter_reset();
        }
        self.set_point = output.set_point;
        self.measurements = output.measurements;
        let received = self.app.take_received().into_iter();
        flown
            .received
            .extend(received.map(|received| received.message));
        flown.dropped.extend(self.app.take_dropped());
        self.now_ms += 1;
    }

    /// Sensors, filter, controller and physics.
    fn vehicle_tick(&mut self, flown: &mut Flown) {
        if let SetPoint::Hold { position_m, .. } = self.set_point {
            flown.finite &= position_m.iter().all(|coordinate| coordinate.is_finite());
        }
        let truth = sensing::motion_truth(self.vehicle.truth());
        let readings = self.sensors.tick(&truth);
        let mut measurements: Vec<_> = sensing::deck_measurements(&readings).collect();
        measurements.append(&mut self.measurements);
        let imu = sensing::imu_sample(&readings);
        let motors = self
            .stabiliser
            .tick(self.now_ms, &imu, &measurements, &self.set_point);
        self.vehicle.step(&motors);
    }
}

fn board(world: &str, pose: Pose) -> Native {
    let pilot = Pilot::new(&pilot::Parameters::DEFAULT).expect("the default lens");
    let initial = pilot.exposure();
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, initial.shutter_lines, initial.gain);
    let world = World::named(world, SEED).expect("a world");
    let optics = PanoramicCamera::new(world, &PanoramicLens::default(), SEED);
    Native::new(pilot, Camera::new(chip, optics, pose))
}

fn camera_pose(vehicle: &Vehicle) -> Pose {
    let truth = vehicle.truth();
    let attitude = truth.attitude.cast::<f32>();
    let above_feet = Vector3::new(0.0, 0.0, CAMERA_HEIGHT_M);
    Pose {
        position_m: truth.position_m.cast() + attitude * above_feet,
        attitude,
    }
}
