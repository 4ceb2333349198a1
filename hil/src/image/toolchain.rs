//! Which compiler can build for the chip: the installed target, one that rustup can add, or
//! Debian's compiler with the library sources beside it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::TARGET;

/// Debian's packages that together can compile for the chip: a compiler that matches the library
/// sources it ships with, and a linker.
const DEBIAN_PACKAGES: [&str; 3] = ["rustc-web", "rust-web-src", "lld"];

/// A compiler for the chip, and how it was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Toolchain {
    /// The target was there.
    Installed,
    /// `rustup target add` has just fetched it.
    AddedByRustup,
    /// Debian's compiler builds `core` from source.
    Debian {
        /// Debian's rustc.
        rustc: PathBuf,
        /// The linker.
        linker: PathBuf,
        /// The packages were installed just now.
        installed_now: bool,
    },
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Installed => write!(f, "the installed target {TARGET}"),
            Self::AddedByRustup => write!(f, "the target {TARGET}, added by rustup"),
            Self::Debian {
                rustc,
                installed_now,
                ..
            } => {
                let origin = if *installed_now {
                    ", installed by apt-get"
                } else {
                    ""
                };
                write!(f, "{} with core built from source{origin}", rustc.display())
            }
        }
    }
}

/// No compiler for the chip.
#[derive(Debug, thiserror::Error)]
#[error(
    "no compiler for {TARGET} on this machine. Any one of these helps:\n  \
     rustup target add {TARGET}\n  \
     apt-get install {packages}   (Debian, as root)\n  \
     --firmware ELF               (an image built elsewhere)\n\
     What was tried:\n  rustup: {rustup}\n  Debian: {debian}",
    packages = DEBIAN_PACKAGES.join(" ")
)]
pub struct ToolchainError {
    rustup: String,
    debian: String,
}

impl Toolchain {
    /// Finds a compiler, in the order of the variants above. May fetch the target with rustup, or
    /// (only as root, on Debian) install the three packages; it says so through `say`.
    pub fn find(workspace: &Path, say: &dyn Fn(&str)) -> Result<Self, ToolchainError> {
        if target_is_installed(workspace) {
            return Ok(Self::Installed);
        }
        say(&format!("rustup target add {TARGET}"));
        let rustup = match run(Command::new("rustup")
            .args(["target", "add", TARGET])
            .current_dir(workspace))
        {
            Ok(_) if target_is_installed(workspace) => return Ok(Self::AddedByRustup),
            Ok(_) => "the target was added to a toolchain that is not the one in use".to_owned(),
            Err(why) => why,
        };
        if let Some(debian) = debian(false) {
            return Ok(debian);
        }
        match install_debian_packages(say) {
            Ok(()) => debian(true).ok_or_else(|| ToolchainError {
                rustup,
                debian: "the packages are installed, but rustc, its sources or ld.lld are not where Debian puts them".to_owned(),
            }),
            Err(why) => Err(ToolchainError { rustup, debian: why }),
        }
    }

    /// What cargo needs in its environment to build with this compiler.
    pub fn environment(&self) -> Vec<(&'static str, String)> {
        match self {
            Self::Installed | Self::AddedByRustup => Vec::new(),
            Self::Debian { rustc, linker, .. } => vec![
                ("RUSTC", rustc.display().to_string()),
                // Building `core` is a nightly feature of cargo; Debian's compiler matches its sources.
                ("RUSTC_BOOTSTRAP", "1".to_owned()),
                ("CARGO_UNSTABLE_BUILD_STD", "core".to_owned()),
                (
                    "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER",
                    linker.display().to_string(),
                ),
            ],
        }
    }
}

fn target_is_installed(workspace: &Path) -> bool {
    run(Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .current_dir(workspace))
    .is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}

/// Debian's compiler, if all three packages are there.
fn debian(installed_now: bool) -> Option<Toolchain> {
    let rustc = PathBuf::from("/usr/bin/rustc");
    let linker = PathBuf::from("/usr/bin/ld.lld");
    let sysroot = run(Command::new(&rustc).args(["--print", "sysroot"])).ok()?;
    let sysroot = String::from_utf8_lossy(&sysroot.stdout).trim().to_owned();
    let sources = Path::new(&sysroot).join("lib/rustlib/src/rust/library/core/Cargo.toml");
    (linker.exists() && sources.exists()).then_some(Toolchain::Debian {
        rustc,
        linker,
        installed_now,
    })
}

fn install_debian_packages(say: &dyn Fn(&str)) -> Result<(), String> {
    let root =
        run(Command::new("id").arg("-u")).is_ok_and(|output| output.stdout.starts_with(b"0\n"));
    if !root {
        return Err("not root, so apt-get was not asked".to_owned());
    }
    let mut install = vec!["install", "--yes", "--no-install-recommends"];
    install.extend(DEBIAN_PACKAGES);
    for arguments in [vec!["update"], install] {
        say(&format!("apt-get {}", arguments.join(" ")));
        run(Command::new("apt-get")
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive"))?;
    }
    Ok(())
}

/// Runs a command to its end; the error is for people.
fn run(command: &mut Command) -> Result<Output, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{name}: {error}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let stderr = String::from_utf8_lossy(&output.stderr);
    let last = stderr
        .lines()
        .rev()
        .find(|line| !line.trim().is_empty())
        .unwrap_or("no message");
    Err(format!(
        "{name} failed ({}): {}",
        output.status,
        last.trim()
    ))
}
