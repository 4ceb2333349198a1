//! The firmware image: found or built with whatever toolchain this machine has.

mod build;
mod identity;
mod toolchain;
mod variant;

pub use build::{BuildError, build, build_example, build_variant, workspace_root};
pub use identity::{IdentityError, identity};
pub use toolchain::{Toolchain, ToolchainError};
pub use variant::Variant;

/// The chip's target: Cortex-M4 with a single-precision FPU, hard-float calls.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The cargo profile of the image that flies (root manifest).
pub const PROFILE: &str = "flight";
