//! Positions on a square grid, some of them free.

/// The paper's spacing of the panoramic images (Gaffin & Brayfield 2016), metres.
pub const SPACING_M: f32 = 0.127;

/// Positions at equal distances, row by row; rows run along x.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The position of the first: x north, y west, metres.
    pub origin_m: [f32; 2],
    /// Metres between neighbours.
    pub spacing_m: f32,
    /// Positions along x.
    pub columns: usize,
    /// Positions along y.
    pub rows: usize,
    /// Whether there is a view from each position.
    pub free: Vec<bool>,
}

impl Grid {
    /// The grid of [`SPACING_M`] in the middle of a rectangle, all of it free.
    pub fn over(low_m: [f32; 2], high_m: [f32; 2]) -> Self {
        let [columns, rows] = [0, 1].map(|axis| {
            let steps = ((high_m[axis] - low_m[axis]) / SPACING_M) as usize;
            steps + 1
        });
        let origin_m = [(0, columns), (1, rows)].map(|(axis, count): (usize, usize)| {
            let spare_m = high_m[axis] - low_m[axis] - (count - 1) as f32 * SPACING_M;
            low_m[axis] + 0.5 * spare_m
        });
        Self {
            origin_m,
            spacing_m: SPACING_M,
            columns,
            rows,
            free: vec![true; columns * rows],
        }
    }

    /// Where position `index` is.
    pub fn position_m(&self, index: usize) -> [f32; 2] {
        let cell = [index % self.columns, index / self.columns];
        [0, 1].map(|axis| self.origin_m[axis] + cell[axis] as f32 * self.spacing_m)
    }

    /// A place in spacings from the first position.
    pub fn cell(&self, at_m: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|axis| (at_m[axis] - self.origin_m[axis]) / self.spacing_m)
    }

    /// The nearest place that is on the grid.
    pub fn held(&self, at_m: [f32; 2]) -> [f32; 2] {
        let last = self.position_m(self.free.len() - 1);
        [0, 1].map(|axis| at_m[axis].clamp(self.origin_m[axis], last[axis]))
    }

    /// The free positions.
    pub fn free_positions(&self) -> impl Iterator<Item = usize> {
        (0..self.free.len()).filter(|index| self.free[*index])
    }

    /// What one position stands for, m².
    pub fn cell_m2(&self) -> f64 {
        f64::from(self.spacing_m * self.spacing_m)
    }

    /// About `count` free positions on a lattice that covers the grid evenly.
    pub fn lattice(&self, count: usize) -> Vec<usize> {
        let free = self.free_positions().count().max(1);
        let share = (free as f64 / count.max(1) as f64).sqrt();
        let along = |length: usize| -> Vec<usize> {
            let points = libm::round(length as f64 / share).max(1.0) as usize;
            let middle = |point| (2 * point + 1) * length / (2 * points);
            (0..points).map(middle).collect()
        };
        let columns = along(self.columns);
        along(self.rows)
            .into_iter()
            .flat_map(|row| {
                columns
                    .iter()
                    .map(move |column| row * self.columns + column)
            })
            .filter(|index| self.free[*index])
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_lies_in_the_middle_of_its_rectangle() {
        let grid = Grid::over([-1.0, 0.0], [0.0, 0.5]);
        assert_eq!((grid.columns, grid.rows), (8, 4));
        let first = grid.position_m(0);
        let last = grid.position_m(grid.free.len() - 1);
        assert!((first[0] + 1.0 + last[0]).abs() < 1e-5);
        assert!((first[1] + last[1] - 0.5).abs() < 1e-5);
    }

    #[test]
    fn a_lattice_has_about_as_many_positions_as_asked_for_and_none_that_is_not_free() {
        let mut grid = Grid::over([0.0, 0.0], [7.0, 6.6]);
        for count in [1, 9, 16, 25, 36] {
            let lattice = grid.lattice(count);
            assert!(
                lattice.len().abs_diff(count) <= count / 3,
                "{count}: {}",
                lattice.len()
            );
        }
        let before = grid.lattice(16);
        grid.free[before[3]] = false;
        assert!(grid.lattice(16).iter().all(|index| grid.free[*index]));
    }
}
