//! What the filter knows: nine states, the reference attitude and the covariance.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::parameters::Parameters;

/// Covariance of the nine states, in the order position, body velocity, attitude error.
pub type Covariance = SMatrix<f32, 9, 9>;

/// Index of the first position state.
pub const POSITION: usize = 0;
/// Index of the first velocity state.
pub const VELOCITY: usize = 3;
/// Index of the first attitude-error state.
pub const ATTITUDE: usize = 6;

/// The filter's state between two steps.
#[derive(Debug, Clone)]
pub struct State {
    /// Position in the world, m.
    pub position: Vector3<f32>,
    /// Velocity in the body frame, m/s.
    pub velocity: Vector3<f32>,
    /// Rotation from the reference attitude to the best estimate, in the body frame, rad. Zero after `finalise`.
    pub attitude_error: Vector3<f32>,
    /// Reference attitude, body to world.
    pub attitude: UnitQuaternion<f32>,
    /// The reference attitude as a matrix, as of the last `finalise`.
    pub rotation: Matrix3<f32>,
    /// Covariance of position, velocity and attitude error.
    pub covariance: Covariance,
}

impl State {
    /// The state after a reset: at the origin, at rest, level, heading as the parameters say.
    pub fn initial(parameters: &Parameters) -> Self {
        let sd = &parameters.reset;
        let mut covariance = Covariance::zeros();
        for axis in 0..3 {
            for (first, deviation) in [
                (POSITION, sd.position_m[axis]),
                (VELOCITY, sd.velocity_m_s[axis]),
                (ATTITUDE, sd.attitude_rad[axis]),
            ] {
                covariance[(first + axis, first + axis)] = deviation * deviation;
            }
        }
        Self {
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            attitude_error: Vector3::zeros(),
            attitude: initial_attitude(parameters),
            // The firmware leaves the matrix level until the first finalise.
            rotation: Matrix3::identity(),
            covariance,
        }
    }

    /// The world's up direction in the body frame: the third row of the rotation matrix.
    pub fn up_in_body(&self) -> Vector3<f32> {
        self.rotation.row(2).transpose()
    }

    /// Whether position or body velocity (10 m/s) has left the bounds of the firmware's supervisor
    /// (`kalman_supervisor`), the only outlier defence in the filter.
    pub fn out_of_bounds(&self, max_position_m: f32) -> bool {
        const MAX_VELOCITY_M_S: f32 = 10.0;
        self.position.amax() > max_position_m || self.velocity.amax() > MAX_VELOCITY_M_S
    }
}

/// The attitude assumed at a reset: level, turned by the initial yaw.
pub fn initial_attitude(parameters: &Parameters) -> UnitQuaternion<f32> {
    let heading = Vector3::new(0.0, 0.0, parameters.initial_yaw_rad);
    super::rotation::turned(&UnitQuaternion::identity(), &heading)
}
