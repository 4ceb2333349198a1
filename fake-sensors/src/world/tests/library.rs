//! Every world that comes with the crate.

use core::f32::consts::{FRAC_PI_4, TAU};
use std::sync::OnceLock;

use nalgebra::UnitQuaternion;

use super::*;
use crate::camera::{AnnulusRenderer, HEIGHT, Moment, PanoramicLens, Pose, WIDTH};
use crate::random::Normal;

/// Each world, built once for all tests.
fn library(name: &str) -> World {
    static WORLDS: [OnceLock<World>; WORLD_NAMES.len()] =
        [const { OnceLock::new() }; WORLD_NAMES.len()];
    let place = WORLD_NAMES.iter().position(|known| *known == name);
    WORLDS[place.unwrap()]
        .get_or_init(|| World::named(name, 1).unwrap())
        .clone()
}

/// Somewhere in a world's free area, tilted by up to 15 degrees.
fn somewhere(world: &World, noise: &mut Normal) -> Pose {
    let free = world.free().unwrap();
    let mut between = |low: f32, high: f32| low + (high - low) * noise.uniform() as f32;
    let [x, y] = [0, 1].map(|axis| between(free.low_m[axis], free.high_m[axis]));
    let position_m = Vector3::new(x, y, between(0.2, 1.2));
    let (roll, pitch) = (between(-0.26, 0.26), between(-0.26, 0.26));
    Pose {
        position_m,
        attitude: UnitQuaternion::from_euler_angles(roll, pitch, between(0.0, TAU)),
    }
}

/// Directions all over the sphere.
fn directions() -> impl Iterator<Item = Vector3<f32>> {
    (-12..=12).flat_map(|row| {
        (0..48).map(move |column| {
            let (elevation, bearing) = (row as f32 * 0.125, column as f32 * TAU / 48.0 + 0.01);
            let (sin, cos) = elevation.sin_cos();
            Vector3::new(cos * bearing.cos(), cos * bearing.sin(), sin)
        })
    })
}

#[test]
fn no_world_has_a_hole_anywhere_in_its_free_area() {
    for name in WORLD_NAMES {
        let world = library(name);
        let mut noise = Normal::new(3, 1);
        for time in 0..8 {
            let pose = somewhere(&world, &mut noise);
            let seen = world.seen_from(pose.position_m, 7.0 * f64::from(time));
            for way in directions() {
                assert!(seen.sees_something(way), "{name}: {pose:?} {way:?}");
                let light = seen.radiance(way, &Aperture::new(0.03, 0.06));
                assert!(light.is_finite() && light > 0.0, "{name}: {pose:?} {way:?}");
            }
        }
    }
}

/// The camera's usual shutter brings a grey room (0.22) to the set point of 80; autoexposure has a
/// range of a thousand. Within a factor of two of it all worlds can be told apart from one flight.
#[test]
fn the_horizon_of_every_world_is_as_bright_as_a_grey_room_within_a_factor_of_two() {
    let lens = PanoramicLens::default();
    let mut renderer = AnnulusRenderer::new(&lens);
    for name in WORLD_NAMES {
        let world = library(name);
        let pose = Pose {
            position_m: at(-2.5, 0.0),
            attitude: UnitQuaternion::identity(),
        };
        let frame = renderer.render(&world, &moment(pose, 0.0));
        let ring = (0..WIDTH * HEIGHT).filter(|index| {
            let centre = [(index % WIDTH) as f32 + 0.5, (index / WIDTH) as f32 + 0.5];
            (18.0..=42.0).contains(&lens.distance_from_centre(centre))
        });
        // A pixel saturates: brighter than white counts as white.
        let light: Vec<f32> = ring.map(|index| frame[index].min(1.0)).collect();
        let mean = light.iter().sum::<f32>() / light.len() as f32;
        assert!((0.11..0.44).contains(&mean), "{name}: {mean}");
    }
}

#[test]
fn a_world_looks_the_same_whenever_it_is_built_and_different_with_another_seed() {
    let look = |world: &World| -> Vec<u32> {
        let seen = world.seen_from(at(-2.5, 0.1), 3.0);
        let aperture = Aperture::new(0.03, 0.06);
        directions()
            .map(|way| seen.radiance(way, &aperture).to_bits())
            .collect()
    };
    for name in WORLD_NAMES {
        let first = look(&library(name));
        assert_eq!(first, look(&World::named(name, 1).unwrap()), "{name}");
        let other = look(&World::named(name, 2).unwrap());
        let changed = first.iter().zip(&other).filter(|(a, b)| a != b).count();
        // A photograph is the same with every seed; what is painted before it is not.
        let least = if name == "hdri" { 8 } else { first.len() / 3 };
        assert!(changed > least, "{name}: {changed}");
    }
}

#[test]
fn the_routes_are_clear_of_what_stands_in_every_world_but_the_corridors() {
    let legs = [
        [[0.0, 0.0], [-5.0, 0.0]],
        [[-5.0, 0.0], [-5.0, -4.0]],
        [[-5.0, -4.0], [0.0, -4.0]],
        [[-5.0, -4.0], [-5.0, -5.0]],
        [[-5.0, -5.0], [0.0, -5.0]],
    ];
    for name in WORLD_NAMES {
        if name.starts_with("corridor") {
            continue;
        }
        let world = library(name);
        for [from, to] in legs {
            for height_m in [0.1, 0.5, 0.9] {
                let end = |[x, y]: [f32; 2]| Vector3::new(x, y, height_m);
                assert!(
                    world.clear_between(end(from), end(to)),
                    "{name}: {from:?} {to:?} {height_m} {:?}",
                    world
                        .seen_from(end(from), 0.0)
                        .distance_m((end(to) - end(from)).normalize())
                );
            }
        }
    }
}

#[test]
fn the_forest_is_300_m_across_and_its_trees_end_the_view() {
    let world = library("forest");
    let free = world.free().unwrap();
    assert!((0..2).all(|axis| free.high_m[axis] - free.low_m[axis] >= 300.0));
    // Level views from the clearing: nearly all end at something that grows, most within 100 m.
    let seen = world.seen_from(Vector3::new(-2.5, 0.0, 1.5), 0.0);
    let distances: Vec<f32> = (0..360)
        .filter_map(|degree| {
            let bearing = degree as f32 * TAU / 360.0;
            seen.distance_m(Vector3::new(bearing.cos(), bearing.sin(), 0.0))
        })
        .collect();
    assert!(distances.len() > 340, "{}", distances.len());
    let near = distances
        .iter()
        .filter(|distance| **distance < 100.0)
        .count();
    assert!(near > 250, "{near}");
}

/// What moves smoothly past a pixel changes it evenly; what blinks changes it to and fro. So the
/// second differences of a pixel's light, as the camera creeps forward by 1 cm a frame, tell flicker from
/// parallax.
#[test]
fn far_geometry_flickers_hardly_more_than_the_surfaces_of_the_arena() {
    let mut renderer = AnnulusRenderer::new(&PanoramicLens::default());
    let mut flicker = |name: &str| {
        let world = library(name);
        let frames: Vec<Vec<f32>> = (0..8)
            .map(|step| {
                let pose = Pose {
                    position_m: at(-2.5 + 0.01 * step as f32, 0.0),
                    attitude: UnitQuaternion::identity(),
                };
                renderer.render(&world, &moment(pose, 0.0)).to_vec()
            })
            .collect();
        let mut swings: Vec<f32> = frames
            .windows(3)
            .flat_map(|run| {
                let pixels = run[0].iter().zip(&run[1]).zip(&run[2]);
                pixels.map(|((a, b), c)| (a - 2.0 * b + c).abs())
            })
            .collect();
        swings.sort_by(f32::total_cmp);
        swings[swings.len() * 999 / 1_000]
    };
    let arena = flicker("arena");
    for name in ["forest", "hall", "greenhouse", "office"] {
        let unrest = flicker(name);
        assert!(unrest < 1.25 * arena, "{name}: {unrest}, arena: {arena}");
    }
}

fn moment(pose: Pose, time_s: f64) -> Moment {
    Moment { pose, time_s }
}

#[test]
fn a_row_rendered_alone_is_the_row_of_a_whole_frame() {
    let world = library("office");
    let mut noise = Normal::new(5, 1);
    let pose = somewhere(&world, &mut noise);
    let mut renderer = AnnulusRenderer::new(&PanoramicLens::default());
    let whole = renderer.render(&world, &moment(pose, 2.0)).to_vec();
    let elsewhere = somewhere(&world, &mut noise);
    renderer.render(&world, &moment(elsewhere, 2.0));
    for row in 0..HEIGHT {
        renderer.render_rows(row..row + 1, &world, &moment(pose, 2.0));
    }
    for (row, line) in whole.chunks_exact(WIDTH).enumerate() {
        assert!(renderer.row(row) == line);
    }
}

#[test]
fn a_rolling_shutter_bends_what_the_camera_turns_past() {
    let world = library("corridor-doors");
    let turned = |angle: f32| Pose {
        position_m: at(0.0, 0.0),
        attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle),
    };
    let mut renderer = AnnulusRenderer::new(&PanoramicLens::default());
    let first = renderer.render(&world, &moment(turned(0.0), 0.0)).to_vec();
    let last = renderer
        .render(&world, &moment(turned(FRAC_PI_4), 0.0))
        .to_vec();
    renderer.render_rows(0..30, &world, &moment(turned(0.0), 0.0));
    renderer.render_rows(30..HEIGHT, &world, &moment(turned(FRAC_PI_4), 0.0));
    let line = |row: usize| row * WIDTH..(row + 1) * WIDTH;
    // The blur reaches one row further.
    for row in 0..29 {
        assert!(renderer.row(row) == &first[line(row)]);
    }
    for row in 31..HEIGHT {
        assert!(renderer.row(row) == &last[line(row)]);
    }
    assert!(first != last);
}
