//! The true pose, between programs: lines of JSON, and who the emulated camera takes it from.

mod line;
mod source;

pub use line::{PoseError, PoseLine, PoseLines};
pub use source::{Eyes, Seen};
