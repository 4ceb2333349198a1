//! Curves over time that are derived from the track: how far belief and flight were off.

use core::f64::consts::TAU;

use super::svg::{self, Point};
use crate::record::{Phase, PlanarPose, Recording, TrackPoint};

/// Least distance of two points of the outbound path that are both kept, metres. Hovering adds
/// points, not path.
const PATH_STEP_M: f64 = 0.02;

/// Distance of a believed position from the true one over time, metres.
pub fn position(track: &[TrackPoint], belief: impl Fn(&TrackPoint) -> PlanarPose) -> Vec<Point> {
    track
        .iter()
        .map(|point| [point.t, belief(point).distance(&point.truth)])
        .collect()
}

/// Believed less true heading over time, degrees, -180..=180.
pub fn heading(track: &[TrackPoint], belief: impl Fn(&TrackPoint) -> PlanarPose) -> Vec<Point> {
    track
        .iter()
        .map(|point| {
            let error = libm::remainder(belief(point).yaw - point.truth.yaw, TAU);
            [point.t, error.to_degrees()]
        })
        .collect()
}

/// Distance of the way back from the nearest point of the way out over time, metres; empty where
/// either is missing.
pub fn cross_track(recording: &Recording) -> Vec<Point> {
    let outbound = |point: &&TrackPoint| point.phase == Phase::Outbound;
    let inbound = |point: &&TrackPoint| matches!(point.phase, Phase::Odometry | Phase::Homing);
    let track = &recording.track;
    let path = svg::thin(track.iter().filter(outbound).map(place), PATH_STEP_M);
    if path.len() < 2 {
        return Vec::new();
    }
    track
        .iter()
        .filter(inbound)
        .map(|point| [point.t, distance_to_path(place(point), &path)])
        .collect()
}

fn place(point: &TrackPoint) -> Point {
    [point.truth.x, point.truth.y]
}

/// Distance of a point from a polyline; infinite if there is no leg to measure against.
fn distance_to_path(point: Point, path: &[Point]) -> f64 {
    path.windows(2)
        .map(|leg| distance_to_leg(point, leg[0], leg[1]))
        .fold(f64::INFINITY, f64::min)
}

/// Distance of a point from a straight leg.
fn distance_to_leg(point: Point, from: Point, to: Point) -> f64 {
    let leg = [to[0] - from[0], to[1] - from[1]];
    let offset = [point[0] - from[0], point[1] - from[1]];
    let length_squared = leg[0] * leg[0] + leg[1] * leg[1];
    let along = if length_squared > 0.0 {
        ((offset[0] * leg[0] + offset[1] * leg[1]) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    svg::distance(offset, [along * leg[0], along * leg[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_beside_a_leg_is_as_far_as_its_perpendicular() {
        assert_eq!(distance_to_leg([1.0, 0.3], [0.0, 0.0], [2.0, 0.0]), 0.3);
    }

    #[test]
    fn a_point_beyond_a_leg_is_as_far_as_its_end() {
        assert_eq!(distance_to_leg([5.0, 4.0], [0.0, 0.0], [2.0, 0.0]), 5.0);
    }

    #[test]
    fn heading_errors_take_the_short_way_round() {
        let mut point = TrackPoint {
            t: 0.0,
            phase: Phase::Homing,
            truth: PlanarPose::default(),
            estimate: PlanarPose::default(),
            uncorrected: PlanarPose::default(),
            height: 0.0,
        };
        point.truth.yaw = 179.0_f64.to_radians();
        point.estimate.yaw = -179.0_f64.to_radians();
        let error = heading(&[point], |point| point.estimate);
        assert!((error[0][1] - 2.0).abs() < 1e-9);
    }
}
