//! How often a frame took so many cycles. The count axis is logarithmic: one late frame among
//! thousands is what matters.

use maud::{Markup, html};

use super::number;
use super::svg::px;
use super::ticks::{self, Range};
use crate::summary::CyclesPerFrame;

const WIDTH: f64 = 1048.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 14.0;
/// Room for the title and three rows of labels.
const TOP: f64 = 76.0;
const HEIGHT: f64 = 170.0;
const BOTTOM: f64 = 44.0;

/// Most bins; their width is a round number.
const MOST_BINS: usize = 140;

/// Where values are on the paper.
struct Scales {
    x: Range,
    /// Decades of the count axis.
    decades: f64,
}

impl Scales {
    fn x(&self, cycles: f64) -> f64 {
        LEFT + (cycles - self.x.low) / self.x.span() * (WIDTH - LEFT - RIGHT)
    }

    /// Zero at the bottom, one frame at a third of a decade above it.
    fn y(&self, count: f64) -> f64 {
        const ONE: f64 = 1.0 / 3.0;
        let height = if count < 1.0 {
            0.0
        } else {
            ONE + libm::log10(count)
        };
        TOP + HEIGHT * (1.0 - height / (ONE + self.decades))
    }
}

/// User units of a histogram: width and height.
pub const SIZE: [f64; 2] = [WIDTH, TOP + HEIGHT + BOTTOM];

/// What a histogram says of itself.
#[derive(Clone, Copy, Debug)]
pub struct Words<'w> {
    /// Above it.
    pub title: &'w str,
    /// At the axis of cycles.
    pub axis: &'w str,
    /// In its place, where there are no frames.
    pub nothing: &'w str,
}

/// Values of the lines that are drawn across a histogram, cycles.
#[derive(Clone, Copy, Debug)]
pub struct Lines {
    /// Median.
    pub p50: u32,
    /// 99th percentile.
    pub p99: u32,
    /// Largest.
    pub max: u32,
}

/// The histogram of all frames, with the quantiles of the summary.
pub fn render(cycles: &[u32], quantiles: Option<CyclesPerFrame>) -> Markup {
    let view_box = format!("0 0 {} {}", px(SIZE[0]), px(SIZE[1]));
    let lines = quantiles.map(|CyclesPerFrame { p50, p99, max, .. }| Lines { p50, p99, max });
    let words = Words {
        title: "Histogram of cycles per frame",
        axis: "cycles from frame to spectrum",
        nothing: "No processor was emulated.",
    };
    html! {
        svg viewBox=(view_box) role="img" aria-label=(words.title) {
            (panel(words, cycles, lines))
        }
    }
}

/// A histogram of cycles, one value a frame, at the origin.
pub fn panel(words: Words, cycles: &[u32], lines: Option<Lines>) -> Markup {
    let range = Range::of(cycles.iter().map(|cycles| f64::from(*cycles)));
    html! {
        text class="f-ink strong" x="0" y="16" { (words.title) }
        @match range {
            Some(range) => (body(words, cycles, range, lines)),
            None => text class="f-soft" x=(px(LEFT)) y="44" { (words.nothing) },
        }
    }
}

fn body(words: Words, cycles: &[u32], range: Range, lines: Option<Lines>) -> Markup {
    let step = ticks::nice_step(range.span(), MOST_BINS);
    let x = range.rounded(step);
    let counts = bins(cycles, x, step);
    let most = counts.iter().copied().max().unwrap_or(1);
    let scales = Scales {
        x,
        decades: libm::log10(most as f64).max(1.0),
    };
    let bars: String = counts
        .iter()
        .enumerate()
        .filter(|(_, count)| **count > 0)
        .map(|(index, count)| bar(&scales, x.low + index as f64 * step, step, *count))
        .collect();
    html! {
        (count_axis(&scales))
        path class="f-homing" d=(bars) {}
        (cycle_axis(&scales, words.axis))
        @if let Some(lines) = lines { (quantile_lines(&scales, lines)) }
    }
}

/// Frames per bin; the last bin is closed.
fn bins(cycles: &[u32], x: Range, step: f64) -> Vec<usize> {
    let bins = libm::round(x.span() / step).max(1.0) as usize;
    let mut counts = vec![0; bins];
    for cycles in cycles {
        let bin = ((f64::from(*cycles) - x.low) / step) as usize;
        counts[bin.min(bins - 1)] += 1;
    }
    counts
}

fn bar(scales: &Scales, from: f64, step: f64, count: usize) -> String {
    let (left, right) = (scales.x(from) + 0.5, scales.x(from + step) - 0.5);
    let (top, bottom) = (scales.y(count as f64), scales.y(0.0));
    format!(
        "M{} {}V{}H{}V{}z",
        px(left),
        px(bottom),
        px(top),
        px(right),
        px(bottom)
    )
}

fn count_axis(scales: &Scales) -> Markup {
    let decades = 0..=libm::floor(scales.decades + 1e-9) as u32;
    let counts: Vec<u64> = decades.map(|decade| 10_u64.pow(decade)).collect();
    html! {
        @for count in counts {
            @let y = scales.y(count as f64);
            path class="hair s-grid" d=(format!("M{} {}H{}", px(LEFT), px(y), px(WIDTH - RIGHT))) {}
            text class="f-muted small end" x=(px(LEFT - 8.0)) y=(px(y + 4.0)) { (number::grouped(count)) }
        }
        text class="f-muted small middle" transform=(format!("translate(11 {}) rotate(-90)", px(TOP + HEIGHT / 2.0))) {
            "frames, log scale"
        }
    }
}

fn cycle_axis(scales: &Scales, name: &str) -> Markup {
    let (values, _) = ticks::ticks(scales.x, 9);
    let bottom = TOP + HEIGHT;
    html! {
        path class="axis s-muted" d=(format!("M{} {}H{}", px(LEFT), px(bottom), px(WIDTH - RIGHT))) {}
        @for value in values {
            path class="axis s-muted" d=(format!("M{} {}v4", px(scales.x(value)), px(bottom))) {}
            text class="f-muted small middle" x=(px(scales.x(value))) y=(px(bottom + 19.0)) {
                (number::grouped(value as u64))
            }
        }
        text class="f-muted small end" x=(px(WIDTH - RIGHT)) y=(px(bottom + 37.0)) { (name) }
    }
}

/// Each quantile has a row of its own for its label, so that labels never meet.
fn quantile_lines(scales: &Scales, lines: Lines) -> Markup {
    let rows = [("p50", lines.p50), ("p99", lines.p99), ("max", lines.max)];
    html! {
        @for (row, (name, cycles)) in rows.into_iter().enumerate() {
            @let x = scales.x(f64::from(cycles)).clamp(LEFT, WIDTH - RIGHT);
            @let y = 38.0 + 15.0 * row as f64;
            @let (class, offset) = if x > WIDTH / 2.0 { ("f-ink s-paper halo small end", -5.0) } else { ("f-ink s-paper halo small", 5.0) };
            path class="level s-ink" d=(format!("M{} {}V{}", px(x), px(y - 9.0), px(TOP + HEIGHT))) {}
            text class=(class) x=(px(x + offset)) y=(px(y)) { (name) " " (number::grouped(u64::from(cycles))) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_falls_into_a_bin_also_the_slowest() {
        let range = Range {
            low: 0.0,
            high: 30.0,
        };
        assert_eq!(bins(&[0, 9, 10, 29, 30], range, 10.0), [2, 1, 2]);
    }
}
