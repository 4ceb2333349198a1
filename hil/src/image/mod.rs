//! The firmware image: found or built with whatever toolchain this machine has.

mod build;
mod toolchain;

pub use build::{BuildError, build, build_example, workspace_root};
pub use toolchain::{Toolchain, ToolchainError};

/// The chip's target: Cortex-M4 with a single-precision FPU, hard-float calls.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The cargo profile of the image that flies (root manifest).
pub const PROFILE: &str = "flight";
