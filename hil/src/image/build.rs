//! Builds the firmware with cargo and says where the image is.

use std::env;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::variant::SERIAL_BAUD;
use super::{PROFILE, TARGET, Toolchain, ToolchainError, Variant};

/// The image could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is no compiler for the chip.
    #[error(transparent)]
    Toolchain(#[from] ToolchainError),
    /// cargo could not be started, or the image not be kept.
    #[error("cargo could not be started, or its image not be kept: {0}")]
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

/// Builds the image that flies, or finds that it is up to date. `say` hears what is going on.
pub fn build(say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    build_variant(&Variant::FLIGHT, say)
}

/// Builds an image, or finds that it is up to date.
pub fn build_variant(variant: &Variant, say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    let workspace = workspace_root()?;
    let images = target_dir(&workspace).join("images");
    fs::create_dir_all(&images)?;
    // cargo leaves every variant in the same file: whoever builds one must take it away before the
    // next is built.
    let _turn = Turn::wait(&images)?;
    let mut arguments = vec!["--bin".to_owned(), "firmware".to_owned()];
    arguments.extend(variant.arguments());
    let built = build_target(&workspace, &arguments, variant.baud, say)?.join("firmware");
    let image = images.join(format!("{variant}.elf"));
    let bytes = fs::read(built)?;
    // A reader of the old one must not find half of the new.
    if fs::read(&image).ok().as_ref() != Some(&bytes) {
        let new = images.join(format!("{variant}.new"));
        fs::write(&new, bytes)?;
        fs::rename(new, &image)?;
    }
    Ok(image)
}

/// Builds one of the firmware's examples: an image that tries a part of it by itself.
pub fn build_example(name: &str, say: &dyn Fn(&str)) -> Result<PathBuf, BuildError> {
    let arguments = ["--example".to_owned(), name.to_owned()];
    let folder = build_target(&workspace_root()?, &arguments, None, say)?;
    Ok(folder.join("examples").join(name))
}

/// A folder of its own: another compiler than the host's must not evict the host's artefacts, and a
/// `cargo test` that waits for us must not hold the lock we need.
fn target_dir(workspace: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| workspace.join("target"), |folder| workspace.join(folder))
        .join("firmware")
}

/// Builds a cargo target of the firmware's package; the folder of the profile's images.
fn build_target(
    workspace: &Path,
    arguments: &[String],
    baud: Option<u32>,
    say: &dyn Fn(&str),
) -> Result<PathBuf, BuildError> {
    let toolchain = Toolchain::find(workspace, say)?;
    say(&format!("building the firmware with {toolchain}"));
    let target_dir = target_dir(workspace);
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(workspace)
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
        .args(arguments)
        .envs(toolchain.environment())
        // The rig reads the log by machine: the level is the checkout's, not the shell's.
        .env_remove("DEFMT_LOG")
        .env_remove(SERIAL_BAUD)
        .stdin(Stdio::null());
    if let Some(baud) = baud {
        cargo.env(SERIAL_BAUD, baud.to_string());
    }
    let output = cargo.output()?;
    if output.status.success() {
        Ok(target_dir.join(TARGET).join(PROFILE))
    } else {
        Err(BuildError::Failed {
            toolchain,
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        })
    }
}

/// The turn of one process among those that build images. Given back when it is dropped.
struct Turn {
    _lock: File,
}

impl Turn {
    fn wait(images: &Path) -> Result<Self, BuildError> {
        let lock = File::create(images.join(".lock"))?;
        #[cfg(unix)]
        rustix::fs::flock(&lock, rustix::fs::FlockOperation::LockExclusive)
            .map_err(std::io::Error::from)?;
        Ok(Self { _lock: lock })
    }
}
