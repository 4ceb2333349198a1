//! From a pose to the light on each pixel: one precomputed ray per pixel of the annulus.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use super::lens::PanoramicLens;
use super::{HEIGHT, WIDTH};
use crate::world::{Aperture, FAN, World};

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

/// What a row of the image is exposed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Where the camera is.
    pub pose: Pose,
    /// Seconds of flight: what the world does by then.
    pub time_s: f64,
}

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
/// [`render_rows`](Self::render_rows), and each [`row`](Self::row) taken when it and its neighbours
/// are there.
#[derive(Clone, Debug)]
pub struct AnnulusRenderer {
    /// Row by row.
    rays: Vec<PixelRay>,
    /// The first ray of each row, and the number of rays.
    row_starts: Vec<usize>,
    sharp: Vec<f32>,
    /// Blurred along the rows.
    streaked: Vec<f32>,
    /// Blurred both ways.
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
        let mut renderer = Self {
            row_starts: (0..=HEIGHT).map(row_start).collect(),
            rays,
            streaked: sharp.clone(),
            blurred: sharp.clone(),
            sharp,
        };
        for row in 0..HEIGHT {
            renderer.streak(row);
        }
        renderer
    }

    /// Radiance on each pixel, row by row ([`WIDTH`] x [`HEIGHT`]), all seen at one moment; 1 is white
    /// paper in the world's own light.
    pub fn render(&mut self, world: &World, moment: &Moment) -> &[f32] {
        self.render_rows(0..HEIGHT, world, moment);
        for row in 0..HEIGHT {
            self.row(row);
        }
        &self.blurred
    }

    /// Renders `rows` (as far as the image has them) as seen at `moment`: with a rolling shutter, each
    /// row has its own.
    pub fn render_rows(&mut self, rows: Range<usize>, world: &World, moment: &Moment) {
        let [start, end] = [rows.start, rows.end].map(|row| row.min(HEIGHT));
        let [first, last] = [start, end].map(|row| self.row_starts[row]);
        if first >= last {
            return;
        }
        let viewpoint = world.seen_from(moment.pose.position_m, moment.time_s);
        let to_world = moment.pose.attitude.to_rotation_matrix();
        for rays in self.rays[first..last].chunks(FAN) {
            // The last fan of a row is filled up with its last ray.
            let ray = |n: usize| &rays[n.min(rays.len() - 1)];
            let ways = core::array::from_fn(|n| to_world * ray(n).direction);
            let apertures = core::array::from_fn(|n| ray(n).aperture);
            let radiances = viewpoint.radiances(&ways, &apertures, rays.len());
            for (ray, radiance) in rays.iter().zip(radiances) {
                self.sharp[ray.index] = radiance;
            }
        }
        for row in start..end {
            self.streak(row);
        }
    }

    /// Radiance on each pixel of `row` (below [`HEIGHT`]), blurred with what was rendered last of it
    /// and of the rows next to it.
    pub fn row(&mut self, row: usize) -> &[f32] {
        let line = row * WIDTH..(row + 1) * WIDTH;
        if (1..HEIGHT - 1).contains(&row) {
            let above = &self.streaked[line.start - WIDTH..line.start];
            let here = &self.streaked[line.clone()];
            let below = &self.streaked[line.end..line.end + WIDTH];
            blur_columns(above, here, below, &mut self.blurred[line.clone()]);
        }
        &self.blurred[line]
    }

    fn streak(&mut self, row: usize) {
        let line = row * WIDTH..(row + 1) * WIDTH;
        blur_row(&self.sharp[line.clone()], &mut self.streaked[line]);
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

/// Binomial blur (1, 2, 1)/4 along a row: standard deviation 0.7 pixels.
fn blur_row(from: &[f32], to: &mut [f32]) {
    for (blurred, triple) in to[1..].iter_mut().zip(from.windows(3)) {
        *blurred = 0.25 * (triple[0] + triple[2]) + 0.5 * triple[1];
    }
}

/// The same along the columns of three rows.
fn blur_columns(above: &[f32], here: &[f32], below: &[f32], to: &mut [f32]) {
    for (blurred, ((a, h), b)) in to.iter_mut().zip(above.iter().zip(here).zip(below)) {
        *blurred = 0.25 * (a + b) + 0.5 * h;
    }
}
