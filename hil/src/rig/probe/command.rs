//! Runs another program to its end, but not for ever.

use std::io::{self, ErrorKind, Read};
use std::process::{Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::ProbeError;

/// Between two looks whether it has ended.
const PATIENCE: Duration = Duration::from_millis(10);

/// A program that has ended.
#[derive(Debug)]
pub struct Finished {
    /// How.
    pub status: ExitStatus,
    /// On stdout.
    pub stdout: String,
    /// On stderr.
    pub stderr: String,
}

impl Finished {
    /// What it said, for people: errors first.
    pub fn said(&self) -> String {
        let both = format!("{}\n{}", self.stderr.trim(), self.stdout.trim());
        both.trim().to_owned()
    }
}

/// The command line, for people.
pub fn in_words(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    words.join(" ")
}

/// Runs a command; after `limit` it is ended.
///
/// # Errors
/// [`ProbeError::NoTool`] where there is no such program, [`ProbeError::NotStarted`] and
/// [`ProbeError::TimedOut`].
pub fn run(command: &mut Command, limit: Duration) -> Result<Finished, ProbeError> {
    let not_started = |source: io::Error, command: &Command| match source.kind() {
        ErrorKind::NotFound => ProbeError::NoTool,
        _ => ProbeError::NotStarted {
            command: in_words(command),
            source,
        },
    };
    let started = Instant::now();
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|source| not_started(source, command))?;
    let (stdout, stderr) = (listen(child.stdout.take()), listen(child.stderr.take()));
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if started.elapsed() < limit => thread::sleep(PATIENCE),
            Ok(None) => {
                // It may have ended by itself at this very moment.
                let _ = child.kill();
                let _ = child.wait();
                return Err(ProbeError::TimedOut {
                    command: in_words(command),
                    limit,
                });
            }
            Err(source) => return Err(not_started(source, command)),
        }
    };
    Ok(Finished {
        status,
        stdout: heard(stdout),
        stderr: heard(stderr),
    })
}

/// Reads all that comes, beside the wait: a full pipe would stop the program.
fn listen(pipe: Option<impl Read + Send + 'static>) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            // What came before an error counts.
            let _ = pipe.read_to_end(&mut bytes);
        }
        bytes
    })
}

fn heard(listener: JoinHandle<Vec<u8>>) -> String {
    String::from_utf8_lossy(&listener.join().unwrap_or_default()).into_owned()
}
