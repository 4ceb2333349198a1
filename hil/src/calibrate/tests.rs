//! Rendered pictures of lenses that are known, in the worlds of the library.

use core::f32::consts::TAU;

use fake_sensors::camera::{Exposure, Moment, PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use nalgebra::{UnitQuaternion, Vector3};

use super::picture::{HEIGHT, WIDTH};
use super::*;

/// Centre, inner and outer radius of lenses as they may be mounted: pixels from (64, 48), pixels.
const LENSES: [([f32; 2], f32, f32); 8] = [
    ([0.0, 0.0], 18.0, 42.0),
    ([3.0, -3.0], 15.0, 38.0),
    ([-3.0, 3.0], 21.0, 43.0),
    ([2.4, 1.7], 16.3, 41.2),
    ([-1.3, -2.6], 19.7, 39.5),
    ([0.5, 2.9], 20.4, 42.6),
    ([-2.9, 0.4], 15.8, 40.3),
    ([1.1, -0.8], 17.2, 43.0),
];

/// Worlds unlike each other: panels and bare walls, narrow and wide, many small things.
const WORLDS: [&str; 4] = ["arena-panels", "arena", "corridor-doors", "office"];

fn lens(centre: [f32; 2], inner: f32, outer: f32) -> PanoramicLens {
    PanoramicLens {
        centre_px: [64.0 + centre[0], 48.0 + centre[1]],
        inner_radius_px: inner,
        outer_radius_px: outer,
        ..PanoramicLens::default()
    }
}

/// Pictures of a spin to the left, evenly spaced round the circle.
fn spin(world: &World, lens: &PanoramicLens, count: usize, seed: u64) -> Vec<Named> {
    let mut camera = PanoramicCamera::new(world.clone(), lens, seed);
    let pictures = (0..count).map(|n| {
        let yaw = TAU * n as f32 / count as f32;
        let pose = Pose {
            position_m: Vector3::new(-0.6, 0.3, 0.6),
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw),
        };
        let exposure = Exposure {
            lines: 135,
            gain: 1.0,
        };
        Named {
            path: format!("{n}.png").into(),
            picture: Picture::from_frame(camera.expose(
                &Moment { pose, time_s: 0.0 },
                exposure,
                n as u32,
            )),
        }
    });
    pictures.collect()
}

fn found(pictures: &[Named]) -> Calibrated {
    calibrate(pictures, &Settings::default()).expect("a ring")
}

/// Errors of centre, inner and outer radius, pixels.
fn errors(found: &LensCalibration, truth: &PanoramicLens) -> [f32; 3] {
    let [x, y] = truth.centre_px;
    [
        libm::hypotf(found.centre_px.0 - x, found.centre_px.1 - y),
        found.inner_radius_px - truth.inner_radius_px,
        found.outer_radius_px - truth.outer_radius_px,
    ]
}

/// With `--nocapture` the figures.
#[test]
fn centre_and_radii_are_right_within_half_a_pixel_in_every_world_from_one_picture_and_from_four() {
    println!("world            pictures  worst error, px: centre  inner  outer; spin residual px");
    for name in WORLDS {
        let world = World::named(name, 1).expect("a world");
        for count in [1, 4] {
            let (mut worst, mut residual) = ([0.0_f32; 3], 0.0_f64);
            for (seed, (centre, inner, outer)) in LENSES.into_iter().enumerate() {
                let truth = lens(centre, inner, outer);
                let result = found(&spin(&world, &truth, count, seed as u64));
                let errors = errors(&result.lens, &truth);
                for (worst, error) in worst.iter_mut().zip(errors) {
                    if error.abs() > worst.abs() {
                        *worst = error;
                    }
                }
                residual = residual.max(result.spin.map_or(0.0, |spin| spin.residual_px));
            }
            let [centre, inner, outer] = worst;
            println!("{name:<18}{count:>7}{centre:>25.2}{inner:>7.2}{outer:>7.2}{residual:>12.2}");
            assert!(
                worst.iter().all(|error| error.abs() < 0.5),
                "{name}: {worst:?}"
            );
        }
    }
}

/// A picture of a ring that is drawn, not rendered: the luma at a distance from (63.2, 49.1).
fn drawn(luma: impl Fn(f64) -> f64) -> Named {
    let frame = (0..WIDTH * HEIGHT).flat_map(|index| {
        let [x, y] = [index % WIDTH, index / WIDTH].map(|at| at as f64 + 0.5);
        let distance = libm::hypot(x - 63.2, y - 49.1);
        [0x80, luma(distance) as u8]
    });
    Named {
        path: "drawn.png".into(),
        picture: Picture::from_frame(&frame.collect::<Vec<u8>>()),
    }
}

/// From `dark` to `bright` within two pixels about `edge`.
fn step(distance: f64, edge: f64, dark: f64, bright: f64) -> f64 {
    dark + (bright - dark) * (0.5 * (distance - edge) + 0.5).clamp(0.0, 1.0)
}

#[test]
fn a_white_bucket_is_enough_with_a_rim_round_the_ring_or_without() {
    let bucket =
        |distance| step(distance, 17.0, 14.0, 230.0).min(step(distance, 41.0, 230.0, 14.0));
    let with_rim = |distance: f64| {
        if distance < 42.5 {
            step(distance, 17.0, 14.0, 230.0).min(step(distance, 40.0, 230.0, 150.0))
        } else {
            step(distance, 45.0, 150.0, 14.0)
        }
    };
    for (picture, outer) in [(drawn(bucket), 41.0), (drawn(with_rim), 40.0)] {
        let lens = found(&[picture]).lens;
        assert!(libm::hypotf(lens.centre_px.0 - 63.2, lens.centre_px.1 - 49.1) < 0.1);
        assert!((lens.inner_radius_px - (17.0 + EDGE_MARGIN_PX)).abs() < 0.2);
        assert!((lens.outer_radius_px - (outer - EDGE_MARGIN_PX)).abs() < 0.2);
    }
}

#[test]
fn what_is_no_ring_is_said_with_the_name_of_the_file() {
    let reason = |picture: Named| match calibrate(&[picture], &Settings::default()) {
        Err(CalibrateError::NoRing { path, source }) => {
            assert_eq!(path.to_str(), Some("drawn.png"));
            source
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(reason(drawn(|_| 80.0)), NoRing::Flat);
    // Bright in the middle.
    assert_eq!(
        reason(drawn(|distance| step(distance, 17.0, 200.0, 20.0))),
        NoRing::NoInnerEdge
    );
    // A dark disc in a white field.
    assert_eq!(
        reason(drawn(|distance| step(distance, 17.0, 20.0, 200.0))),
        NoRing::NoOuterEdge
    );
}

#[test]
fn a_centre_that_is_a_pixel_off_shows_in_the_spin() {
    let world = World::named("arena-panels", 1).expect("a world");
    let truth = lens([1.0, -0.5], 18.0, 42.0);
    let pictures = spin(&world, &truth, 4, 1);
    let result = found(&pictures);
    assert!(result.holds());
    let pictures: Vec<Picture> = pictures.into_iter().map(|named| named.picture).collect();
    let residual = |off: f64| {
        let [x, y] = result.edges.centre;
        let band = Band {
            centre: [x + off, y],
            inner_px: 18.0,
            outer_px: 42.0,
        };
        Spin::of(&pictures, &band).expect("patterns").residual_px
    };
    println!(
        "spin residual, px: {:.2}, 1 px off: {:.2}",
        residual(0.0),
        residual(1.0)
    );
    assert!(residual(0.0) < 0.3);
    assert!(residual(1.0) > RESIDUAL_LIMIT_PX);
}

/// Four pictures a quarter turn apart: what is on the drone's left comes to its front.
#[test]
fn a_spin_in_known_order_tells_which_way_bearings_run() {
    use fake_sensors::camera::Direction;
    let world = World::named("office", 1).expect("a world");
    for (direction, expected) in [
        (Direction::Clockwise, BearingDirection::Clockwise),
        (
            Direction::CounterClockwise,
            BearingDirection::CounterClockwise,
        ),
    ] {
        let truth = PanoramicLens {
            direction,
            ..lens([-1.0, 2.0], 17.0, 41.0)
        };
        let mut pictures = spin(&world, &truth, 4, 1);
        let told = |pictures: &[Named], order| {
            let settings = Settings {
                order,
                ..Settings::default()
            };
            calibrate(pictures, &settings).expect("a ring").direction
        };
        assert_eq!(told(&pictures, Order::CounterClockwise), Some(expected));
        assert_eq!(told(&pictures, Order::None), None);
        let turns = found(&pictures).spin.expect("a spin").turns_deg;
        for (turn, quarter) in turns.iter().zip([90.0, 180.0, 270.0]) {
            let off = libm::remainder(turn.abs() - quarter, 360.0).abs();
            assert!(off.min((off - 180.0).abs()) < 1.0, "{turns:?}");
        }
        pictures.reverse();
        assert_eq!(told(&pictures, Order::Clockwise), Some(expected));
        // Half a turn may have been to either side.
        let halves = [pictures[0].clone(), pictures[2].clone()];
        assert_eq!(told(&halves, Order::CounterClockwise), None);
    }
}

#[test]
fn a_lens_that_moved_between_two_pictures_is_named() {
    let world = World::named("arena-panels", 1).expect("a world");
    let mut pictures = spin(&world, &lens([-1.5, 0.0], 18.0, 41.0), 1, 1);
    pictures.extend(spin(&world, &lens([1.5, 0.0], 18.0, 41.0), 1, 2));
    pictures[1].path = "moved.png".into();
    let error = calibrate(&pictures, &Settings::default()).expect_err("two lenses");
    assert!(error.to_string().starts_with("moved.png: "), "{error}");
}
