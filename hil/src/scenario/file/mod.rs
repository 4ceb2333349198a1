//! A scenario as its file describes it, in TOML: world, route, recording, conditions, seeds, and what is expected.
//!
//! Lengths are in metres, times in seconds, speeds in m/s. Every number has a range, every table a closed list of keys:
//! what does not fit is refused with the line where it stands.
//!
//! | room | what it checks |
//! | --- | --- |
//! | `description` | the file in all, recording, seeds and expectations |
//! | `way` | the way out |
//! | `script` | a way out and back, step by step |
//! | `conditions` | wind, light and faults |

mod conditions;
mod description;
mod script;
#[cfg(test)]
mod tests;
mod way;

use std::fs;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use crc::{CRC_64_XZ, Crc};
use fake_sensors::world::World;
use serde::{Deserialize, Serialize};

use super::expectation::Expectation;
use super::{Conditions, Homing, Meander, Polyline, Route, Scenario, Spacing, Storage};
use crate::flight::FlightError;
use crate::toml_file::{self, FileError};
use description::Description;

/// A board that flies in virtual time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// The firmware's logic compiled for this machine: fast, for statistics
    #[default]
    Native,
    /// The image that would be flashed, on an emulated STM32F407
    Emulator,
}

impl Backend {
    /// The name on the command line and in a summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Native => "native",
            Self::Emulator => "emulator",
        }
    }
}

/// Seeds in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// The first.
    pub first: u64,
    /// How many, from 1.
    pub count: u64,
}

impl Seeds {
    /// All of them, in order.
    pub fn all(self) -> impl Iterator<Item = u64> {
        (0..self.count).map(move |index| self.first.wrapping_add(index))
    }
}

/// The way out as a file describes it.
#[derive(Clone, Debug, PartialEq)]
enum Way {
    Fixed(Route),
    /// Drawn in the world of each seed.
    Drawn(Meander),
}

/// A file that describes a scenario.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    /// The file's name, without folder and extension.
    pub name: String,
    /// What it stands for, for people.
    pub meaning: String,
    /// What it is flown on, unless somebody asks for another board.
    pub backend: Backend,
    /// Which flights it consists of.
    pub seeds: Seeds,
    /// What they are expected to do.
    pub expectations: Vec<Expectation>,
    world: String,
    way: Way,
    homing: Homing,
    spacing: Spacing,
    storage: Storage,
    conditions: Conditions,
    /// Where a world's file is looked for.
    folder: PathBuf,
    /// The file as it stands.
    text: String,
}

impl ScenarioFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`FileError`] with the file, and the line where something is wrong.
    pub fn open(file: &Path) -> Result<Self, FileError> {
        Self::parse(file, toml_file::read(file)?)
    }

    /// Reads a text as if it stood in that file; the file of a world is looked for beside it.
    ///
    /// # Errors
    /// [`FileError::Mistake`].
    pub fn parse(file: &Path, text: String) -> Result<Self, FileError> {
        let check = |description: Description| description.check(file);
        let scenario = toml_file::parse(file, &text, check)?;
        Ok(Self { text, ..scenario })
    }

    /// Every file of a folder, by name.
    ///
    /// # Errors
    /// [`FileError`] of the first that describes no scenario, or where the folder cannot be read.
    pub fn open_all(folder: &Path) -> Result<Vec<Self>, FileError> {
        let unreadable = |source| FileError::Unreadable {
            file: folder.to_owned(),
            source,
        };
        let entries: Result<Vec<_>, _> = fs::read_dir(folder).map_err(unreadable)?.collect();
        let mut files: Vec<PathBuf> = entries
            .map_err(unreadable)?
            .into_iter()
            .map(|entry| entry.path())
            .filter(|file| {
                file.extension()
                    .is_some_and(|extension| extension == "toml")
            })
            .collect();
        files.sort();
        files.iter().map(|file| Self::open(file)).collect()
    }

    /// The flight of one seed.
    ///
    /// # Errors
    /// [`FlightError`] where a route is to be drawn in a world that cannot be built, or has no room for it.
    pub fn scenario(&self, seed: u64) -> Result<Scenario, FlightError> {
        let world = self.world_name();
        let route = match &self.way {
            Way::Fixed(route) => route.clone(),
            Way::Drawn(meander) => Route::Own(Polyline {
                name: self.name.clone(),
                places: meander.places(&World::open(&world, seed)?, seed)?,
                passes: 1,
            }),
        };
        Ok(Scenario {
            route,
            world,
            seed,
            spacing: self.spacing,
            storage: self.storage,
            homing: self.homing,
            conditions: self.conditions,
        })
    }

    /// What tells it from every other scenario: a checksum of its text, and of the file of its world.
    pub fn fingerprint(&self) -> String {
        let crc = Crc::<u64>::new(&CRC_64_XZ);
        let mut digest = crc.digest();
        digest.update(self.text.as_bytes());
        if self.has_world_file()
            && let Ok(world) = fs::read(self.world_name())
        {
            digest.update(&world);
        }
        format!("{:016x}", digest.finalize())
    }

    /// The file as it stands.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Where the file of its world is looked for.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn has_world_file(&self) -> bool {
        !World::names().contains(&self.world.as_str())
    }

    fn world_name(&self) -> String {
        if self.has_world_file() {
            self.folder.join(&self.world).display().to_string()
        } else {
            self.world.clone()
        }
    }
}
