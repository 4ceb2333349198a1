//! What the rig says: results on stdout; status lines and a progress bar on stderr, coloured only on
//! a terminal.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::time::Duration;

use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressStyle};

const VERB: Style = AnsiColor::Green.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const ERROR: Style = AnsiColor::Red.on_default().bold();

/// Status lines on stderr, in cargo's manner.
#[derive(Debug)]
pub struct Console {
    is_terminal: bool,
}

impl Console {
    /// The console of this process.
    pub fn new() -> Self {
        Self {
            is_terminal: std::io::stderr().is_terminal(),
        }
    }

    /// A line such as `    Firmware building with ...`.
    pub fn status(&self, verb: &str, text: &str) {
        // A closed stderr must not end a flight.
        let _ = writeln!(anstream::stderr(), "{VERB}{verb:>12}{VERB:#} {text}");
    }

    /// Something that is not as it should be and ends nothing, for people.
    pub fn warning(&self, text: &str) {
        let _ = writeln!(anstream::stderr(), "{WARNING}warning{WARNING:#}: {text}");
    }

    /// An error, for people.
    pub fn error(&self, text: &str) {
        let _ = writeln!(anstream::stderr(), "{ERROR}error{ERROR:#}: {text}");
    }

    /// A result on stdout. A reader that has read enough (`hil ... | head -1`) is no error.
    pub fn result(&self, text: &str) -> io::Result<()> {
        let mut stdout = io::stdout().lock();
        match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            written => written,
        }
    }

    /// A bar on a terminal, a line now and then elsewhere.
    pub fn progress(&self, verb: &'static str, total: u64) -> Progress {
        let bar = if self.is_terminal {
            let bar = ProgressBar::new(total);
            let template = "{prefix:>12.green.bold} [{bar:30}] {percent:>3}% {msg}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_prefix(verb);
            bar.enable_steady_tick(Duration::from_millis(100));
            Some(bar)
        } else {
            None
        };
        Progress {
            verb,
            total: total.max(1),
            bar,
            printed_tenths: 0,
        }
    }
}

/// How far a long piece of work has come.
#[derive(Debug)]
pub struct Progress {
    verb: &'static str,
    total: u64,
    bar: Option<ProgressBar>,
    printed_tenths: u64,
}

impl Progress {
    /// Says that `done` of the total is done; `text` is evaluated only if it will be shown.
    pub fn set(&mut self, done: u64, text: impl FnOnce() -> String) {
        if let Some(bar) = &self.bar {
            bar.set_position(done.min(self.total));
            bar.set_message(text());
            return;
        }
        let tenths = 10 * done / self.total;
        if tenths > self.printed_tenths {
            self.printed_tenths = tenths;
            let _ = writeln!(
                anstream::stderr(),
                "{VERB}{:>12}{VERB:#} {}",
                self.verb,
                text()
            );
        }
    }

    /// Removes the bar.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}
