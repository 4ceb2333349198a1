//! What a scenario's file may say, and from there to what can be flown.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use fake_sensors::world::World;
use serde::Deserialize;
use toml::Spanned;

use super::conditions::ConditionsTable;
use super::way::{self, RouteTable};
use super::{Backend, ScenarioFile, Seeds, Way};
use crate::scenario::expectation::{Bounds, Expectation, Metric};
use crate::scenario::{Deviation, Homing, Route, SnapshotForm, Spacing, Storage};
use crate::toml_file::Mistake;

/// Seeds of one scenario.
const COUNTS: RangeInclusive<u64> = 1..=1_000_000;
/// Numbers of the paper's claims.
const CLAIMS: RangeInclusive<u8> = 1..=36;

/// The file as it stands.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    meaning: String,
    world: Spanned<String>,
    route: Spanned<RouteTable>,
    homing: Option<Spanned<HomingName>>,
    #[serde(default)]
    backend: Backend,
    #[serde(default)]
    recording: RecordingTable,
    #[serde(default)]
    conditions: ConditionsTable,
    seeds: Spanned<Seeds>,
    #[serde(default)]
    expect: Vec<Spanned<ExpectTable>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum HomingName {
    Both,
    Odometry,
    Sequence,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordingTable {
    spacing: Option<Spanned<SpacingTable>>,
    #[serde(default)]
    snapshots: SnapshotForm,
    deviation: Option<Spanned<f64>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "metres, or \"auto\"")]
enum SpacingTable {
    Metres(f64),
    Found(FoundSpacing),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum FoundSpacing {
    Auto,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ExpectTable {
    metric: Metric,
    at_least: Option<f64>,
    at_most: Option<f64>,
    claim: Option<u8>,
    paper: Option<String>,
    reason: String,
}

impl Description {
    /// What can be flown, without the text.
    pub fn check(self, file: &Path) -> Result<ScenarioFile, Mistake> {
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let name = self.homing.as_ref().map(|name| *name.get_ref());
        let storage = self.recording.storage()?;
        let (homing, spacing) = check_homing(name, self.recording)?;
        let way = way::check(self.route)?;
        if let Some(name) = self.homing {
            let mistake = match (&way, homing) {
                (Way::Fixed(Route::Experiment(_) | Route::Scripted(_)), _) => {
                    Some("a script says itself how the drone finds back")
                }
                (_, Homing::SequenceEvery(_)) if self.backend == Backend::Emulator => Some(
                    "the image has its own spacing of a sequence: another one wants backend = \"native\"",
                ),
                _ => None,
            };
            if let Some(mistake) = mistake {
                return Err((name.span(), mistake.to_owned()));
            }
        }
        let conditions = self.conditions.check(self.backend)?;
        let seeds = *self.seeds.get_ref();
        if !COUNTS.contains(&seeds.count) {
            let (least, most) = (COUNTS.start(), COUNTS.end());
            let reason = format!("{} seeds: from {least} to {most}", seeds.count);
            return Err((self.seeds.span(), reason));
        }
        let expectations: Result<_, _> = self.expect.into_iter().map(check_expectation).collect();
        let stem = file.file_stem().unwrap_or_default();
        Ok(ScenarioFile {
            name: stem.to_string_lossy().into_owned(),
            meaning: self.meaning,
            backend: self.backend,
            seeds,
            expectations: expectations?,
            world: check_world(self.world, &folder, seeds.first)?,
            way,
            homing,
            spacing,
            storage,
            conditions,
            folder,
            text: String::new(),
        })
    }
}

fn check_world(world: Spanned<String>, folder: &Path, seed: u64) -> Result<String, Mistake> {
    let span = world.span();
    let name = world.into_inner();
    if World::names().contains(&name.as_str()) {
        return Ok(name);
    }
    let file: PathBuf = folder.join(&name);
    match World::open(&file.display().to_string(), seed) {
        Ok(_) => Ok(name),
        Err(_) if Path::new(&name).extension().is_none() => {
            let known = World::names().join(", ");
            Err((span, format!("no world `{name}`: {known}, or a file")))
        }
        Err(error) => Err((span, error.to_string())),
    }
}

/// How the drone finds back, and the spacing along odometry.
fn check_homing(
    homing: Option<HomingName>,
    recording: RecordingTable,
) -> Result<(Homing, Spacing), Mistake> {
    let Some(asked) = recording.spacing else {
        let homing = match homing.unwrap_or(HomingName::Both) {
            HomingName::Both => Homing::Both,
            HomingName::Odometry => Homing::Odometry,
            HomingName::Sequence => Homing::Sequence,
        };
        return Ok((homing, Spacing::DEFAULT));
    };
    let spacing = match asked.get_ref() {
        SpacingTable::Found(FoundSpacing::Auto) => Spacing::ByTheory,
        SpacingTable::Metres(metres) => Spacing::from_metres(*metres).ok_or_else(|| {
            let reason = format!("a spacing of {metres} m: from 0.2 to 10 m in steps of 0.1");
            (asked.span(), reason)
        })?,
    };
    let homing = match (homing.unwrap_or(HomingName::Both), spacing) {
        (HomingName::Both, _) => Homing::Both,
        (HomingName::Odometry, _) => Homing::Odometry,
        (HomingName::Sequence, Spacing::Every(distance)) => Homing::SequenceEvery(distance),
        (HomingName::Sequence, Spacing::ByTheory) => {
            let reason = "theory spaces snapshots along odometry: a sequence has none";
            return Err((asked.span(), reason.to_owned()));
        }
    };
    Ok((homing, spacing))
}

impl RecordingTable {
    fn storage(&self) -> Result<Storage, Mistake> {
        let Some(metres) = &self.deviation else {
            return Ok(Storage {
                snapshots: self.snapshots,
                ..Storage::PAPER
            });
        };
        match Deviation::from_metres(*metres.get_ref()) {
            Some(deviation) => Ok(Storage {
                snapshots: self.snapshots,
                deviation,
            }),
            None => {
                let asked = metres.get_ref();
                let reason = format!("a deviation of {asked} m: from 0.1 to 1 m in steps of 0.1");
                Err((metres.span(), reason))
            }
        }
    }
}

fn check_expectation(table: Spanned<ExpectTable>) -> Result<Expectation, Mistake> {
    let span = table.span();
    let ExpectTable {
        metric,
        at_least,
        at_most,
        claim,
        paper,
        reason,
    } = table.into_inner();
    let impossible = match (at_least, at_most) {
        (None, None) => Some("an expectation needs `at_least` or `at_most`"),
        (Some(least), Some(most)) if least > most => Some("`at_least` is beyond `at_most`"),
        (least, most) if least.into_iter().chain(most).any(f64::is_nan) => {
            Some("a bound that is no number")
        }
        _ if claim.is_some_and(|claim| !CLAIMS.contains(&claim)) => {
            Some("the paper's claims have the numbers 1 to 36")
        }
        _ => None,
    };
    match impossible {
        Some(mistake) => Err((span, mistake.to_owned())),
        None => Ok(Expectation {
            metric,
            bounds: Bounds { at_least, at_most },
            claim,
            paper,
            reason,
        }),
    }
}
