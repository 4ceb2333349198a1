//! A drawing of the calibration: the mean picture, the edges and the band.

use maud::html;

use super::Calibrated;
use super::picture::{HEIGHT, WIDTH};
use crate::report::svg::px;

/// User units of a pixel.
const SCALE: f64 = 8.0;

/// Luma is drawn in steps of this size: equal neighbours in a row become one rectangle.
const STEP: f32 = 8.0;

/// The drawing as a stand-alone SVG.
pub fn picture(found: &Calibrated) -> String {
    let [width, height] = [WIDTH, HEIGHT].map(|pixels| SCALE * pixels as f64);
    let lens = &found.lens;
    let [x, y] = found.edges.centre.map(|coordinate| px(SCALE * coordinate));
    let edges = found.edges.rings.map(|ring| ring.radius_px);
    let band = [lens.inner_radius_px, lens.outer_radius_px].map(f64::from);
    let horizon = f64::from(lens.horizon_radius_px);
    let circle = |radius: f64, colour: &str, dashes: &str| {
        html! {
            circle cx=(x) cy=(y) r=(px(SCALE * radius)) fill="none" stroke=(colour) stroke-width="1.5" stroke-dasharray=(dashes) {}
        }
    };
    let (nose_sin, nose_cos) = libm::sincos(f64::from(lens.zero_bearing_rad));
    let nose = band.map(|radius| {
        let [x, y] = found.edges.centre;
        [
            px(SCALE * (x + radius * nose_cos)),
            px(SCALE * (y + radius * nose_sin)),
        ]
    });
    let markup = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", px(width), px(height))) font-family="sans-serif" font-size="14" {
            title { "Calibration of the lens" }
            @for (row, luma) in found.mean.luma().chunks_exact(WIDTH).enumerate() {
                @for run in runs(luma) {
                    rect x=(px(SCALE * run.from as f64)) y=(px(SCALE * row as f64))
                        width=(px(SCALE * run.length as f64 + 0.5)) height=(px(SCALE + 0.5)) fill=(run.grey()) {}
                }
            }
            @for radius in edges { (circle(radius, "#e3a500", "2 4")) }
            @for radius in band { (circle(radius, "#5b9dff", "none")) }
            (circle(horizon, "#ff6a5c", "8 4"))
            path d=(format!("M{} {}L{} {}", nose[0][0], nose[0][1], nose[1][0], nose[1][1])) stroke="#ff6a5c" stroke-width="2" {}
            circle cx=(x) cy=(y) r="3" fill="#5b9dff" {}
            text x="8" y="20" fill="#e3a500" { "visible edges" }
            text x="8" y="38" fill="#5b9dff" { "band that is unwrapped" }
            text x="8" y="56" fill="#ff6a5c" { "horizon, nose" }
        }
    };
    markup.into_string()
}

/// Pixels of one shade side by side.
struct Run {
    from: usize,
    length: usize,
    level: u8,
}

impl Run {
    fn grey(&self) -> String {
        let level = self.level;
        format!("#{level:02x}{level:02x}{level:02x}")
    }
}

fn runs(row: &[f32]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (from, luma) in row.iter().enumerate() {
        // The cast saturates.
        let level = ((luma / STEP).round() * STEP) as u8;
        match runs.last_mut() {
            Some(run) if run.level == level => run.length += 1,
            _ => runs.push(Run {
                from,
                length: 1,
                level,
            }),
        }
    }
    runs
}
