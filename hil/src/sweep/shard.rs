//! The flights of a scenario in a file, whole or one part of several, and the parts put together.

use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::FlightFigures;
use crate::scenario::file::{Backend, ScenarioFile, Seeds};

/// The version of the rig that flies: flights of two versions are not the same flights.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// One of so many parts of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Which, from 1.
    pub index: u64,
    /// Of how many.
    pub of: u64,
}

impl Part {
    /// All of it.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// The seeds that are flown in this part: every so many-th, so that the parts take as long as each other.
    pub fn of_seeds(self, seeds: Seeds) -> Vec<u64> {
        let mine = |(place, _): &(u64, u64)| place % self.of == self.index - 1;
        (0..)
            .zip(seeds.all())
            .filter(mine)
            .map(|(_, seed)| seed)
            .collect()
    }
}

/// As in `2/8`.
impl FromStr for Part {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(index, of)| {
            let (index, of) = (index.parse().ok()?, of.parse().ok()?);
            (1..=of).contains(&index).then_some(Self { index, of })
        });
        parts.ok_or_else(|| "INDEX/OF, from 1/OF to OF/OF, as in 2/8".to_owned())
    }
}

/// Flights that have been flown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flights {
    /// Of the rig.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// What tells it from every other.
    pub fingerprint: String,
    /// Which board.
    pub backend: Backend,
    /// Which part this is.
    pub part: Part,
    /// The seeds of all parts together.
    pub seeds: Seeds,
    /// The scenario's file as it stands.
    pub text: String,
    /// Where a world's file is looked for.
    pub folder: PathBuf,
    /// In the order of their seeds.
    pub flights: Vec<FlightFigures>,
}

/// A file that holds no flights.
#[derive(Debug, thiserror::Error)]
pub enum ShardError {
    /// It cannot be read or written.
    #[error("{}: {source}", file.display())]
    Io {
        /// Which.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is something else.
    #[error("{}:{}: no shard of a sweep: {source}", file.display(), source.line())]
    Malformed {
        /// Which.
        file: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
}

impl Flights {
    /// Those of a part of a scenario's seeds.
    pub fn new(
        file: &ScenarioFile,
        backend: Backend,
        (part, seeds): (Part, Seeds),
        flights: Vec<FlightFigures>,
    ) -> Self {
        Self {
            version: VERSION.to_owned(),
            scenario: file.name.clone(),
            fingerprint: file.fingerprint(),
            backend,
            part,
            seeds,
            text: file.text().to_owned(),
            folder: file.folder().to_owned(),
            flights,
        }
    }

    /// The name of its file.
    pub fn file_name(&self) -> String {
        let (name, Part { index, of }) = (&self.scenario, self.part);
        if self.part == Part::WHOLE {
            format!("{name}.json")
        } else {
            format!("{name}-{index}-of-{of}.json")
        }
    }

    /// Writes them into a folder, and says which file that made.
    ///
    /// # Errors
    /// [`ShardError::Io`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, ShardError> {
        let file = folder.join(self.file_name());
        let written = fs::create_dir_all(folder)
            .and_then(|()| Ok(serde_json::to_string_pretty(self)? + "\n"))
            .and_then(|text| fs::write(&file, text));
        match written {
            Ok(()) => Ok(file),
            Err(source) => Err(ShardError::Io { file, source }),
        }
    }

    /// Reads them from a file.
    ///
    /// # Errors
    /// [`ShardError`] with the file, and the line where it is no shard.
    pub fn read(file: &Path) -> Result<Self, ShardError> {
        let text = fs::read_to_string(file).map_err(|source| ShardError::Io {
            file: file.to_owned(),
            source,
        })?;
        serde_json::from_str(&text).map_err(|source| ShardError::Malformed {
            file: file.to_owned(),
            source,
        })
    }
}

/// Shards that do not belong together, or are not all of them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// There is none.
    #[error("no shards")]
    Nothing,
    /// Two shards differ in something that all have in common.
    #[error("{one} and {other} are not of one sweep: {what} `{first}` and `{second}`")]
    Mixed {
        /// A shard.
        one: String,
        /// Another.
        other: String,
        /// What differs.
        what: &'static str,
        /// As the one says.
        first: String,
        /// As the other says.
        second: String,
    },
    /// One part is there twice.
    #[error("{one} and {other} overlap: both are shard {index}/{of}")]
    Overlap {
        /// A shard.
        one: String,
        /// Another.
        other: String,
        /// Which part.
        index: u64,
        /// Of how many.
        of: u64,
    },
    /// Parts that are not there.
    #[error("missing: shard {}", missing.join(", shard "))]
    Missing {
        /// Which.
        missing: Vec<String>,
    },
    /// A shard has not the seeds of its part.
    #[error("{name} has not the seeds of shard {index}/{of}")]
    OtherSeeds {
        /// The shard.
        name: String,
        /// Which part.
        index: u64,
        /// Of how many.
        of: u64,
    },
}

/// Puts the parts of a sweep together, each with a name for people: what one sweep would have been.
///
/// # Errors
/// [`MergeError`] by the names of the shards.
pub fn merge(shards: &[(String, Flights)]) -> Result<Flights, MergeError> {
    let (name, first) = shards.first().ok_or(MergeError::Nothing)?;
    for (other, shard) in shards {
        if let Some((what, first, second)) = difference(first, shard) {
            let (one, other) = (name.clone(), other.clone());
            return Err(MergeError::Mixed {
                one,
                other,
                what,
                first,
                second,
            });
        }
    }
    let of = first.part.of;
    let mut missing = Vec::new();
    for index in 1..=of {
        let mut these = shards
            .iter()
            .filter(|(_, shard)| shard.part.index == index)
            .map(|(name, _)| name);
        match (these.next(), these.next()) {
            (Some(one), Some(other)) => {
                let (one, other) = (one.clone(), other.clone());
                return Err(MergeError::Overlap {
                    one,
                    other,
                    index,
                    of,
                });
            }
            (None, _) => missing.push(format!("{index}/{of}")),
            (Some(_), None) => {}
        }
    }
    if !missing.is_empty() {
        return Err(MergeError::Missing { missing });
    }
    for (name, Flights { part, flights, .. }) in shards {
        let seeds = flights.iter().map(|flight| flight.seed);
        if !seeds.eq(part.of_seeds(first.seeds)) {
            return Err(MergeError::OtherSeeds {
                name: name.clone(),
                index: part.index,
                of,
            });
        }
    }
    Ok(Flights {
        part: Part::WHOLE,
        flights: interleaved(shards, first.seeds),
        ..first.clone()
    })
}

/// The first thing in which two shards of one sweep may not differ.
fn difference(one: &Flights, other: &Flights) -> Option<(&'static str, String, String)> {
    let said = |shard: &Flights| {
        [
            ("version", shard.version.clone()),
            ("scenario", shard.scenario.clone()),
            ("fingerprint", shard.fingerprint.clone()),
            ("backend", shard.backend.name().to_owned()),
            ("number of shards", shard.part.of.to_string()),
            ("first seed", shard.seeds.first.to_string()),
            ("number of seeds", shard.seeds.count.to_string()),
        ]
    };
    let mut pairs = said(one).into_iter().zip(said(other));
    pairs
        .find_map(|((what, first), (_, second))| (first != second).then_some((what, first, second)))
}

/// The flights of all parts in the order of the seeds: part 1 has the first, part 2 the second, and so on.
fn interleaved(shards: &[(String, Flights)], seeds: Seeds) -> Vec<FlightFigures> {
    let mut parts: Vec<_> = shards.iter().map(|(_, shard)| shard).collect();
    parts.sort_by_key(|shard| shard.part.index);
    let rows = (0..seeds.count as usize).filter_map(|place| {
        let shard = parts.get(place % parts.len())?;
        shard.flights.get(place / parts.len())
    });
    rows.cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::super::figures::tests::flight;
    use super::*;

    const SEEDS: Seeds = Seeds { first: 5, count: 7 };

    fn shard(index: u64, of: u64) -> (String, Flights) {
        let part = Part { index, of };
        let flights = part.of_seeds(SEEDS).into_iter();
        let shard = Flights {
            version: VERSION.to_owned(),
            scenario: "u".to_owned(),
            fingerprint: "0123456789abcdef".to_owned(),
            backend: Backend::Native,
            part,
            seeds: SEEDS,
            text: String::new(),
            folder: PathBuf::new(),
            // Figures that only survive where every digit does.
            flights: flights
                .map(|seed| flight(seed, 1.0 / (3.0 + seed as f64)))
                .collect(),
        };
        (format!("part{index}.json"), shard)
    }

    #[test]
    fn a_part_is_written_as_index_and_number() {
        assert_eq!("2/8".parse(), Ok(Part { index: 2, of: 8 }));
        for nonsense in ["", "2", "0/8", "9/8", "2/", "/8", "-1/8", "1/0"] {
            assert!(nonsense.parse::<Part>().is_err(), "{nonsense}");
        }
    }

    #[test]
    fn the_parts_of_a_sweep_put_together_in_any_order_are_the_sweep() {
        let (_, whole) = shard(1, 1);
        let written = |(name, shard): (String, Flights)| {
            let text = serde_json::to_string(&shard).expect("JSON");
            (name, serde_json::from_str(&text).expect("a shard"))
        };
        for parts in [vec![3, 1, 2], vec![1, 2, 3]] {
            let shards: Vec<_> = parts
                .into_iter()
                .map(|index| written(shard(index, 3)))
                .collect();
            assert_eq!(merge(&shards), Ok(whole.clone()));
        }
        assert_eq!(whole.flights.len(), 7);
    }

    #[test]
    fn shards_of_two_sweeps_are_refused_by_name() {
        type Change = fn(&mut Flights);
        let changes: [(&str, Change); 5] = [
            ("version", |shard| shard.version = "0.0.1".to_owned()),
            ("fingerprint", |shard| shard.fingerprint = "0".to_owned()),
            ("backend", |shard| shard.backend = Backend::Emulator),
            ("number of shards", |shard| shard.part.of = 3),
            ("number of seeds", |shard| shard.seeds.count = 8),
        ];
        for (what, change) in changes {
            let mut shards = [shard(1, 2), shard(2, 2)];
            change(&mut shards[1].1);
            let said = merge(&shards).expect_err(what).to_string();
            for word in ["part1.json", "part2.json", what] {
                assert!(said.contains(word), "{said}");
            }
        }
    }

    #[test]
    fn a_shard_that_is_there_twice_or_not_at_all_is_named() {
        let twice = [
            shard(1, 3),
            shard(2, 3),
            ("again.json".to_owned(), shard(2, 3).1),
        ];
        let said = merge(&twice).expect_err("an overlap").to_string();
        assert_eq!(
            said,
            "part2.json and again.json overlap: both are shard 2/3"
        );
        let said = merge(&[shard(2, 4)]).expect_err("missing").to_string();
        assert_eq!(said, "missing: shard 1/4, shard 3/4, shard 4/4");
        assert_eq!(merge(&[]), Err(MergeError::Nothing));
    }

    #[test]
    fn a_shard_with_seeds_of_another_is_refused() {
        let mut shards = [shard(1, 2), shard(2, 2)];
        shards[1].1.flights.pop();
        let refused = MergeError::OtherSeeds {
            name: "part2.json".to_owned(),
            index: 2,
            of: 2,
        };
        assert_eq!(merge(&shards), Err(refused));
    }
}
