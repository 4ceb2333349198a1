//! The figures of an imported flight. What the logs do not tell is NaN, null in JSON, or zero for counts.

use std::path::Path;
use std::time::Duration;

use super::table::Table;
use crate::metrics;
use crate::record::{PlanarPose, Recording};
use crate::summary::Summary;

/// A flight that was led back and ended nearer than this to where it took off came home, m: what the rig's own
/// flights are held to.
const HOME_M: f64 = 0.5;

/// The figures, by the drone's own estimate.
pub fn summary(tables: &[Table], recording: &Recording, wall: Duration) -> Summary {
    let (outbound, inbound) = metrics::paths(recording);
    let outbound_m = metrics::length_in_steps(&outbound);
    let memory_bytes = recording.memory().with_counts();
    // The filter's origin is where it was reset before take-off.
    let home = PlanarPose::default();
    let last = recording.track.last();
    let home_error_m = last.map_or(f64::NAN, |last| last.truth.distance(&home));
    let led = !inbound.is_empty();
    Summary {
        completed: led && home_error_m <= HOME_M,
        outcome: outcome(led, home_error_m),
        backend: "cfclient",
        world: "not known".into(),
        route: route(tables),
        homing: homing(recording),
        spacing_m: f64::NAN,
        outbound_m,
        inbound_m: metrics::length_in_steps(&inbound),
        home_error_m,
        cross_track_rms_m: metrics::cross_track_rms(&inbound, &outbound),
        odometry_only_error_m: f64::NAN,
        snapshots: recording.snapshots.len(),
        memory_bytes,
        bytes_per_m: if outbound_m > 0.0 {
            memory_bytes as f64 / outbound_m
        } else {
            0.0
        },
        vectors: recording.vectors.len(),
        flight_s: last.map_or(0.0, |last| last.t),
        wall_s: wall.as_secs_f64(),
        realtime_factor: f64::NAN,
        // Frames, processor and image: the logs know nothing of the board.
        ..Summary::default()
    }
}

fn outcome(led: bool, home_error_m: f64) -> String {
    if led {
        format!("by its own estimate the drone ended {home_error_m:.2} m from where it took off")
    } else {
        "the camera did not lead in these logs".into()
    }
}

/// The first file without its folder and extension.
fn route(tables: &[Table]) -> String {
    let name = tables.first().map_or("", |table| table.name.as_str());
    let stem = Path::new(name).file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// What led the way back.
fn homing(recording: &Recording) -> &'static str {
    let visual = recording.vectors.iter().any(|mark| mark.visual);
    let odometry = recording.vectors.iter().any(|mark| !mark.visual);
    match (visual, odometry) {
        (true, false) => "sequence",
        (false, true) => "odometry",
        _ => "both",
    }
}
