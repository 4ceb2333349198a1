//! Process noise, added every millisecond.

use super::parameters::ProcessNoise;
use super::state::{ATTITUDE, POSITION, State, VELOCITY};

impl State {
    /// Widens the covariance by `dt` seconds of process noise.
    ///
    /// The variances are squares of `noise · dt`, so a step of 1 ms taken ten times adds a tenth of what one step of
    /// 10 ms would: the rate of this call is part of the filter's tuning.
    pub fn add_process_noise(&mut self, noise: &ProcessNoise, dt: f32) {
        for axis in 0..3 {
            let velocity = noise.acceleration_m_s2[axis] * dt;
            let position = velocity * dt;
            let attitude = noise.angular_rate_rad_s[axis] * dt;
            for (first, deviation) in [
                (POSITION, position),
                (VELOCITY, velocity),
                (ATTITUDE, attitude),
            ] {
                self.covariance[(first + axis, first + axis)] += deviation * deviation;
            }
        }
        self.bound_covariance();
    }
}
