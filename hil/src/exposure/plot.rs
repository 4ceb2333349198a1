//! Luma against frames for the worst conditions, as one picture.

use maud::{Markup, PreEscaped, html};

use super::{DEADLINE, FRAMES, Outcome, SET_POINT, TOLERANCE};
use crate::report::style;
use crate::report::svg::{self, Point, px};

/// User units of the whole picture.
const WIDTH: f64 = 900.0;
const MARGIN: f64 = 24.0;
/// The drawing area: left and upper edge, size.
const ORIGIN: Point = [40.0, 64.0];
const AREA: [f64; 2] = [840.0, 320.0];
/// Height of a line of the key.
const KEY_PITCH: f64 = 18.0;
/// Luma at the upper edge.
const TOP_LUMA: f64 = 260.0;
/// Colours of the curves (see `report::style`).
const COLOURS: [&str; 6] = [
    "outbound",
    "homing",
    "odometry",
    "uncorrected",
    "ink",
    "soft",
];

/// The picture as a stand-alone SVG on a light background. As many curves as there are colours.
pub fn picture(worst: &[&Outcome]) -> String {
    let worst: Vec<(&Outcome, &str)> = worst.iter().copied().zip(COLOURS).collect();
    let key_top = ORIGIN[1] + AREA[1] + 52.0;
    let height = key_top + KEY_PITCH * worst.len() as f64;
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(px(WIDTH + 2.0 * MARGIN)) height=(px(height + 2.0 * MARGIN))
            viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(WIDTH + 2.0 * MARGIN), px(height + 2.0 * MARGIN)))
            role="img" aria-label="Autoexposure" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(WIDTH + 2.0 * MARGIN))
                height=(px(height + 2.0 * MARGIN)) {}
            text class="f-ink title" x="0" y="16" { "How the exposure arrives: the worst conditions" }
            text class="f-muted subtitle" x="0" y="38" {
                "Mean luma of the horizon band. Shaded: 80 +- 3 from frame 10 on."
            }
            (goal())
            (grid())
            @for (outcome, colour) in worst.iter().rev() {
                @let points = (1..).zip(&outcome.lumas).map(|(frame, luma)| place(f64::from(frame), *luma));
                path class=(format!("line curve s-{colour}")) d=(svg::polyline(points)) {}
            }
            @for (index, (outcome, colour)) in worst.iter().enumerate() {
                @let y = key_top + KEY_PITCH * index as f64;
                path class=(format!("line curve s-{colour}")) d=(svg::polyline([[0.0, y - 4.0], [24.0, y - 4.0]])) {}
                text class="f-ink small" x="32" y=(px(y)) {
                    (outcome.condition.in_words()) (format!(": holds from frame {}", outcome.frames()))
                }
            }
        }
    }
    .into_string()
}

fn place(frame: f64, luma: f64) -> Point {
    let [left, top] = ORIGIN;
    [
        left + (frame - 1.0) / (FRAMES - 1) as f64 * AREA[0],
        top + (1.0 - luma / TOP_LUMA) * AREA[1],
    ]
}

/// Where the curves have to be from the deadline on.
fn goal() -> Markup {
    let [left, top] = place(DEADLINE as f64, SET_POINT + TOLERANCE);
    let [right, bottom] = place(FRAMES as f64, SET_POINT - TOLERANCE);
    html! {
        rect class="f-route" x=(px(left)) y=(px(top)) width=(px(right - left)) height=(px(bottom - top)) {}
        path class="hair s-soft" d=(svg::polyline([place(DEADLINE as f64, 0.0), place(DEADLINE as f64, TOP_LUMA)])) {}
    }
}

fn grid() -> Markup {
    html! {
        @for luma in [0.0, 80.0, 160.0, 255.0] {
            @let ends = [place(1.0, luma), place(FRAMES as f64, luma)];
            path class="hair s-grid" d=(svg::polyline(ends)) {}
            text class="f-muted small end" x=(px(ends[0][0] - 8.0)) y=(px(ends[0][1] + 4.0)) { (luma) }
        }
        @for frame in [1, 4, 7, 10, 15, 20, 25, 30] {
            @let [x, y] = place(f64::from(frame), 0.0);
            text class="f-muted small middle" x=(px(x)) y=(px(y + 18.0)) { (frame) }
        }
        @let [x, y] = place(FRAMES as f64, 0.0);
        text class="f-muted small end" x=(px(x)) y=(px(y + 34.0)) { "frame" }
    }
}
