//! Long routes through a world, drawn from a seed.

use core::f32::consts::{PI, TAU};

use fake_sensors::random::Normal;
use fake_sensors::world::{Rectangle, World};
use nalgebra::{Vector2, Vector3};

/// Stream of the seed that draws the way, clear of the sensors'.
const STREAM: u64 = u64::from_be_bytes(*b"meanders");
/// Length of one straight piece, metres: at the paper's spacing a snapshot or two.
const PIECE_M: f32 = 3.0;
/// Standard deviation of the turn from one piece to the next, radians.
const TURN_SD_RAD: f32 = 0.3;
/// Where the way is blocked, it is tried this much further to each side, radians.
const DETOUR_RAD: f32 = PI / 12.0;
/// Half the width that has to be free on both sides of the way, metres: what a drone that follows by odometry and
/// sight may stray, and its rotors.
const CLEARANCE_M: f32 = 0.6;
/// Rays side by side that look whether a piece is free.
const LANES: usize = 5;
/// Heights at which it has to be free, metres: those of a flight at 0.5 m.
const HEIGHTS_M: [f32; 3] = [0.3, 0.55, 0.8];
/// So many pieces may lead nowhere, per piece of the route.
const DEAD_ENDS: usize = 20;

/// A smooth way that wanders about, within what the world leaves free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meander {
    /// Its length, metres, rounded up to whole pieces of 3 m.
    pub length_m: f32,
}

/// No way of that length was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no way of {length_m} m was found from the start of the routes through seed {seed} of this world"
)]
pub struct NoWay {
    /// The length that was asked for, metres.
    pub length_m: f32,
    /// Of the world and the way.
    pub seed: u64,
}

impl Meander {
    /// Places north and east of the start, metres. The same seed in the same world is the same way.
    ///
    /// # Errors
    /// [`NoWay`] where the world is too narrow.
    pub fn places(&self, world: &World, seed: u64) -> Result<Vec<[f32; 2]>, NoWay> {
        let pieces = (self.length_m / PIECE_M).ceil() as usize;
        let mut random = Normal::new(seed, STREAM);
        let mut way: Vec<Vector2<f32>> = vec![Vector2::zeros()];
        let mut heading_rad = TAU * random.uniform() as f32;
        for _ in 0..DEAD_ENDS * pieces {
            if way.len() > pieces {
                // World: x north, y west.
                return Ok(way.iter().map(|place| [place.x, -place.y]).collect());
            }
            let from = way.last().copied().unwrap_or_default();
            let wished_rad = heading_rad + TURN_SD_RAD * random.sample() as f32;
            let headings = detours().map(|detour_rad| wished_rad + detour_rad);
            let open = headings
                .map(|heading| (heading, from + PIECE_M * towards(heading)))
                .find(|(_, to)| is_free(world, &from, to));
            match open {
                Some((heading, to)) => {
                    heading_rad = heading;
                    way.push(to);
                }
                None if way.len() > 1 => {
                    way.pop();
                    heading_rad = TAU * random.uniform() as f32;
                }
                None => break,
            }
        }
        Err(NoWay {
            length_m: self.length_m,
            seed,
        })
    }
}

/// Straight on, then a little to the left and right, and further and further, but not back.
fn detours() -> impl Iterator<Item = f32> {
    const MOST: i16 = 10;
    (0..=MOST).flat_map(|step| {
        let detour_rad = f32::from(step) * DETOUR_RAD;
        [detour_rad, -detour_rad]
    })
}

/// One metre in a direction, counter-clockwise from north.
fn towards(heading_rad: f32) -> Vector2<f32> {
    let (sin, cos) = libm::sincosf(heading_rad);
    Vector2::new(cos, sin)
}

/// Whether a drone can fly from one place to the other, and a little beyond.
fn is_free(world: &World, from: &Vector2<f32>, to: &Vector2<f32>) -> bool {
    let along = (to - from).normalize();
    let across = Vector2::new(-along.y, along.x);
    let beyond = to + CLEARANCE_M * along;
    world.free().is_none_or(|free| is_within(&free, &beyond))
        && (0..LANES).all(|lane| {
            let share = 2.0 * lane as f32 / (LANES - 1) as f32 - 1.0;
            let aside = share * CLEARANCE_M * across;
            let at = |place: Vector2<f32>, height_m| Vector3::new(place.x, place.y, height_m);
            HEIGHTS_M.iter().all(|height_m| {
                world.clear_between(at(from + aside, *height_m), at(beyond + aside, *height_m))
            })
        })
}

fn is_within(free: &Rectangle, place: &Vector2<f32>) -> bool {
    (0..2).all(|axis| (free.low_m[axis]..=free.high_m[axis]).contains(&place[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Meander = Meander { length_m: 300.0 };

    fn forest(seed: u64) -> World {
        World::named("forest", seed).expect("a world")
    }

    #[test]
    fn a_way_through_the_forest_is_as_long_as_asked_for_and_meets_no_trunk() {
        let world = forest(1);
        let places = LONG.places(&world, 1).expect("a way");
        assert_eq!(places[0], [0.0, 0.0]);
        let at = |place: &[f32; 2]| Vector3::new(place[0], -place[1], 0.54);
        let mut length_m = 0.0;
        for leg in places.windows(2) {
            assert!(world.clear_between(at(&leg[0]), at(&leg[1])), "{leg:?}");
            length_m += (at(&leg[1]) - at(&leg[0])).norm();
        }
        assert!((length_m - 300.0).abs() < 0.01, "{length_m} m");
    }

    #[test]
    fn a_seed_repeats_its_way_and_another_takes_another() {
        let world = forest(1);
        let way = |seed| LONG.places(&world, seed).expect("a way");
        assert_eq!(way(1), way(1));
        assert_ne!(way(1), way(2));
    }

    #[test]
    fn a_world_without_room_is_no_way() {
        let text = r#"
            free = { from = [-1.0, -1.0], to = [1.0, 1.0] }
            room = { corner = [-2.0, -2.0], size = [4.0, 4.0], height = 3.0, floor = { painter = "concrete" }, ceiling = { painter = "office-ceiling" }, walls = [{ painter = "plaster" }] }
        "#;
        let world = World::from_text(text, "closet.toml".as_ref(), 1).expect("a world");
        let found = LONG.places(&world, 3).expect_err("no room");
        assert_eq!((found.length_m, found.seed), (300.0, 3));
    }
}
