//! Small rotations: the exponential map and its effect on a covariance.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// `q ⊗ exp(u)`, normalised: the attitude `q` turned by the rotation vector `u` (rad) given in the body frame.
pub fn turned(q: &UnitQuaternion<f32>, u: &Vector3<f32>) -> UnitQuaternion<f32> {
    UnitQuaternion::new_normalize(q.quaternion() * exponential(u))
}

/// The unit quaternion of the rotation vector `u` (rad): `(cos |u|/2, u/|u| sin |u|/2)`.
fn exponential(u: &Vector3<f32>) -> Quaternion<f32> {
    let angle = u.norm();
    if angle == 0.0 {
        return Quaternion::identity();
    }
    let (sin, cos) = libm::sincosf(0.5 * angle);
    Quaternion::from_parts(cos, u * (sin / angle))
}

/// How a rotation by `u` (rad) of the reference attitude turns the covariance of the attitude error:
/// `I - [u/2]x + [u/2]x² / 2` (Mueller, Hehn & D'Andrea 2016).
pub fn covariance_turn(u: &Vector3<f32>) -> Matrix3<f32> {
    let half = (u * 0.5).cross_matrix();
    Matrix3::identity() - half + half * half * 0.5
}
