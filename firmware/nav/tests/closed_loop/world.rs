//! A square room with painted walls, seen by analysis: no pixels.

use std::f32::consts::TAU;

use nalgebra::{Point2, Vector2};
use nav::horizon::BEARINGS;
use nav::{Horizon, Spectrum};

use crate::random::Random;

/// Length of a wall, metres.
const SIDE_M: f32 = 10.0;
/// Waves of paint round the room.
const WAVES: usize = 40;

/// Points of paint round the room: one a centimetre.
const POINTS: usize = 4_000;

/// 10 x 10 m; the walls carry a sum of waves along their 40 m, random for each seed.
pub struct Room {
    corner: Point2<f32>,
    paint: Vec<f32>,
}

impl Room {
    /// The room of a seed; `corner` is its south-east corner (least x and y).
    pub fn new(seed: u64, corner: Point2<f32>) -> Self {
        let mut random = Random::new(seed);
        let waves: [(f32, f32); WAVES] =
            std::array::from_fn(|_| (15.0 * random.uniform(), TAU * random.uniform()));
        let luma = |point: usize| {
            let along = point as f32 * (TAU / POINTS as f32);
            let wave = |(n, (amplitude, phase)): (i16, &(f32, f32))| {
                amplitude * libm::cosf(f32::from(n) * along + phase)
            };
            (80.0 + (1..).zip(&waves).map(wave).sum::<f32>()).clamp(0.0, 255.0)
        };
        Self {
            corner,
            paint: (0..POINTS).map(luma).collect(),
        }
    }

    /// What a viewer sees whose panorama is aligned with a north that is off by `north_error`
    /// (estimated heading less true heading).
    pub fn view(&self, at: Point2<f32>, north_error: f32) -> Spectrum {
        let luma = std::array::from_fn(|n| {
            let bearing = n as f32 * (TAU / BEARINGS as f32) - north_error;
            self.luma(at, bearing)
        });
        Spectrum::of(&Horizon::new(luma, 0.0))
    }

    fn luma(&self, at: Point2<f32>, bearing: f32) -> f32 {
        let along = self.wall_metres(at, bearing) * (POINTS as f32 / (4.0 * SIDE_M));
        let (point, rest) = (along as usize, along.fract());
        let [here, next] = [0, 1].map(|offset| self.paint[(point + offset) % POINTS]);
        here + (next - here) * rest
    }

    /// Where a ray meets the walls: metres round the room, 0..=40.
    fn wall_metres(&self, at: Point2<f32>, bearing: f32) -> f32 {
        let from = at - self.corner;
        let ray = Vector2::new(libm::cosf(bearing), libm::sinf(bearing));
        let reach = |position: f32, slope: f32| {
            let wall = if slope > 0.0 { SIDE_M } else { 0.0 };
            if slope == 0.0 {
                f32::INFINITY
            } else {
                (wall - position) / slope
            }
        };
        let (to_x, to_y) = (reach(from.x, ray.x), reach(from.y, ray.y));
        if to_x < to_y {
            let y = from.y + to_x * ray.y;
            if ray.x > 0.0 {
                SIDE_M + y
            } else {
                4.0 * SIDE_M - y
            }
        } else {
            let x = from.x + to_y * ray.x;
            if ray.y > 0.0 { 3.0 * SIDE_M - x } else { x }
        }
    }
}
