//! When things happened: a row of ticks for each kind over the common time axis.

use maud::{Markup, html};

use super::axes::{Scales, TimeAxis};
use super::{BOTTOM, LEFT, RIGHT, TOP, WIDTH};
use crate::report::svg::px;
use crate::report::ticks::Range;

/// Height of a row, and of the ticks in it, user units.
const ROW: f64 = 26.0;
const TICK: f64 = 14.0;

/// Ticks drawn at most in a row: one for each pixel is all that can be seen.
const MOST_TICKS: usize = 1000;

/// Instants by kind.
pub struct Strip {
    /// Heading: what happened.
    pub title: &'static str,
    /// The name of each row, and its instants in the order of time, seconds.
    pub rows: Vec<(&'static str, Vec<f64>)>,
}

impl Strip {
    /// The strip as an SVG element.
    pub fn render(&self, time: &TimeAxis) -> Markup {
        let scales = Scales {
            x: time.range,
            y: Range {
                low: 0.0,
                high: 1.0,
            },
            height: ROW * self.rows.len() as f64,
        };
        let bottom = px(scales.bottom() + BOTTOM);
        let right = px(WIDTH - RIGHT);
        html! {
            svg viewBox=(format!("0 0 {} {bottom}", px(WIDTH))) role="img" aria-label=(self.title) {
                text class="f-ink strong" x="0" y="16" { (self.title) }
                (scales.x_axis(&time.phases))
                @for (row, (label, times)) in self.rows.iter().enumerate() {
                    @let y = TOP + ROW * (row as f64 + 0.5);
                    path class="hair s-grid" d=(format!("M{} {}H{right}", px(LEFT), px(y))) {}
                    path class="line tick s-outbound" d=(ticks(times, y, &scales)) {}
                    text class="f-muted small" x=(px(LEFT)) y=(px(y - TICK / 2.0 - 2.0)) {
                        (label) ": " (times.len())
                    }
                }
            }
        }
    }
}

fn ticks(times: &[f64], y: f64, scales: &Scales) -> String {
    let step = times.len().div_ceil(MOST_TICKS).max(1);
    let inside = times.iter().filter(|time| scales.x.contains(**time));
    inside
        .step_by(step)
        .map(|time| {
            format!(
                "M{} {}v{}",
                px(scales.x(*time)),
                px(y - TICK / 2.0),
                px(TICK)
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_instant_is_a_tick_in_its_row() {
        let time = TimeAxis {
            range: Range {
                low: 0.0,
                high: 10.0,
            },
            phases: Vec::new(),
        };
        let strip = Strip {
            title: "T",
            rows: vec![("first", vec![0.0, 10.0, 11.0]), ("second", vec![])],
        };
        let svg = strip.render(&time).into_string();
        let drawn = format!("M{} 46v14M{} 46v14\"", px(LEFT), px(WIDTH - RIGHT));
        assert!(svg.contains(&drawn), "{svg}");
        assert!(svg.contains("first: 3") && svg.contains("second: 0"));
    }
}
