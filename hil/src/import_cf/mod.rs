//! Flights of the real thing: the log files that cfclient writes for the published flight app, as the same folder
//! that a flight of the rig leaves.
//!
//! ```text
//! log files -> tables -> series of each variable on one clock -> pose and messages -> Recorder -> Flown
//! ```
//!
//! cfclient's "write to file" gives one CSV file for each log configuration: a header `Timestamp,group.name,...` and
//! a row for each packet, its time the low 24 bits of the Crazyflie's tick in milliseconds
//! (crazyflie-clients-python `logdatawriter`, crazyflie-lib-python `log`). The variables hold what the last message
//! left in them; a message that was overwritten between two rows is not seen.
//!
//! There is no truth in such logs: [`Reference::Estimate`](crate::record::Reference::Estimate) stands for it.

mod clock;
mod error;
mod estimate;
mod messages;
mod missing;
mod phases;
mod rebuild;
mod series;
mod snapshots;
mod sum_up;
mod table;

use std::path::Path;
use std::time::Instant;

pub use error::{Fault, ImportError};

use crate::flight::Flown;
use clock::Clock;
use estimate::Track;
use messages::Messages;
use phases::Phases;
use series::Variables;
use table::Table;

/// A log file as it was read.
#[derive(Clone, Debug)]
pub struct LogFile {
    /// What errors and notes call it.
    pub name: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

impl LogFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ImportError::Unreadable`].
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        let name = path.display().to_string();
        match std::fs::read(path) {
            Ok(bytes) => Ok(Self { name, bytes }),
            Err(source) => Err(ImportError::Unreadable { file: name, source }),
        }
    }
}

/// The flight that the files of one power-on tell of.
///
/// # Errors
/// [`ImportError::Faulty`] with file, line and column, where a file is none of cfclient's, where its time runs back,
/// or where there is nothing in the files that this can draw.
pub fn import(files: &[LogFile]) -> Result<Flown, ImportError> {
    let started = Instant::now();
    let tables: Vec<Table> = files.iter().map(Table::parse).collect::<Result<_, _>>()?;
    let clock = Clock::of(&tables)?;
    let variables = Variables::of(&tables, &clock);
    let track = Track::of(&variables);
    let messages = Messages::of(&variables);
    if !variables.are_known() {
        let name = tables.first().map_or("", |table| table.name.as_str());
        return Err(Fault::NothingKnown.at(name, 1, 1));
    }
    let notes = missing::notes(&tables, &clock, &variables, track.as_ref());
    let vectors = tables.iter().find(|table| table.has("vh.v_to_n"));
    let row_ms = vectors.and_then(Table::period_ms).unwrap_or_default();
    let phases = Phases::of(track.as_ref(), &messages, row_ms);
    let recording = rebuild::recording(track.as_ref(), &messages, &phases, notes);
    Ok(Flown {
        summary: sum_up::summary(&tables, &recording, started.elapsed()),
        recording,
    })
}
