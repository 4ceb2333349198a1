//! A drone in the plane: it flies by its estimate, and the estimate drifts.

use nalgebra::{Point2, Rotation2, Vector2};
use nav::{Correction, Pose, Spectrum};

use crate::random::Random;
use crate::world::Room;

/// One STATE period, milliseconds.
const PERIOD_MS: u32 = 100;
/// Simulation steps of a period.
const SUBSTEPS: u32 = 5;
const DT_S: f32 = PERIOD_MS as f32 * 1e-3 / SUBSTEPS as f32;
/// First-order response of the velocity.
const RESPONSE_S: f32 = 0.3;
/// Position controller: metres a second for each metre, and the most of it.
const POSITION_GAIN: f32 = 1.5;
const SPEED_MPS: f32 = 0.5;
/// The heading estimate wanders by 1.6 degrees in 5 m, that is in 10 s.
const HEADING_WANDER_RAD: f32 = 0.028 / 3.162;
/// The scale of odometry is off by 10 %, anew every three seconds: 0.2 to 0.3 m along 5 m.
const SCALE_ERROR: f32 = 0.1;
const SCALE_PERIODS: u32 = 30;

/// Truth, estimate, and the time since the start.
pub struct Drone {
    pub position: Point2<f32>,
    pub heading: f32,
    pub estimate: Pose,
    pub now_ms: u32,
    velocity: Vector2<f32>,
    scale: f32,
    random: Random,
    target: Point2<f32>,
    applied_correction: u16,
}

impl Drone {
    pub fn new(seed: u64, at: Point2<f32>) -> Self {
        Self {
            position: at,
            heading: 0.0,
            estimate: Pose::new(at, 0.0),
            now_ms: 0,
            velocity: Vector2::zeros(),
            scale: 1.0,
            random: Random::new(seed ^ 0x00D0_0D1E),
            target: at,
            applied_correction: 0,
        }
    }

    /// Estimated heading less true heading.
    pub fn north_error(&self) -> f32 {
        self.estimate.heading - self.heading
    }

    pub fn view(&self, room: &Room) -> Spectrum {
        room.view(self.position, self.north_error())
    }

    /// Takes over a correction as the autopilot does: once for each index, as a difference.
    pub fn correct(&mut self, correction: &Correction) {
        if correction.index != self.applied_correction {
            self.applied_correction = correction.index;
            self.estimate.position += correction.to.position - correction.from.position;
            self.estimate.heading += correction.to.heading - correction.from.heading;
        }
    }

    /// Flies one period towards the target of the period before, then takes the new one.
    pub fn fly(&mut self, target: Option<Point2<f32>>) {
        if (self.now_ms / PERIOD_MS).is_multiple_of(SCALE_PERIODS) {
            self.scale = 1.0 + SCALE_ERROR * self.random.normal();
        }
        for _ in 0..SUBSTEPS {
            self.substep();
        }
        self.estimate.heading +=
            HEADING_WANDER_RAD * libm::sqrtf(PERIOD_MS as f32 * 1e-3) * self.random.normal();
        self.now_ms += PERIOD_MS;
        self.target = target.unwrap_or(self.target);
    }

    fn substep(&mut self) {
        let wanted = (self.target - self.estimate.position) * POSITION_GAIN;
        let into_truth = Rotation2::new(-self.north_error());
        let wanted = into_truth * wanted.cap_magnitude(SPEED_MPS);
        self.velocity += (wanted - self.velocity) * (DT_S / RESPONSE_S);
        self.position += self.velocity * DT_S;
        self.estimate.position += into_truth.inverse() * self.velocity * (DT_S * self.scale);
    }
}
