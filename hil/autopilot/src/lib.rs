//! The other end of the link: what a Crazyflie does with the camera board's vectors.

pub mod ekf;
