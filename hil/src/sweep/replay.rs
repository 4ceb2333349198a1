//! What a flight that failed leaves behind, and the same flight once more.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crc::{CRC_64_XZ, Crc};
use serde::{Deserialize, Serialize};

use super::shard::VERSION;
use crate::flight::Flown;
use crate::folder;
use crate::scenario::file::{Backend, ScenarioFile};
use crate::toml_file::FileError;

/// The file in a flight's folder that says how to fly it again.
const FILE: &str = "replay.toml";

/// How to fly a flight again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Replay {
    /// Of the rig that flew it.
    pub version: String,
    /// Which board.
    pub backend: Backend,
    /// Which flight of the scenario.
    pub seed: u64,
    /// Checksum of `recording.json`, CRC-64/XZ.
    pub recording: String,
    /// Name of the scenario.
    pub name: String,
    /// Where a world's file is looked for.
    pub folder: PathBuf,
    /// The scenario's file as it stood.
    pub scenario: String,
}

/// A folder that no flight can be replayed from, or one that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A file cannot be read or written.
    #[error("{}: {source}", file.display())]
    Io {
        /// Which.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file says something else.
    #[error("{}: {reason}", file.display())]
    Malformed {
        /// Which.
        file: PathBuf,
        /// What is wrong, and on which line.
        reason: String,
    },
    /// The scenario in it is none.
    #[error(transparent)]
    Scenario(#[from] FileError),
}

/// Leaves a flight's folder with what is needed to fly it again.
///
/// # Errors
/// [`ReplayError::Io`].
pub fn write_failed(
    folder: &Path,
    file: &ScenarioFile,
    backend: Backend,
    flown: &Flown,
) -> Result<(), ReplayError> {
    let replay = Replay {
        version: VERSION.to_owned(),
        backend,
        seed: flown.summary.seed,
        recording: checksum(&recording_of(folder, flown)?),
        name: file.name.clone(),
        folder: fs::canonicalize(file.folder()).unwrap_or_else(|_| file.folder().to_owned()),
        scenario: file.text().to_owned(),
    };
    let path = folder.join(FILE);
    folder::prepare(folder)
        .and_then(|()| folder::write(folder, flown))
        .and_then(|()| toml::to_string_pretty(&replay).map_err(io::Error::other))
        .and_then(|text| fs::write(&path, text))
        .map_err(|source| ReplayError::Io { file: path, source })
}

impl Replay {
    /// Reads it from a flight's folder.
    ///
    /// # Errors
    /// [`ReplayError`] with the file.
    pub fn read(folder: &Path) -> Result<Self, ReplayError> {
        let file = folder.join(FILE);
        match fs::read_to_string(&file) {
            Ok(text) => toml::from_str(&text).map_err(|error| ReplayError::Malformed {
                file,
                reason: error.to_string(),
            }),
            Err(source) => Err(ReplayError::Io { file, source }),
        }
    }

    /// The scenario of which it is a flight.
    ///
    /// # Errors
    /// [`ReplayError::Scenario`].
    pub fn scenario_file(&self) -> Result<ScenarioFile, ReplayError> {
        let file = self.folder.join(&self.name).with_extension("toml");
        Ok(ScenarioFile::parse(&file, self.scenario.clone())?)
    }

    /// The first byte in which the flight flown again differs from the one in the folder: from its `recording.json`, or,
    /// where that is gone, at 0 if the checksums differ. None where they are the same.
    ///
    /// # Errors
    /// [`ReplayError::Io`].
    pub fn first_difference(
        &self,
        folder: &Path,
        again: &Flown,
    ) -> Result<Option<usize>, ReplayError> {
        let again = recording_of(folder, again)?;
        let file = folder.join(folder::RECORDING);
        let before = match fs::read(&file) {
            Ok(before) => before,
            Err(source) if source.kind() == io::ErrorKind::NotFound => {
                return Ok((checksum(&again) != self.recording).then_some(0));
            }
            Err(source) => return Err(ReplayError::Io { file, source }),
        };
        if again.as_bytes() == before {
            return Ok(None);
        }
        let same = again.bytes().zip(&before).take_while(|(a, b)| a == *b);
        Ok(Some(same.count()))
    }
}

fn recording_of(folder: &Path, flown: &Flown) -> Result<String, ReplayError> {
    folder::recording_text(&flown.recording).map_err(|error| ReplayError::Io {
        file: folder.join(folder::RECORDING),
        source: error.into(),
    })
}

fn checksum(text: &str) -> String {
    format!(
        "{:016x}",
        Crc::<u64>::new(&CRC_64_XZ).checksum(text.as_bytes())
    )
}
