//! Catchment area and area per byte over the bytes of a snapshot, by method.

use maud::{Markup, html};

use super::super::measure::Row;
use super::super::settings::Method;
use super::page;
use crate::report::number;
use crate::report::svg::{self, Point, px};
use crate::report::ticks::{Range, ticks};

/// User units: upper edge and size of the drawing areas, their left edges, the whole picture.
const TOP: f64 = 96.0;
const AREA: [f64; 2] = [380.0, 270.0];
const LEFTS: [f64; 2] = [40.0, 480.0];
const SIZE: [f64; 2] = [860.0, 410.0];
/// Ticks of the value axis at most.
const TICKS: usize = 6;

/// Colour and dashes of a method.
fn look(method: Method) -> (&'static str, &'static str) {
    match method {
        Method::Fourier => ("homing", "none"),
        Method::Search => ("outbound", "none"),
        Method::SearchFull => ("outbound", "5 3"),
        Method::Mfdid => ("odometry", "none"),
        Method::Warp => ("uncorrected", "5 3"),
        Method::Default => ("ink", "none"),
    }
}

/// The picture of one place's rows under one condition.
pub fn picture(rows: &[Row]) -> String {
    let mut methods: Vec<Method> = Vec::new();
    for row in rows {
        if !methods.contains(&row.method) {
            methods.push(row.method);
        }
    }
    let first = rows.first();
    let areas = Panel::new("Catchment area, m²", LEFTS[0], rows, |row| {
        [row.area_m2, row.stderr_m2]
    });
    let per_byte = Panel::new("Area per byte, m²", LEFTS[1], rows, |row| {
        [row.area_per_byte, row.stderr_m2 / f64::from(row.bytes)]
    });
    let content = html! {
        @if let Some(row) = first {
            text class="f-ink title" x="0" y="16" { (row.world) ", condition " (row.condition) }
            text class="f-muted subtitle" x="0" y="38" {
                "From where a run ends within 0.5 m: mean and standard error over " (row.snapshots) " snapshots"
            }
        }
        @for panel in [areas, per_byte].into_iter().flatten() {
            (panel.frame())
            @for method in &methods { (panel.curve(rows, *method)) }
        }
        @for (index, method) in methods.iter().enumerate() { (key(index, *method)) }
    };
    page(SIZE, "Catchment area over bytes", &content)
}

/// One drawing area. The bytes are logarithmic.
struct Panel {
    title: &'static str,
    left: f64,
    sizes: Vec<u8>,
    x: Range,
    y: Range,
    /// And its error.
    value: fn(&Row) -> [f64; 2],
}

impl Panel {
    /// None if there is nothing to draw.
    fn new(
        title: &'static str,
        left: f64,
        rows: &[Row],
        value: fn(&Row) -> [f64; 2],
    ) -> Option<Self> {
        let mut sizes: Vec<u8> = rows.iter().map(|row| row.bytes).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let tops = rows.iter().map(|row| value(row).iter().sum());
        let x = Range::of(sizes.iter().map(|bytes| libm::log2(f64::from(*bytes))))?;
        Some(Self {
            title,
            left,
            sizes,
            x: Range {
                low: x.low - 0.15,
                high: x.high + 0.15,
            },
            y: Range::of(tops)?.with(0.0),
            value,
        })
    }

    fn x(&self, bytes: u8) -> f64 {
        let share = (libm::log2(f64::from(bytes)) - self.x.low) / self.x.span();
        self.left + share * AREA[0]
    }

    fn y(&self, value: f64) -> f64 {
        TOP + (1.0 - (value - self.y.low) / self.y.span()) * AREA[1]
    }

    fn frame(&self) -> Markup {
        let (steps, decimals) = ticks(self.y, TICKS);
        let bottom = TOP + AREA[1];
        html! {
            text class="f-ink strong" x=(px(self.left - 40.0)) y=(px(TOP - 14.0)) { (self.title) }
            @for value in steps {
                @let y = self.y(value);
                path class="hair s-grid" d=(format!("M{} {}h{}", px(self.left), px(y), px(AREA[0]))) {}
                text class="f-muted small end" x=(px(self.left - 6.0)) y=(px(y + 4.0)) { (number::fixed(value, decimals)) }
            }
            path class="axis s-soft" d=(format!("M{} {}h{}", px(self.left), px(bottom), px(AREA[0]))) {}
            @for bytes in &self.sizes {
                text class="f-muted small middle" x=(px(self.x(*bytes))) y=(px(bottom + 16.0)) { (bytes) }
            }
            text class="f-muted small middle" x=(px(self.left + 0.5 * AREA[0])) y=(px(bottom + 34.0)) { "bytes of a snapshot" }
        }
    }

    fn curve(&self, rows: &[Row], method: Method) -> Markup {
        let (colour, dashes) = look(method);
        let mut points: Vec<(u8, [f64; 2])> = rows
            .iter()
            .filter(|row| row.method == method)
            .map(|row| (row.bytes, (self.value)(row)))
            .collect();
        points.sort_by_key(|(bytes, _)| *bytes);
        let line = points
            .iter()
            .map(|(bytes, [value, _])| -> Point { [self.x(*bytes), self.y(*value)] });
        let bars: String = points
            .iter()
            .map(|(bytes, [value, error])| {
                let ends = [value - error, value + error].map(|end| [self.x(*bytes), self.y(end)]);
                svg::polyline(ends)
            })
            .collect();
        html! {
            path class=(format!("line s-{colour}")) stroke-width="0.8" opacity="0.6" d=(bars) {}
            path class=(format!("line s-{colour}")) stroke-width="2" stroke-dasharray=(dashes) d=(svg::polyline(line.clone())) {}
            @for [x, y] in line {
                circle class=(format!("f-{colour}")) cx=(px(x)) cy=(px(y)) r="2.6" {}
            }
        }
    }
}

fn key(index: usize, method: Method) -> Markup {
    let (colour, dashes) = look(method);
    let left = 110.0 * index as f64;
    html! {
        path class=(format!("line s-{colour}")) stroke-width="2" stroke-dasharray=(dashes) d=(format!("M{} 58h22", px(left))) {}
        text class="f-ink small" x=(px(left + 28.0)) y="62" { (method) }
    }
}
