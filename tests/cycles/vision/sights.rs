//! What there is to see: rendered rooms, and what is hard on the arithmetic.

use std::f32::consts::{PI, TAU};

use fake_sensors::camera::{Exposure, Moment, PanoramicCamera, PanoramicLens, Pose};
use fake_sensors::world::World;
use nalgebra::{UnitQuaternion, Vector3};
use pilot::Frame;

/// A frame and the heading that it is taken at.
pub struct Sight {
    /// What it is.
    pub name: &'static str,
    /// As the camera sends it.
    pub frame: Box<Frame>,
    /// Radians.
    pub heading: f32,
}

/// The arena from its middle, heading north.
pub fn arena_from_the_middle() -> Box<Frame> {
    rendered("arena", [0.0, 0.0], 0.0)
}

/// Every sight.
pub fn all() -> Vec<Sight> {
    let room = |name, at, heading| Sight {
        name,
        frame: rendered(name, at, heading),
        heading,
    };
    let drawn = |name, luma: &dyn Fn(f32, usize) -> u8| Sight {
        name,
        frame: drawn(luma),
        heading: 0.7,
    };
    vec![
        room("arena", [0.3, -0.2], 0.1),
        room("arena", [0.3, -0.2], -2.9),
        room("office", [0.2, 0.4], 1.3),
        room("forest", [0.0, 0.3], 40.0),
        drawn("black", &|_, _| 0),
        drawn("white", &|_, _| 255),
        drawn("half white, half black", &|bearing, _| {
            if bearing > 0.0 { 255 } else { 0 }
        }),
        drawn("eight stripes", &|bearing, _| {
            if (bearing + PI) * 16.0 % TAU < PI {
                255
            } else {
                0
            }
        }),
        drawn("noise", &|_, pixel| noise(pixel)),
    ]
}

fn rendered(world: &str, [x, y]: [f32; 2], heading: f32) -> Box<Frame> {
    let world = World::open(world, 1).expect("a world of the library");
    let mut camera = PanoramicCamera::new(world, &PanoramicLens::default(), 1);
    let pose = Pose {
        position_m: Vector3::new(x, y, 0.7),
        attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, heading),
    };
    let exposure = Exposure {
        lines: 100,
        gain: 1.0,
    };
    Box::new(*camera.expose(&Moment { pose, time_s: 0.0 }, exposure, 0))
}

/// A luma for each bearing about the middle of the image, -π to π, and each pixel.
fn drawn(luma: &dyn Fn(f32, usize) -> u8) -> Box<Frame> {
    let mut frame = Box::new([0x80; pilot::FRAME_LAYOUT.bytes()]);
    for (pixel, bytes) in frame.chunks_exact_mut(2).enumerate() {
        let [x, y] = [pixel % 128, pixel / 128].map(|place| place as f32 + 0.5);
        bytes[1] = luma(libm::atan2f(y - 48.0, x - 64.0), pixel);
    }
    frame
}

/// The upper eight bits of a product that mixes all of the pixel's (Knuth, TAOCP 6.4: multiplicative
/// hashing).
fn noise(pixel: usize) -> u8 {
    let mixed = (pixel as u32).wrapping_mul(2_654_435_769);
    ((mixed ^ (mixed >> 15)).wrapping_mul(2_654_435_769) >> 24) as u8
}
