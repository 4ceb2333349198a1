//! The time line as a picture: one frame period in whole, and what vision does with the frame
//! under the magnifying glass.

use maud::{Markup, PreEscaped, html};

use super::timeline::{Slice, Timeline, Track};
use crate::report::style;
use crate::report::svg::px;
use crate::report::ticks::{self, Range};

/// User units of the whole picture.
const WIDTH: f64 = 1200.0;
/// Room for the names of the tracks.
const LEFT: f64 = 170.0;
const RIGHT: f64 = 18.0;
/// Room for the title.
const TITLE: f64 = 52.0;
/// Room for a panel's heading, and for its axis.
const HEADING: f64 = 22.0;
const AXIS: f64 = 40.0;
const ROW: f64 = 15.0;
const GAP: f64 = 4.0;
/// What is narrower is drawn as wide as this.
const NARROWEST: f64 = 0.8;
/// Boxes wider than this tell their name when they are pointed at.
const NAMED: f64 = 2.0;
/// Width of a character of the labels, on average.
const CHARACTER: f64 = 5.4;

/// One frame period of a time line as a stand-alone SVG: of all in the window, the first in which
/// most stages run.
pub fn picture(timeline: &Timeline) -> String {
    let period = busiest_period(timeline.slices());
    let whole = Panel::new(timeline, period, "One frame period, ms");
    let close = looks(timeline.slices(), period).map(|span| {
        Panel::new(
            timeline,
            span,
            "The same, where vision looks at the frame, ms",
        )
    });
    let below = TITLE + whole.height();
    let height = below + close.as_ref().map_or(0.0, Panel::height);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", px(WIDTH), px(height)))
            role="img" aria-label="Timing diagram of a frame period" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" width=(px(WIDTH)) height=(px(height)) {}
            text class="f-ink title" x="16" y="24" { "Tasks, interrupts, DMA and link in one frame period" }
            text class="f-muted subtitle" x="16" y="43" {
                (format!("from {:.6} s of the flight on; by the emulated core's cycle counter", 1.0e-6 * period.low))
            }
            (whole.draw(TITLE))
            @if let Some(close) = close { (close.draw(below)) }
        }
    }
    .into_string()
}

/// From the start of a frame to that of the next, microseconds of the flight; everything, where there
/// are not two frames.
fn busiest_period(slices: &[Slice]) -> Range {
    let of = |track| slices.iter().filter(move |slice| slice.track == track);
    let mut starts: Vec<f64> = of(Track::Camera).map(|frame| frame.from_us).collect();
    starts.sort_by(f64::total_cmp);
    let periods = starts.windows(2).map(|ends| Range {
        low: ends[0],
        high: ends[1],
    });
    let stages = |period: &Range| {
        let stages = of(Track::Stages).filter(|stage| period.contains(stage.from_us));
        let mut names: Vec<&str> = stages.map(|stage| stage.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names.len()
    };
    // Of equals, `max_by_key` takes the last.
    let busiest = periods.rev().max_by_key(stages);
    let ends = |slice: &Slice| [slice.from_us, slice.from_us + slice.for_us];
    busiest
        .or_else(|| Range::of(slices.iter().flat_map(ends)))
        .unwrap_or(Range {
            low: 0.0,
            high: 1.0,
        })
}

/// The longest stage of a period with some room about it: the look at the frame.
fn looks(slices: &[Slice], period: Range) -> Option<Range> {
    /// Of its length, on either side.
    const ROOM: f64 = 0.3;
    let stages = slices
        .iter()
        .filter(|slice| slice.track == Track::Stages && period.contains(slice.from_us));
    let look = stages.max_by(|a, b| a.for_us.total_cmp(&b.for_us))?;
    let room = ROOM * look.for_us;
    (room > 0.0).then_some(Range {
        low: look.from_us - room,
        high: look.from_us + look.for_us + room,
    })
}

/// A stretch of time, its tracks one below the other.
struct Panel<'t> {
    heading: &'static str,
    /// Microseconds of the flight.
    span: Range,
    tracks: Vec<Row<'t>>,
}

/// A track; what is within another thing is a row lower.
struct Row<'t> {
    track: Track,
    name: &'t str,
    slices: Vec<(usize, &'t Slice)>,
    depth: usize,
}

impl<'t> Panel<'t> {
    /// The tracks that have something in the span.
    fn new(timeline: &'t Timeline, span: Range, heading: &'static str) -> Self {
        let rows = timeline.tracks().iter().map(|(track, name)| {
            let here = timeline.slices().iter().filter(|slice| {
                slice.track == *track
                    && slice.from_us < span.high
                    && slice.from_us + slice.for_us >= span.low
            });
            let slices = nested(here.collect());
            let depth = slices.iter().map(|(depth, _)| depth + 1).max().unwrap_or(0);
            Row {
                track: *track,
                name,
                slices,
                depth,
            }
        });
        Self {
            heading,
            span,
            tracks: rows.filter(|row| row.depth > 0).collect(),
        }
    }

    fn height(&self) -> f64 {
        let rows = self.tracks.iter();
        HEADING + rows.map(Row::height).sum::<f64>() + AXIS
    }

    fn x(&self, microseconds: f64) -> f64 {
        let share = (microseconds - self.span.low) / self.span.span();
        LEFT + share.clamp(0.0, 1.0) * (WIDTH - LEFT - RIGHT)
    }

    fn draw(&self, top: f64) -> Markup {
        let mut y = top + HEADING;
        let rows = self.tracks.iter().map(|row| {
            let at = y;
            y += row.height();
            (row, at)
        });
        let rows: Vec<(&Row, f64)> = rows.collect();
        let axis = top + self.height() - AXIS;
        html! {
            text class="f-ink strong" x="16" y=(px(top + 12.0)) { (self.heading) }
            (self.axis(top + HEADING, axis))
            @for (row, y) in rows {
                text class="f-ink small end" x=(px(LEFT - 8.0)) y=(px(y + 11.0)) { (row.name) }
                (self.row(row, y))
            }
        }
    }

    /// Milliseconds since the start of the span.
    fn axis(&self, top: f64, bottom: f64) -> Markup {
        let span = Range {
            low: 0.0,
            high: 1.0e-3 * self.span.span(),
        };
        let (values, decimals) = ticks::ticks(span, 12);
        html! {
            path class="axis s-muted" d=(format!("M{} {}H{}", px(LEFT), px(bottom), px(WIDTH - RIGHT))) {}
            @for value in values {
                @let x = self.x(self.span.low + 1.0e3 * value);
                path class="hair s-grid" d=(format!("M{} {}V{}", px(x), px(top), px(bottom))) {}
                text class="f-muted small middle" x=(px(x)) y=(px(bottom + 16.0)) { (format!("{value:.decimals$}")) }
            }
        }
    }

    /// Wide boxes have names; all narrow ones are one path.
    fn row(&self, row: &Row, top: f64) -> Markup {
        let class = class_of(row.track);
        let mut narrow = String::new();
        let mut drawn_to = vec![0.0; row.depth];
        let mut wide = Vec::new();
        for (depth, slice) in &row.slices {
            let left = self.x(slice.from_us);
            let width = (self.x(slice.from_us + slice.for_us) - left).max(NARROWEST);
            let y = top + ROW * *depth as f64;
            if width > NAMED {
                wide.push((slice, left, width, y));
            } else if left >= drawn_to[*depth] {
                drawn_to[*depth] = left + NARROWEST / 2.0;
                let height = ROW - 2.0;
                narrow += &format!(
                    "M{} {}v{}h{}v-{}z",
                    px(left),
                    px(y),
                    px(height),
                    px(width),
                    px(height)
                );
            }
        }
        html! {
            @if !narrow.is_empty() { path class=(class) d=(narrow) {} }
            @for (slice, left, width, y) in wide {
                @let room = ((width - 5.0) / CHARACTER).max(0.0) as usize;
                g {
                    title { (slice.name) (format!(": {:.1} us", slice.for_us)) }
                    rect class=(class) x=(px(left)) y=(px(y)) width=(px(width)) height=(px(ROW - 2.0)) {}
                    @if slice.name.len() <= room {
                        text class=(label_of(row.track)) x=(px(left + 3.0)) y=(px(y + 10.0)) { (slice.name) }
                    }
                }
            }
        }
    }
}

impl Row<'_> {
    fn height(&self) -> f64 {
        ROW * self.depth as f64 + GAP
    }
}

/// In the order of their beginnings, each with the number of those that it is within.
fn nested(mut slices: Vec<&Slice>) -> Vec<(usize, &Slice)> {
    /// Cycles become microseconds with an error far below this; a cycle is 0.006 of one.
    const SAME_US: f64 = 1.0e-3;
    let longest_first = |a: &&Slice, b: &&Slice| {
        let starts = a.from_us.total_cmp(&b.from_us);
        starts.then(b.for_us.total_cmp(&a.for_us))
    };
    slices.sort_by(longest_first);
    let mut open: Vec<f64> = Vec::new();
    let depths = slices.into_iter().map(|slice| {
        while open.pop_if(|end| *end <= slice.from_us + SAME_US).is_some() {}
        open.push(slice.from_us + slice.for_us);
        (open.len() - 1, slice)
    });
    depths.collect()
}

fn class_of(track: Track) -> &'static str {
    match track {
        Track::Camera => "f-soft",
        Track::Stages => "f-homing",
        Track::Task(_) => "f-odometry",
        Track::Exception(_) => "f-outbound",
        Track::Dma(..) => "f-ink",
        Track::Received | Track::Sent => "f-uncorrected",
        Track::Sleep => "f-grid",
    }
}

/// Labels on dark boxes are light.
fn label_of(track: Track) -> &'static str {
    match track {
        Track::Camera | Track::Task(_) | Track::Sleep => "f-ink tiny",
        _ => "f-paper tiny",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slice(track: Track, name: &str, from_us: f64, for_us: f64) -> Slice {
        Slice {
            track,
            name: name.to_owned(),
            from_us,
            for_us,
        }
    }

    #[test]
    fn a_stage_within_another_is_a_row_lower_and_the_next_one_is_not() {
        let outer = slice(Track::Stages, "expose", 10.0, 20.0);
        let first = slice(Track::Stages, "unwrap", 10.0, 5.0);
        let second = slice(Track::Stages, "spectrum", 15.0, 5.0);
        let next = slice(Track::Stages, "navigate", 30.0, 5.0);
        let slices = nested(vec![&next, &second, &first, &outer]);
        let depths: Vec<(usize, &str)> = slices
            .iter()
            .map(|(depth, slice)| (*depth, slice.name.as_str()))
            .collect();
        let expected = [
            (0, "expose"),
            (1, "unwrap"),
            (1, "spectrum"),
            (0, "navigate"),
        ];
        assert_eq!(depths, expected);
    }

    #[test]
    fn the_first_of_the_periods_with_most_stages_is_shown() {
        let frames = [0.0, 39_000.0, 78_000.0, 117_000.0];
        let mut slices: Vec<Slice> = frames
            .map(|start| slice(Track::Camera, "frame", start, 30_000.0))
            .into();
        for (name, at, long) in [
            ("unwrap", 33_000.0, 100.0),
            ("unwrap", 72_000.0, 100.0),
            ("align", 73_000.0, 20.0),
            ("unwrap", 111_000.0, 100.0),
            ("align", 112_000.0, 20.0),
        ] {
            slices.push(slice(Track::Stages, name, at, long));
        }
        let period = busiest_period(&slices);
        assert_eq!((period.low, period.high), (39_000.0, 78_000.0));
        let close = looks(&slices, period).expect("a stage");
        assert!(close.contains(72_000.0) && close.contains(72_100.0));
        assert!(close.span() < 200.0);
    }
}
