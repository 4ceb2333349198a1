//! Rays side by side against rays one by one.

use std::path::Path;

use super::*;
use crate::random::Normal;
use crate::vectors::{self, Kernel};
use crate::world::{Directions, FAN, Pixels};

/// Fans looked at from each place.
const FANS: usize = 60;

/// The radiances of a fan, as the renderer asks for them.
struct Look<'a>(&'a Viewpoint<'a>, &'a Directions, &'a [Aperture; FAN]);

impl Kernel for Look<'_> {
    type Output = [f32; FAN];

    #[inline(always)]
    fn run(self) -> [f32; FAN] {
        self.0.radiances(self.1, self.2, FAN, &mut Pixels::none())
    }
}

/// Neighbours in a row of pixels if `spread` is small; every which way if it is 1.
fn fan(noise: &mut Normal, spread: f32) -> [Vector3<f32>; FAN] {
    let mut way = |size: f32| {
        Vector3::from_fn(|axis, _| {
            let flat = if axis == 2 { 0.4 } else { 1.0 };
            size * flat * (2.0 * noise.uniform() as f32 - 1.0)
        })
    };
    let (middle, step) = (way(1.0), way(spread));
    core::array::from_fn(|ray| {
        let stray = if spread < 1.0 {
            Vector3::zeros()
        } else {
            way(1.0)
        };
        (middle + step * ray as f32 + stray).normalize()
    })
}

/// Rays that differ from the one that is traced alone, of all that were looked along.
fn strays(world: &World, [low, high]: [[f32; 2]; 2], places: usize) -> usize {
    let mut noise = Normal::new(5, 1);
    let mut strays = 0;
    for place in 0..places {
        let mut between = |low: f32, high: f32| low + (high - low) * noise.uniform() as f32;
        let [x, y] = [0, 1].map(|axis| between(low[axis], high[axis]));
        let position_m = Vector3::new(x, y, between(0.2, 1.2));
        let seen = world.seen_from(position_m, 5.0 * place as f64);
        let apertures = [Aperture::new(between(0.02, 0.07), between(0.03, 0.07)); FAN];
        for number in 0..FANS {
            let ways = fan(&mut noise, [0.04, 0.2, 1.0][number % 3]);
            let directions = Directions::new(&ways);
            let wide = vectors::run(Look(&seen, &directions, &apertures));
            let plain = Look(&seen, &directions, &apertures).run();
            for ray in 0..FAN {
                let alone = seen.simple_radiance(ways[ray], &apertures[ray]).to_bits();
                let alike = [wide[ray], plain[ray]].map(f32::to_bits) == [alone; 2];
                strays += usize::from(!alike);
            }
        }
    }
    strays
}

#[test]
fn a_ray_in_a_fan_sees_to_the_bit_what_it_sees_alone_in_every_world() {
    for name in WORLD_NAMES {
        let world = world(name);
        let free = world.free().unwrap();
        assert_eq!(strays(&world, [free.low_m, free.high_m], 12), 0, "{name}");
    }
}

#[test]
fn a_ray_in_a_fan_sees_to_the_bit_what_it_sees_alone_among_walls_and_rows_of_plants() {
    let worlds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/worlds");
    for name in ["building.toml", "greenhouse-rows.toml", "arena-lamps.toml"] {
        let world = World::from_file(&worlds.join(name), 1).unwrap();
        assert_eq!(strays(&world, [[-57.0, 0.0], [0.0, 43.0]], 40), 0, "{name}");
    }
}
