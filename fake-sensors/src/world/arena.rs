//! The flight arena: 10 x 10 x 7 m in a dark hall, canvas panels with mostly natural scenes along
//! its sides, artificial grass; for the U and S routes, panels in the middle as well (van Dijk et
//! al. 2024, experimental setup).

use nalgebra::Vector3;

use super::canvas::{Area, Canvas};
use super::surface::Surface;
use super::texture::Texture;
use super::{PlanLine, Structure, World};
use crate::random::Normal;

/// A point on the floor: x north, y west, in metres.
type Point = [f32; 2];

/// The arena's south-east corner. The U route spans x -5..0 and y -4..0 and the S route y -5..0:
/// both stay 2 m clear of the walls.
const SOUTH_EAST: Point = [-7.5, -7.0];
/// Edge length of the floor in metres.
const SIDE_M: f32 = 10.0;
/// Height of the ceiling in metres.
const CEILING_M: f32 = 7.0;
/// Height of the panels in the middle in metres: seen from 0.5 m up and the nearest leg, they fill
/// the optic's upper half.
const PANEL_HEIGHT_M: f32 = 2.4;

/// The ends of a row of panels between the two long legs of the U route, set up like a folding
/// screen: 1.85 m clear of either leg, 0.9 m of the leg that joins them.
pub(super) const U_ROUTE_PANELS: [Point; 4] =
    [[-4.1, -2.15], [-2.5, -1.85], [-0.9, -2.15], [0.7, -1.85]];

/// How bright the four sides of the hall are, in order: daylight comes from one of them. The
/// seed turns the order.
const SIDE_LIGHT: [f32; 4] = [1.8, 1.1, 0.6, 1.3];
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

/// Builds the arena, with panels between consecutive `panel_ends`.
pub(super) fn build(seed: u64, panel_ends: &[Point]) -> World {
    let mut surfaces = Vec::new();
    let mut plan = Vec::new();
    let mut stream = 0..;
    let mut noise = || Normal::new(seed, stream.next().unwrap_or(u64::MAX));

    let daylight_from = (4.0 * noise().uniform()) as usize;
    let [south, east] = SOUTH_EAST;
    let (north, west) = (south + SIDE_M, east + SIDE_M);
    // Clockwise, so that the room lies to the right of every wall.
    let corners = [[north, west], [north, east], [south, east], [south, west]];
    for side in 0..4 {
        let (from, to) = (corners[side], corners[(side + 1) % 4]);
        let light = SIDE_LIGHT[(side + daylight_from) % 4];
        let picture = wall(&mut noise()).lit_by(light);
        surfaces.push(upright(from, to, CEILING_M, picture));
        plan.push(line(Structure::Wall, from, to));
    }
    for ends in panel_ends.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let width = length(from, to);
        for (from, to) in [(from, to), (to, from)] {
            let picture = screen(&mut noise(), width).lit_by(1.2);
            surfaces.push(upright(from, to, PANEL_HEIGHT_M, picture));
        }
        plan.push(line(Structure::Panel, from, to));
    }
    surfaces.push(floor(&mut noise()));
    surfaces.push(ceiling(&mut noise()));
    World {
        surfaces: surfaces.into(),
        plan: plan.into(),
    }
}

fn line(structure: Structure, from_m: Point, to_m: Point) -> PlanLine {
    PlanLine {
        structure,
        from_m,
        to_m,
    }
}

fn length(from: Point, to: Point) -> f32 {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    (x * x + y * y).sqrt()
}

/// A vertical surface, visible to those who see `from` on their left.
fn upright(from: Point, to: Point, height_m: f32, picture: Texture) -> Surface {
    let width_m = length(from, to);
    let along = Vector3::new(to[0] - from[0], to[1] - from[1], 0.0) / width_m;
    let corner = Vector3::new(from[0], from[1], 0.0);
    let up = Vector3::z();
    Surface::new(corner, (along, width_m), (up, height_m), picture)
}

fn floor(noise: &mut Normal) -> Surface {
    let mut grass = Canvas::new(SIDE_M, SIDE_M, GRASS);
    grass.weather(noise, 0.08);
    let corner = Vector3::new(SOUTH_EAST[0], SOUTH_EAST[1], 0.0);
    let (x, y) = (Vector3::x(), Vector3::y());
    Surface::new(corner, (x, SIDE_M), (y, SIDE_M), grass.lit_by(1.0))
}

/// A dark roof with rows of lamps.
fn ceiling(noise: &mut Normal) -> Surface {
    let mut roof = Canvas::new(SIDE_M, SIDE_M, ROOF);
    roof.weather(noise, 0.1);
    for row in 0..3 {
        for column in 0..4 {
            let lamp = Area {
                u: 1.5 + 3.0 * row as f32,
                v: 1.0 + 2.4 * column as f32,
                width: 0.4,
                height: 1.4,
            };
            roof.fill(lamp, 0.9);
        }
    }
    let corner = Vector3::new(SOUTH_EAST[0], SOUTH_EAST[1], CEILING_M);
    let (x, y) = (Vector3::x(), Vector3::y());
    Surface::new(corner, (y, SIDE_M), (x, SIDE_M), roof.lit_by(1.0))
}

/// A number in `low..high`.
fn between(noise: &mut Normal, low: f32, high: f32) -> f32 {
    low + (high - low) * noise.uniform() as f32
}

/// A side of the arena: the hall with its windows, and before it a row of canvases and doors.
fn wall(noise: &mut Normal) -> Canvas {
    let mut canvas = Canvas::new(SIDE_M, CEILING_M, HALL);
    windows(&mut canvas, noise);
    let places = (SIDE_M / PLACE_M) as usize;
    for place in 0..places {
        let width = between(noise, 1.5, 1.95);
        let area = Area {
            u: PLACE_M * place as f32 + between(noise, 0.0, PLACE_M - width),
            v: 0.0,
            width,
            height: between(noise, 2.2, 3.2),
        };
        let brightness = between(noise, 0.4, 1.4);
        if noise.uniform() < 0.8 {
            scene(&mut canvas, noise, area, brightness);
        } else {
            door(&mut canvas, noise, area, brightness);
        }
    }
    canvas.weather(noise, NATURAL);
    canvas
}

/// One side of a free-standing panel.
fn screen(noise: &mut Normal, width: f32) -> Canvas {
    let mut canvas = Canvas::new(width, PANEL_HEIGHT_M, HALL);
    let area = Area {
        u: 0.0,
        v: 0.0,
        width,
        height: PANEL_HEIGHT_M,
    };
    let brightness = between(noise, 0.4, 1.4);
    scene(&mut canvas, noise, area, brightness);
    canvas.weather(noise, NATURAL);
    canvas
}

/// A band of windows high up in the hall's wall, some of them with blinds down.
fn windows(canvas: &mut Canvas, noise: &mut Normal) {
    let sill = between(noise, 3.8, 4.6);
    let mut u = between(noise, 0.2, 1.2);
    while u < SIDE_M - 1.0 {
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
