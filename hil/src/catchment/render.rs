//! Views of a world from anywhere, as a camera without lens, noise and colour would have them: the
//! mean over 45 degrees of elevation round the horizon, at 128 bearings from north.

use core::f32::consts::TAU;

use fake_sensors::world::{Aperture, Viewpoint, World};
use nalgebra::{UnitQuaternion, Vector3};
use nav::horizon::BEARINGS;
use nav::methods::Luma;

use super::grid::Grid;

/// Elevations that are averaged, from one end to the other, radians (the paper's cylinder).
const ELEVATIONS_RAD: f32 = TAU / 8.0;
/// Lines of sight over them.
const ROWS: usize = 8;

/// The mean luma to which the autoexposure brings each view (paper, "Image processing").
pub const MEAN_LUMA: f32 = 80.0;
/// The brightest luma.
const WHITE: f32 = 255.0;
/// Steps towards the exposure at which the view has its mean, with what is white then.
const EXPOSURE_STEPS: usize = 12;

/// Where a camera is and how it is held.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    /// x north, y west, z up, metres.
    pub position_m: [f32; 3],
    /// How far it is turned counter-clockwise from what is taken for north, radians.
    pub turn_rad: f32,
    /// Roll and pitch, radians.
    pub tilt_rad: [f32; 2],
}

/// Something upright that stands in the world beside what its description says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pillar {
    /// Its axis: x, y, metres.
    pub at_m: [f32; 2],
    /// Metres.
    pub radius_m: f32,
    /// From the floor, metres.
    pub height_m: f32,
    /// Its radiance; 1 is white paper.
    pub radiance: f32,
}

/// A lamp on one side of the place.
#[derive(Clone, Copy, Debug)]
pub struct SideLight {
    /// The middle of the place, metres.
    pub middle_m: [f32; 2],
    /// From there to where its effect is full, metres.
    pub reach_m: f32,
    /// By what share it makes things brighter there, and darker at the other end.
    pub share: f32,
}

/// Towards the lamp: 60 degrees west of north.
const TO_THE_LAMP: [f32; 2] = [0.5, 0.866];

/// What else there is.
#[derive(Clone, Debug, Default)]
pub struct Extras {
    /// Things and people.
    pub pillars: Vec<Pillar>,
    /// Another light.
    pub light: Option<SideLight>,
}

/// The view from a stand, brought to [`MEAN_LUMA`].
pub fn view(world: &World, stand: &Stand, extras: &Extras) -> Luma {
    let from = Vector3::from(stand.position_m);
    let seen = world.seen_from(from, 0.0);
    let up_rad = ELEVATIONS_RAD / ROWS as f32;
    let aperture = Aperture::new(TAU / BEARINGS as f32, up_rad);
    let [roll, pitch] = stand.tilt_rad;
    let attitude = UnitQuaternion::from_euler_angles(roll, pitch, stand.turn_rad);
    let mut radiances = [[0.0; ROWS]; BEARINGS];
    for (n, column) in radiances.iter_mut().enumerate() {
        let bearing = TAU * n as f32 / BEARINGS as f32;
        for (row, radiance) in column.iter_mut().enumerate() {
            let elevation = (row as f32 + 0.5) * up_rad - 0.5 * ELEVATIONS_RAD;
            let level = libm::cosf(elevation);
            let way = Vector3::new(
                level * libm::cosf(bearing),
                level * libm::sinf(bearing),
                libm::sinf(elevation),
            );
            *radiance = look(&seen, &from, attitude * way, &aperture, extras);
        }
    }
    exposed(&radiances)
}

fn look(
    seen: &Viewpoint<'_>,
    from: &Vector3<f32>,
    way: Vector3<f32>,
    aperture: &Aperture,
    extras: &Extras,
) -> f32 {
    let pillars = extras.pillars.iter();
    let touched = pillars.filter_map(|pillar| Some((pillar.distance_m(from, &way)?, pillar)));
    let nearest = touched.min_by(|a, b| a.0.total_cmp(&b.0));
    if nearest.is_none() && extras.light.is_none() {
        return seen.radiance(way, aperture);
    }
    let behind_m = seen.distance_m(way);
    let (radiance, distance_m) = match nearest {
        Some((distance_m, pillar)) if behind_m.is_none_or(|behind_m| distance_m < behind_m) => {
            (pillar.radiance, Some(distance_m))
        }
        _ => (seen.radiance(way, aperture), behind_m),
    };
    match (&extras.light, distance_m) {
        (Some(light), Some(distance_m)) => radiance * light.level(&(from + way * distance_m)),
        _ => radiance,
    }
}

impl Pillar {
    /// Metres to it along a unit vector.
    fn distance_m(&self, from: &Vector3<f32>, way: &Vector3<f32>) -> Option<f32> {
        let [x, y] = [self.at_m[0] - from.x, self.at_m[1] - from.y];
        let level = libm::hypotf(way.x, way.y);
        let ahead_m = (x * way.x + y * way.y) / level;
        let aside2 = x * x + y * y - ahead_m * ahead_m;
        let half2 = self.radius_m * self.radius_m - aside2;
        if half2 <= 0.0 || ahead_m <= 0.0 {
            return None;
        }
        let distance_m = (ahead_m - half2.sqrt()) / level;
        let height_m = from.z + distance_m * way.z;
        (distance_m > 0.0 && (0.0..=self.height_m).contains(&height_m)).then_some(distance_m)
    }
}

impl SideLight {
    /// Factor on the light at a point.
    fn level(&self, point: &Vector3<f32>) -> f32 {
        let [x, y] = [point.x - self.middle_m[0], point.y - self.middle_m[1]];
        let along = (x * TO_THE_LAMP[0] + y * TO_THE_LAMP[1]) / self.reach_m;
        1.0 + self.share * along.clamp(-1.0, 1.0)
    }
}

/// Luma by bearing at the exposure that gives the view its mean.
fn exposed(radiances: &[[f32; ROWS]; BEARINGS]) -> Luma {
    let mut gain = 1.0;
    let mut view = columns(radiances, gain);
    for _ in 0..EXPOSURE_STEPS {
        let mean = view.iter().sum::<f32>() / BEARINGS as f32;
        if mean <= 0.0 {
            break;
        }
        gain *= MEAN_LUMA / mean;
        view = columns(radiances, gain);
    }
    view
}

fn columns(radiances: &[[f32; ROWS]; BEARINGS], gain: f32) -> Luma {
    let luma = |column: &[f32; ROWS]| {
        let pixels = column.iter().map(|radiance| (radiance * gain).min(WHITE));
        pixels.sum::<f32>() / ROWS as f32
    };
    core::array::from_fn(|n| luma(&radiances[n]))
}

/// Metres that a robot keeps from what stands there.
const CLEARANCE_M: f32 = 0.15;
/// Directions in which is looked for it.
const FEELERS: usize = 16;

/// Closes the positions of a grid, at a height, that have something too near.
pub fn close_what_is_occupied(world: &World, grid: &mut Grid, height_m: f32) {
    for index in 0..grid.free.len() {
        let [x, y] = grid.position_m(index);
        let seen = world.seen_from(Vector3::new(x, y, height_m), 0.0);
        grid.free[index] = (0..FEELERS).all(|feeler| {
            let bearing = TAU * feeler as f32 / FEELERS as f32;
            let way = Vector3::new(libm::cosf(bearing), libm::sinf(bearing), 0.0);
            seen.distance_m(way)
                .is_none_or(|free_m| free_m > CLEARANCE_M)
        });
    }
}
