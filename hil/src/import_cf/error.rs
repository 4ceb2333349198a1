//! What can be wrong with a log file.

use std::io;

/// Log files that give no flight.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// A file cannot be read.
    #[error("{file}: {source}")]
    Unreadable {
        /// Which.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// A file is not what it should be.
    #[error("{file}:{line}:{column}: {fault}")]
    Faulty {
        /// Which.
        file: String,
        /// Line, from 1.
        line: u64,
        /// Column of the first byte that is wrong, from 1.
        column: u64,
        /// What is wrong.
        fault: Fault,
    },
}

/// What is wrong in a place of a log file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// The header is not one of cfclient's.
    #[error("not a log of cfclient: the first column is called `{0}`, not `Timestamp`")]
    NotALog(String),
    /// The header has a name twice.
    #[error("the column `{0}` is there twice")]
    TwoColumns(String),
    /// Bytes that are no text.
    #[error("not a text file (UTF-8)")]
    NotText,
    /// A row with more or fewer values than the header has names.
    #[error("{found} values where the header names {expected} columns")]
    WrongCount {
        /// Names in the header.
        expected: u64,
        /// Values in the row.
        found: u64,
    },
    /// A time that is no count of milliseconds.
    #[error("`{0}` is no time stamp: a whole number of milliseconds")]
    NotATime(String),
    /// A value that is no number.
    #[error("`{text}` is no number (column `{variable}`)")]
    NotANumber {
        /// Name of the column.
        variable: String,
        /// What stands there.
        text: String,
    },
    /// The Crazyflie's clock began anew.
    #[error(
        "the time falls from {from_ms} ms to {to_ms} ms: the Crazyflie was restarted here. One import is one flight: cut the files at the restart"
    )]
    Restarted {
        /// Time of the row before.
        from_ms: u64,
        /// Time of this row.
        to_ms: u64,
    },
    /// No file has a row.
    #[error("no file has a row of values")]
    NoRows,
    /// No file has a variable of which anything can be drawn.
    #[error(
        "no file has a column `vh.*`, `stateEstimate.*` or `kalman.*`: there is nothing to draw"
    )]
    NothingKnown,
}

impl Fault {
    /// The fault in its place.
    pub(super) fn at(self, file: &str, line: u64, column: u64) -> ImportError {
        ImportError::Faulty {
            file: file.to_owned(),
            line,
            column,
            fault: self,
        }
    }
}
