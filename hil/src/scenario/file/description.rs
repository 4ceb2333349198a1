//! What a scenario's file may say, and from there to what can be flown.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use autopilot::app::{Experiment, Quirks};
use fake_sensors::world::World;
use serde::Deserialize;
use toml::Spanned;

use super::script::{self, StepTable};
use super::{Backend, ScenarioFile, Seeds, Way};
use crate::scenario::expectation::{Bounds, Expectation, Metric};
use crate::scenario::{
    CameraTrouble, Conditions, Correction, Deviation, Homing, LARGEST_SWING, LIGHTS, Meander,
    Polyline, Quirk, Route, STRONGEST_WIND_M_S, SWING_PERIODS_S, SnapshotForm, Spacing, Storage,
    Wind, WireFault, flow_scale,
};
use crate::toml_file::Mistake;

/// Lengths of a route that the memory of the camera board can hold, metres.
pub(super) const LENGTHS_M: RangeInclusive<f32> = 3.0..=2_000.0;
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

#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum RouteTable {
    U,
    S,
    Line,
    Corner,
    Corridor,
    Through(ThroughTable),
    Meander(MeanderTable),
    Experiment(ExperimentName),
    Script(Vec<StepTable>),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ThroughTable {
    /// North and east of the start.
    places: Vec<[f32; 2]>,
    passes: Option<usize>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeanderTable {
    length: f32,
}

/// Experiments that lead home by themselves.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ExperimentName {
    CorridorBoth,
    CorridorOdometry,
    Distances,
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

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ConditionsTable {
    corrupted: Option<Spanned<f64>>,
    restart_at: Option<Spanned<f64>>,
    quirks: Option<Vec<Quirk>>,
    #[serde(default)]
    correction: Correction,
    wind: Option<Spanned<WindTable>>,
    light: Option<Spanned<f32>>,
    flow_scale: Option<Spanned<SwingTable>>,
    #[serde(default)]
    pilot: bool,
    camera_fault: Option<Spanned<FaultTable>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WindTable {
    mean: f64,
    #[serde(default)]
    turbulence: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SwingTable {
    amplitude: f64,
    period: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FaultTable {
    name: WireFault,
    at: f64,
    lasts: Option<f64>,
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
        let way = check_route(self.route)?;
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

fn check_route(route: Spanned<RouteTable>) -> Result<Way, Mistake> {
    let span = route.span();
    let way = match route.into_inner() {
        RouteTable::U => Route::U,
        RouteTable::S => Route::S,
        RouteTable::Line => Route::Line,
        RouteTable::Corner => Route::Corner,
        RouteTable::Corridor => Route::Corridor,
        RouteTable::Experiment(name) => Route::Experiment(match name {
            ExperimentName::CorridorBoth => Experiment::CorridorBoth,
            ExperimentName::CorridorOdometry => Experiment::CorridorOdometry,
            ExperimentName::Distances => Experiment::Rmse,
        }),
        RouteTable::Script(steps) => {
            return script::check(&steps)
                .map(|scripted| Way::Fixed(Route::Scripted(scripted)))
                .map_err(|reason| (span, reason));
        }
        RouteTable::Meander(MeanderTable { length }) if LENGTHS_M.contains(&length) => {
            return Ok(Way::Drawn(Meander { length_m: length }));
        }
        RouteTable::Meander(MeanderTable { length }) => return Err((span, no_length(length))),
        RouteTable::Through(through) => {
            return check_polyline(through)
                .map(|polyline| Way::Fixed(Route::Own(polyline)))
                .map_err(|reason| (span, reason));
        }
    };
    Ok(Way::Fixed(way))
}

fn check_polyline(ThroughTable { places, passes }: ThroughTable) -> Result<Polyline, String> {
    let passes = passes.unwrap_or(1);
    if places.len() < 2 || passes == 0 {
        return Err("a way leads through two places at least, once at least".to_owned());
    }
    let polyline = Polyline {
        name: "polyline".to_owned(),
        places,
        passes,
    };
    let length_m = Route::Own(polyline.clone()).waypoints().length_m();
    if LENGTHS_M.contains(&length_m) {
        Ok(polyline)
    } else {
        Err(no_length(length_m))
    }
}

fn no_length(length_m: f32) -> String {
    let (least, most) = (LENGTHS_M.start(), LENGTHS_M.end());
    format!("a way of {length_m} m: from {least} to {most} m")
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

impl ConditionsTable {
    fn check(self, backend: Backend) -> Result<Conditions, Mistake> {
        let mut conditions = Conditions {
            correction: self.correction,
            piloted: self.pilot,
            ..Conditions::default()
        };
        if let Some(names) = self.quirks {
            conditions.quirks = Quirks::NONE;
            for quirk in names {
                *quirk.of(&mut conditions.quirks) = true;
            }
        }
        if let Some(share) = self.corrupted {
            conditions.corrupted_share = within(share, 0.0..=1.0, "a share")?;
        }
        if let Some(time) = self.restart_at {
            conditions.restart_s = Some(within(time, 0.0..=1e6, "a time in seconds")?);
        }
        if let Some(light) = self.light {
            conditions.light = within(light, LIGHTS, "a strength of the lamps")?;
        }
        if let Some(wind) = self.wind {
            let WindTable { mean, turbulence } = wind.get_ref();
            let blows = Wind::new(*mean, *turbulence).ok_or_else(|| {
                let most = STRONGEST_WIND_M_S;
                let reason = format!("a mean from 0 to {most} m/s and a turbulence from 0 to 1");
                (wind.span(), reason)
            })?;
            conditions.wind = Some(blows);
        }
        if let Some(swing) = self.flow_scale {
            let SwingTable { amplitude, period } = swing.get_ref();
            let swings = flow_scale(*amplitude, *period).ok_or_else(|| {
                let (least, most) = (SWING_PERIODS_S.start(), SWING_PERIODS_S.end());
                let reason = format!(
                    "an amplitude from 0 to {LARGEST_SWING} and a period from {least} to {most} s"
                );
                (swing.span(), reason)
            })?;
            conditions.flow_scale = Some(swings);
        }
        if let Some(fault) = self.camera_fault {
            conditions.camera = Some(check_fault(fault, backend)?);
        }
        Ok(conditions)
    }
}

fn check_fault(fault: Spanned<FaultTable>, backend: Backend) -> Result<CameraTrouble, Mistake> {
    const TIMES_S: RangeInclusive<f64> = 0.0..=1e6;
    let FaultTable { name, at, lasts } = fault.get_ref();
    let in_ms = |seconds: f64| (1_000.0 * seconds) as u64;
    if backend == Backend::Native {
        let reason =
            "the native board has no camera wires: a fault of theirs wants backend = \"emulator\"";
        return Err((fault.span(), reason.to_owned()));
    }
    if !TIMES_S.contains(at) || lasts.is_some_and(|time| !TIMES_S.contains(&time)) {
        return Err((fault.span(), "times in seconds, from 0".to_owned()));
    }
    Ok(CameraTrouble {
        fault: *name,
        from_ms: in_ms(*at),
        for_ms: lasts.map_or(CameraTrouble::USUAL_MS, in_ms),
    })
}

/// A number in its range.
fn within<T: PartialOrd + std::fmt::Display + Copy>(
    value: Spanned<T>,
    range: RangeInclusive<T>,
    what: &str,
) -> Result<T, Mistake> {
    if range.contains(value.get_ref()) {
        return Ok(*value.get_ref());
    }
    let (least, most, given) = (range.start(), range.end(), value.get_ref());
    let reason = format!("{given}: {what} from {least} to {most}");
    Err((value.span(), reason))
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
