//! Lengths and distances of flown paths.

use crate::record::{Phase, PlanarPose, Recording, TrackPoint};

/// True length of a path, metres.
pub fn length(path: &[PlanarPose]) -> f64 {
    // Not sum(), whose sum of nothing is -0.
    path.windows(2)
        .map(|pair| pair[0].distance(&pair[1]))
        .fold(0.0, |length, step| length + step)
}

/// Steps in which the length of an estimated path is measured, metres. The estimate trembles by some millimetres from
/// row to row, which adds up to a fifth of a slow flight.
const STEP_M: f64 = 0.1;

/// Length of a path whose points tremble, metres: a point counts when it is `STEP_M` or more from the one that
/// counted last.
pub fn length_in_steps(path: &[PlanarPose]) -> f64 {
    let mut steps: Vec<PlanarPose> = Vec::new();
    for pose in path {
        if steps
            .last()
            .is_none_or(|last| last.distance(pose) >= STEP_M)
        {
            steps.push(*pose);
        }
    }
    length(&steps)
}

/// True positions of the way out and of the way back.
pub fn paths(recording: &Recording) -> (Vec<PlanarPose>, Vec<PlanarPose>) {
    let of = |wanted: fn(&TrackPoint) -> bool| {
        recording
            .track
            .iter()
            .filter(|point| wanted(point))
            .map(|point| point.truth)
            .collect()
    };
    (
        of(|point| point.phase == Phase::Outbound),
        of(|point| matches!(point.phase, Phase::Odometry | Phase::Homing)),
    )
}

/// Root mean square of the distances from the points of `path` to the nearest point of the
/// polyline `reference`, metres: the cross-track error. Zero where either is empty.
pub fn cross_track_rms(path: &[PlanarPose], reference: &[PlanarPose]) -> f64 {
    if path.is_empty() || reference.is_empty() {
        return 0.0;
    }
    let sum: f64 = path
        .iter()
        .map(|point| {
            let to_ends = reference
                .iter()
                .map(|vertex| square(point.x - vertex.x, point.y - vertex.y));
            let to_edges = reference
                .windows(2)
                .map(|edge| square_distance_to_edge(point, &edge[0], &edge[1]));
            to_ends.chain(to_edges).fold(f64::INFINITY, f64::min)
        })
        .sum();
    (sum / path.len() as f64).sqrt()
}

fn square(x: f64, y: f64) -> f64 {
    x * x + y * y
}

fn square_distance_to_edge(point: &PlanarPose, from: &PlanarPose, to: &PlanarPose) -> f64 {
    let (edge_x, edge_y) = (to.x - from.x, to.y - from.y);
    let (x, y) = (point.x - from.x, point.y - from.y);
    let length = square(edge_x, edge_y);
    if length == 0.0 {
        return square(x, y);
    }
    let along = ((x * edge_x + y * edge_y) / length).clamp(0.0, 1.0);
    square(x - along * edge_x, y - along * edge_y)
}

/// The value below which `fraction` of the sorted values lie (nearest rank); zero if there are none.
pub fn quantile<T: Copy + Default>(sorted: &[T], fraction: f64) -> T {
    let rank = (fraction * sorted.len() as f64).ceil() as usize;
    sorted
        .get(rank.saturating_sub(1))
        .copied()
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64) -> PlanarPose {
        PlanarPose { x, y, yaw: 0.0 }
    }

    #[test]
    fn a_path_beside_a_line_has_its_distance_as_cross_track_error() {
        let line = [at(0.0, 0.0), at(10.0, 0.0)];
        let beside = [at(1.0, 0.3), at(5.0, -0.3), at(9.0, 0.3)];
        assert!((cross_track_rms(&beside, &line) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn beyond_the_end_of_a_line_the_distance_is_to_its_end() {
        assert!(
            (cross_track_rms(&[at(13.0, 4.0)], &[at(0.0, 0.0), at(10.0, 0.0)]) - 5.0).abs() < 1e-12
        );
    }

    #[test]
    fn a_square_of_one_metre_is_four_metres_long() {
        let square = [
            at(0.0, 0.0),
            at(1.0, 0.0),
            at(1.0, 1.0),
            at(0.0, 1.0),
            at(0.0, 0.0),
        ];
        assert!((length(&square) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn trembling_adds_nothing_to_a_length_in_steps() {
        let tremble = |step: i32| 0.004 * f64::from(step % 2);
        let path: Vec<PlanarPose> = (0..=200)
            .map(|step| at(0.01 * f64::from(step), tremble(step)))
            .collect();
        assert!((length_in_steps(&path) - 2.0).abs() < 0.01);
    }

    #[test]
    fn the_length_of_nothing_is_zero_without_a_sign() {
        assert!(length(&[]).is_sign_positive());
        assert!(length_in_steps(&[]).is_sign_positive());
    }

    #[test]
    fn quantiles_are_values_that_occur() {
        let values: Vec<u32> = (1..=100).collect();
        assert_eq!(quantile(&values, 0.5), 50);
        assert_eq!(quantile(&values, 0.99), 99);
        assert_eq!(quantile(&values, 1.0), 100);
        assert_eq!(quantile::<u32>(&[], 0.5), 0);
    }
}
