//! From a pose to the light on each pixel: one precomputed ray per pixel of the annulus.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use super::lens::PanoramicLens;
use super::{HEIGHT, WIDTH};
use crate::world::{Aperture, World};

/// The optic images this far beyond the ring's nominal edges, in pixels: users calibrate inside.
const RING_MARGIN_PX: f32 = 1.5;
/// Width of the fixture's bright rim outside the ring, in pixels.
const RIM_WIDTH_PX: f32 = 5.0;
/// Radiance of the dark hole in the middle: the camera sees itself.
const CENTRE_RADIANCE: f32 = 0.01;
/// Radiance of the rim: the lens body, lit by the room.
const RIM_RADIANCE: f32 = 0.6;
/// Radiance outside the rim: the inside of the holder.
const HOLDER_RADIANCE: f32 = 0.02;

/// Where the camera is and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position in the world in metres: x north, y west, z up.
    pub position_m: Vector3<f32>,
    /// Rotation from body (x forward, y left, z up) to world.
    pub attitude: UnitQuaternion<f32>,
}

/// A pixel's direction in the body frame.
#[derive(Clone, Copy, Debug)]
struct PixelRay {
    index: usize,
    direction: Vector3<f32>,
    aperture: Aperture,
}

/// Renders the annulus of a panoramic lens.
///
/// The world's textures are prefiltered to a pixel's footprint, and solids cover as much of a pixel
/// as they fill; a blur of about one pixel stands for the optic's poor focus, and smooths the edges
/// between walls that single rays leave jagged.
///
/// A frame is [`render`](Self::render)ed whole, or, for a rolling shutter, row by row with
/// [`render_rows`](Self::render_rows) and then [`finish`](Self::finish)ed.
#[derive(Clone, Debug)]
pub struct AnnulusRenderer {
    /// Row by row.
    rays: Vec<PixelRay>,
    /// The first ray of each row, and the number of rays.
    row_starts: Vec<usize>,
    sharp: Vec<f32>,
    scratch: Vec<f32>,
    blurred: Vec<f32>,
}

impl AnnulusRenderer {
    /// Prepares the rays of every pixel whose centre lies in the lens's ring.
    #[must_use]
    pub fn new(lens: &PanoramicLens) -> Self {
        let inner = lens.inner_radius_px - RING_MARGIN_PX;
        let outer = lens.outer_radius_px + RING_MARGIN_PX;
        let mut rays: Vec<PixelRay> = Vec::new();
        let mut sharp = vec![0.0; WIDTH * HEIGHT];
        for (index, pixel) in sharp.iter_mut().enumerate() {
            let centre = pixel_centre(index);
            let radius = lens.distance_from_centre(centre);
            if (inner..=outer).contains(&radius) {
                rays.push(PixelRay::new(lens, index, radius));
            } else if radius < inner {
                *pixel = CENTRE_RADIANCE;
            } else if radius < outer + RIM_WIDTH_PX {
                *pixel = RIM_RADIANCE;
            } else {
                *pixel = HOLDER_RADIANCE;
            }
        }
        let row_start = |row| rays.partition_point(|ray| ray.index < row * WIDTH);
        Self {
            row_starts: (0..=HEIGHT).map(row_start).collect(),
            rays,
            scratch: sharp.clone(),
            blurred: sharp.clone(),
            sharp,
        }
    }

    /// Radiance on each pixel, row by row ([`WIDTH`] x [`HEIGHT`]), all seen from `pose` at `time_s`;
    /// 1 is white paper in the world's own light.
    pub fn render(&mut self, world: &World, pose: &Pose, time_s: f64) -> &[f32] {
        self.render_rows(0..HEIGHT, world, pose, time_s);
        self.finish()
    }

    /// Renders `rows` (as far as the image has them) as seen from `pose` at `time_s` (seconds of
    /// flight): with a rolling shutter, each row has its own.
    pub fn render_rows(&mut self, rows: Range<usize>, world: &World, pose: &Pose, time_s: f64) {
        let [first, last] = [rows.start, rows.end].map(|row| self.row_starts[row.min(HEIGHT)]);
        if first >= last {
            return;
        }
        let viewpoint = world.seen_from(pose.position_m, time_s);
        let to_world = pose.attitude.to_rotation_matrix();
        for ray in &self.rays[first..last] {
            self.sharp[ray.index] = viewpoint.radiance(to_world * ray.direction, &ray.aperture);
        }
    }

    /// Blurs the rows rendered last into a frame: radiance on each pixel, as from
    /// [`render`](Self::render).
    pub fn finish(&mut self) -> &[f32] {
        blur_rows(&self.sharp, &mut self.scratch);
        blur_columns(&self.scratch, &mut self.blurred);
        &self.blurred
    }
}

impl PixelRay {
    fn new(lens: &PanoramicLens, index: usize, radius_px: f32) -> Self {
        let view = lens.view(pixel_centre(index));
        let (sin_bearing, cos_bearing) = libm::sincosf(view.bearing_rad);
        let (sin_elevation, cos_elevation) = libm::sincosf(view.elevation_rad);
        let width = cos_elevation / radius_px;
        Self {
            index,
            direction: Vector3::new(
                cos_elevation * cos_bearing,
                cos_elevation * sin_bearing,
                sin_elevation,
            ),
            aperture: Aperture::new(width, lens.elevation_per_px()),
        }
    }
}

fn pixel_centre(index: usize) -> [f32; 2] {
    [(index % WIDTH) as f32 + 0.5, (index / WIDTH) as f32 + 0.5]
}

/// Binomial blur (1, 2, 1)/4 along each row: standard deviation 0.7 pixels.
fn blur_rows(from: &[f32], to: &mut [f32]) {
    for (source, target) in from.chunks_exact(WIDTH).zip(to.chunks_exact_mut(WIDTH)) {
        for (blurred, triple) in target[1..].iter_mut().zip(source.windows(3)) {
            *blurred = 0.25 * (triple[0] + triple[2]) + 0.5 * triple[1];
        }
    }
}

/// The same along each column.
fn blur_columns(from: &[f32], to: &mut [f32]) {
    let interior = WIDTH..from.len() - WIDTH;
    let above = from.iter();
    let here = from[WIDTH..].iter();
    let below = from[2 * WIDTH..].iter();
    for (blurred, ((a, h), b)) in to[interior].iter_mut().zip(above.zip(here).zip(below)) {
        *blurred = 0.25 * (a + b) + 0.5 * h;
    }
}
