//! From what happened to the figures.

use std::time::Duration;

use autopilot::app::Outcome;

use crate::board::BoardFigures;
use crate::board::emulated::Firmware;
use crate::metrics::{self, quantile};
use crate::record::Recording;
use crate::scenario::{Homing, Scenario};
use crate::summary::{CyclesPerFrame, FirmwareFigures, LinkFigures, Summary};

/// What is known at the end beside the recording.
#[derive(Debug)]
pub struct End<'f> {
    /// Whether the drone followed the route to its first snapshot and landed.
    pub completed: bool,
    /// How the flight ended, for people.
    pub outcome: &'static str,
    /// Flight time, seconds.
    pub flight_s: f64,
    /// The board's figures.
    pub figures: BoardFigures,
    /// Which board.
    pub backend: &'static str,
    /// The image, where there was one.
    pub firmware: Option<&'f Firmware>,
    /// Frames of the link.
    pub link: LinkFigures,
    /// Wall time.
    pub wall: Duration,
}

/// The figures of a flight.
pub fn summary(scenario: &Scenario, recording: &Recording, end: End) -> Summary {
    let (outbound, inbound) = metrics::paths(recording);
    let outbound_m = metrics::length(&outbound);
    let snapshots = recording.snapshots_stored();
    let memory_bytes = recording.memory().with_counts();
    let home = recording
        .track
        .first()
        .map(|point| point.truth)
        .unwrap_or_default();
    let last = recording.track.last();
    let figures = &end.figures;
    let wall_s = end.wall.as_secs_f64();
    Summary {
        completed: end.completed,
        outcome: end.outcome.to_owned(),
        backend: end.backend,
        seed: scenario.seed,
        world: scenario.world.clone(),
        route: scenario.route.name().to_owned(),
        homing: scenario.homing.name(),
        spacing_m: scenario.snapshot_spacing_m(),
        conditions: scenario.conditions,
        outbound_m,
        inbound_m: metrics::length(&inbound),
        home_error_m: last.map_or(0.0, |last| last.truth.distance(&home)),
        cross_track_rms_m: metrics::cross_track_rms(&inbound, &outbound),
        odometry_only_error_m: last.map_or(0.0, |last| last.truth.distance(&last.uncorrected)),
        snapshots,
        memory_bytes,
        bytes_per_m: if outbound_m > 0.0 {
            memory_bytes as f64 / outbound_m
        } else {
            0.0
        },
        frames_sent: figures.frames_sent,
        frames_captured: figures.frames_captured,
        frames_dropped: figures.frames_sent - figures.frames_processed.min(figures.frames_sent),
        vectors: recording.vectors.len(),
        link: end.link,
        live: None,
        cycles_per_frame: cycles_per_frame(recording, figures),
        cpu_load: figures.cpu_load,
        flight_s: end.flight_s,
        wall_s,
        realtime_factor: end.flight_s / wall_s,
        firmware: end.firmware.map(|firmware| FirmwareFigures {
            flash_bytes: firmware.flash_bytes(),
            ram_bytes: firmware.static_ram_bytes(),
            stack_peak_bytes: figures.stack_peak_bytes,
        }),
    }
}

/// The firmware's own readings, held against the emulator's of the same frames where there are some.
fn cycles_per_frame(recording: &Recording, figures: &BoardFigures) -> Option<CyclesPerFrame> {
    let own: Vec<u32> = recording
        .frames
        .iter()
        .filter_map(|frame| frame.cycles)
        .collect();
    let pairs = own.iter().zip(&figures.traced_cycles);
    let largest_disagreement = pairs.map(|(own, traced)| own.abs_diff(*traced)).max();
    if own.is_empty() {
        return None;
    }
    let (own, traced) = (sorted(&own), sorted(&figures.traced_cycles));
    Some(CyclesPerFrame {
        p50: quantile(&own, 0.5),
        p99: quantile(&own, 0.99),
        max: quantile(&own, 1.0),
        emulator_p50: (!traced.is_empty()).then(|| quantile(&traced, 0.5)),
        largest_disagreement,
    })
}

fn sorted(values: &[u32]) -> Vec<u32> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted
}

/// How a flight ended in which the camera gave up, for people.
pub const SAFE_STOP: &str =
    "safe stop: the camera kept the drone where it was, and the operator landed it";

/// How a flight of the flight app ended, for people.
pub fn in_words(outcome: Outcome, homing: Homing) -> &'static str {
    match outcome {
        Outcome::Completed if homing == Homing::Odometry => "followed the route to its start",
        Outcome::Completed => "followed the route to its first snapshot",
        Outcome::TimedOut => "landed: the time limit had passed",
        Outcome::NoEcho => "landed: the camera did not answer a command",
        Outcome::FenceBreached => "landed: too far from the start",
        Outcome::TooHigh => "landed: too high",
        Outcome::PositionLost => "landed: the filter lost its position",
        Outcome::BrokenMessage => "landed: the camera sent a target that is no number",
        Outcome::RadioLost => "landed: the radio link was lost",
        Outcome::BatteryLow => "landed: the battery was low",
        Outcome::LandCommanded => "landed: on command",
        Outcome::Killed => "stopped: the motors were switched off",
    }
}
