//! What the filter's queue carries, and one model per kind.
//!
//! A model corrects the state with the rotation matrix of the last `finalise`: it is not refreshed between the
//! measurements of one tick. None of them gates its innovation.

mod flow;
mod height;
mod inertial;
mod pose;
mod position;
mod range;
mod yaw_error;

pub use flow::Flow;
pub use height::AbsoluteHeight;
pub use inertial::ImuSample;
pub use pose::Pose;
pub use position::Position;
pub use range::Range;
pub use yaw_error::YawError;

use nalgebra::Vector3;

/// One entry of the filter's queue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measurement {
    /// Angular rate, body frame, deg/s, after the driver's 80 Hz filter.
    Gyroscope(Vector3<f32>),
    /// Specific force, body frame, in units of g, after the driver's 30 Hz filter.
    Accelerometer(Vector3<f32>),
    /// Optical flow of the ground.
    Flow(Flow),
    /// Distance to the ground.
    Range(Range),
    /// Position in the world, e.g. a fix by visual homing.
    Position(Position),
    /// By how much the estimated yaw is too large.
    YawError(YawError),
    /// Height above the origin.
    AbsoluteHeight(AbsoluteHeight),
    /// Position and attitude, e.g. from motion capture.
    Pose(Pose),
}
