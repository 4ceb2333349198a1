//! The runs as a picture: from above, north up.

use maud::{Markup, PreEscaped, html};

use super::{NEAR_M, Run, Verdict};
use crate::report::style;
use crate::report::svg::{self, Point, px};

/// User units of the picture, and of a metre.
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 590.0;
const MARGIN: f64 = 24.0;
const METRE: f64 = 108.0;
/// The middle of the map, and how many metres of it are shown to each side.
const MIDDLE: Point = [280.0, 330.0];
const REACH_M: f64 = 2.4;

/// The runs relative to their snapshots, as a stand-alone SVG on a light background.
pub fn picture(world: &str, runs: &[Run]) -> String {
    let verdict = Verdict::on(runs);
    let whole_m: Vec<f64> = vec![-2.0, -1.0, 0.0, 1.0, 2.0];
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN))
            viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(WIDTH + 2.0 * MARGIN), px(HEIGHT + 2.0 * MARGIN)))
            role="img" aria-label="Homing runs to one snapshot" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN)) {}
            text class="f-ink title" x="0" y="16" { "Homing to one snapshot" }
            text class="f-muted subtitle" x="0" y="38" {
                (world) ": " (verdict.home) " of " (verdict.runs) " runs end within 0.5 m, median "
                (format!("{:.2} m", verdict.p50_m))
            }
            @for metres in &whole_m {
                (grid_line(*metres))
            }
            @for run in runs { (path(run)) }
            circle class="level s-ink" fill="none" cx=(px(MIDDLE[0])) cy=(px(MIDDLE[1])) r=(px(NEAR_M * METRE)) {}
            @for run in runs { (ends(run)) }
            (key())
        }
    }
    .into_string()
}

/// North up, west to the left.
fn place([x, y]: [f64; 2]) -> Point {
    [MIDDLE[0] - y * METRE, MIDDLE[1] - x * METRE]
}

fn relative(run: &Run, [x, y]: [f64; 2]) -> [f64; 2] {
    [x - run.snapshot_m[0], y - run.snapshot_m[1]]
}

fn grid_line(metres: f64) -> Markup {
    let across = [[metres, REACH_M], [metres, -REACH_M]].map(place);
    let along = [[REACH_M, metres], [-REACH_M, metres]].map(place);
    let label = format!("{metres:.0} m");
    html! {
        path class="hair s-grid" d=(svg::polyline(across)) {}
        path class="hair s-grid" d=(svg::polyline(along)) {}
        text class="f-muted small end" x=(px(across[0][0] - 4.0)) y=(px(across[0][1] + 4.0)) { (label) }
    }
}

fn path(run: &Run) -> Markup {
    let points = run.path_m.iter().map(|at_m| place(relative(run, *at_m)));
    html! {
        path class="line curve s-homing" opacity="0.35" d=(svg::polyline(svg::thin(points, 1.5))) {}
    }
}

fn ends(run: &Run) -> Markup {
    let Some((first, last)) = run.path_m.first().zip(run.path_m.last()) else {
        return html! {};
    };
    let [start, end] = [first, last].map(|at_m| place(relative(run, *at_m)));
    let colour = if run.end_error_m() < NEAR_M {
        "f-ink"
    } else {
        "f-outbound"
    };
    html! {
        circle class="f-paper s-soft" cx=(px(start[0])) cy=(px(start[1])) r="3" {}
        circle class=(colour) cx=(px(end[0])) cy=(px(end[1])) r="2.2" {}
    }
}

fn key() -> Markup {
    html! {
        circle class="f-paper s-soft" cx="6" cy="58" r="3" {}
        text class="f-muted small" x="16" y="62" { "start" }
        circle class="f-ink" cx="66" cy="58" r="2.2" {}
        text class="f-muted small" x="74" y="62" { "end" }
        circle class="f-outbound" cx="116" cy="58" r="2.2" {}
        text class="f-muted small" x="124" y="62" { "end beyond 0.5 m (dashed)" }
    }
}
