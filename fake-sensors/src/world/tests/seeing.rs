//! What is seen of solids, lamps, light and things that move.

use core::f32::consts::PI;
use std::path::Path;

use super::*;

/// A black plane under a black sky, and `things` on it.
fn dark(things: &str) -> World {
    let text = format!(
        "[ground]\npaint = {{ painter = \"plain\", brightness = 0 }}\n[sky]\nzenith = 0\nhorizon = 0\nfar = 0.001\n{things}"
    );
    World::from_text(&text, Path::new("dark.toml"), 1).unwrap()
}

fn towards(x: f32, y: f32, z: f32) -> Vector3<f32> {
    Vector3::new(x, y, z).normalize()
}

#[test]
fn a_ray_meets_boxes_columns_and_balls_where_they_are() {
    let solid = "paint = { painter = \"plain\" }";
    let world = dark(&format!(
        "[[box]]\nat = [4, 0]\nsize = [2, 1, 2]\n{solid}\n\
         [[box]]\nat = [0, 4]\nsize = [2, 2, 2]\nturn_deg = 45\n{solid}\n\
         [[column]]\nat = [-3, 0]\nradius = 0.5\nheight = 2\n{solid}\n\
         [[ball]]\nat = [0, -5, 0.5]\nradii = [1, 0.25]\n{solid}\n"
    ));
    let seen = world.seen_from(at(0.0, 0.0), 0.0);
    let meets = |way, distance_m: f32| {
        let found = seen.distance_m(way).unwrap();
        assert!((found - distance_m).abs() < 2e-3, "{way:?}: {found}");
    };
    meets(towards(1.0, 0.0, 0.0), 3.0);
    // The edge of a square of 2 m that stands on its corner is 1.414 m from its middle.
    meets(towards(0.0, 1.0, 0.0), 4.0 - core::f32::consts::SQRT_2);
    meets(towards(-1.0, 0.0, 0.0), 2.5);
    meets(towards(0.0, -1.0, 0.0), 4.0);
    assert_eq!(seen.distance_m(towards(-1.0, 0.0, 0.9)), None);
    assert_eq!(seen.distance_m(towards(1.0, 0.2, 0.0)), None);
    assert!(!world.clear_between(at(0.0, 0.0), at(6.0, 0.0)));
    assert!(world.clear_between(at(0.0, 0.0), at(2.9, 0.0)));
}

/// A pixel 4 x 4 degrees wide looks at a white ball as it recedes: what it sees is the part of the
/// pixel that the ball fills, and changes as smoothly as that.
#[test]
fn a_small_ball_fills_the_part_of_a_pixel_that_it_should() {
    let world = dark("[[lamp]]\nat = [20, 0, 0.5]\nradius = 0.2\nradiance = 1\n");
    let aperture = Aperture::new(0.07, 0.07);
    let seen = |x: f32, y: f32| {
        let view = world.seen_from(at(x, y), 0.0);
        view.radiance(Vector3::x(), &aperture)
    };
    for distance_m in [8.0, 10.0, 14.0] {
        let pixel_m: f32 = 0.07 * distance_m;
        let part = PI * 0.2 * 0.2 / (pixel_m * pixel_m);
        assert!((seen(20.0 - distance_m, 0.0) - part).abs() < 0.01);
    }
    let sideways: Vec<f32> = (0..200).map(|step| seen(8.0, 0.01 * step as f32)).collect();
    let jump = sideways.windows(2).map(|pair| (pair[0] - pair[1]).abs());
    assert!(jump.fold(0.0, f32::max) < 0.02);
    // Beside the ball there is only the sky's dim horizon.
    assert!(sideways[199] < 1e-3);
}

#[test]
fn a_lamp_saturates_the_image_and_goes_on_when_its_table_says() {
    let world = dark(
        "[[light]]\nname = \"evening\"\nlevels = [[9.9, 0], [10, 1]]\n\
         [[lamp]]\nat = [3, 0, 0.5]\nradius = 0.5\nradiance = 20\nfollows = \"evening\"\n",
    );
    let light = |time_s| {
        let seen = world.seen_from(at(0.0, 0.0), time_s);
        seen.radiance(Vector3::x(), &Aperture::new(0.04, 0.04))
    };
    assert_eq!([light(0.0), light(9.0), light(10.0)], [0.0, 0.0, 20.0]);
}

#[test]
fn light_on_walls_follows_its_table() {
    let text = "[[light]]\nname = \"day\"\nlevels = [[0, 1], [10, 0.5]]\n[room]\ncorner = [-5, -5]\nsize = [10, 10]\nheight = 3\nfloor = { painter = \"plain\" }\nceiling = { painter = \"plain\" }\nwalls = [{ painter = \"doors\", follows = \"day\" }]\n";
    let world = World::from_text(text, Path::new("day.toml"), 1).unwrap();
    let look = |way, time_s| {
        let seen = world.seen_from(at(0.0, 0.0), time_s);
        seen.radiance(way, &Aperture::new(0.04, 0.04))
    };
    assert_eq!(look(Vector3::x(), 10.0), 0.5 * look(Vector3::x(), 0.0));
    assert_eq!(look(-Vector3::z(), 10.0), look(-Vector3::z(), 0.0));
}

#[test]
fn a_patch_of_sunlight_is_as_many_times_brighter_as_the_file_says() {
    let wall = |sun: &str| {
        let text = format!(
            "[[panel]]\nthrough = [[3, 2], [3, -2]]\nheight = 2\npaint = {{ painter = \"plaster\", sun = [{sun}] }}\n"
        );
        let world = World::from_text(&text, Path::new("sun.toml"), 1).unwrap();
        let seen = world.seen_from(at(0.0, 0.0), 0.0);
        let look = |y: f32| seen.radiance(towards(3.0, y, 0.0), &Aperture::new(0.01, 0.01));
        [look(0.0), look(1.2)]
    };
    let plain = wall("");
    let sunny = wall("{ at = [1.5, 0.2], size = [1, 1], times = 2.5 }");
    assert!((sunny[0] / plain[0] - 2.5).abs() < 1e-4);
    assert_eq!(sunny[1], plain[1]);
}

#[test]
fn a_person_is_where_their_walk_has_brought_them() {
    let world = dark("[[person]]\nat = [4, -3]\nroute = { through = [[4, 3]], speed = 1.5 }\n");
    // After 2 s they are straight ahead; after 4 s at the far end, after 6 s back.
    let meets = |time_s, y: f32| {
        let seen = world.seen_from(Vector3::new(0.0, 0.0, 1.15), time_s);
        seen.distance_m(towards(4.0, y, 0.0)).is_some()
    };
    assert_eq!(
        [0.0, 2.0, 4.0, 6.0].map(|t| meets(t, 0.0)),
        [false, true, false, true]
    );
    assert_eq!(
        [0.0, 2.0, 4.0, 6.0].map(|t| meets(t, 3.0)),
        [false, false, true, false]
    );
    assert!(meets(0.0, -3.0));
}

#[test]
fn who_stands_still_looks_the_same_at_any_time() {
    let world = dark("[[person]]\nat = [3, 0]\n");
    let look = |time_s| {
        let seen = world.seen_from(at(0.0, 0.0), time_s);
        seen.radiance(towards(3.0, 0.0, 0.2), &Aperture::new(0.05, 0.05))
    };
    assert!(look(0.0) > 0.0);
    assert_eq!(look(0.0), look(50.0));
}

#[test]
fn a_face_turned_to_the_sun_is_brighter() {
    let world = dark(
        "[sun]\ntowards = [-1, 0, 0]\nshare = 0.8\n\
         [[box]]\nat = [5, 0]\nsize = [1, 1, 2]\npaint = { painter = \"plain\", contrast = 0 }\n\
         [[box]]\nat = [-5, 0]\nsize = [1, 1, 2]\npaint = { painter = \"plain\", contrast = 0 }\n",
    );
    let seen = world.seen_from(at(0.0, 0.0), 0.0);
    let look = |x: f32| seen.radiance(towards(x, 0.0, 0.0), &Aperture::new(0.02, 0.02));
    // Upright faces: 0.35 + 0.65 / 2 from above, times 0.2, and for one of them 0.8 from the sun.
    let above = 0.2 * (0.35 + 0.65 * 0.5);
    assert!((look(1.0) / look(-1.0) - (0.8 + above) / above).abs() < 0.01);
}
