//! The motion model: 10 ms forward on averaged IMU samples.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::parameters::{GRAVITY_M_S2, Parameters};
use super::rotation::{covariance_turn, turned};
use super::state::{ATTITUDE, Covariance, POSITION, State, VELOCITY, initial_attitude};

/// Mean IMU sample over one prediction interval.
#[derive(Debug, Clone, Copy)]
pub struct Motion {
    /// Angular rate, body frame, rad/s.
    pub angular_rate: Vector3<f32>,
    /// Specific force, body frame, m/s².
    pub specific_force: Vector3<f32>,
    /// Whether the propellers carry the drone. In flight only the force along z is believed.
    pub flying: bool,
}

impl State {
    /// Moves state and covariance forward by `dt` seconds.
    ///
    /// Every right side uses the state before the step and the rotation matrix of the last `finalise`. The
    /// firmware's linear drag is left out: its coefficient is zero on every platform with two-blade rotors.
    pub fn predict(&mut self, motion: &Motion, dt: f32, parameters: &Parameters) {
        let transition = self.transition(motion, dt);
        self.covariance = transition * self.covariance * transition.transpose();

        let force = if motion.flying {
            Vector3::new(0.0, 0.0, motion.specific_force.z)
        } else {
            motion.specific_force
        };
        let gravity = self.up_in_body() * GRAVITY_M_S2;
        let acceleration = force - motion.angular_rate.cross(&self.velocity) - gravity;

        self.position += self.rotation * (self.velocity * dt + force * (0.5 * dt * dt));
        self.position.z -= 0.5 * GRAVITY_M_S2 * dt * dt;
        self.velocity += acceleration * dt;
        self.attitude = turned(&self.attitude, &(motion.angular_rate * dt));
        if !motion.flying {
            self.revert_attitude(parameters);
        }
    }

    /// Jacobian of the step.
    fn transition(&self, motion: &Motion, dt: f32) -> Covariance {
        let rate = motion.angular_rate;
        let mut f = Covariance::identity();
        let mut set = |row, column, block: Matrix3<f32>| {
            f.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
        };
        set(POSITION, VELOCITY, self.rotation * dt);
        let swept = self.rotation * self.velocity.cross_matrix();
        set(POSITION, ATTITUDE, swept * -dt);
        let turn = Matrix3::identity() - rate.cross_matrix() * dt;
        set(VELOCITY, VELOCITY, turn);
        let lean = self.up_in_body().cross_matrix() * (-GRAVITY_M_S2 * dt);
        set(VELOCITY, ATTITUDE, lean);
        set(ATTITUDE, ATTITUDE, covariance_turn(&(rate * dt)));
        f
    }

    /// On the ground the attitude creeps back to the initial one, against gyro bias.
    fn revert_attitude(&mut self, parameters: &Parameters) {
        let share = parameters.ground_attitude_reversion;
        let mixed = self.attitude.quaternion() * (1.0 - share)
            + initial_attitude(parameters).quaternion() * share;
        self.attitude = UnitQuaternion::new_normalize(mixed);
    }
}
