use super::*;

/// Flight height of the published flights, in metres.
const HEIGHT_M: f32 = 0.5;

fn at(x: f32, y: f32) -> Vector3<f32> {
    Vector3::new(x, y, HEIGHT_M)
}

fn world(name: &str) -> World {
    World::named(name, 1).unwrap()
}

#[test]
fn an_unknown_name_is_refused_with_the_names_that_exist() {
    let error = World::named("moon", 1).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with("there is no world named `moon`; there are: arena, arena-panels, "));
    assert!(WORLD_NAMES.iter().all(|name| text.contains(name)));
}

#[test]
fn every_listed_world_can_be_built() {
    assert!(WORLD_NAMES.iter().all(|name| World::named(name, 1).is_ok()));
}

#[test]
fn the_arena_is_10_by_10_by_7_metres_and_closed() {
    let world = world("arena");
    let seen = world.seen_from(at(-2.5, -2.0), 0.0);
    let distance = |x, y, z| seen.distance_m(Vector3::new(x, y, z)).unwrap();
    let across = |d: f32| (d - 5.0).abs() < 1e-5;
    assert!(across(distance(1.0, 0.0, 0.0)) && across(distance(-1.0, 0.0, 0.0)));
    assert!(across(distance(0.0, 1.0, 0.0)) && across(distance(0.0, -1.0, 0.0)));
    assert!((distance(0.0, 0.0, 1.0) - 6.5).abs() < 1e-5);
    assert!((distance(0.0, 0.0, -1.0) - HEIGHT_M).abs() < 1e-6);
}

#[test]
fn panels_hide_one_long_leg_of_the_u_route_from_the_other() {
    let (open, screened) = (world("arena"), world("arena-panels"));
    for step in 0..=10 {
        let x = -0.4 * step as f32;
        assert!(open.clear_between(at(x, 0.0), at(x, -4.0)));
        assert!(!screened.clear_between(at(x, 0.0), at(x, -4.0)), "x {x}");
        assert!(!screened.clear_between(at(x, -4.0), at(x, 0.0)), "x {x}");
    }
}

#[test]
fn the_u_route_is_1_5_m_clear_of_walls_and_0_8_m_of_panels() {
    let world = world("arena-panels");
    let corners = [[0.0, 0.0], [-5.0, 0.0], [-5.0, -4.0], [0.0, -4.0]];
    for leg in corners.windows(2) {
        for step in 0..=50 {
            let t = step as f32 / 50.0;
            let point = [0, 1].map(|i| leg[0][i] + t * (leg[1][i] - leg[0][i]));
            for line in world.plan() {
                let clearance = match line.structure {
                    Structure::Wall => 1.5,
                    Structure::Panel => 0.8,
                };
                assert!(distance(point, line) >= clearance, "{point:?} {line:?}");
            }
        }
    }
}

/// Distance from a point to a line of the plan.
fn distance(point: [f32; 2], line: &PlanLine) -> f32 {
    let minus = |a: [f32; 2], b: [f32; 2]| nalgebra::Vector2::new(a[0] - b[0], a[1] - b[1]);
    let along = minus(line.to_m, line.from_m);
    let offset = minus(point, line.from_m);
    let t = (offset.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (offset - along * t).norm()
}

#[test]
fn another_seed_paints_other_textures() {
    let look = |seed| {
        let world = World::named("arena", seed).unwrap();
        let seen = world.seen_from(at(0.0, 0.0), 0.0);
        seen.radiance(Vector3::x(), &Aperture::new(0.05, 0.05))
    };
    assert_eq!(look(1), look(1));
    assert_ne!(look(1), look(2));
}

#[test]
fn no_ray_slips_out_between_walls() {
    let world = world("arena-panels");
    for corner in [[2.5, 3.0], [2.5, -7.0], [-7.5, -7.0], [-7.5, 3.0]] {
        for step in 0..1_000 {
            let eye = at(-0.003 * step as f32, 0.2);
            let height = 0.007 * step as f32;
            let way = Vector3::new(corner[0], corner[1], height) - eye;
            let seen = world.seen_from(eye, 0.0);
            assert!(seen.distance_m(way.normalize()).is_some());
        }
    }
}

mod descriptions;
mod fans;
mod library;
mod seeing;
