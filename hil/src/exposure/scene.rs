//! What is looked at: radiance on every pixel, and which pixels are the horizon band.

use core::f32::consts::TAU;

use fake_sensors::camera::{
    AnnulusRenderer, Exposure, FRAME_BYTES, Frame, HEIGHT, ImageSensor, LINE_BYTES, Moment,
    PanoramicLens, Pose, View, WIDTH,
};
use fake_sensors::world::{UnknownWorld, World};
use nalgebra::{UnitQuaternion, Vector3};

use super::SET_POINT;

/// Seed of the worlds' textures and of the sensor's noise.
pub(super) const SEED: u64 = 1;
/// Half the height of the horizon band: 3 of the 16 rows that the ring of 90 degrees is unwrapped into.
const BAND_DEG: f32 = 3.0 * 90.0 / 16.0;
/// Where the camera stands: the height of flight, a little off the start of the routes.
const POSITION_M: [f32; 3] = [-1.1, 0.37, 0.5];
/// The setting at which a scene's light is measured.
const REFERENCE: Exposure = Exposure {
    lines: 135,
    gain: 1.0,
};

/// A part of the view that shines: bearings and elevations in degrees, radiance (1 is white paper in the world's own
/// light).
struct Glare {
    bearings_deg: [f32; 2],
    elevations_deg: [f32; 2],
    radiance: f32,
}

/// Lamps close above and daylight on the floor below: all outside the band, and as much light as all the rest together.
const LAMPS: [Glare; 2] = [
    Glare {
        bearings_deg: [-60.0, 60.0],
        elevations_deg: [25.0, 45.0],
        radiance: 20.0,
    },
    Glare {
        bearings_deg: [120.0, 200.0],
        elevations_deg: [-45.0, -25.0],
        radiance: 5.0,
    },
];
/// The sun through a window, at the height of the drone: a twelfth of the band.
const SUN: [Glare; 1] = [Glare {
    bearings_deg: [40.0, 70.0],
    elevations_deg: [-17.0, 17.0],
    radiance: 8.0,
}];

/// Name, world, and what shines in it.
const SCENES: [(&str, &str, &[Glare]); 6] = [
    ("arena", "arena-panels", &[]),
    ("office", "office", &[]),
    ("hall", "hall", &[]),
    ("forest", "forest", &[]),
    ("lamps", "arena-panels", &LAMPS),
    ("sun", "office", &SUN),
];

/// A scene that stands still.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What it is called.
    pub name: &'static str,
    radiance: Vec<f32>,
    light_for_a_line: f32,
}

impl Scene {
    /// All scenes, rendered.
    ///
    /// # Errors
    /// [`UnknownWorld`] if the library lacks one of them.
    pub fn all() -> Result<Vec<Self>, UnknownWorld> {
        SCENES
            .iter()
            .map(|(name, world, glare)| {
                let world = World::named(world, SEED)?;
                Ok(Self::new(name, &world, glare))
            })
            .collect()
    }

    fn new(name: &'static str, world: &World, glare: &[Glare]) -> Self {
        let lens = PanoramicLens::default();
        let moment = Moment {
            pose: Pose {
                position_m: Vector3::from(POSITION_M),
                attitude: UnitQuaternion::identity(),
            },
            time_s: 0.0,
        };
        let mut radiance = AnnulusRenderer::new(&lens).render(world, &moment).to_vec();
        for (index, light) in radiance.iter_mut().enumerate() {
            let view = lens.view(middle_of(index));
            let in_ring = view.elevation_rad.abs() <= lens.half_field_rad;
            for glare in glare.iter().filter(|glare| in_ring && glare.covers(view)) {
                *light = glare.radiance;
            }
        }
        let band = Band::new();
        let mut sensor = ImageSensor::new(&lens, SEED);
        let mut frame = Box::new([0; FRAME_BYTES]);
        let mut scale = 1.0_f32;
        // Bisection of the logarithm, 2^-16 to 2^16: the luma grows with the light.
        for step in (0..16).map(|halving| libm::exp2f(8.0 / f32::from(1_u16 << halving))) {
            sensor.set_light(scale);
            form(&mut sensor, &radiance, REFERENCE, 0, &mut frame);
            scale *= if band.luma(&frame) < SET_POINT {
                step
            } else {
                1.0 / step
            };
        }
        Self {
            name,
            radiance,
            light_for_a_line: scale * f32::from(REFERENCE.lines),
        }
    }

    /// Light on each pixel, row by row, in the world's own light.
    pub(super) fn radiance(&self) -> &[f32] {
        &self.radiance
    }

    /// How many times the world's own light it takes for a linear sensor to need so many lines at gain 1.
    pub(super) fn light(&self, needs_lines: f64) -> f32 {
        self.light_for_a_line / needs_lines as f32
    }
}

impl Glare {
    fn covers(&self, view: View) -> bool {
        let [from, to] = self.bearings_deg.map(f32::to_radians);
        let [low, high] = self.elevations_deg.map(f32::to_radians);
        (view.bearing_rad - from).rem_euclid(TAU) <= to - from
            && (low..=high).contains(&view.elevation_rad)
    }
}

/// The pixels of the horizon band.
#[derive(Clone, Debug)]
pub(super) struct Band {
    /// The byte of each pixel's luma, and its share of the band: as much of it as lies inside, and more of it near the
    /// centre, where a pixel sees more bearings.
    weights: Vec<(usize, f64)>,
}

impl Band {
    pub(super) fn new() -> Self {
        let lens = PanoramicLens::default();
        let mut weights: Vec<(usize, f64)> = (0..WIDTH * HEIGHT)
            .map(|index| {
                let view = lens.view(middle_of(index));
                let to_edge_rad = BAND_DEG.to_radians() - view.elevation_rad.abs();
                let inside = (to_edge_rad / lens.elevation_per_px() + 0.5).clamp(0.0, 1.0);
                let radius_px = lens.distance_from_centre(middle_of(index));
                (2 * index + 1, f64::from(inside / radius_px))
            })
            .filter(|(_, weight)| *weight > 0.0)
            .collect();
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Self { weights }
    }

    /// The band's mean luma.
    pub(super) fn luma(&self, frame: &Frame) -> f64 {
        self.weights
            .iter()
            .map(|(byte, weight)| f64::from(frame[*byte]) * weight)
            .sum()
    }
}

/// Forms frame `number` all at one moment.
pub(super) fn form(
    sensor: &mut ImageSensor,
    radiance: &[f32],
    exposure: Exposure,
    number: u32,
    frame: &mut Frame,
) {
    sensor.begin_frame(number);
    let (lines, _) = frame.as_chunks_mut::<LINE_BYTES>();
    for (row, (line, radiance)) in lines
        .iter_mut()
        .zip(radiance.chunks_exact(WIDTH))
        .enumerate()
    {
        sensor.form_row(row, radiance, exposure, line);
    }
}

fn middle_of(index: usize) -> [f32; 2] {
    [(index % WIDTH) as f32 + 0.5, (index / WIDTH) as f32 + 0.5]
}
