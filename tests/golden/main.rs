//! Vectors recorded from other implementations.

mod client;
mod ekf;
mod homing;
mod link;
