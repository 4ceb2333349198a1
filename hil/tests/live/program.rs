//! `hil emulate` and `hil autopilot` as processes.

use std::fmt;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread::{self, JoinHandle};

use serde_json::Value;

use super::wait_until;

/// How much faster than the clock: a busy machine keeps up with that.
const SPEED: &str = "4";

/// The image; a machine that cannot build it fails every test with a board.
fn elf() -> &'static Path {
    static ELF: OnceLock<PathBuf> = OnceLock::new();
    ELF.get_or_init(|| hil::image::build(&|line| eprintln!("{line}")).expect("the firmware builds"))
}

/// A program that runs, and what it has said on stderr; ended with the test.
pub struct Program {
    child: Child,
    said: Arc<Mutex<String>>,
    listener: Option<JoinHandle<()>>,
    out: PathBuf,
}

impl Program {
    fn start(verb: &str, name: &str, arguments: &[&str]) -> Self {
        let out = std::env::temp_dir().join(format!("hil-live-{name}-{}", std::process::id()));
        let mut child = Command::new(env!("CARGO_BIN_EXE_hil"))
            .arg(verb)
            .args(arguments)
            .args(["--json", "--speed", SPEED, "--out"])
            .arg(&out)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let said = Arc::new(Mutex::new(String::new()));
        let stderr = BufReader::new(child.stderr.take().expect("piped"));
        let hears = Arc::clone(&said);
        let listener = thread::spawn(move || {
            for line in stderr.lines().map_while(Result::ok) {
                let mut said = hears.lock().expect("one speaker");
                said.push_str(&line);
                said.push('\n');
            }
        });
        Self {
            child,
            said,
            listener: Some(listener),
            out,
        }
    }

    /// `hil emulate`, many times faster than the clock.
    pub fn emulate(name: &str, link: &str, more: &[&str]) -> Self {
        let elf = elf().display().to_string();
        let mut arguments = vec!["--link", link, "--firmware", &elf];
        arguments.extend(more);
        Self::start("emulate", name, &arguments)
    }

    /// `hil autopilot` on the shortest route.
    pub fn autopilot(name: &str, link: &str, more: &[&str]) -> Self {
        let mut arguments = vec!["--link", link, "--route", "corner"];
        arguments.extend(more);
        Self::start("autopilot", name, &arguments)
    }

    /// On stderr, so far.
    pub fn said(&self) -> String {
        self.said.lock().expect("one speaker").clone()
    }

    /// Waits until it has said that.
    pub fn wait_for(&mut self, text: &str) {
        self.wait_for_times(text, 1);
    }

    /// Waits until it has said that so many times.
    pub fn wait_for_times(&mut self, text: &str, times: usize) {
        let awaited = Awaited {
            text,
            said: Arc::clone(&self.said),
        };
        wait_until(awaited, || {
            let ended = self.child.try_wait().expect("a child").is_some();
            if let Some(listener) = self.listener.take_if(|_| ended) {
                listener.join().expect("all heard");
            }
            let said = self.said();
            let enough = said.matches(text).count() >= times;
            assert!(enough || !ended, "ended before `{text}`: {said}");
            enough
        });
    }

    /// Sends `-INT` or `-TERM`.
    pub fn signal(&self, signal: &str) {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.expect("kill").success());
    }

    /// Waits for the end; the exit code and the summary that it printed.
    pub fn end(mut self) -> (ExitStatus, Value, Folder) {
        wait_until("the program ends", || {
            self.child.try_wait().expect("a child").is_some()
        });
        let status = self.child.wait().expect("a child");
        let stdout = self.child.stdout.take().expect("piped");
        let summary = serde_json::from_reader(stdout)
            .unwrap_or_else(|error| panic!("{error}: {}", self.said()));
        (status, summary, Folder(self.out.clone()))
    }
}

/// What a program is to say; for people who want to know what it said instead.
struct Awaited<'t> {
    text: &'t str,
    said: Arc<Mutex<String>>,
}

impl fmt::Display for Awaited<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = self.said.lock().expect("one speaker");
        write!(f, "`{}`; it said: {said}", self.text)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It has ended, but for a test that failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What a flight has left; gone after the test.
pub struct Folder(pub PathBuf);

impl Folder {
    /// A file of it.
    pub fn read(&self, file: &str) -> String {
        let path = self.0.join(file);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// `recording.json`.
    pub fn recording(&self) -> Value {
        serde_json::from_str(&self.read("recording.json")).expect("JSON")
    }

    /// Everything is there.
    pub fn is_whole(&self) {
        for file in [
            "summary.json",
            "recording.json",
            "flight.log",
            "report.html",
            "map.svg",
        ] {
            assert!(self.read(file).len() > 100, "{file}");
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
