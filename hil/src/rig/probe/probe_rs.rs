//! A debug probe, driven by the command-line tool of probe-rs as its users drive it.

use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;
use std::time::Duration;

use super::command::{Finished, in_words, run};
use super::text_log;
use super::{Image, LEAST_PROBE_RS, LogSource, Probe, ProbeError};
use crate::board::FirmwareLog;

/// The tool.
const PROGRAM: &str = "probe-rs";
/// For what only asks: both questions of [`Probe::find`] within the five seconds in which a rig that
/// is not there has to be known.
const ASK: Duration = Duration::from_secs(2);
/// For what talks to the chip.
const ACCESS: Duration = Duration::from_secs(5);
/// For erasing and writing: the image is 110 KB, an ST-LINK writes some 20 KB a second.
const FLASH: Duration = Duration::from_secs(60);
/// Time stamp, level and message of a log line (defmt's display hints).
const LOG_FORMAT: &str = "{t} {L} {s}";

/// A probe behind probe-rs.
#[derive(Debug)]
pub struct ProbeRs {
    chip: String,
    selector: Option<String>,
}

impl ProbeRs {
    /// The probe `selector` (VID:PID:SERIAL; the only one where there is none) on a chip.
    pub fn new(chip: String, selector: Option<String>) -> Self {
        Self { chip, selector }
    }

    /// A verb of the tool that talks to the chip.
    fn verb(&self, verb: &str) -> Command {
        let mut command = Command::new(PROGRAM);
        command.args([verb, "--non-interactive", "--chip", &self.chip]);
        if let Some(selector) = &self.selector {
            command.args(["--probe", selector]);
        }
        command
    }

    fn succeed(&self, mut command: Command, limit: Duration) -> Result<Finished, ProbeError> {
        let finished = run(&mut command, limit)?;
        if finished.status.success() {
            return Ok(finished);
        }
        Err(self.understood(in_words(&command), finished.said()))
    }

    /// What the tool's words mean (probe-rs 0.30, `common_options` and `error`).
    fn understood(&self, command: String, said: String) -> ProbeError {
        let says = |words: &[&str]| words.iter().any(|words| said.contains(words));
        let chip = self.chip.clone();
        if says(&["No connected probes were found", "No probe was found"]) {
            ProbeError::NoProbe
        } else if says(&["was not found in the database"]) {
            ProbeError::UnknownChip { chip }
        } else if says(&[
            "lacked the permission to do so",
            "read protect",
            "is locked",
        ]) {
            ProbeError::Locked { said }
        } else if says(&["Connecting to the chip was unsuccessful"]) {
            ProbeError::NoChip { chip, said }
        } else {
            ProbeError::Failed { command, said }
        }
    }

    /// The tool, if it can be believed.
    fn version(&self) -> Result<String, ProbeError> {
        let mut command = Command::new(PROGRAM);
        command.arg("--version");
        let finished = run(&mut command, ASK)?;
        let found = finished.stdout.trim().to_owned();
        let version = found.split_whitespace().nth(1).and_then(|version| {
            let mut numbers = version.split('.').map(|number| number.parse::<u32>().ok());
            Some((numbers.next()??, numbers.next()??))
        });
        match version {
            Some(version) if version >= LEAST_PROBE_RS => {}
            Some(_) => return Err(ProbeError::OldTool { found }),
            None => {
                return Err(ProbeError::NotUnderstood {
                    command: in_words(&command),
                    said: finished.said(),
                });
            }
        }
        let words: Vec<_> = found.split_whitespace().take(2).collect();
        Ok(words.join(" "))
    }

    /// The line of `probe-rs list` that stands for this rig's probe.
    fn listed(&self) -> Result<String, ProbeError> {
        let mut command = Command::new(PROGRAM);
        command.arg("list");
        let said = self.succeed(command, ASK)?.stdout;
        let probes: Vec<_> = said.lines().filter(|line| line.starts_with('[')).collect();
        let found = || probes.join("\n");
        match (&self.selector, probes.as_slice()) {
            (_, []) => Err(ProbeError::NoProbe),
            (None, [probe]) => Ok((*probe).to_owned()),
            (None, _) => Err(ProbeError::ManyProbes { found: found() }),
            (Some(selector), probes) => probes
                .iter()
                .find(|probe| probe.contains(selector.as_str()))
                .map(|probe| (*probe).to_owned())
                .ok_or_else(|| ProbeError::OtherProbe {
                    wanted: selector.clone(),
                    found: found(),
                }),
        }
    }
}

impl Probe for ProbeRs {
    fn find(&mut self) -> Result<String, ProbeError> {
        let tool = self.version()?;
        Ok(format!("{tool}, {}", self.listed()?))
    }

    fn flash(&mut self, elf: &Path) -> Result<(), ProbeError> {
        let mut command = self.verb("download");
        command
            .args(["--verify", "--disable-progressbars"])
            .arg(elf);
        self.succeed(command, FLASH)?;
        self.reset()
    }

    fn reset(&mut self) -> Result<(), ProbeError> {
        self.succeed(self.verb("reset"), ACCESS).map(drop)
    }

    fn read(&mut self, address: u32, length: usize) -> Result<Vec<u8>, ProbeError> {
        let mut command = self.verb("read");
        command.args(["b8", &format!("0x{address:08x}"), &length.to_string()]);
        let words = in_words(&command);
        let said = self.succeed(command, ACCESS)?.stdout;
        bytes(&said)
            .filter(|bytes| bytes.len() == length)
            .ok_or(ProbeError::NotUnderstood {
                command: words,
                said,
            })
    }

    fn log<'f>(&mut self, image: &Image<'f>) -> Result<Box<dyn LogSource + 'f>, ProbeError> {
        let mut command = self.verb("attach");
        command
            .args(["--no-location", "--log-format", LOG_FORMAT])
            .arg(image.elf);
        Ok(Box::new(Attached::start(command)?))
    }
}

/// The bytes of a memory dump: two digits each, with or without the address of its line before them.
fn bytes(dump: &str) -> Option<Vec<u8>> {
    let words = dump.lines().flat_map(|line| {
        let line = line.split_once(':').map_or(line, |(_, bytes)| bytes);
        line.split_whitespace()
    });
    words
        .map(|word| u8::from_str_radix(word, 16).ok())
        .collect()
}

/// `probe-rs attach`, with what it prints.
struct Attached {
    child: Child,
    lines: Receiver<String>,
    errors: Receiver<String>,
}

impl Attached {
    fn start(mut command: Command) -> Result<Self, ProbeError> {
        let words = in_words(&command);
        let spawned = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = spawned.map_err(|source| match source.kind() {
            ErrorKind::NotFound => ProbeError::NoTool,
            _ => ProbeError::NotStarted {
                command: words,
                source,
            },
        })?;
        let (lines, errors) = (listen(child.stdout.take()), listen(child.stderr.take()));
        Ok(Self {
            child,
            lines,
            errors,
        })
    }
}

/// Lines as they come; the receiver ends with the pipe.
fn listen(pipe: Option<impl std::io::Read + Send + 'static>) -> Receiver<String> {
    let (sender, receiver) = channel();
    if let Some(pipe) = pipe {
        thread::spawn(move || {
            let lines = BufReader::new(pipe).lines().map_while(Result::ok);
            // Nobody listens any more: the flight has ended.
            let _ = lines.into_iter().try_for_each(|line| sender.send(line));
        });
    }
    receiver
}

impl LogSource for Attached {
    fn poll(&mut self, into: &mut Vec<FirmwareLog>) -> Result<(), ProbeError> {
        loop {
            match self.lines.try_recv() {
                Ok(line) => into.extend(text_log::read(&line)),
                Err(TryRecvError::Empty) => return Ok(()),
                Err(TryRecvError::Disconnected) => {
                    let errors: Vec<_> = self.errors.try_iter().collect();
                    return Err(ProbeError::LogEnded(errors.join("\n")));
                }
            }
        }
    }
}

impl Drop for Attached {
    fn drop(&mut self) {
        // It ends by a signal alone.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dump_is_read_with_and_without_addresses() {
        let table = "08000000: 00 10 ff\n08000003: 20 01\n";
        assert_eq!(bytes(table), Some(vec![0x00, 0x10, 0xff, 0x20, 0x01]));
        assert_eq!(
            bytes("00 10 ff 20 01\n"),
            Some(vec![0x00, 0x10, 0xff, 0x20, 0x01])
        );
        assert_eq!(bytes("Error: nothing"), None);
    }
}
