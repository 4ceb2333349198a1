//! How the drone answers steps of its set-point, and how still it hovers.
//!
//! No figures of a Crazyflie's step responses with the firmware's gains are published: there are videos and plots
//! without numbers (`cfclient`'s tuning tab among them). So each response stands beside what the gains predict
//! ([`Prediction`]): the same cascade as a few lines of mechanics that share no code with the controller, the vehicle,
//! the filter or the sensors. Sensors are ideal here, so that their errors do not pass for the controller's; the hover
//! is flown with the nominal ones.

mod hover;
mod plot;
mod prediction;
mod response;
mod stand;

pub use hover::{Hover, hover};
pub use plot::picture;
pub use prediction::Prediction;
pub use response::Figures;
pub use stand::{Stand, hold};

use autopilot::vehicle;
use fake_sensors::motion::SensorModel;
use nalgebra::Vector3;
use serde::Serialize;

/// From take-off until the step, seconds: the integrals of the climb have died away.
const BEFORE_S: f64 = 12.0;
/// From the step to the end, seconds.
const AFTER_S: f64 = 8.0;

/// What steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Forwards, metres.
    X,
    /// Upwards, metres.
    Z,
    /// Counter-clockwise, degrees.
    Yaw,
}

impl Axis {
    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::X | Self::Z => "m",
            Self::Yaw => "deg",
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Z => "z",
            Self::Yaw => "yaw",
        }
    }
}

/// A step of the set-point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Step {
    /// Along what.
    pub axis: Axis,
    /// How far, in the axis's unit.
    pub size: f64,
}

/// The steps that are looked at.
pub const STEPS: [Step; 5] = [
    Step {
        axis: Axis::X,
        size: 0.5,
    },
    Step {
        axis: Axis::X,
        size: 1.0,
    },
    Step {
        axis: Axis::X,
        size: 2.0,
    },
    Step {
        axis: Axis::Z,
        size: 0.3,
    },
    Step {
        axis: Axis::Yaw,
        size: 90.0,
    },
];

/// A step and its answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// What was asked for.
    pub step: Step,
    /// How the drone answered; none if it did not arrive.
    pub flown: Option<Figures>,
    /// How the gains predict it.
    pub predicted: Option<Figures>,
    /// How far apart the two are, root mean square, as a share of the step.
    pub distance: f64,
    /// The greatest tilt on the way, degrees.
    pub tilt_deg: f64,
    /// What changed, every millisecond from the step on, and what was predicted.
    #[serde(skip)]
    pub curves: [Vec<f64>; 2],
}

impl Response {
    /// A response counts as predicted if the rise differs by less than this share of the predicted time,
    pub const RISE_TOLERANCE: f64 = 0.15;
    /// and the overshoot by less than this share of the step,
    pub const OVERSHOOT_TOLERANCE: f64 = 0.06;
    /// and the two curves by less than this share of the step, root mean square over the time that is looked at. What
    /// the prediction leaves out (the motors' lag, rate loops, filters, discrete steps) is worth that much.
    pub const CURVE_TOLERANCE: f64 = 0.04;

    /// Whether the drone answers as the gains predict.
    pub fn is_as_predicted(&self) -> bool {
        let (Some(flown), Some(predicted)) = (self.flown, self.predicted) else {
            return false;
        };
        (flown.rise_s - predicted.rise_s).abs() < Self::RISE_TOLERANCE * predicted.rise_s
            && (flown.overshoot - predicted.overshoot).abs() < Self::OVERSHOOT_TOLERANCE
            && self.distance < Self::CURVE_TOLERANCE
    }
}

/// Hovers, then steps.
pub fn fly(step: Step) -> Response {
    let mut stand = Stand::new(&SensorModel::ideal(), 1);
    stand.take_off();
    let rest = Vector3::z() * Stand::HEIGHT_M;
    stand.fly(BEFORE_S, |_| hold(rest, 0.0), |_| ());
    let size = step.size as f32;
    let goal = match step.axis {
        Axis::X => hold(rest + Vector3::x() * size, 0.0),
        Axis::Z => hold(rest + Vector3::z() * size, 0.0),
        Axis::Yaw => hold(rest, size.to_radians()),
    };
    let (mut curve, mut tilt_deg) = (Vec::new(), 0.0_f64);
    let start = value(&stand, step.axis);
    stand.fly(
        BEFORE_S + AFTER_S,
        |_| goal,
        |stand| {
            curve.push(value(stand, step.axis) - start);
            tilt_deg = tilt_deg.max(stand.tilt_deg());
        },
    );
    let prediction = Prediction::new();
    let predicted = match step.axis {
        Axis::X => prediction.horizontal(step.size, AFTER_S),
        Axis::Z => prediction.vertical(step.size, AFTER_S),
        Axis::Yaw => prediction.heading(step.size, AFTER_S),
    };
    Response {
        step,
        flown: Figures::of(&curve, vehicle::STEP_S, step.size),
        predicted: Figures::of(&predicted, prediction::STEP_S, step.size),
        distance: distance(&curve, &predicted) / step.size,
        tilt_deg,
        curves: [curve, predicted],
    }
}

/// Root mean square of the difference of two curves in the same steps of time.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    (squares.sum::<f64>() / a.len().min(b.len()) as f64).sqrt()
}

fn value(stand: &Stand, axis: Axis) -> f64 {
    let truth = stand.truth();
    match axis {
        Axis::X => truth.position_m.x,
        Axis::Z => truth.position_m.z,
        Axis::Yaw => {
            let forward = truth.attitude * Vector3::x();
            libm::atan2(forward.y, forward.x).to_degrees()
        }
    }
}
