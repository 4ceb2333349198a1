//! The way out, as a scenario's file describes it.

use std::ops::RangeInclusive;

use autopilot::app::Experiment;
use serde::Deserialize;
use toml::Spanned;

use super::Way;
use super::script::{self, StepTable};
use crate::scenario::{Meander, Polyline, Route};
use crate::toml_file::Mistake;

/// Lengths of a route that the memory of the camera board can hold, metres.
pub(super) const LENGTHS_M: RangeInclusive<f32> = 3.0..=2_000.0;
/// How often a way through places may be flown. Its length bounds that as well, but is known only once all
/// passes are laid out in memory.
const PASSES: RangeInclusive<usize> = 1..=1_000;

/// The value of `route`.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RouteTable {
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

/// A polyline.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThroughTable {
    /// North and east of the start, metres.
    places: Vec<[f32; 2]>,
    /// How often it is flown, every second time backwards: once where nothing is said.
    passes: Option<usize>,
}

/// A way that each seed draws.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeanderTable {
    /// Metres.
    length: f32,
}

/// Experiments of the published app that lead home by themselves.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExperimentName {
    CorridorBoth,
    CorridorOdometry,
    Distances,
}

/// The way, or what is wrong with it and where.
pub fn check(route: Spanned<RouteTable>) -> Result<Way, Mistake> {
    let span = route.span();
    way(route.into_inner()).map_err(|reason| (span, reason))
}

fn way(table: RouteTable) -> Result<Way, String> {
    let route = match table {
        RouteTable::U => Route::U,
        RouteTable::S => Route::S,
        RouteTable::Line => Route::Line,
        RouteTable::Corner => Route::Corner,
        RouteTable::Corridor => Route::Corridor,
        RouteTable::Through(through) => Route::Own(polyline(through)?),
        RouteTable::Meander(MeanderTable { length }) => {
            let length_m = storable(length)?;
            return Ok(Way::Drawn(Meander { length_m }));
        }
        RouteTable::Experiment(name) => Route::Experiment(match name {
            ExperimentName::CorridorBoth => Experiment::CorridorBoth,
            ExperimentName::CorridorOdometry => Experiment::CorridorOdometry,
            ExperimentName::Distances => Experiment::Rmse,
        }),
        RouteTable::Script(steps) => Route::Scripted(script::check(&steps)?),
    };
    Ok(Way::Fixed(route))
}

fn polyline(ThroughTable { places, passes }: ThroughTable) -> Result<Polyline, String> {
    let passes = passes.unwrap_or(1);
    if places.len() < 2 {
        return Err("a way leads through two places at least".to_owned());
    }
    if !PASSES.contains(&passes) {
        let (least, most) = (PASSES.start(), PASSES.end());
        return Err(format!("{passes} passes: from {least} to {most}"));
    }
    let polyline = Polyline {
        name: "polyline".to_owned(),
        places,
        passes,
    };
    storable(Route::Own(polyline.clone()).waypoints().length_m())?;
    Ok(polyline)
}

/// A length within [`LENGTHS_M`].
fn storable(length_m: f32) -> Result<f32, String> {
    let (least, most) = (LENGTHS_M.start(), LENGTHS_M.end());
    if LENGTHS_M.contains(&length_m) {
        Ok(length_m)
    } else {
        Err(format!("a way of {length_m} m: from {least} to {most} m"))
    }
}
