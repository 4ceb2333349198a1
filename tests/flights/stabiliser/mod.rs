//! Filter, controller, vehicle and motion sensors together, without camera or link.

mod closed_loop;
mod corrections;
mod drift;
mod steps;
mod wind;

use autopilot::controller::SetPoint;
use nalgebra::Vector3;

fn hold(x: f64, y: f64, z: f64, yaw_rad: f64) -> SetPoint {
    SetPoint::Hold {
        position_m: Vector3::new(x, y, z).cast(),
        yaw_rad: yaw_rad as f32,
    }
}

/// From zero at `from_s` to one at `to_s`.
fn ramp(t_s: f64, from_s: f64, to_s: f64) -> f64 {
    ((t_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0)
}
