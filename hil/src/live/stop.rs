//! Ctrl-C and its kin: the first one ends the flight, whose folder is written; the second one ends
//! the program.

use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that a signal ended (shells: 128 + 2 for SIGINT).
const INTERRUPTED: i32 = 130;

/// Whether the flight is to end.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Listens to Ctrl-C, SIGTERM and SIGHUP from now on. Once in a process.
    ///
    /// # Errors
    /// The system's, or that it is not the first time.
    pub fn on_signals() -> Result<Self, ctrlc::Error> {
        let stop = Self::default();
        let requested = Arc::clone(&stop.0);
        ctrlc::set_handler(move || {
            if requested.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED);
            }
        })?;
        Ok(stop)
    }

    /// Asks.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody has asked.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
