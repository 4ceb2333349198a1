//! A Crazyflie Brushless in flight: four lagging motors on a rigid body with linear drag, over flat ground.
//!
//! This is the truth every sensor reads, so it is computed in `f64`, one millisecond at a time.

mod ground;
mod motors;
mod parameters;
#[cfg(test)]
mod tests;

pub use parameters::{GRAVITY_M_S2, PAPER_MASS_KG, STOCK_MASS_KG, VehicleParameters};

use nalgebra::{UnitQuaternion, Vector3};

use crate::controller::MotorCommands;
use motors::Motors;

/// Length of a step, s.
pub const STEP_S: f64 = 0.001;

/// True motion of the body. World: x forward, y left, z up, ground at height zero. Body: x front, y left, z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Position in the world, m.
    pub position_m: Vector3<f64>,
    /// Velocity in the world, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f64>,
    /// Angular rate, body frame, rad/s.
    pub angular_rate_rad_s: Vector3<f64>,
    /// Specific force, body frame, m/s²: acceleration less gravity, averaged over the last step.
    pub specific_force_m_s2: Vector3<f64>,
}

impl Truth {
    /// The world's up direction in the body frame.
    fn up_in_body(&self) -> Vector3<f64> {
        self.attitude.inverse_transform_vector(&Vector3::z())
    }

    /// Turns the attitude by `rotation` (rad, body frame).
    fn turn(&mut self, rotation: Vector3<f64>) {
        let turned = self.attitude * UnitQuaternion::from_scaled_axis(rotation);
        self.attitude = UnitQuaternion::new_normalize(turned.into_inner());
    }
}

/// The drone.
#[derive(Debug, Clone)]
pub struct Vehicle {
    parameters: VehicleParameters,
    motors: Motors,
    truth: Truth,
    wind_m_s: Vector3<f64>,
}

impl Vehicle {
    /// A drone standing at `position_m` (its height is taken as zero) with heading `yaw_rad`, counter-clockwise.
    #[must_use]
    pub fn standing_at(
        parameters: VehicleParameters,
        position_m: Vector3<f64>,
        yaw_rad: f64,
    ) -> Self {
        Self {
            motors: Motors::new(&parameters),
            parameters,
            truth: Truth {
                position_m: Vector3::new(position_m.x, position_m.y, 0.0),
                velocity_m_s: Vector3::zeros(),
                attitude: UnitQuaternion::from_scaled_axis(Vector3::z() * yaw_rad),
                angular_rate_rad_s: Vector3::zeros(),
                specific_force_m_s2: Vector3::z() * GRAVITY_M_S2,
            },
            wind_m_s: Vector3::zeros(),
        }
    }

    /// The motion after the last step.
    #[must_use]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// From now on the air moves with this velocity in the world, m/s.
    pub fn set_wind(&mut self, wind_m_s: Vector3<f64>) {
        self.wind_m_s = wind_m_s;
    }

    /// Whether the feet carry the drone.
    #[must_use]
    pub fn on_ground(&self) -> bool {
        self.truth.position_m.z <= 0.0
    }

    /// One millisecond under the given motor commands.
    pub fn step(&mut self, commands: &MotorCommands) {
        self.motors.step(commands);
        let before = self.truth.velocity_m_s;
        if self.on_ground() && self.vertical_acceleration() <= 0.0 {
            ground::rest(&mut self.truth);
        } else {
            self.fly();
            if self.truth.position_m.z < 0.0 {
                ground::touch_down(&mut self.truth);
            }
        }
        let felt = (self.truth.velocity_m_s - before) / STEP_S + Vector3::z() * GRAVITY_M_S2;
        self.truth.specific_force_m_s2 = self.truth.attitude.inverse_transform_vector(&felt);
    }

    /// Acceleration in the world without the ground's help, m/s².
    fn acceleration(&self) -> Vector3<f64> {
        let lift = Vector3::z() * (self.motors.total_thrust_n() / self.parameters.mass_kg);
        let drag = (self.truth.velocity_m_s - self.wind_m_s) * -self.parameters.drag_per_s;
        self.truth.attitude.transform_vector(&lift) + drag - Vector3::z() * GRAVITY_M_S2
    }

    fn vertical_acceleration(&self) -> f64 {
        self.acceleration().z
    }

    /// Semi-implicit Euler: velocities first, then positions with the new velocities.
    fn fly(&mut self) {
        let acceleration = self.acceleration();
        let inertia = self.parameters.inertia_kg_m2;
        let truth = &mut self.truth;
        let rate = truth.angular_rate_rad_s;
        let torque = self.motors.torque_nm() - rate.cross(&inertia.component_mul(&rate));

        truth.velocity_m_s += acceleration * STEP_S;
        truth.position_m += truth.velocity_m_s * STEP_S;
        truth.angular_rate_rad_s += torque.component_div(&inertia) * STEP_S;
        truth.turn(truth.angular_rate_rad_s * STEP_S);
    }
}
