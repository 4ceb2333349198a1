//! What the gains themselves predict: each axis of the cascade as one loop in continuous time, with its limits.
//!
//! No filter, no sensors, no discrete steps, no coupling of the axes. What is fast counts as immediate: the rates of
//! roll and pitch, and the motors.

use autopilot::controller::ControllerParameters;
use autopilot::vehicle::{GRAVITY_M_S2, VehicleParameters};

/// Step of the integration, seconds.
pub const STEP_S: f64 = 0.001;

/// Command counts in a unit of the climb-rate loop's output.
const COUNTS_PER_UNIT: f64 = 1000.0;
/// The greatest torque command: 16 bits with a sign.
const TORQUE_LIMIT: f64 = 32_767.0;

/// The drone as its gains describe it.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    gains: ControllerParameters,
    drone: VehicleParameters,
}

impl Prediction {
    /// Of the paper's drone with the firmware's gains.
    pub fn new() -> Self {
        Self {
            gains: ControllerParameters::default(),
            drone: VehicleParameters::default(),
        }
    }

    /// Position after a step of the set-point of `size` metres along x or y, for so many seconds.
    pub fn horizontal(&self, size: f64, seconds: f64) -> Vec<f64> {
        let [position, velocity] = [self.gains.position_xy, self.gains.velocity_xy];
        let tilt_limit = f64::from(self.gains.tilt_limit_deg);
        let attitude = self.gains.attitude.tilt;
        let [mut x, mut speed, mut tilt_deg] = [0.0; 3];
        let [mut integral, mut tilt_integral] = [0.0; 2];
        run(seconds, || {
            let limit = f64::from(position.output_limit);
            let wanted = (f64::from(position.proportional) * (size - x)).clamp(-limit, limit);
            let error = wanted - speed;
            integral += error * STEP_S;
            let asked =
                f64::from(velocity.proportional) * error + f64::from(velocity.integral) * integral;
            let left_deg = asked.clamp(-tilt_limit, tilt_limit) - tilt_deg;
            tilt_integral += left_deg * STEP_S;
            tilt_deg += (f64::from(attitude.proportional) * left_deg
                + f64::from(attitude.integral) * tilt_integral)
                * STEP_S;
            let pull = GRAVITY_M_S2 * libm::tan(tilt_deg.to_radians());
            speed += (pull - self.drone.drag_per_s * speed) * STEP_S;
            x += speed * STEP_S;
            x
        })
    }

    /// Height gained after a step of the set-point of `size` metres.
    pub fn vertical(&self, size: f64, seconds: f64) -> Vec<f64> {
        let [position, velocity] = [self.gains.position_z, self.gains.velocity_z];
        let base = f64::from(self.gains.base_thrust);
        let least = f64::from(self.gains.min_thrust);
        let [mut z, mut speed, mut height_integral, mut speed_integral] = [0.0; 4];
        run(seconds, || {
            height_integral += (size - z) * STEP_S;
            let limit = f64::from(position.output_limit);
            let wanted = (f64::from(position.proportional) * (size - z)
                + f64::from(position.integral) * height_integral)
                .clamp(-limit, limit);
            speed_integral += (wanted - speed) * STEP_S;
            let limit = f64::from(velocity.output_limit);
            let asked = (f64::from(velocity.proportional) * (wanted - speed)
                + f64::from(velocity.integral) * speed_integral)
                .clamp(-limit, limit);
            let thrust = (COUNTS_PER_UNIT * asked + base).max(least);
            // The base thrust carries the drone.
            let lift = GRAVITY_M_S2 * (thrust / base - 1.0);
            speed += (lift - self.drone.drag_per_s * speed) * STEP_S;
            z += speed * STEP_S;
            z
        })
    }

    /// Heading after a step of the set-point of `size` degrees.
    pub fn heading(&self, size: f64, seconds: f64) -> Vec<f64> {
        let [attitude, rate] = [self.gains.attitude.yaw, self.gains.rate.yaw];
        let base = f64::from(self.gains.base_thrust);
        let idle = f64::from(autopilot::controller::IDLE_THRUST);
        let per_count = 4.0 * self.drone.full_thrust_n / f64::from(u16::MAX)
            * self.drone.torque_per_thrust_m
            / self.drone.inertia_kg_m2.z;
        let [mut yaw, mut turning, mut yaw_integral, mut rate_integral] = [0.0; 4];
        run(seconds, || {
            yaw_integral += (size - yaw) * STEP_S;
            let wanted = f64::from(attitude.proportional) * (size - yaw)
                + f64::from(attitude.integral) * yaw_integral
                - f64::from(attitude.derivative) * turning;
            let limit = f64::from(rate.integral_limit);
            rate_integral = (rate_integral + (wanted - turning) * STEP_S).clamp(-limit, limit);
            let torque = (f64::from(rate.proportional) * (wanted - turning)
                + f64::from(rate.integral) * rate_integral)
                .clamp(-TORQUE_LIMIT, TORQUE_LIMIT);
            // Two motors give, two give way until they idle.
            let [up, down] = [base + torque.abs(), (base - torque.abs()).max(idle)];
            let felt = 0.5 * (up - down) * torque.signum();
            turning += (per_count * felt).to_degrees() * STEP_S;
            yaw += turning * STEP_S;
            yaw
        })
    }
}

impl Default for Prediction {
    fn default() -> Self {
        Self::new()
    }
}

fn run(seconds: f64, mut step: impl FnMut() -> f64) -> Vec<f64> {
    let steps = (seconds / STEP_S) as usize;
    (0..steps).map(|_| step()).collect()
}
