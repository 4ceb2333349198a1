//! What a snapshot remembers, for the eye: the horizon its coefficients stand for.

use core::f64::consts::{PI, TAU};

use maud::{Markup, html};
use nav::snapshot::COUNT_LUMA;

use super::svg::{self, px};

/// Points of the curve and shades of the strip.
const SAMPLES: usize = 48;

/// Size of the curve, user units.
const WIDTH: f64 = 140.0;
const HEIGHT: f64 = 44.0;

/// Luma of the remembered horizon relative to its mean, at a bearing counter-clockwise from north
/// in radians. Coefficients are a_1..a_K, b_1..b_K in counts.
pub fn luma(coefficients: &[i8], bearing: f64) -> f64 {
    let (a, b) = coefficients.split_at(coefficients.len() / 2);
    let mut sum = 0.0;
    for (index, ((a, b), amplitude)) in a.iter().zip(b).zip(COUNT_LUMA).enumerate() {
        let angle = (index + 1) as f64 * bearing;
        sum += f64::from(amplitude)
            * (f64::from(*a) * libm::cos(angle) + f64::from(*b) * libm::sin(angle));
    }
    sum
}

/// The horizon from south over west, north and east to south, as a viewer facing north has it.
fn samples(coefficients: &[i8]) -> Vec<f64> {
    (0..SAMPLES)
        .map(|index| PI - TAU * (index as f64 + 0.5) / SAMPLES as f64)
        .map(|bearing| luma(coefficients, bearing))
        .collect()
}

/// Largest deviation from the mean over all snapshots, so that they share one scale.
pub fn largest_deviation<'a>(snapshots: impl IntoIterator<Item = &'a [i8]>) -> f64 {
    let deviations = snapshots.into_iter().flat_map(samples).map(f64::abs);
    deviations.fold(1.0, f64::max)
}

/// A strip of greys and the curve above it; `full` is the deviation that is black or white.
pub fn glyph(coefficients: &[i8], full: f64) -> Markup {
    let samples = samples(coefficients);
    let step = WIDTH / SAMPLES as f64;
    let place = |(index, luma): (usize, &f64)| {
        [
            (index as f64 + 0.5) * step,
            HEIGHT / 2.0 * (1.0 - 0.94 * luma / full),
        ]
    };
    let curve = svg::polyline(samples.iter().enumerate().map(place));
    let middle = px(HEIGHT / 2.0);
    html! {
        svg viewBox=(format!("0 0 {} {}", px(WIDTH), px(HEIGHT))) preserveAspectRatio="none" {
            path class="hair s-grid" d=(format!("M0 {middle}H{0}M{1} 0V{2}", px(WIDTH), px(WIDTH / 2.0), px(HEIGHT))) {}
            path class="line curve s-ink" d=(curve) {}
        }
        div style=(format!("background:linear-gradient(90deg,{})", shades(&samples, full))) {}
    }
}

fn shades(samples: &[f64], full: f64) -> String {
    let shade = |luma: &f64| {
        let grey = (127.5 + 127.5 * luma / full).clamp(0.0, 255.0) as u8;
        format!("#{grey:02x}{grey:02x}{grey:02x}")
    };
    samples.iter().map(shade).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    // The steps are single precision: six figures.
    #[test]
    fn one_count_of_frequency_k_has_the_published_amplitude() {
        let mut coefficients = [0_i8; 16];
        coefficients[0] = 10;
        assert!((luma(&coefficients, 0.0) - 6.0).abs() < 1e-6);
        coefficients[0] = 0;
        coefficients[2] = 10;
        assert!((luma(&coefficients, 0.0) - 6.0 * 0.826 * 0.826).abs() < 1e-6);
    }

    #[test]
    fn the_first_sine_is_bright_in_the_west() {
        let mut coefficients = [0_i8; 16];
        coefficients[8] = 10;
        assert!((luma(&coefficients, PI / 2.0) - 6.0).abs() < 1e-6);
        assert!(luma(&coefficients, 0.0).abs() < 1e-12);
    }
}
