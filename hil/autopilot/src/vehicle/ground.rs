//! Flat ground: it stops a fall, holds the feet and levels the body.

use nalgebra::Vector3;

use super::{STEP_S, Truth};

/// How fast the feet level a body set down at a tilt, s.
const LEVELLING_TIME_S: f64 = 0.05;

/// One step on the feet, which neither slide nor turn.
pub fn rest(truth: &mut Truth) {
    truth.velocity_m_s.fill(0.0);
    truth.angular_rate_rad_s = Vector3::z().cross(&truth.up_in_body()) / LEVELLING_TIME_S;
    truth.turn(truth.angular_rate_rad_s * STEP_S);
}

/// The end of a fall: the ground takes all momentum.
pub fn touch_down(truth: &mut Truth) {
    truth.position_m.z = 0.0;
    truth.velocity_m_s.fill(0.0);
}
