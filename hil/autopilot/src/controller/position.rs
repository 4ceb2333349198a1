//! Position and velocity loops, in the frame turned with the drone's heading.

use nalgebra::Vector3;

use super::pid::Pid;
use super::{Command, ControllerParameters, POSITION_PERIOD_MS};
use crate::ekf::Estimate;

/// Thrust counts in one unit of the climb-rate controller's output.
const THRUST_SCALE: f32 = 1000.0;
/// The largest motor command.
const MAX_THRUST: f32 = 65_535.0;

/// The two outer loops.
#[derive(Debug, Clone)]
pub struct PositionController {
    position: [Pid; 3],
    velocity: [Pid; 3],
    tilt_limit_deg: f32,
    base_thrust: f32,
    min_thrust: f32,
}

impl PositionController {
    pub fn new(parameters: &ControllerParameters) -> Self {
        let dt_s = POSITION_PERIOD_MS as f32 * 0.001;
        let loops = |xy, z| [xy, xy, z].map(|gains| Pid::new(gains, dt_s));
        Self {
            position: loops(&parameters.position_xy, &parameters.position_z),
            velocity: loops(&parameters.velocity_xy, &parameters.velocity_z),
            tilt_limit_deg: parameters.tilt_limit_deg,
            base_thrust: parameters.base_thrust,
            min_thrust: parameters.min_thrust,
        }
    }

    /// One step towards `target_m`, in the world.
    pub fn update(&mut self, estimate: &Estimate, target_m: &Vector3<f32>) -> Command {
        let heading = Heading::of(estimate.yaw_rad());
        let wanted = heading.to_body(target_m);
        let here = heading.to_body(&estimate.position_m);
        let moving = heading.to_body(&estimate.velocity_m_s);
        let [forward, left, up] = [0, 1, 2].map(|axis| {
            let speed = self.position[axis].update(wanted[axis], here[axis]);
            self.velocity[axis].update(speed, moving[axis])
        });
        let tilt = |wanted: f32| wanted.clamp(-self.tilt_limit_deg, self.tilt_limit_deg);
        Command {
            // Left side up moves to the right, nose up moves back.
            roll_deg: tilt(-left),
            pitch_deg: tilt(-forward),
            thrust: (THRUST_SCALE * up + self.base_thrust).clamp(self.min_thrust, MAX_THRUST),
        }
    }
}

/// A rotation about the vertical.
struct Heading {
    sin: f32,
    cos: f32,
}

impl Heading {
    fn of(yaw_rad: f32) -> Self {
        let (sin, cos) = libm::sincosf(yaw_rad);
        Self { sin, cos }
    }

    /// Turns a vector of the world by minus the heading.
    fn to_body(&self, v: &Vector3<f32>) -> Vector3<f32> {
        Vector3::new(
            v.x * self.cos + v.y * self.sin,
            v.y * self.cos - v.x * self.sin,
            v.z,
        )
    }
}
