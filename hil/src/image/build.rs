//! Builds the firmware with cargo and says where the image is.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{PROFILE, TARGET, Toolchain, ToolchainError};

/// The image could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is no compiler for the chip.
    #[error(transparent)]
    Toolchain(#[from] ToolchainError),
    /// cargo could not be started.
    #[error("cargo could not be started: {0}")]
    Cargo(#[from] std::io::Error),
    /// cargo ended with an error.
    #[error("the firmware does not build with {toolchain}:\n{stderr}")]
    Failed {
        /// The compiler.
        toolchain: Toolchain,
        /// What cargo said.
        stderr: String,
    },
    /// The folder that holds the firmware's sources was not found.
    #[error("no Cataglyphis checkout at or above {0}; give an image with --firmware ELF")]
    NoWorkspace(PathBuf),
}

/// The checkout: the working directory or the nearest folder above it that holds `firmware` and
/// `hil`, else the one this program was built from.
pub fn workspace_root() -> Result<PathBuf, BuildError> {
    let here = env::current_dir()?;
    let is_root = |folder: &Path| {
        folder.join("firmware/Cargo.toml").exists() && folder.join("hil/Cargo.toml").exists()
    };
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    here.ancestors()
        .chain(built_from)
        .find(|folder| is_root(folder))
        .map(Path::to_path_buf)
        .ok_or(BuildError::NoWorkspace(here))
}

/// Builds the firmware, or finds that it is up to date. `say` hears what is going on.
pub fn build(say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    let folder = build_target(&["--bin", "firmware"], say)?;
    Ok(folder.join("firmware"))
}

/// Builds one of the firmware's examples: an image that tries a part of it by itself.
pub fn build_example(name: &str, say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    let folder = build_target(&["--example", name], say)?;
    Ok(folder.join("examples").join(name))
}

/// Builds a cargo target of the firmware's package; the folder of the profile's images.
fn build_target(target: &[&str], say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    let workspace = workspace_root()?;
    let toolchain = Toolchain::find(&workspace, say)?;
    say(&format!("building the firmware with {toolchain}"));
    // A folder of its own: another compiler than the host's must not evict the host's artefacts,
    // and a `cargo test` that waits for us must not hold the lock we need.
    let target_dir = env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| workspace.join("target"), |folder| workspace.join(folder))
        .join("firmware");
    let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(&workspace)
        .args([
            "build",
            "--package",
            "firmware",
            "--profile",
            PROFILE,
            "--target",
            TARGET,
            "--target-dir",
        ])
        .arg(&target_dir)
        .args(target)
        .envs(toolchain.environment())
        // The rig reads the log by machine: the level is the checkout's, not the shell's.
        .env_remove("DEFMT_LOG")
        .stdin(Stdio::null())
        .output()?;
    if output.status.success() {
        Ok(target_dir.join(TARGET).join(PROFILE))
    } else {
        Err(BuildError::Failed {
            toolchain,
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        })
    }
}
