//! What is painted on the arena's surfaces: canvases with landscapes, doors, windows, grass, lamps.
//!
//! All of it is drawn from a seed; nothing is photographed, so nothing has a licence. Lengths are
//! in metres, brightness in reflectance.

use super::between;
use super::canvas::{Area, Canvas, Sheet};
use crate::random::Normal;

/// Width of a place for one canvas along a wall, in metres.
const PLACE_M: f32 = 2.0;
/// Reflectance of the hall behind the canvases.
const HALL: f32 = 0.10;
/// Reflectance of the grass.
const GRASS: f32 = 0.17;
/// Reflectance of the roof.
const ROOF: f32 = 0.05;
/// Log-contrast per octave of the printed scenes: with what is painted on them, eight octaves make
/// the standard deviation of 0.7 or so in log-luminance that photographs of nature show.
const NATURAL: f32 = 0.24;

/// Artificial grass: fine noise, almost even at a distance.
pub fn grass(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, GRASS);
    canvas.weather(noise, contrast.unwrap_or(0.08));
    canvas
}

/// A dark roof with rows of lamps.
pub fn roof(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, ROOF);
    canvas.weather(noise, contrast.unwrap_or(0.1));
    for (row, column) in (0..3).flat_map(|row| (0..4).map(move |column| (row, column))) {
        let lamp = Area {
            u: 1.5 + 3.0 * row as f32,
            v: 1.0 + 2.4 * column as f32,
            width: 0.4,
            height: 1.4,
        };
        canvas.fill(lamp, 0.9);
    }
    canvas
}

/// A side of the arena: the hall with its windows, and before it a row of canvases and doors.
pub fn wall(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let width = sheet.width_m;
    let mut canvas = Canvas::new(sheet, HALL);
    windows(&mut canvas, noise, width);
    let places = (width / PLACE_M) as usize;
    for place in 0..places {
        let picture_width = between(noise, 1.5, 1.95);
        let area = Area {
            u: PLACE_M * place as f32 + between(noise, 0.0, PLACE_M - picture_width),
            v: 0.0,
            width: picture_width,
            height: between(noise, 2.2, 3.2),
        };
        let brightness = between(noise, 0.4, 1.4);
        if noise.uniform() < 0.8 {
            scene(&mut canvas, noise, area, brightness);
        } else {
            door(&mut canvas, noise, area, brightness);
        }
    }
    canvas.weather(noise, contrast.unwrap_or(NATURAL));
    canvas
}

/// One side of a free-standing panel.
pub fn screen(noise: &mut Normal, sheet: &Sheet, contrast: Option<f32>) -> Canvas {
    let mut canvas = Canvas::new(sheet, HALL);
    let area = sheet.area();
    let brightness = between(noise, 0.4, 1.4);
    scene(&mut canvas, noise, area, brightness);
    canvas.weather(noise, contrast.unwrap_or(NATURAL));
    canvas
}

/// A band of windows high up in the hall's wall, some of them with blinds down.
fn windows(canvas: &mut Canvas, noise: &mut Normal, wall_width: f32) {
    let sill = between(noise, 3.8, 4.6);
    let mut u = between(noise, 0.2, 1.2);
    while u < wall_width - 1.0 {
        let width = between(noise, 0.8, 2.0);
        let area = Area {
            u,
            v: sill,
            width,
            height: between(noise, 1.0, 1.8),
        };
        canvas.fill(area, between(noise, 0.15, 0.8));
        u += width + between(noise, 0.2, 1.5);
    }
}

/// A landscape printed on canvas: sky, a line of hills, meadow, and trees before them.
fn scene(canvas: &mut Canvas, noise: &mut Normal, area: Area, brightness: f32) {
    let skyline = between(noise, 0.3, 0.6);
    let sky = between(noise, 0.35, 0.65) * brightness;
    let meadow = between(noise, 0.12, 0.3) * brightness;
    canvas.paint(area, |_, y, _| {
        if y > skyline {
            sky * (0.7 + 0.6 * (y - skyline))
        } else {
            meadow * (0.8 + 0.6 * y)
        }
    });
    let trees = 1 + (3.0 * noise.uniform()) as usize;
    for _ in 0..trees {
        tree(canvas, noise, area, brightness);
    }
}

/// A crown on a trunk, within the picture at `area`.
fn tree(canvas: &mut Canvas, noise: &mut Normal, area: Area, brightness: f32) {
    let shade = between(noise, 0.05, 0.2) * brightness;
    let width = between(noise, 0.3, 0.7) * area.width;
    let height = between(noise, 0.35, 0.6) * area.height;
    let crown = Area {
        u: area.u + between(noise, 0.0, area.width - width),
        v: area.v + between(noise, 0.3, 0.95) * (area.height - height),
        width,
        height,
    };
    let trunk = Area {
        u: crown.u + 0.45 * width,
        v: area.v + 0.05 * area.height,
        width: 0.1 * width,
        height: crown.v - area.v,
    };
    canvas.fill(trunk, 0.6 * shade);
    canvas.fill_ellipse(crown, shade);
}

/// A door in the hall's wall with a notice on it.
fn door(canvas: &mut Canvas, noise: &mut Normal, area: Area, brightness: f32) {
    let leaf = Area {
        u: area.u + 0.3,
        width: 0.95,
        height: 2.1,
        ..area
    };
    let frame = Area {
        u: leaf.u - 0.08,
        width: leaf.width + 0.16,
        height: leaf.height + 0.08,
        ..leaf
    };
    let notice = Area {
        u: leaf.u + between(noise, 0.1, 0.5),
        v: between(noise, 1.2, 1.5),
        width: 0.3,
        height: 0.42,
    };
    canvas.fill(frame, 0.5 * brightness);
    canvas.fill(leaf, 0.25 * brightness);
    canvas.fill(notice, 0.8 * brightness);
}
