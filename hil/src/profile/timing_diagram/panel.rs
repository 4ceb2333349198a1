//! A stretch of a time line, its tracks one below the other.

use maud::{Markup, html};

use super::super::timeline::{Slice, Timeline, Track};
use super::WIDTH;
use crate::report::svg::px;
use crate::report::ticks::{self, Range};

/// Room for the names of the tracks.
const LEFT: f64 = 170.0;
const RIGHT: f64 = 18.0;
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

/// A stretch of time, its tracks one below the other.
pub(super) struct Panel<'t> {
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
    pub(super) fn new(timeline: &'t Timeline, span: Range, heading: &'static str) -> Self {
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

    pub(super) fn height(&self) -> f64 {
        let rows = self.tracks.iter();
        HEADING + rows.map(Row::height).sum::<f64>() + AXIS
    }

    fn x(&self, microseconds: f64) -> f64 {
        let share = (microseconds - self.span.low) / self.span.span();
        LEFT + share.clamp(0.0, 1.0) * (WIDTH - LEFT - RIGHT)
    }

    /// Its top at `top`.
    pub(super) fn draw(&self, top: f64) -> Markup {
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
    use super::super::slice;
    use super::*;

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
}
