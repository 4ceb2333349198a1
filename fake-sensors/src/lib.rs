//! Signals computed from truth, time and a seed: worlds, the panoramic camera, optical flow, range and IMU.

pub mod camera;
pub mod motion;
pub mod random;
pub mod world;
