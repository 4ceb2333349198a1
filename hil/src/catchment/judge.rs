//! What a catchment area does not tell: how exactly runs end, and whether bad vectors are known to be bad.

use core::f32::consts::TAU;

use super::field::{self, Field};
use super::grid::Grid;
use super::measure::Vectors;

/// From how far away homing starts along a route, metres: what odometry strays between two snapshots.
const START_M: f32 = 0.3;
/// Starts round a snapshot.
const STARTS: u8 = 8;
/// What the vectors' unit is taken for, metres: the distance of things in a room.
pub const SURROUNDINGS_M: f32 = 2.0;
/// The part of a vector that one step covers, as the flight's smoothed set-point does.
const GAIN: f32 = 0.3;
/// Steps until a run is over: more than are needed to come to rest.
const STEPS: usize = 80;

/// How far from a snapshot runs end that start 0.3 m from it, mean over the directions, metres. Other than
/// those that an area is made of they go slower the shorter the vectors are, and so come to rest.
pub fn end_error_m(grid: &Grid, moves: &Field, goal_m: [f32; 2]) -> f64 {
    let runs = (0..STARTS).map(|start| {
        let bearing = TAU * f32::from(start) / f32::from(STARTS);
        let mut at_m = [
            goal_m[0] + START_M * libm::cosf(bearing),
            goal_m[1] + START_M * libm::sinf(bearing),
        ];
        for _ in 0..STEPS {
            let Some(vector) = field::at(grid, moves, at_m) else {
                break;
            };
            let step_m = vector.map(|part| GAIN * SURROUNDINGS_M * part);
            let length_m = libm::hypotf(step_m[0], step_m[1]);
            let held = (0.5 * grid.spacing_m / length_m.max(f32::MIN_POSITIVE)).min(1.0);
            at_m = grid.held([0, 1].map(|axis: usize| at_m[axis] + held * step_m[axis]));
        }
        f64::from(libm::hypotf(at_m[0] - goal_m[0], at_m[1] - goal_m[1]))
    });
    runs.sum::<f64>() / f64::from(STARTS)
}

/// The probability that of two vectors, of which one points to within 90 degrees of the goal and the other does
/// not, the first has the higher quality; an even chance where both have the same. Over all positions but the
/// goals themselves.
pub fn roc(grid: &Grid, goals: &[([f32; 2], &Vectors)]) -> Option<f64> {
    let mut judged = Vec::new();
    for (goal_m, vectors) in goals {
        for (index, vector) in vectors.moves.iter().enumerate() {
            let at_m = grid.position_m(index);
            let home_m = [goal_m[0] - at_m[0], goal_m[1] - at_m[1]];
            let is_home = libm::hypotf(home_m[0], home_m[1]) < 0.5 * grid.spacing_m;
            if let (Some(vector), false) = (vector, is_home) {
                let is_right = vector[0] * home_m[0] + vector[1] * home_m[1] > 0.0;
                judged.push((vectors.qualities[index], is_right));
            }
        }
    }
    area_under_curve(judged)
}

/// The area under the curve of hits over false alarms, by ranks.
fn area_under_curve(mut judged: Vec<(f32, bool)>) -> Option<f64> {
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut wrong_below, mut right, mut pairs_won) = (0_u64, 0_u64, 0.0);
    for alike in judged.chunk_by(|a, b| a.0 == b.0) {
        let right_here = alike.iter().filter(|(_, is_right)| *is_right).count() as u64;
        let wrong_here = alike.len() as u64 - right_here;
        pairs_won += right_here as f64 * (wrong_below as f64 + 0.5 * wrong_here as f64);
        right += right_here;
        wrong_below += wrong_here;
    }
    let pairs = right as f64 * wrong_below as f64;
    (pairs > 0.0).then(|| pairs_won / pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOAL_M: [f32; 2] = [1.5, 1.4];

    /// Vectors to a place beside the goal, as long as the way there in units of the surroundings.
    fn to(grid: &Grid, off_m: [f32; 2]) -> Field {
        let vector = |index| {
            let at_m = grid.position_m(index);
            Some(
                [0, 1]
                    .map(|axis: usize| (GOAL_M[axis] + off_m[axis] - at_m[axis]) / SURROUNDINGS_M),
            )
        };
        (0..grid.free.len()).map(vector).collect()
    }

    #[test]
    fn a_run_ends_where_the_vectors_vanish() {
        let grid = Grid::over([0.0, 0.0], [3.0, 3.0]);
        assert!(end_error_m(&grid, &to(&grid, [0.0, 0.0]), GOAL_M) < 1e-3);
        let error_m = end_error_m(&grid, &to(&grid, [0.09, -0.12]), GOAL_M);
        assert!((error_m - 0.15).abs() < 1e-3, "{error_m}");
        let nowhere = vec![None; grid.free.len()];
        let error_m = end_error_m(&grid, &nowhere, GOAL_M);
        assert!((error_m - 0.3).abs() < 1e-6, "{error_m}");
    }

    #[test]
    fn the_area_under_the_curve_counts_pairs_in_the_right_order() {
        let judged = |right: &[f32], wrong: &[f32]| {
            let right = right.iter().map(|quality| (*quality, true));
            let wrong = wrong.iter().map(|quality| (*quality, false));
            area_under_curve(right.chain(wrong).collect())
        };
        assert_eq!(judged(&[0.6, 0.9], &[0.1, 0.5]), Some(1.0));
        assert_eq!(judged(&[0.1, 0.5], &[0.6, 0.9]), Some(0.0));
        assert_eq!(judged(&[0.1, 0.7], &[0.5]), Some(0.5));
        assert_eq!(judged(&[0.5, 0.7], &[0.5]), Some(0.75));
        assert_eq!(judged(&[0.5], &[]), None);
    }

    #[test]
    fn a_vector_is_right_that_points_to_within_a_right_angle_of_home() {
        let grid = Grid::over([0.0, 0.0], [3.0, 3.0]);
        let mut vectors = Vectors {
            moves: to(&grid, [0.0, 0.0]),
            qualities: vec![0.8; grid.free.len()],
        };
        for index in [7, 30] {
            vectors.moves[index] = vectors.moves[index].map(|[x, y]| [-x, -y]);
            vectors.qualities[index] = 0.2;
        }
        assert_eq!(roc(&grid, &[(GOAL_M, &vectors)]), Some(1.0));
        vectors.qualities[7] = 0.9;
        assert_eq!(roc(&grid, &[(GOAL_M, &vectors)]), Some(0.5));
    }
}
