//! The end of a run, for people.

use core::fmt;

use crate::core::Cause;
use crate::image::Image;
use crate::soc::Refusal;
use crate::time::Nanos;

/// Who ended the run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Reason {
    /// The core met something it cannot do.
    #[error(transparent)]
    Core(Cause),
    /// The chip was asked for something it does not have, or its watchdog expired.
    #[error(transparent)]
    Chip(Refusal),
}

/// Why, when and where the firmware stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Why.
    pub reason: Reason,
    /// Virtual time.
    pub at: Nanos,
    /// Address of the instruction that stopped.
    pub pc: u32,
    /// The link register: where the function returns to, if it has called nothing yet.
    pub lr: u32,
    /// The function that holds `pc`, and how far into it that is.
    pub function: Option<String>,
    /// The function that holds `lr`, and how far into it that is.
    pub caller: Option<String>,
}

impl Fault {
    pub(super) fn new(reason: Reason, at: Nanos, image: &Image, pc: u32, lr: u32) -> Self {
        let name = |address| {
            let (name, offset) = image.symbol_at(address)?;
            Some(format!("{name}+{offset:#x}"))
        };
        Self {
            reason,
            at,
            pc,
            lr,
            function: name(pc),
            caller: name(lr),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at {}, pc {:#010x}", self.reason, self.at, self.pc)?;
        if let Some(function) = &self.function {
            write!(f, " ({function})")?;
        }
        write!(f, ", lr {:#010x}", self.lr)?;
        match &self.caller {
            Some(caller) => write!(f, " ({caller})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Fault {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.reason)
    }
}
