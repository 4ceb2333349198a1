//! One look as a picture: ring and spectrum above, panorama and horizon below each other.

use core::f64::consts::{PI, TAU};

use maud::{Markup, PreEscaped, html};
use nav::horizon::BEARINGS;
use nav::spectrum::STORED_FREQUENCIES;

use super::Glance;
use super::raster::Raster;
use crate::report::horizon;
use crate::report::style;
use crate::report::svg::{self, Point, px};

/// User units of the drawing, and the paper round it.
pub const WIDTH: f64 = 896.0;
pub const HEIGHT: f64 = 690.0;
const MARGIN: f64 = 20.0;

/// The ring: three units a pixel.
const RING_TOP: f64 = 58.0;
const RING_SIZE: [f64; 2] = [384.0, 288.0];
/// The spectrum beside it.
const BARS_LEFT: f64 = 452.0;
const BARS_WIDTH: f64 = WIDTH - BARS_LEFT;
const BARS_HEIGHT: f64 = 190.0;
/// The panorama: seven units a column and a row.
const PANORAMA_TOP: f64 = 384.0;
const PANORAMA_HEIGHT: f64 = 112.0;
/// The horizon below it.
const HORIZON_TOP: f64 = 524.0;
const HORIZON_HEIGHT: f64 = 140.0;

/// A look as a stand-alone SVG on a light background.
pub fn picture(world: &str, glance: &Glance) -> String {
    page("", &drawing(world, glance)).into_string()
}

/// A drawing on paper; `css` comes on top of the figures' own.
pub fn page(css: &str, content: &Markup) -> Markup {
    html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN))
            viewBox=(format!("{0} {0} {1} {2}", px(-MARGIN), px(WIDTH + 2.0 * MARGIN), px(HEIGHT + 2.0 * MARGIN)))
            role="img" aria-label="What the panoramic camera sees" {
            style { (PreEscaped(style::figure())) (PreEscaped(css)) }
            (content)
        }
    }
}

/// The picture without its page.
pub fn drawing(world: &str, glance: &Glance) -> Markup {
    html! {
        rect class="f-paper" x=(px(-MARGIN)) y=(px(-MARGIN)) width=(px(WIDTH + 2.0 * MARGIN)) height=(px(HEIGHT + 2.0 * MARGIN)) {}
        text class="f-ink title" x="0" y="14" { (world) }
        text class="f-muted subtitle" x="0" y="36" { (caption(glance)) }
        (Raster::of_frame(&glance.frame).render([0.0, RING_TOP], RING_SIZE))
        (bars(glance))
        text class="f-ink strong" x="0" y=(px(PANORAMA_TOP - 10.0)) { "Unrolled: 128 bearings, 16 elevations from 45 degrees down to -45" }
        (Raster::of_panorama(&glance.panorama, &columns()).render([0.0, PANORAMA_TOP], [WIDTH, PANORAMA_HEIGHT]))
        (lines(glance))
    }
}

/// Bearings from left to right as a viewer has them who looks ahead: behind, left, ahead, right.
fn columns() -> Vec<usize> {
    let middle = BEARINGS / 2;
    (0..BEARINGS)
        .map(|column| (middle + BEARINGS - column) % BEARINGS)
        .collect()
}

fn caption(glance: &Glance) -> String {
    let pose = &glance.moment.pose;
    let (roll, pitch, yaw) = pose.attitude.euler_angles();
    format!(
        "from x {:.2}, y {:.2}, z {:.2} m, yaw {:.0}, roll {:.0}, pitch {:.0} degrees, at {:.1} s; \
         shutter {} lines, gain {:.2}",
        pose.position_m.x,
        pose.position_m.y,
        pose.position_m.z,
        degrees(yaw),
        degrees(roll),
        degrees(pitch),
        glance.moment.time_s,
        glance.exposure.lines,
        glance.exposure.gain
    )
}

/// Whole degrees, never -0.
fn degrees(angle_rad: f32) -> f32 {
    angle_rad.to_degrees().round() + 0.0
}

/// The amplitudes of the frequencies, the stored ones in full colour, and the bytes that keep them.
fn bars(glance: &Glance) -> Markup {
    let most = glance.amplitudes.iter().copied().fold(1.0, f32::max);
    let pitch = BARS_WIDTH / glance.amplitudes.len() as f64;
    let floor = RING_TOP + 26.0 + BARS_HEIGHT;
    let bytes: Vec<String> = glance.snapshot.bytes().iter().map(i8::to_string).collect();
    html! {
        text class="f-ink strong" x=(px(BARS_LEFT)) y=(px(RING_TOP + 10.0)) { "Spectrum of the horizon, luma" }
        @for (index, amplitude) in glance.amplitudes.iter().enumerate() {
            @let height = f64::from(*amplitude / most) * (BARS_HEIGHT - 20.0);
            @let left = BARS_LEFT + pitch * index as f64;
            @let colour = if index < STORED_FREQUENCIES { "f-homing" } else { "f-soft" };
            rect class=(colour) x=(px(left + 4.0)) y=(px(floor - height)) width=(px(pitch - 8.0)) height=(px(height)) {}
            text class="f-muted small middle" x=(px(left + 0.5 * pitch)) y=(px(floor - height - 5.0)) { (format!("{amplitude:.1}")) }
            text class="f-muted small middle" x=(px(left + 0.5 * pitch)) y=(px(floor + 15.0)) { (index + 1) }
        }
        text class="f-muted small" x=(px(BARS_LEFT)) y=(px(floor + 38.0)) { "The snapshot: 16 bytes, cosines and sines of 1 to 8" }
        @for (row, half) in bytes.chunks(STORED_FREQUENCIES).enumerate() {
            @for (index, byte) in half.iter().enumerate() {
                text class="f-ink small middle" x=(px(BARS_LEFT + pitch * (index as f64 + 0.5))) y=(px(floor + 56.0 + 17.0 * row as f64)) { (byte) }
            }
        }
    }
}

/// The horizon, and what the snapshot knows of it.
fn lines(glance: &Glance) -> Markup {
    let mean = f64::from(glance.mean_luma());
    let most = glance.horizon.iter().copied().fold(1.0, f32::max);
    let place = |column, luma| place(column, luma / f64::from(1.1 * most));
    let seen = columns()
        .into_iter()
        .enumerate()
        .map(|(column, bearing)| place(column, f64::from(glance.horizon[bearing])));
    let kept = (0..BEARINGS).map(|column| {
        let bearing = PI - TAU * column as f64 / BEARINGS as f64;
        let luma = mean + horizon::luma(glance.snapshot.bytes(), bearing);
        place(column, luma)
    });
    let floor = HORIZON_TOP + HORIZON_HEIGHT;
    let names = ["behind", "left", "ahead", "right", "behind"];
    html! {
        text class="f-ink strong" x="0" y=(px(HORIZON_TOP - 8.0)) { "Horizon: what is seen, and (dashed) what 16 bytes remember" }
        path class="hair s-grid" d=(format!("M0 {}H{}", px(floor), px(WIDTH))) {}
        path class="hair s-grid" d=(svg::polyline([place(0, mean), place(BEARINGS - 1, mean)])) {}
        text class="f-muted small end" x=(px(WIDTH)) y=(px(HORIZON_TOP - 8.0)) { (format!("mean luma {mean:.0}")) }
        path class="line curve s-ink" d=(svg::polyline(seen)) {}
        path class="line odometry s-homing" d=(svg::polyline(kept)) {}
        @for (index, name) in names.into_iter().enumerate() {
            @let x = WIDTH * index as f64 / (names.len() - 1) as f64;
            @let side = match index { 0 => "", 4 => " end", _ => " middle" };
            text class=(format!("f-muted small{side}")) x=(px(x)) y=(px(floor + 15.0)) { (name) }
        }
    }
}

/// A column's place at a share of the diagram's height.
fn place(column: usize, share: f64) -> Point {
    [
        (column as f64 + 0.5) * WIDTH / BEARINGS as f64,
        HORIZON_TOP + HORIZON_HEIGHT * (1.0 - share.clamp(0.0, 1.0)),
    ]
}
