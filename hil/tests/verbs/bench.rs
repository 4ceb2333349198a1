//! The command, what it says, what it is given, and folders for what it reads and leaves.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use hil::scenario::file::ScenarioFile;
use serde_json::Value;
use tempfile::TempDir;

/// Files that a flight leaves.
const FLIGHT_FILES: [&str; 5] = [
    "summary.json",
    "recording.json",
    "flight.log",
    "report.html",
    "map.svg",
];

/// A scenario of seconds, for tests that do not care what is flown.
pub const CORNER: &str = r#"
meaning = "Round one corner"
world = "arena"
route = "corner"
seeds = { first = 1, count = 3 }

[[expect]]
metric = "home_error_m.max"
at_most = 0.5
reason = "it is short"
"#;

/// Runs the command to its end.
pub fn hil(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hil"))
        .args(arguments)
        .output()
        .expect("the command starts")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What a command with `--json` ends with.
pub fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", stderr(output)))
}

/// A file or folder of this checkout.
pub fn checkout(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The path of a golden file.
pub fn golden(name: &str) -> String {
    let path = checkout("tests/golden/data").join(name);
    path.display().to_string()
}

/// The scenarios in a folder of this checkout.
pub fn scenarios(folder: &str) -> Vec<ScenarioFile> {
    ScenarioFile::open_all(&checkout(folder)).expect("the library is sound")
}

/// A folder for one test, gone after it.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    pub fn path(&self) -> PathBuf {
        self.0.path().to_path_buf()
    }

    /// The path of a file in it.
    pub fn file(&self, name: &str) -> String {
        self.path().join(name).display().to_string()
    }

    /// A file in it, written.
    pub fn with(&self, name: &str, contents: impl AsRef<[u8]>) -> String {
        std::fs::write(self.path().join(name), contents).expect("a file for the test");
        self.file(name)
    }

    /// Whether a flight left all its files in it.
    pub fn assert_holds_a_flight(&self, folder: &str) {
        for file in FLIGHT_FILES {
            let length = self.path().join(folder).join(file).metadata();
            assert!(length.expect(file).len() > 100, "{file}");
        }
    }
}
