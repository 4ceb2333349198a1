//! The responses as one picture: what was flown over what the gains predict, a drawing area for each unit.

use autopilot::vehicle::STEP_S;
use maud::{Markup, PreEscaped, html};

use super::{Axis, Response};
use crate::report::number;
use crate::report::style;
use crate::report::svg::{self, Point, px};
use crate::report::ticks::{self, Range};

/// User units of the whole picture.
const WIDTH: f64 = 1080.0;
const HEIGHT: f64 = 400.0;
const MARGIN: f64 = 24.0;
/// Upper edge of the drawing areas, their size, and the distance of their left edges.
const TOP: f64 = 96.0;
const AREA: [f64; 2] = [300.0, 250.0];
const PITCH: f64 = 376.0;
const FIRST_LEFT: f64 = 40.0;
/// Time shown, seconds from the step on.
const SHOWN_S: f64 = 5.0;
/// Slices of the time axis whose extremes are drawn.
const BUCKETS: usize = 150;

/// The picture as a stand-alone SVG on a light background.
pub fn picture(responses: &[Response]) -> String {
    let panels = [
        (Axis::X, "Forwards, m"),
        (Axis::Z, "Upwards, m"),
        (Axis::Yaw, "Heading, degrees"),
    ];
    let panels = panels.into_iter().enumerate().filter_map(|(index, panel)| {
        Panel::new(panel, FIRST_LEFT + PITCH * index as f64, responses)
    });
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN))
            viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(WIDTH + 2.0 * MARGIN), px(HEIGHT + 2.0 * MARGIN)))
            role="img" aria-label="Step responses" {
            style { (PreEscaped(style::figure())) }
            rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN)) {}
            text class="f-ink title" x="0" y="16" { "How the drone answers a step" }
            text class="f-muted subtitle" x="0" y="38" {
                "Solid: flown with ideal sensors. Dashed: what the gains predict. Thin: the set-point."
            }
            @for panel in panels { (panel.render()) }
        }
    }
    .into_string()
}

/// One drawing area with all steps of an axis.
struct Panel<'a> {
    title: &'static str,
    left: f64,
    responses: Vec<&'a Response>,
    y: Range,
}

impl<'a> Panel<'a> {
    /// None if there is nothing to draw.
    fn new(
        (axis, title): (Axis, &'static str),
        left: f64,
        responses: &'a [Response],
    ) -> Option<Self> {
        let responses: Vec<&Response> = responses
            .iter()
            .filter(|response| response.step.axis == axis)
            .collect();
        let values = responses
            .iter()
            .flat_map(|response| response.curves.iter().flatten().copied());
        let range = Range::of(values)?;
        let step = ticks::nice_step(range.span(), 7);
        Some(Self {
            title,
            left,
            responses,
            y: range.rounded(step),
        })
    }

    fn place(&self, time_s: f64, value: f64) -> Point {
        let [width, height] = AREA;
        let up = (value - self.y.low) / self.y.span();
        [
            self.left + time_s / SHOWN_S * width,
            TOP + (1.0 - up) * height,
        ]
    }

    fn render(&self) -> Markup {
        html! {
            text class="f-ink strong" x=(px(self.left - 30.0)) y=(px(TOP - 18.0)) { (self.title) }
            (self.grid())
            @for response in &self.responses {
                @let [flown, predicted] = &response.curves;
                @let goal = [0.0, SHOWN_S].map(|time_s| self.place(time_s, response.step.size));
                path class="hair s-soft" d=(svg::polyline(goal)) {}
                path class="line estimate s-ink" d=(self.curve(predicted)) {}
                path class="line curve s-homing" d=(self.curve(flown)) {}
            }
        }
    }

    fn curve(&self, values: &[f64]) -> String {
        let points: Vec<Point> = values
            .iter()
            .enumerate()
            .map(|(step, value)| [step as f64 * STEP_S, *value])
            .take_while(|point| point[0] <= SHOWN_S)
            .collect();
        let drawn = svg::decimate(&points, [0.0, SHOWN_S], BUCKETS);
        svg::polyline(
            drawn
                .into_iter()
                .map(|[time_s, value]| self.place(time_s, value)),
        )
    }

    /// Lines at round values, and the seconds below.
    fn grid(&self) -> Markup {
        let (values, decimals) = ticks::ticks(self.y, 7);
        let right = self.left + AREA[0];
        let bottom = TOP + AREA[1];
        html! {
            @for value in &values {
                @let y = self.place(0.0, *value)[1];
                path class="hair s-grid" d=(format!("M{} {}H{}", px(self.left), px(y), px(right))) {}
                text class="f-muted small end" x=(px(self.left - 8.0)) y=(px(y + 4.0)) { (number::fixed(*value, decimals)) }
            }
            @for second in 0..=SHOWN_S as u32 {
                text class="f-muted small middle" x=(px(self.place(f64::from(second), 0.0)[0])) y=(px(bottom + 18.0)) { (second) }
            }
            text class="f-muted small end" x=(px(right)) y=(px(bottom + 36.0)) { "seconds after the step" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steps::Step;

    #[test]
    fn every_response_is_drawn_beside_its_prediction() {
        let response = |axis, size: f64| Response {
            step: Step { axis, size },
            flown: None,
            predicted: None,
            distance: 0.0,
            tilt_deg: 0.0,
            curves: [vec![0.0, size, 1.1 * size], vec![0.0, size]],
        };
        let svg = picture(&[
            response(Axis::X, 1.0),
            response(Axis::X, 2.0),
            response(Axis::Yaw, 90.0),
        ]);
        assert_eq!(svg.matches("line curve s-homing").count(), 3);
        assert_eq!(svg.matches("line estimate s-ink").count(), 3);
        assert!(svg.contains("Forwards") && svg.contains("Heading") && !svg.contains("Upwards"));
        assert!(!svg.contains("NaN"));
    }
}
