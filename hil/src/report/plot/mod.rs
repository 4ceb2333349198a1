//! One kind of plot for everything over time: curves, level lines, marked instants, and below the
//! axis a strip that tells the phase of the flight.

mod axes;
mod strip;

use maud::{Markup, html};

pub use self::axes::TimeAxis;
use self::axes::{Scales, most_ticks};
pub use self::strip::Strip;
use super::svg::{self, Point, px};
use super::ticks::{self, Range};

/// User units of a whole plot; the page shows about one per pixel.
const WIDTH: f64 = 1048.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 44.0;

/// Classes of a line of reference.
const LEVEL_CLASS: &str = "level s-muted";

/// Room in the key around a label, and for each of its characters. Text cannot be measured here:
/// this is enough for the widest of the usual fonts.
const KEY_GAP: f64 = 52.0;
const KEY_CHARACTER: f64 = 7.1;

/// Slices of the time axis whose extremes are drawn: one for about two pixels.
const BUCKETS: usize = 480;

/// A curve.
pub struct Series {
    /// What it is, for the key; empty for the only one.
    pub label: &'static str,
    /// Classes of its line.
    pub class: &'static str,
    /// Time and value, in the order of time. What is not finite leaves a gap.
    pub points: Vec<Point>,
}

/// A horizontal line of reference.
pub struct Level {
    /// What it is, for the key.
    pub label: String,
    /// Where.
    pub value: f64,
}

/// Instants marked at the upper edge.
pub struct Events {
    /// What happened, for the key.
    pub label: &'static str,
    /// When, seconds.
    pub times: Vec<f64>,
}

/// A plot over flight time.
pub struct Plot {
    /// Heading: what is drawn.
    pub title: &'static str,
    /// Unit of the vertical axis.
    pub unit: &'static str,
    /// Height of the drawing area, user units.
    pub height: f64,
    /// Whether the vertical axis shows zero.
    pub with_zero: bool,
    /// The curves, lowest first.
    pub series: Vec<Series>,
    /// Lines of reference.
    pub levels: Vec<Level>,
    /// Marked instants.
    pub events: Option<Events>,
}

impl Plot {
    /// The plot as an SVG element. Its `data-` attributes tell the read-out what the axes span.
    pub fn render(&self, time: &TimeAxis) -> Markup {
        let y = self.y_range();
        let scales = Scales {
            x: time.range,
            y: y.unwrap_or(Range {
                low: 0.0,
                high: 1.0,
            }),
            height: self.height,
        };
        let [right, bottom] = [WIDTH - RIGHT, scales.bottom()];
        let area = [LEFT, TOP, right, bottom].map(px).join(" ");
        html! {
            svg.plot viewBox=(format!("0 0 {} {}", px(WIDTH), px(bottom + BOTTOM))) role="img" aria-label=(self.title)
                data-x=(span(scales.x)) data-y=(span(scales.y)) data-area=(area) {
                text class="f-ink strong" x="0" y="16" { (self.title) }
                @if y.is_some() {
                    (self.key())
                    (scales.y_axis(self.unit))
                    (scales.x_axis(&time.phases))
                    @for level in &self.levels { (level.render(&scales)) }
                    @for series in &self.series { (series.render(&scales)) }
                    @if let Some(events) = &self.events { (events.render(&scales)) }
                } @else {
                    text class="f-soft" x=(px(LEFT)) y=(px(TOP + 20.0)) { "Nothing was recorded." }
                }
            }
        }
    }

    /// All that is drawn, rounded to whole steps; none if there is nothing.
    fn y_range(&self) -> Option<Range> {
        let values = self.series.iter().flat_map(|series| &series.points);
        let mut range = Range::of(values.map(|point| point[1]))?;
        for level in &self.levels {
            range = range.with(level.value);
        }
        if self.with_zero {
            range = range.with(0.0);
        }
        let step = ticks::nice_step(range.span(), most_ticks(self.height));
        Some(range.rounded(step))
    }

    /// Every kind of line and mark with its meaning.
    fn marks(&self) -> Vec<(&str, Markup)> {
        let line = |class: &str| html! { path class=(class) d="M-25 -4h25" {} };
        let triangle = html! { path class="f-homing" d="M-12 -1l-4 -7h8z" {} };
        let series = self
            .series
            .iter()
            .map(|series| (series.label, line(series.class)));
        let levels = self
            .levels
            .iter()
            .map(|level| (level.label.as_str(), line(LEVEL_CLASS)));
        let events = self
            .events
            .iter()
            .map(|events| (events.label, triangle.clone()));
        let all = series.chain(levels).chain(events);
        all.filter(|(label, _)| !label.is_empty()).collect()
    }

    /// What the marks mean, from the right edge leftwards.
    fn key(&self) -> Markup {
        let mut right = WIDTH - RIGHT;
        let placed = self.marks().into_iter().map(|(label, sample)| {
            let place = right;
            right -= KEY_GAP + KEY_CHARACTER * label.chars().count() as f64;
            (place, label, sample)
        });
        html! {
            @for (right, label, sample) in placed {
                g transform=(format!("translate({} 15)", px(right))) {
                    (sample)
                    text class="f-muted small end" x="-31" { (label) }
                }
            }
        }
    }
}

fn span(range: Range) -> String {
    format!("{:.6} {:.6}", range.low, range.high)
}

impl Level {
    fn render(&self, scales: &Scales) -> Markup {
        let [y, right] = [scales.y(self.value), WIDTH - RIGHT];
        html! {
            path class=(LEVEL_CLASS) d=(format!("M{} {}H{}", px(LEFT), px(y), px(right))) {}
        }
    }
}

impl Series {
    fn render(&self, scales: &Scales) -> Markup {
        let points = svg::decimate(&self.points, [scales.x.low, scales.x.high], BUCKETS);
        let placed = points
            .iter()
            .map(|point| [scales.x(point[0]), scales.y(point[1])]);
        html! {
            path class=(self.class) data-label=(self.label) d=(svg::polyline(placed)) {}
        }
    }
}

impl Events {
    /// Small triangles that point down at their instants.
    fn render(&self, scales: &Scales) -> Markup {
        let inside = self.times.iter().filter(|time| scales.x.contains(**time));
        let marks: String = inside
            .map(|time| format!("M{} {}l-4 -7h8z", px(scales.x(*time)), px(TOP - 1.0)))
            .collect();
        html! {
            @if !marks.is_empty() { path class="f-homing" d=(marks) {} }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<Point>) -> Plot {
        Plot {
            title: "T",
            unit: "m",
            height: 100.0,
            with_zero: true,
            series: vec![Series {
                label: "",
                class: "line",
                points,
            }],
            levels: Vec::new(),
            events: None,
        }
    }

    fn time() -> TimeAxis {
        TimeAxis {
            range: Range {
                low: 0.0,
                high: 10.0,
            },
            phases: Vec::new(),
        }
    }

    #[test]
    fn the_vertical_axis_covers_all_values_and_zero_in_round_steps() {
        let range = plot(vec![[0.0, 0.31], [1.0, 2.7]])
            .y_range()
            .expect("values");
        assert_eq!((range.low, range.high), (0.0, 3.0));
    }

    #[test]
    fn a_plot_of_nothing_says_so() {
        let nothing = plot(vec![[0.0, f64::NAN]]).render(&time()).into_string();
        assert!(nothing.contains("Nothing was recorded."));
    }

    #[test]
    fn a_value_at_half_the_axis_is_drawn_at_half_the_height() {
        let svg = plot(vec![[0.0, 0.0], [5.0, 1.0], [10.0, 2.0]])
            .render(&time())
            .into_string();
        let [middle_x, middle_y] = [(LEFT + WIDTH - RIGHT) / 2.0, TOP + 50.0];
        assert!(svg.contains(&format!("L{} {}L", px(middle_x), px(middle_y))));
    }
}
