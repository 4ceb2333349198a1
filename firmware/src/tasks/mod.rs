//! The tasks. Each awaits a peripheral or a neighbour, calls the room that knows what to do, and
//! passes on what it returned. Deadlines and their consequences stand at each task.

pub mod camera;
pub mod exposure;
pub mod health;
pub mod link_rx;
pub mod link_tx;
#[cfg(feature = "rig")]
pub mod serial_frames;
pub mod vision;
