//! The flight arena: 10 x 10 x 7 m in a dark hall, canvas panels with mostly natural scenes along
//! its sides, artificial grass; for the U and S routes, panels in the middle as well (van Dijk et
//! al. 2024, experimental setup).

use nalgebra::Vector3;

use super::surface::Surface;
use super::texture::Texture;
use super::{PlanLine, Structure, World, scenery};
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

/// Stream of the seed before the first that a texture is painted from: "pain" in ASCII, clear of the
/// streams that sensors take from the same seed.
const FIRST_STREAM: u64 = u64::from_be_bytes(*b"pain\0\0\0\0");
/// Light of the lamps on everything but the sides, relative to the world's usual light.
const LAMPS: f32 = 1.1;
/// How bright the four sides of the hall are, in order: daylight comes from one of them. The
/// seed turns the order.
const SIDE_LIGHT: [f32; 4] = [1.8, 1.1, 0.6, 1.3];

/// Builds the arena, with panels between consecutive `panel_ends`.
pub(super) fn build(seed: u64, panel_ends: &[Point]) -> World {
    let mut stream = FIRST_STREAM;
    let mut noise = || {
        stream += 1;
        Normal::new(seed, stream)
    };
    let mut surfaces = vec![
        level(
            0.0,
            true,
            scenery::grass(&mut noise(), SIDE_M).lit_by(LAMPS),
        ),
        level(
            CEILING_M,
            false,
            scenery::roof(&mut noise(), SIDE_M).lit_by(LAMPS),
        ),
    ];
    let mut plan = Vec::new();
    let daylight_from = (4.0 * noise().uniform()) as usize;
    for (side, (from, to)) in walls().into_iter().enumerate() {
        let light = SIDE_LIGHT[(side + daylight_from) % 4];
        let picture = scenery::wall(&mut noise(), SIDE_M, CEILING_M).lit_by(light);
        surfaces.push(upright(from, to, CEILING_M, picture));
        plan.push(line(Structure::Wall, from, to));
    }
    for ends in panel_ends.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        for (from, to) in [(from, to), (to, from)] {
            let width_m = length(from, to);
            let picture = scenery::screen(&mut noise(), width_m, PANEL_HEIGHT_M).lit_by(LAMPS);
            surfaces.push(upright(from, to, PANEL_HEIGHT_M, picture));
        }
        plan.push(line(Structure::Panel, from, to));
    }
    World {
        surfaces: surfaces.into(),
        plan: plan.into(),
    }
}

/// The four sides, clockwise from above, so that the room lies to the right of each.
fn walls() -> [(Point, Point); 4] {
    let [south, east] = SOUTH_EAST;
    let (north, west) = (south + SIDE_M, east + SIDE_M);
    [
        ([north, west], [north, east]),
        ([north, east], [south, east]),
        ([south, east], [south, west]),
        ([south, west], [north, west]),
    ]
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

/// A level square over the whole arena, visible from above (the floor) or from below.
fn level(height_m: f32, from_above: bool, picture: Texture) -> Surface {
    let corner = Vector3::new(SOUTH_EAST[0], SOUTH_EAST[1], height_m);
    let (x, y) = (Vector3::x(), Vector3::y());
    let (u, v) = if from_above { (x, y) } else { (y, x) };
    Surface::new(corner, (u, SIDE_M), (v, SIDE_M), picture)
}
