//! Signals computed from truth, time and a seed: worlds, the panoramic camera, optical flow, range, IMU and wind.

pub mod camera;
pub mod motion;
pub mod random;
mod vectors;
pub mod wind;
pub mod world;
