//! All that flies and is not the camera board: the vehicle in its air, its motion sensors and its
//! autopilot.

use core::f64::consts::TAU;

use autopilot::app::{self, Dropped, Script, Settings, Step, Until};
use autopilot::vehicle::{PAPER_MASS_KG, Truth, Vehicle, VehicleParameters};
use fake_sensors::camera;
use fake_sensors::motion::{FlowModel, MotionSensors, SensorModel};
use fake_sensors::random::Normal;
use fake_sensors::wind::{Wind, WindModel};
use link::{Message, Mode, WorldPoint, WorldPose};
use nalgebra::{UnitQuaternion, Vector3};

use super::autopilot::Autopilot;
use crate::record::{PlanarPose, What};
use crate::recorder::Glimpse;
use crate::scenario::{Conditions, Scenario};
use crate::sensing::motion_truth;

/// How high the camera looks out above the drone's feet, metres.
const CAMERA_HEIGHT_M: f32 = 0.04;

/// From the moment in which the autopilot stops to its flight app's first tick, milliseconds: two
/// seconds to boot, and the operator's way to the button.
const RESTART_MS: u64 = 5_000;

/// How long the operator looks on while the camera leads nowhere, milliseconds: longer than the longest
/// vector takes, and than the app rests at home.
const PATIENCE_MS: u64 = 20_000;

/// The operator's patience with a way back, milliseconds a metre: three times what cruise and homing every two
/// metres take.
const FOLLOWING_MS_PER_M: f32 = 7_000.0;

/// From the farthest place of a long route to the fence, metres: what odometry alone is off after some hundred
/// metres.
const FENCE_MARGIN_M: f32 = 10.0;

/// Stream of the seed that draws where the wind comes from, clear of the sensors'.
const WIND_DIRECTION_STREAM: u64 = u64::from_be_bytes(*b"windfrom");

/// A Crazyflie without its camera board.
#[derive(Debug)]
pub struct Aircraft {
    vehicle: Vehicle,
    sensors: MotionSensors,
    wind: Option<Wind>,
    is_piloted: bool,
    autopilot: Autopilot,
    settings: Settings,
    /// What the operator starts: from the ground the whole script, later on the way back.
    script: Script,
    /// When the autopilot stops, if it has not yet.
    stops_ms: Option<u64>,
    /// Since when the autopilot runs, or from when on it will.
    runs_since_ms: u64,
    /// Where the filter's coordinates have their origin; none as long as that is the route's.
    origin: Option<PlanarPose>,
    origin_is_news: bool,
    filter_resets: u32,
    /// Where the app lets the drone fly, and since when.
    flies_to: (Option<WorldPoint>, u64),
    /// The operator has seen that the camera leads nowhere any more.
    stopped_safely: bool,
    deeds: Vec<What>,
}

impl Aircraft {
    /// On the ground at the start of the route, facing north.
    pub fn new(scenario: &Scenario, route: &app::Route) -> Self {
        Self::flying(scenario, route, scenario.script())
    }

    /// On the ground at the start of the route, facing north, to fly another script.
    pub fn flying(scenario: &Scenario, route: &app::Route, script: Script) -> Self {
        let settings = settings(&scenario.conditions, route);
        let stops_s = scenario.conditions.restart_s;
        Self {
            vehicle: Vehicle::standing_at(
                VehicleParameters::crazyflie_brushless(PAPER_MASS_KG),
                Vector3::zeros(),
                0.0,
            ),
            sensors: MotionSensors::new(&sensor_model(&scenario.conditions), scenario.seed),
            wind: wind(scenario),
            is_piloted: scenario.conditions.piloted,
            autopilot: Autopilot::new(script.clone(), settings, 0),
            settings,
            script,
            stops_ms: stops_s.map(|seconds| (1_000.0 * seconds) as u64),
            runs_since_ms: 0,
            origin: None,
            origin_is_news: false,
            filter_resets: 0,
            flies_to: (None, 0),
            stopped_safely: false,
            deeds: Vec::new(),
        }
    }

    /// One millisecond: `received` is what came from the camera board since the last call. Returns
    /// what goes to it.
    pub fn tick(&mut self, now_ms: u64, received: &[u8]) -> Vec<u8> {
        if self.stops_ms == Some(now_ms) {
            self.restart(now_ms);
        }
        let readings = self.sensors.tick(&motion_truth(self.vehicle.truth()));
        if self.is_piloted {
            let seen = self.true_pose();
            self.autopilot.app().set_seen(WorldPose {
                x: seen.x as f32,
                y: seen.y as f32,
                yaw: seen.yaw as f32,
            });
        }
        let transmit = if now_ms >= self.runs_since_ms {
            self.autopilot.tick(now_ms, &readings, received)
        } else {
            // Nobody reads the sensors or the UART.
            Vec::new()
        };
        self.notice_filter_reset();
        self.notice_deeds(now_ms);
        self.watch(now_ms);
        if let Some(wind) = &mut self.wind {
            self.vehicle.set_wind(wind.tick());
        }
        self.vehicle.step(self.autopilot.motors());
        transmit
    }

    /// The autopilot's processor stops, and the motors with it; when it runs again, the operator lets
    /// the drone take off where it lies and follow the route.
    fn restart(&mut self, now_ms: u64) {
        let has_flown = !matches!(self.phase(), app::Phase::Ground | app::Phase::TakeOff);
        if has_flown {
            self.script = way_back();
        }
        self.runs_since_ms = now_ms + RESTART_MS;
        self.autopilot = Autopilot::new(self.script.clone(), self.settings, self.runs_since_ms);
        self.filter_resets = 0;
        self.stops_ms = None;
    }

    /// A filter that is reset counts from where the drone is. The first reset is at the route's own
    /// origin.
    fn notice_filter_reset(&mut self) {
        let resets = self.autopilot.filter_resets();
        if resets != self.filter_resets {
            self.filter_resets = resets;
            if resets > 1 || self.runs_since_ms > 0 {
                self.origin = Some(self.true_pose());
                self.origin_is_news = true;
            }
        }
    }

    fn notice_deeds(&mut self, now_ms: u64) {
        let set_point = self.autopilot.set_point();
        if set_point != self.flies_to.0 || self.phase() != app::Phase::Following {
            self.flies_to = (set_point, now_ms);
            if let Some(place) = set_point
                && self.phase() == app::Phase::Following
            {
                self.deeds.push(What::FlyTo([place.x, place.y]));
            }
        }
        if let Some((shift_m, turn_rad)) = self.autopilot.correction() {
            self.deeds.push(What::Correct { shift_m, turn_rad });
        }
    }

    /// The operator lands a drone that the camera keeps where it is.
    fn watch(&mut self, now_ms: u64) {
        let (_, since_ms) = self.flies_to;
        if self.phase() == app::Phase::Following && now_ms - since_ms >= PATIENCE_MS {
            self.stopped_safely = true;
            self.autopilot.app().command_landing();
        }
    }

    /// Whether the operator has landed a drone that the camera kept where it was.
    pub fn stopped_safely(&self) -> bool {
        self.stopped_safely
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
        self.autopilot.phase()
    }

    /// The messages that the app has taken from its UART since the last call.
    pub fn take_received(&mut self) -> impl Iterator<Item = Message> + use<> {
        let received = self.autopilot.app().take_received();
        received.into_iter().map(|received| received.message)
    }

    /// The frames that the app has dropped since the last call.
    pub fn take_dropped(&mut self) -> Vec<Dropped> {
        self.autopilot.app().take_dropped()
    }

    /// The origin that the filter's coordinates have got since the last call, if they have.
    pub fn take_new_origin(&mut self) -> Option<PlanarPose> {
        std::mem::take(&mut self.origin_is_news)
            .then_some(self.origin)
            .flatten()
    }

    /// Where the app has let the drone fly since the last call, and what it has told the filter.
    pub fn take_deeds(&mut self) -> Vec<What> {
        std::mem::take(&mut self.deeds)
    }

    /// Where things stand.
    pub fn glimpse(&self) -> Glimpse {
        let on_the_map = |pose: PlanarPose| match self.origin {
            None => pose,
            Some(origin) => origin.onward(&pose),
        };
        Glimpse {
            truth: self.true_pose(),
            estimate: on_the_map(self.autopilot.estimate()),
            uncorrected: on_the_map(self.autopilot.uncorrected()),
            height_m: self.vehicle.truth().position_m.z,
        }
    }

    fn true_pose(&self) -> PlanarPose {
        let truth = self.vehicle.truth();
        PlanarPose {
            x: truth.position_m.x,
            y: truth.position_m.y,
            yaw: yaw(&truth.attitude),
        }
    }
}

/// What the operator starts after a restart: the rest of the way back, as the camera remembers it.
fn way_back() -> Script {
    Script {
        steps: vec![Step::Follow {
            mode: Mode::Follow,
            until: Until::Home,
        }],
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

/// The app's settings in a flight. A route that leaves the published fence, or takes longer than the published
/// routes, moves fence and limits with it.
fn settings(conditions: &Conditions, route: &app::Route) -> Settings {
    let usual = Settings::default();
    let places = route.waypoints.iter().map(|waypoint| waypoint.place);
    let reach_m = places
        .map(|place| libm::hypotf(place.x, place.y))
        .fold(0.0, f32::max);
    let following_ms = (FOLLOWING_MS_PER_M * route.length_m()) as u64;
    Settings {
        quirks: conditions.quirks,
        correction: conditions.correction.sd(),
        max_distance_m: if conditions.piloted {
            // The pilot sees where it is; what the filter believes may turn round by a half and more.
            usual.max_distance_m + route.length_m() + FENCE_MARGIN_M
        } else if reach_m < usual.max_distance_m {
            usual.max_distance_m
        } else {
            reach_m + FENCE_MARGIN_M
        },
        follow_limit_ms: usual.follow_limit_ms.max(following_ms),
        flight_limit_ms: usual.flight_limit_ms.max(2 * following_ms),
        ..usual
    }
}

/// The motion sensors under these conditions.
fn sensor_model(conditions: &Conditions) -> SensorModel {
    SensorModel {
        flow: FlowModel {
            scale_swing: conditions.flow_scale,
            ..FlowModel::default()
        },
        ..SensorModel::default()
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

/// Heading of an attitude, radians, counter-clockwise from north.
fn yaw(attitude: &UnitQuaternion<f64>) -> f64 {
    let forward = attitude * Vector3::x();
    libm::atan2(forward.y, forward.x)
}
