//! Cycles on the emulated core.

mod flight;
mod homing;
mod link;
mod vision;
