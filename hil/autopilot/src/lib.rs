//! The other end of the link: what a Crazyflie does with the camera board's vectors.

pub mod app;
pub mod controller;
pub mod ekf;
mod flying;
pub mod stabiliser;
pub mod vehicle;

pub use flying::FlyingDetector;
pub use stabiliser::Stabiliser;
