//! From a field of homing vectors to the area from which they lead home (paper, Fig. 3B).

use super::grid::Grid;

/// The part of a cell that a step at full length covers.
const STEP_CELLS: f32 = 0.5;
/// Steps until a trajectory ends at the latest: several times across the room.
const MOST_STEPS: usize = 600;
/// Every so many steps is looked whether it still goes anywhere.
const GLANCE_STEPS: usize = 16;
/// If not even this part of a cell is gained between two looks, it has arrived or is stuck.
const STANDSTILL_CELLS: f32 = 0.25;

/// How near counts as home, metres: the paper's runs end within half a metre (Fig. 4).
pub const NEAR_M: [f64; 2] = [0.5, 0.25];

/// Homing vectors by position of a grid, of length one where trajectories follow them; none where there is no view or no vector.
pub type Field = Vec<Option<[f32; 2]>>;

/// Where a robot that starts at `start_m` ends by following the interpolated vectors.
pub fn end_of(grid: &Grid, field: &Field, start_m: [f32; 2]) -> [f32; 2] {
    let mut end_m = start_m;
    follow(grid, field, start_m, |at_m| end_m = at_m);
    end_m
}

/// Follows the vectors from `start_m`, telling of each position.
pub fn follow(grid: &Grid, field: &Field, start_m: [f32; 2], mut visit: impl FnMut([f32; 2])) {
    let mut cell = grid.cell(start_m);
    let last = [grid.columns, grid.rows].map(|count| (count - 1) as f32);
    let mut glanced = cell;
    for step in 1..=MOST_STEPS {
        let Some(vector) = interpolated(grid, field, cell) else {
            return;
        };
        cell = [0, 1].map(|axis| {
            // Walls hold it back.
            (cell[axis] + STEP_CELLS * vector[axis]).clamp(0.0, last[axis])
        });
        visit([0, 1].map(|axis| grid.origin_m[axis] + cell[axis] * grid.spacing_m));
        if step % GLANCE_STEPS == 0 {
            let gained = libm::hypotf(cell[0] - glanced[0], cell[1] - glanced[1]);
            if gained < STANDSTILL_CELLS {
                return;
            }
            glanced = cell;
        }
    }
}

/// The vector at a place, by interpolation; none where there is none round it.
pub fn at(grid: &Grid, field: &Field, at_m: [f32; 2]) -> Option<[f32; 2]> {
    interpolated(grid, field, grid.cell(grid.held(at_m)))
}

/// The vector at a place in cells; corners without one do not count. None if there is none at all.
fn interpolated(grid: &Grid, field: &Field, cell: [f32; 2]) -> Option<[f32; 2]> {
    let low = [cell[0] as usize, cell[1] as usize];
    let [x, y] = [0, 1].map(|axis: usize| cell[axis] - low[axis] as f32);
    let corners = [
        (0, 0, (1.0 - x) * (1.0 - y)),
        (1, 0, x * (1.0 - y)),
        (0, 1, (1.0 - x) * y),
        (1, 1, x * y),
    ];
    let mut sum = [0.0; 3];
    for (right, up, weight) in corners {
        let [column, row] = [low[0] + right, low[1] + up];
        if weight <= 0.0 || column >= grid.columns || row >= grid.rows {
            continue;
        }
        if let Some(vector) = field[row * grid.columns + column] {
            sum = [
                sum[0] + weight * vector[0],
                sum[1] + weight * vector[1],
                sum[2] + weight,
            ];
        }
    }
    (sum[2] > 0.0).then(|| [sum[0] / sum[2], sum[1] / sum[2]])
}

/// The catchment areas of a snapshot for each of [`NEAR_M`], m². With a stride, every so manieth start
/// along both axes is tried and stands for the others.
pub fn areas_m2(grid: &Grid, field: &Field, goal_m: [f32; 2], stride: usize) -> [f64; 2] {
    let mut counts = [0_usize; 2];
    for index in grid.free_positions() {
        if !(index % grid.columns).is_multiple_of(stride)
            || !(index / grid.columns).is_multiple_of(stride)
        {
            continue;
        }
        let end_m = end_of(grid, field, grid.position_m(index));
        let error_m = f64::from(libm::hypotf(end_m[0] - goal_m[0], end_m[1] - goal_m[1]));
        for (count, near_m) in counts.iter_mut().zip(NEAR_M) {
            *count += usize::from(error_m < near_m);
        }
    }
    counts.map(|count| (count * stride * stride) as f64 * grid.cell_m2())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOAL_M: [f32; 2] = [1.0, 1.2];

    fn grid() -> Grid {
        Grid::over([0.0, 0.0], [3.0, 3.0])
    }

    /// Unit vectors that point by `turn_deg` to the left of the goal.
    fn field(grid: &Grid, turn_deg: f32) -> Field {
        let turn = turn_deg.to_radians();
        (0..grid.free.len())
            .map(|index| {
                let at = grid.position_m(index);
                let [x, y] = [GOAL_M[0] - at[0], GOAL_M[1] - at[1]];
                let angle = libm::atan2f(y, x) + turn;
                Some([libm::cosf(angle), libm::sinf(angle)])
            })
            .collect()
    }

    #[test]
    fn vectors_that_point_home_bring_every_start_home() {
        let grid = grid();
        let all = grid.free.len() as f64 * grid.cell_m2();
        assert_eq!(areas_m2(&grid, &field(&grid, 0.0), GOAL_M, 1), [all, all]);
        // By 60 degrees to the left is a longer way home, and a wall may be in it.
        let [near, nearer] = areas_m2(&grid, &field(&grid, 60.0), GOAL_M, 1);
        assert!(
            near > 0.9 * all && nearer > 0.9 * all,
            "{near} {nearer} {all}"
        );
    }

    #[test]
    fn vectors_that_point_away_bring_home_none_but_those_that_are_there() {
        let grid = grid();
        let areas = areas_m2(&grid, &field(&grid, 180.0), GOAL_M, 1);
        assert!(areas[0] < 0.05, "{areas:?}");
        let areas = areas_m2(&grid, &field(&grid, 100.0), GOAL_M, 1);
        assert!(areas[0] < 0.05, "{areas:?}");
    }

    #[test]
    fn without_a_vector_a_robot_stays_where_it_is() {
        let grid = grid();
        let nothing = vec![None; grid.free.len()];
        let [near, nearer] = areas_m2(&grid, &nothing, GOAL_M, 1);
        // Circles of half and a quarter metre.
        assert!((near - 0.785).abs() < 0.05, "{near}");
        assert!((nearer - 0.196).abs() < 0.04, "{nearer}");
    }

    #[test]
    fn a_hole_in_the_field_is_bridged_by_its_neighbours() {
        let grid = grid();
        let mut vectors = field(&grid, 0.0);
        vectors[3 * grid.columns + 4] = None;
        let all = grid.free.len() as f64 * grid.cell_m2();
        let [near, _] = areas_m2(&grid, &vectors, GOAL_M, 1);
        assert!(near > all - 2.5 * grid.cell_m2());
    }

    #[test]
    fn a_stride_counts_a_part_for_the_whole() {
        let grid = grid();
        let full = areas_m2(&grid, &field(&grid, 0.0), GOAL_M, 1);
        let coarse = areas_m2(&grid, &field(&grid, 0.0), GOAL_M, 2);
        assert!((coarse[0] / full[0] - 1.0).abs() < 0.1);
    }
}
