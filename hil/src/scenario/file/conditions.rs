//! What the flight is up against, as a scenario's file describes it.

use std::ops::RangeInclusive;

use autopilot::app::Quirks;
use serde::Deserialize;
use toml::Spanned;

use super::Backend;
use crate::scenario::{
    CameraTrouble, Conditions, Correction, LARGEST_SWING, LIGHTS, Quirk, STRONGEST_WIND_M_S,
    SWING_PERIODS_S, Wind, WireFault, flow_scale,
};
use crate::toml_file::Mistake;

/// The table `conditions`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConditionsTable {
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

impl ConditionsTable {
    /// The conditions, or what is wrong with them and where.
    pub fn check(self, backend: Backend) -> Result<Conditions, Mistake> {
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
