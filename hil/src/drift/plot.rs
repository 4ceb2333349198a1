//! The table as a picture: errors over distance, both logarithmic, beside the firmware's own filter.

use maud::{Markup, PreEscaped, html};

use super::{Published, Row, accepted};
use crate::report::number;
use crate::report::style;
use crate::report::svg::{self, Point, px};
use crate::report::ticks::Range;

/// User units of the whole picture.
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 430.0;
const MARGIN: f64 = 24.0;
/// Upper edge of the drawing areas, and their size.
const TOP: f64 = 104.0;
const AREA: [f64; 2] = [390.0, 260.0];
/// Left edges of the two drawing areas.
const LEFTS: [f64; 2] = [46.0, 546.0];
/// Space between the outermost values and the frame, decades.
const PADDING_DECADES: f64 = 0.08;

/// One of the three errors.
struct Curve {
    label: &'static str,
    colour: &'static str,
    value: fn(&Row) -> f64,
    published: fn(&Published) -> Reference,
}

/// What the firmware's filter made of it.
struct Reference {
    value: f64,
    /// Between which figures ours agrees with it.
    accepted: [f64; 2],
}

const CROSS: Curve = Curve {
    label: "across",
    colour: "homing",
    value: |row| row.cross_rms_m * 100.0,
    published: |published| Reference {
        value: published.cross_rms_m * 100.0,
        accepted: published.cross_accepted_m.map(|end| end * 100.0),
    },
};
const ALONG: Curve = Curve {
    label: "along",
    colour: "outbound",
    value: |row| row.along_rms_m * 100.0,
    published: |published| Reference {
        value: published.along_rms_m * 100.0,
        accepted: accepted(published.along_rms_m * 100.0),
    },
};
const YAW: Curve = Curve {
    label: "heading",
    colour: "uncorrected",
    value: |row| row.yaw_rms_rad.to_degrees(),
    published: |published| Reference {
        value: published.yaw_rms_rad.to_degrees(),
        accepted: accepted(published.yaw_rms_rad.to_degrees()),
    },
};

/// The picture as a stand-alone SVG on a light background.
pub fn picture(rows: &[Row]) -> String {
    let seeds = rows.first().map_or(0, |row| row.seeds);
    let position = Panel::new("Position error, RMS, cm", LEFTS[0], &[CROSS, ALONG], rows);
    let heading = Panel::new("Heading error, RMS, degrees", LEFTS[1], &[YAW], rows);
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN))
            viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(WIDTH + 2.0 * MARGIN), px(HEIGHT + 2.0 * MARGIN)))
            role="img" aria-label="Drift of the filter over distance" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN)) {}
            text class="f-ink title" x="0" y="16" { "How far dead reckoning strays" }
            text class="f-muted subtitle" x="0" y="38" {
                (seeds) " flights straight on at 0.5 m/s and 0.5 m. Circles: the firmware's own filter, and what counts as agreeing with it."
            }
            @for panel in [position, heading].into_iter().flatten() { (panel.render()) }
        }
    }
    .into_string()
}

/// One drawing area with its curves.
struct Panel<'a> {
    title: &'static str,
    left: f64,
    curves: &'a [Curve],
    rows: &'a [Row],
    /// Decades along both axes.
    x: Range,
    y: Range,
}

impl<'a> Panel<'a> {
    /// None if there is nothing to draw.
    fn new(title: &'static str, left: f64, curves: &'a [Curve], rows: &'a [Row]) -> Option<Self> {
        let padded = |range: Range| Range {
            low: range.low - PADDING_DECADES,
            high: range.high + PADDING_DECADES,
        };
        let values = curves.iter().flat_map(|curve| {
            let ours = rows.iter().map(|row| (curve.value)(row));
            let theirs = rows
                .iter()
                .filter_map(|row| Published::at(row.distance_m))
                .flat_map(|published| (curve.published)(published).accepted);
            ours.chain(theirs)
        });
        Some(Self {
            title,
            left,
            curves,
            rows,
            x: padded(Range::of(
                rows.iter().map(|row| libm::log10(row.distance_m)),
            )?),
            y: padded(Range::of(values.map(libm::log10))?),
        })
    }

    fn place(&self, distance_m: f64, value: f64) -> Point {
        let [width, height] = AREA;
        let along = (libm::log10(distance_m) - self.x.low) / self.x.span();
        let up = (libm::log10(value) - self.y.low) / self.y.span();
        [self.left + along * width, TOP + (1.0 - up) * height]
    }

    fn render(&self) -> Markup {
        html! {
            text class="f-ink strong" x=(px(self.left - 46.0)) y=(px(TOP - 22.0)) { (self.title) }
            (self.grid())
            @for (index, curve) in self.curves.iter().enumerate() {
                (self.curve(curve))
                (self.key(curve, index))
            }
        }
    }

    /// Lines at 1, 2 and 5 of each decade, and a label under every distance.
    fn grid(&self) -> Markup {
        let [left, right] = [self.left, self.left + AREA[0]];
        let bottom = TOP + AREA[1];
        let height = |value: f64| self.place(1.0, value)[1];
        html! {
            @for (value, decimals) in round_values(self.y) {
                path class="hair s-grid" d=(format!("M{} {}H{}", px(left), px(height(value)), px(right))) {}
                text class="f-muted small end" x=(px(left - 8.0)) y=(px(height(value) + 4.0)) { (number::fixed(value, decimals)) }
            }
            @for row in self.rows {
                text class="f-muted small middle" x=(px(self.place(row.distance_m, 1.0)[0])) y=(px(bottom + 18.0)) {
                    (number::trimmed(row.distance_m, 1))
                }
            }
            text class="f-muted small end" x=(px(right)) y=(px(bottom + 36.0)) { "distance flown, m" }
        }
    }

    fn curve(&self, curve: &Curve) -> Markup {
        let points = self
            .rows
            .iter()
            .map(|row| self.place(row.distance_m, (curve.value)(row)));
        let published = self
            .rows
            .iter()
            .filter_map(|row| Published::at(row.distance_m));
        html! {
            @for published in published {
                @let reference = (curve.published)(published);
                @let [low, high] = reference.accepted.map(|end| self.place(published.distance_m, end));
                @let [x, y] = self.place(published.distance_m, reference.value);
                path class=(format!("line s-{}", curve.colour)) stroke-width="6" stroke-opacity=".22"
                    d=(svg::polyline([low, high])) {}
                circle class=(format!("f-paper s-{}", curve.colour)) stroke-width="1.3" cx=(px(x)) cy=(px(y)) r="4" {}
            }
            path class=(format!("line curve s-{}", curve.colour)) d=(svg::polyline(points.clone())) {}
            @for point in points {
                circle class=(format!("f-{}", curve.colour)) cx=(px(point[0])) cy=(px(point[1])) r="2.2" {}
            }
        }
    }

    /// What the colour means, above the area's right edge.
    fn key(&self, curve: &Curve, index: usize) -> Markup {
        let right = self.left + AREA[0] - 84.0 * (self.curves.len() - 1 - index) as f64;
        html! {
            g transform=(format!("translate({} {})", px(right), px(TOP - 22.0))) {
                path class=(format!("line curve s-{}", curve.colour)) d="M-74 -4h22" {}
                text class="f-muted small" x="-47" { (curve.label) }
            }
        }
    }
}

/// 1, 2 and 5 times the powers of ten inside a range of decades, each with the decimals it needs.
fn round_values(decades: Range) -> Vec<(f64, usize)> {
    let [first, last] = [decades.low, decades.high].map(|end| libm::floor(end) as i32);
    (first..=last)
        .flat_map(|exponent| {
            let power = libm::pow(10.0, f64::from(exponent));
            let decimals = usize::try_from(-exponent).unwrap_or(0);
            [1.0, 2.0, 5.0].map(|factor| (factor * power, decimals))
        })
        .filter(|(value, _)| decades.contains(libm::log10(*value)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(distance_m: f64, cross_rms_m: f64) -> Row {
        Row {
            distance_m,
            cross_rms_m,
            along_rms_m: 0.2,
            yaw_rms_rad: 0.02,
            seeds: 7,
        }
    }

    #[test]
    fn round_values_are_one_two_and_five_of_each_decade() {
        let decades = Range {
            low: libm::log10(0.4),
            high: libm::log10(22.0),
        };
        let expected = [(0.5, 1), (1.0, 0), (2.0, 0), (5.0, 0), (10.0, 0), (20.0, 0)];
        for (found, expected) in round_values(decades).iter().zip(expected) {
            assert!((found.0 - expected.0).abs() < 1e-9 && found.1 == expected.1);
        }
        assert_eq!(round_values(decades).len(), expected.len());
    }

    #[test]
    fn every_row_is_drawn_and_the_reference_where_there_is_one() {
        let svg = picture(&[row(5.0, 0.13), row(7.0, 0.2)]);
        // Three errors: two own points each, one reference each at 5 m.
        assert_eq!(svg.matches("r=\"2.2\"").count(), 6);
        assert_eq!(svg.matches("r=\"4\"").count(), 3);
        assert!(svg.contains("7 flights"));
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn an_empty_table_is_an_empty_picture() {
        assert!(!picture(&[]).contains("circle"));
    }
}
