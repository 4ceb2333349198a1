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

/// Steps in which the length of a path is measured, m. The estimate trembles by some millimetres from row to row, which
/// adds up to a fifth of a slow flight.
const STEP_M: f64 = 0.1;

/// The figures, by the drone's own estimate.
pub fn summary(tables: &[Table], recording: &Recording, wall: Duration) -> Summary {
    let (outbound, inbound) = metrics::paths(recording);
    let outbound_m = length(&outbound);
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
        inbound_m: length(&inbound),
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

/// Length of a path whose points tremble, metres.
fn length(path: &[PlanarPose]) -> f64 {
    let mut steps: Vec<PlanarPose> = Vec::new();
    for pose in path {
        if steps
            .last()
            .is_none_or(|last| last.distance(pose) >= STEP_M)
        {
            steps.push(*pose);
        }
    }
    // The sum of nothing is minus zero.
    metrics::length(&steps) + 0.0
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

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> PlanarPose {
        PlanarPose { x, y, yaw: 0.0 }
    }

    #[test]
    fn trembling_adds_nothing_to_a_length() {
        let tremble = |step: i32| 0.004 * f64::from(step % 2);
        let path: Vec<PlanarPose> = (0..=200)
            .map(|step| at(0.01 * f64::from(step), tremble(step)))
            .collect();
        assert!((length(&path) - 2.0).abs() < 0.01);
    }

    #[test]
    fn the_length_of_nothing_is_zero_without_a_sign() {
        assert!(length(&[]).is_sign_positive());
    }
}
