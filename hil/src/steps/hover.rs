//! How still the drone hovers.

use autopilot::vehicle::VehicleParameters;
use fake_sensors::motion::SensorModel;
use fake_sensors::wind::WindModel;
use nalgebra::Vector3;
use serde::Serialize;

use super::{Stand, hold};

/// From the end of the take-off until the errors count, seconds.
const SETTLE_S: f64 = 6.0;

/// Figures of a hover over `seconds`. Errors are distances from the set-point, root mean squares.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hover {
    /// Of the true position, in the plane, metres. It grows with the time: dead reckoning strays.
    pub position_rms_m: f64,
    /// Of the position that the filter believes, in the plane, metres.
    pub estimate_rms_m: f64,
    /// Of the true height, metres.
    pub height_rms_m: f64,
    /// Of the true velocity in the plane, m/s.
    pub speed_rms_m_s: f64,
    /// Of the tilt about its mean, degrees.
    pub tilt_rms_deg: f64,
    /// The steepest tilt, degrees.
    pub tilt_deg: f64,
    /// The greatest distance of the believed position from the set-point, metres.
    pub farthest_m: f64,
}

impl Hover {
    /// Over several hovers of the same length: root mean squares of the root mean squares, the greatest of the extremes.
    pub fn over(hovers: &[Self]) -> Self {
        let rms = |of: fn(&Self) -> f64| {
            let squares: f64 = hovers.iter().map(|hover| of(hover) * of(hover)).sum();
            (squares / hovers.len() as f64).sqrt()
        };
        let greatest = |of: fn(&Self) -> f64| hovers.iter().map(of).fold(0.0, f64::max);
        Self {
            position_rms_m: rms(|hover| hover.position_rms_m),
            estimate_rms_m: rms(|hover| hover.estimate_rms_m),
            height_rms_m: rms(|hover| hover.height_rms_m),
            speed_rms_m_s: rms(|hover| hover.speed_rms_m_s),
            tilt_rms_deg: rms(|hover| hover.tilt_rms_deg),
            tilt_deg: greatest(|hover| hover.tilt_deg),
            farthest_m: greatest(|hover| hover.farthest_m),
        }
    }
}

/// Hovers at half a metre for so many seconds after it has settled.
pub fn hover(
    drone: VehicleParameters,
    sensors: &SensorModel,
    wind: &WindModel,
    seed: u64,
    seconds: f64,
) -> Hover {
    let mut stand = Stand::in_wind(drone, sensors, wind, seed);
    stand.take_off();
    let here = hold(Vector3::z() * Stand::HEIGHT_M, 0.0);
    let start_s = stand.now_s() + SETTLE_S;
    stand.fly(start_s, |_| here, |_| ());
    let mut sums = Sums::default();
    stand.fly(start_s + seconds, |_| here, |stand| sums.add(stand));
    sums.figures()
}

#[derive(Default)]
struct Sums {
    count: f64,
    position: f64,
    estimate: f64,
    height: f64,
    speed: f64,
    up: Vector3<f64>,
    sideways: f64,
    tilt_deg: f64,
    farthest_m: f64,
}

impl Sums {
    fn add(&mut self, stand: &Stand) {
        let truth = stand.truth();
        let believed = stand.estimate().position_m.xy().cast::<f64>();
        // Where the body's up points, in the world: its plane components are the tilt.
        let up = truth.attitude * Vector3::z();
        self.count += 1.0;
        self.position += truth.position_m.xy().norm_squared();
        self.estimate += believed.norm_squared();
        let high = truth.position_m.z - f64::from(Stand::HEIGHT_M);
        self.height += high * high;
        self.speed += truth.velocity_m_s.xy().norm_squared();
        self.up += up;
        self.sideways += up.xy().norm_squared();
        self.tilt_deg = self.tilt_deg.max(stand.tilt_deg());
        self.farthest_m = self.farthest_m.max(believed.norm());
    }

    fn figures(&self) -> Hover {
        let mean = |sum: f64| sum / self.count;
        let wobble = mean(self.sideways) - (self.up.xy() / self.count).norm_squared();
        Hover {
            position_rms_m: mean(self.position).sqrt(),
            estimate_rms_m: mean(self.estimate).sqrt(),
            height_rms_m: mean(self.height).sqrt(),
            speed_rms_m_s: mean(self.speed).sqrt(),
            tilt_rms_deg: wobble.max(0.0).sqrt().to_degrees(),
            tilt_deg: self.tilt_deg,
            farthest_m: self.farthest_m,
        }
    }
}
