//! A room from above, north up: how views differ from a snapshot, where vectors point, from where they lead home.

use maud::{Markup, html};

use super::super::field::{self, Field, NEAR_M};
use super::super::grid::Grid;
use super::super::measure::Vectors;
use super::super::survey::Survey;
use super::page;
use crate::report::svg::{self, Point, px};

/// The longer side of a map, user units.
const SIDE: f64 = 250.0;
/// Between two maps.
const GAP: f64 = 34.0;
/// Above the upper maps, and above the lower ones.
const HEAD: f64 = 76.0;
/// Shades of the difference function.
const SHADES: usize = 12;
/// Every so manieth position has an arrow, or a trajectory.
const ARROWS: usize = 3;
const TRAJECTORIES: usize = 6;

/// The maps of one snapshot: the difference function, and for each method the field and the catchment.
pub fn picture(survey: &Survey, bytes: u8, found: &[(String, Vectors)]) -> String {
    let Some(goal) = survey.goals.first() else {
        return page([SIDE, HEAD], "No snapshot", &html! {});
    };
    let goal_m = survey.grid.position_m(goal.index);
    let map = |column: usize, row: usize| {
        let size = Map::new(&survey.grid, [0.0; 2]).size();
        let left = column as f64 * (SIDE + GAP);
        Map::new(&survey.grid, [left, HEAD + row as f64 * (size[1] + GAP)])
    };
    let lowest = map(0, 1);
    let size = [
        found.len() as f64 * (SIDE + GAP) + SIDE,
        lowest.origin[1] + lowest.size()[1],
    ];
    let content = html! {
        text class="f-ink title" x="0" y="16" { (survey.place) ", condition " (survey.condition) }
        text class="f-muted subtitle" x="0" y="38" { "One snapshot of " (bytes) " bytes (cross); north is up" }
        (map(0, 0).titled("Image difference", &difference(&map(0, 0), survey)))
        (key(&map(0, 1)))
        @for (column, (name, vectors)) in (1..).zip(found) {
            @let directions = vectors.directions();
            (map(column, 0).titled(&format!("{name}: vectors"), &arrows(&map(column, 0), &survey.grid, &directions)))
            (map(column, 1).titled(&format!("{name}: catchment"), &catchment(&map(column, 1), &survey.grid, &directions, goal_m)))
        }
        (map(0, 0).cross(goal_m))
        @for column in 1..=found.len() {
            (map(column, 0).cross(goal_m))
            (map(column, 1).cross(goal_m))
        }
    };
    page(size, "Homing from everywhere in a room", &content)
}

/// Where a grid lies on the paper.
#[derive(Clone, Copy)]
struct Map<'a> {
    grid: &'a Grid,
    origin: Point,
    /// User units of a position.
    cell: f64,
}

impl<'a> Map<'a> {
    fn new(grid: &'a Grid, origin: Point) -> Self {
        let longer = grid.columns.max(grid.rows);
        Self {
            grid,
            origin,
            cell: SIDE / longer as f64,
        }
    }

    /// Rows run along x, which is north and up.
    fn size(&self) -> Point {
        [self.grid.rows, self.grid.columns].map(|count| count as f64 * self.cell)
    }

    /// A place in positions on the paper.
    fn at(&self, cell: [f64; 2]) -> Point {
        let [width, height] = self.size();
        [
            self.origin[0] + width - (cell[1] + 0.5) * self.cell,
            self.origin[1] + height - (cell[0] + 0.5) * self.cell,
        ]
    }

    fn place(&self, at_m: [f32; 2]) -> Point {
        self.at(self.grid.cell(at_m).map(f64::from))
    }

    fn titled(&self, title: &str, content: &Markup) -> Markup {
        let [width, height] = self.size();
        let [left, top] = self.origin;
        html! {
            text class="f-ink strong" x=(px(left)) y=(px(top - 8.0)) { (title) }
            (content)
            rect class="hair s-soft" fill="none" x=(px(left)) y=(px(top)) width=(px(width)) height=(px(height)) {}
        }
    }

    fn cross(&self, at_m: [f32; 2]) -> Markup {
        let [x, y] = self.place(at_m);
        let data = format!("M{} {}h10m-5 -5v10", px(x - 5.0), px(y));
        html! {
            path class="line halo s-paper" stroke-width="5" d=(data) {}
            path class="line s-outbound" stroke-width="2.2" d=(data) {}
        }
    }

    /// The outline of all positions for which `inside` holds, as squares along the columns.
    fn squares(&self, inside: impl Fn(usize) -> bool) -> String {
        let mut data = String::new();
        for column in 0..self.grid.columns {
            let mut row = 0;
            while row < self.grid.rows {
                let first = row;
                while row < self.grid.rows && inside(row * self.grid.columns + column) {
                    row += 1;
                }
                if row > first {
                    let [x, y] = self.at([column as f64, row as f64 - 1.0]);
                    let half = 0.5 * self.cell;
                    data += &format!(
                        "M{} {}h{}v{}h-{}z",
                        px(x - half),
                        px(y - half),
                        px((row - first) as f64 * self.cell),
                        px(self.cell),
                        px((row - first) as f64 * self.cell)
                    );
                }
                row += 1;
            }
        }
        data
    }
}

/// The root of the mean squared difference of each view from the snapshot, the darker the larger.
fn difference(map: &Map<'_>, survey: &Survey) -> Markup {
    let Some(goal) = survey.goals.first() else {
        return html! {};
    };
    let from_goal = |view: &nav::methods::Luma| {
        let squares = view.iter().zip(&goal.view).map(|(a, b)| (a - b) * (a - b));
        libm::sqrtf(squares.sum::<f32>() / view.len() as f32)
    };
    let values: Vec<Option<f32>> = survey
        .currents
        .iter()
        .map(|current| Some(from_goal(&current.as_ref()?.view)))
        .collect();
    let most = values.iter().flatten().copied().fold(1e-3, f32::max);
    let shade = |index: usize| {
        let value: Option<f32> = values[index];
        value.map(|value| ((value / most * SHADES as f32) as usize).min(SHADES - 1))
    };
    html! {
        @for level in 0..SHADES {
            path class="f-homing" fill-opacity=(format!("{:.2}", level as f64 / SHADES as f64))
                d=(map.squares(|index| shade(index) == Some(level))) {}
        }
    }
}

/// Unit vectors at every third position.
fn arrows(map: &Map<'_>, grid: &Grid, directions: &Field) -> Markup {
    let mut data = String::new();
    for index in grid
        .free_positions()
        .filter(|index| is_each(grid, *index, ARROWS))
    {
        let Some(direction) = directions[index] else {
            continue;
        };
        let [column, row] = [index % grid.columns, index / grid.columns].map(|n| n as f64);
        let along = |share: f64, aside: f64| {
            let [x, y] = direction.map(f64::from);
            map.at([column + share * x - aside * y, row + share * y + aside * x])
        };
        let tip = along(1.2, 0.0);
        data += &svg::polyline([along(-1.2, 0.0), tip]);
        data += &svg::polyline([along(0.4, 0.5), tip, along(0.4, -0.5)]);
    }
    html! { path class="line s-ink" stroke-width="0.9" d=(data) {} }
}

/// The positions from which a run ends near, and some runs.
fn catchment(map: &Map<'_>, grid: &Grid, directions: &Field, goal_m: [f32; 2]) -> Markup {
    let is_home = |index: usize| {
        let end_m = field::end_of(grid, directions, grid.position_m(index));
        f64::from(libm::hypotf(end_m[0] - goal_m[0], end_m[1] - goal_m[1])) < NEAR_M[0]
    };
    let home: Vec<bool> = (0..grid.free.len())
        .map(|index| grid.free[index] && is_home(index))
        .collect();
    let starts = grid
        .free_positions()
        .filter(|index| is_each(grid, *index, TRAJECTORIES));
    let run = |start: usize| {
        let start_m = grid.position_m(start);
        let mut points = vec![map.place(start_m)];
        field::follow(grid, directions, start_m, |at_m| {
            points.push(map.place(at_m))
        });
        svg::polyline(svg::thin(points, 2.0))
    };
    html! {
        path class="f-odometry" fill-opacity="0.35" d=(map.squares(|index| home[index])) {}
        @for start in starts {
            path class=(if home[start] { "line s-homing" } else { "line s-soft" }) stroke-width="0.8" d=(run(start)) {}
        }
    }
}

/// Whether a position is one of every so manieth along both axes.
fn is_each(grid: &Grid, index: usize, stride: usize) -> bool {
    let middle = |n: usize| n % stride == stride / 2;
    middle(index % grid.columns) && middle(index / grid.columns)
}

/// What the colours mean.
fn key(map: &Map<'_>) -> Markup {
    let [left, top] = map.origin;
    let line = |row: f64| px(top + 20.0 + 22.0 * row);
    html! {
        @for level in 0..SHADES {
            rect class="f-homing" fill-opacity=(format!("{:.2}", level as f64 / SHADES as f64))
                x=(px(left + 8.0 * level as f64)) y=(px(top + 10.0)) width="8" height="12" {}
        }
        text class="f-muted small" x=(px(left + 8.0 * SHADES as f64 + 8.0)) y=(line(0.0)) { "like the snapshot to most unlike" }
        rect class="f-odometry" fill-opacity="0.35" x=(px(left)) y=(px(top + 32.0)) width="24" height="12" {}
        text class="f-muted small" x=(px(left + 32.0)) y=(line(1.0)) { "catchment: ends within 0.5 m" }
        path class="line s-homing" stroke-width="1.4" d=(format!("M{} {}h24", px(left), px(top + 60.0))) {}
        text class="f-muted small" x=(px(left + 32.0)) y=(line(2.0)) { "a run that comes home" }
        path class="line s-soft" stroke-width="1.4" d=(format!("M{} {}h24", px(left), px(top + 82.0))) {}
        text class="f-muted small" x=(px(left + 32.0)) y=(line(3.0)) { "one that does not" }
    }
}
