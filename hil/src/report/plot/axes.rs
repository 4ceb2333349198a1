//! Where values stand on the paper, and the axes that say so.

use maud::{Markup, html};

use super::{LEFT, RIGHT, TOP, WIDTH};
use crate::record::Phase;
use crate::report::number;
use crate::report::phase::{self, PhaseSpan};
use crate::report::svg::px;
use crate::report::ticks::{self, Range};

/// Least height of the space between two labels of the vertical axis, user units.
const LABEL_STEP: f64 = 32.0;
/// Labels of the time axis at most.
const MOST_TIMES: usize = 12;

/// The common time axis of all plots of a flight.
pub struct TimeAxis {
    /// Flight time, seconds.
    pub range: Range,
    /// What happened when.
    pub phases: Vec<PhaseSpan>,
}

/// Where values are on the paper.
pub struct Scales {
    /// Flight time, seconds.
    pub x: Range,
    /// The vertical axis.
    pub y: Range,
    /// Height of the drawing area, user units.
    pub height: f64,
}

impl Scales {
    /// A time on the paper.
    pub fn x(&self, time: f64) -> f64 {
        LEFT + (time - self.x.low) / self.x.span() * (WIDTH - LEFT - RIGHT)
    }

    /// A value on the paper.
    pub fn y(&self, value: f64) -> f64 {
        TOP + (self.y.high - value) / self.y.span() * self.height
    }

    /// The lower edge of the drawing area.
    pub fn bottom(&self) -> f64 {
        TOP + self.height
    }

    /// Grid lines at round values, with labels, and the unit beside them.
    pub fn y_axis(&self, unit: &str) -> Markup {
        let (values, decimals) = ticks::ticks(self.y, most_ticks(self.height));
        let line =
            |value: &f64| format!("M{} {}H{}", px(LEFT), px(self.y(*value)), px(WIDTH - RIGHT));
        let grid: String = values.iter().map(line).collect();
        let middle = px(TOP + self.height / 2.0);
        html! {
            path class="hair s-grid" d=(grid) {}
            @for value in values {
                text class="f-muted small end" x=(px(LEFT - 8.0)) y=(px(self.y(value) + 4.0)) {
                    (number::fixed(value, decimals))
                }
            }
            text class="f-muted small middle" transform=(format!("translate(11 {middle}) rotate(-90)")) { (unit) }
        }
    }

    /// The time axis: a strip in the colours of the phases, labels and unit.
    pub fn x_axis(&self, phases: &[PhaseSpan]) -> Markup {
        let (values, decimals) = ticks::ticks(self.x, MOST_TIMES);
        let bottom = self.bottom();
        html! {
            @for span in phases.iter().filter(|span| span.time[1] > span.time[0]) {
                @let [from, to] = span.time.map(|time| self.x(time));
                rect class=(format!("f-{}", phase::colour(span.phase)))
                    x=(px(from)) y=(px(bottom + 1.0)) width=(px(to - from)) height=(strip_height(span.phase)) {}
            }
            @for value in &values {
                text class="f-muted small middle" x=(px(self.x(*value))) y=(px(bottom + 23.0)) {
                    (number::fixed(*value, decimals))
                }
            }
            text class="f-muted small end" x=(px(WIDTH - RIGHT)) y=(px(bottom + 39.0)) { "flight time, s" }
        }
    }
}

/// As many as have room for their labels.
pub fn most_ticks(height: f64) -> usize {
    (height / LABEL_STEP) as usize
}

/// Thicker on the way back: a cue beside the colour.
fn strip_height(phase: Phase) -> &'static str {
    match phase {
        Phase::Ground => "1",
        Phase::Outbound => "3",
        Phase::Odometry => "5",
        Phase::Homing => "7",
    }
}
