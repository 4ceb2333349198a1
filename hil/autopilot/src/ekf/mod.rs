//! The Crazyflie's default extended Kalman filter, in `f32` and in the order of the firmware's 1 ms task.
//!
//! Nine states: position in the world, velocity **in the body frame**, and a small attitude error that is folded
//! into a reference quaternion after every change (Mueller, Hamer & D'Andrea, ICRA 2015; Mueller, Hehn & D'Andrea,
//! JGCD 2016; crazyflie-firmware `kalman_core`, `estimator_kalman`, commit 2a18fc29).
//!
//! Frames: world x forward at yaw zero, y left, z up; body x front, y left, z up. Units: m, m/s, rad.
//!
//! | room | reason to exist |
//! |---|---|
//! | [`parameters`](Parameters) | every constant, with its source |
//! | `state` | the nine states, the reference attitude, the covariance; their reset |
//! | `predict`, `noise` | motion model at 100 Hz, process noise at 1 kHz |
//! | `update`, `measurements` | the scalar update and the models that use it |
//! | `finalise` | attitude error into reference attitude |
//! | `task` | the 1 ms pass with its queue |
//! | `replay` | recorded sequences in, deviation from a recorded filter out |

mod estimate;
mod finalise;
mod measurements;
mod noise;
mod parameters;
mod predict;
pub mod replay;
mod rotation;
mod state;
mod task;
#[cfg(test)]
mod tests;
mod update;

pub use estimate::{Estimate, LegacyEuler};
pub use measurements::{
    AbsoluteHeight, Flow, ImuSample, Measurement, Pose, Position, Range, YawError,
};
pub use parameters::{FlowParameters, Parameters, ProcessNoise, RangeParameters, ResetDeviations};
pub use task::{Ekf, QUEUE_LENGTH, QueueFull};
