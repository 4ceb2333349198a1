//! One kind of plot for everything over time: curves, level lines, events, and below the axis a
//! strip that tells the phase of the flight.

use maud::{Markup, html};

use super::number;
use super::phase::{self, PhaseSpan};
use super::svg::{self, Point, px};
use super::ticks::{self, Range};

/// User units of a whole plot; the page shows about one per pixel.
const WIDTH: f64 = 1048.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 36.0;
const BOTTOM: f64 = 44.0;

/// Slices of the time axis whose extremes are drawn: one for about two pixels.
const BUCKETS: usize = 480;

/// A curve.
pub struct Series {
    /// What it is, for the key.
    pub label: String,
    /// Classes of its line.
    pub class: &'static str,
    /// Time and value, in the order of time. What is not finite leaves a gap.
    pub points: Vec<Point>,
}

/// A horizontal line of reference.
pub struct Level {
    /// Written on the line.
    pub label: String,
    /// Where.
    pub value: f64,
}

/// Instants marked by vertical lines.
pub struct Events {
    /// What happened, for the key.
    pub label: String,
    /// When, seconds.
    pub times: Vec<f64>,
}

/// A plot over flight time.
pub struct Plot<'a> {
    /// Heading, with what is drawn.
    pub title: &'a str,
    /// Unit of the vertical axis.
    pub unit: &'a str,
    /// Height of the drawing area, user units.
    pub height: f64,
    /// Whether the vertical axis begins at zero.
    pub from_zero: bool,
    /// The curves, lowest first.
    pub series: Vec<Series>,
    /// Lines of reference.
    pub levels: Vec<Level>,
    /// Marked instants.
    pub events: Option<Events>,
}

/// The common time axis of all plots of a flight.
pub struct TimeAxis {
    /// Flight time, seconds.
    pub range: Range,
    /// What happened when.
    pub phases: Vec<PhaseSpan>,
}

/// Where values are on the paper.
struct Scales {
    x: Range,
    y: Range,
    height: f64,
}

impl Scales {
    fn x(&self, time: f64) -> f64 {
        LEFT + (time - self.x.low) / self.x.span() * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, value: f64) -> f64 {
        TOP + (self.y.high - value) / self.y.span() * self.height
    }

    fn bottom(&self) -> f64 {
        TOP + self.height
    }
}

impl Plot<'_> {
    /// The plot as a figure of its own.
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
        let total = scales.bottom() + BOTTOM;
        let view_box = format!("0 0 {} {}", px(WIDTH), px(total));
        html! {
            svg class="plot" viewBox=(view_box) role="img" aria-label=(self.title)
                data-x=(format!("{:.3} {:.3}", time.range.low, time.range.high))
                data-y=(format!("{:.6} {:.6}", scales.y.low, scales.y.high))
                data-box=(format!("{} {} {} {}", px(LEFT), px(TOP), px(WIDTH - RIGHT), px(scales.bottom()))) {
                (self.head())
                @if y.is_some() {
                    (self.y_axis(&scales))
                    (time.strip(&scales))
                    (self.event_lines(&scales))
                    @for level in &self.levels { (level.line(&scales)) }
                    @for series in &self.series { (series.curve(&scales)) }
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
        if self.from_zero {
            range = range.with(0.0);
        }
        Some(range.rounded(ticks::nice_step(range.span(), self.most_ticks())))
    }

    /// As many ticks as have room for their labels.
    fn most_ticks(&self) -> usize {
        (self.height / 32.0) as usize
    }

    /// Title to the left, key to the right.
    fn head(&self) -> Markup {
        let marks = self
            .series
            .iter()
            .map(|series| (series.label.as_str(), series.class));
        let events = self
            .events
            .iter()
            .map(|events| (events.label.as_str(), "event s-homing"));
        let mut right = WIDTH - RIGHT;
        let mut key = Vec::new();
        for (label, class) in marks.chain(events).filter(|(label, _)| !label.is_empty()) {
            key.push((label, class, right));
            // Room for the widest fonts; a key has no means to measure its text.
            right -= 52.0 + 7.1 * label.chars().count() as f64;
        }
        html! {
            text class="f-ink strong" x="0" y="16" { (self.title) }
            @for (label, class, right) in key {
                text class="f-muted small end" x=(px(right - 30.0)) y="15" { (label) }
                path class=(class) d=(format!("M{} 11h25", px(right - 25.0))) {}
            }
        }
    }

    fn y_axis(&self, scales: &Scales) -> Markup {
        let (values, decimals) = ticks::ticks(scales.y, self.most_ticks());
        let grid: String = values
            .iter()
            .map(|value| {
                format!(
                    "M{} {}H{}",
                    px(LEFT),
                    px(scales.y(*value)),
                    px(WIDTH - RIGHT)
                )
            })
            .collect();
        let middle = TOP + self.height / 2.0;
        html! {
            path class="hair s-grid" d=(grid) {}
            @for value in values {
                text class="f-muted small end" x=(px(LEFT - 8.0)) y=(px(scales.y(value) + 4.0)) {
                    (number::fixed(value, decimals))
                }
            }
            text class="f-muted small middle" transform=(format!("translate(11 {}) rotate(-90)", px(middle))) {
                (self.unit)
            }
        }
    }

    fn event_lines(&self, scales: &Scales) -> Markup {
        let times = self.events.iter().flat_map(|events| &events.times);
        let lines: String = times
            .filter(|time| scales.x.contains(**time))
            .map(|time| {
                format!(
                    "M{} {}v-{}",
                    px(scales.x(*time)),
                    px(scales.bottom()),
                    px(self.height)
                )
            })
            .collect();
        html! {
            @if !lines.is_empty() { path class="event s-homing" d=(lines) {} }
        }
    }
}

impl TimeAxis {
    /// The axis: a strip in the colours of the phases, ticks and unit.
    fn strip(&self, scales: &Scales) -> Markup {
        let (values, decimals) = ticks::ticks(scales.x, 12);
        let bottom = scales.bottom();
        html! {
            @for span in self.phases.iter().filter(|span| span.time[1] > span.time[0]) {
                @let [from, to] = span.time.map(|time| scales.x(time));
                rect class=(format!("f-{}", phase::colour(span.phase)))
                    x=(px(from)) y=(px(bottom + 1.0)) width=(px(to - from)) height=(strip_height(span)) {}
            }
            @for value in &values {
                text class="f-muted small middle" x=(px(scales.x(*value))) y=(px(bottom + 23.0)) {
                    (number::fixed(*value, decimals))
                }
            }
            text class="f-muted small end" x=(px(WIDTH - RIGHT)) y=(px(bottom + 39.0)) { "flight time, s" }
        }
    }
}

/// Thicker for the phases of the way back: a cue beside the colour.
fn strip_height(span: &PhaseSpan) -> &'static str {
    match span.phase {
        crate::record::Phase::Ground => "1",
        crate::record::Phase::Outbound => "3",
        crate::record::Phase::Odometry => "5",
        crate::record::Phase::Homing => "7",
    }
}

impl Level {
    fn line(&self, scales: &Scales) -> Markup {
        let y = scales.y(self.value);
        html! {
            path class="level s-muted" d=(format!("M{} {}H{}", px(LEFT), px(y), px(WIDTH - RIGHT))) {}
            text class="f-muted s-paper small halo end" x=(px(WIDTH - RIGHT - 4.0)) y=(px(y - 5.0)) { (self.label) }
        }
    }
}

impl Series {
    fn curve(&self, scales: &Scales) -> Markup {
        let span = [scales.x.low, scales.x.high];
        let points = svg::decimate(&self.points, span, BUCKETS);
        let placed = points
            .iter()
            .map(|point| [scales.x(point[0]), scales.y(point[1])]);
        html! {
            path class=(self.class) data-label=(self.label) d=(svg::polyline(placed)) {}
        }
    }
}
