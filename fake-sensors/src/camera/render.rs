//! From a pose to the light on each pixel: one precomputed ray per pixel of the annulus.

use std::ops::Range;

use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use super::lens::PanoramicLens;
use super::{HEIGHT, WIDTH};
use crate::vectors::{self, Kernel};
use crate::world::{Aperture, Directions, FAN, Pixels, Viewpoint, World};

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

/// Pixels of a row that are rendered together.
#[derive(Clone, Debug)]
struct PixelFan {
    /// The pixels.
    indices: Vec<usize>,
    /// Their directions in the body frame; the last fills the fan up.
    directions: Directions,
    apertures: [Aperture; FAN],
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
    /// Of each row.
    fans: Vec<Vec<PixelFan>>,
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
        let mut in_ring: Vec<Vec<usize>> = vec![Vec::new(); HEIGHT];
        let mut sharp = vec![0.0; WIDTH * HEIGHT];
        for (index, pixel) in sharp.iter_mut().enumerate() {
            let radius = lens.distance_from_centre(pixel_centre(index));
            if (inner..=outer).contains(&radius) {
                in_ring[index / WIDTH].push(index);
            } else if radius < inner {
                *pixel = CENTRE_RADIANCE;
            } else if radius < outer + RIM_WIDTH_PX {
                *pixel = RIM_RADIANCE;
            } else {
                *pixel = HOLDER_RADIANCE;
            }
        }
        let fans_of = |row: &Vec<usize>| {
            let fans = row.chunks(FAN);
            fans.map(|pixels| PixelFan::new(lens, pixels)).collect()
        };
        let mut renderer = Self {
            fans: in_ring.iter().map(fans_of).collect(),
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
        let end = rows.end.min(HEIGHT);
        let rows = rows.start.min(end)..end;
        if self.fans[rows.clone()].iter().all(Vec::is_empty) {
            return;
        }
        let viewpoint = world.seen_from(moment.pose.position_m, moment.time_s);
        let to_world = moment.pose.attitude.to_rotation_matrix();
        for row in rows {
            vectors::run(Look {
                fans: &self.fans[row],
                viewpoint: &viewpoint,
                to_world: &to_world,
                sharp: &mut self.sharp,
            });
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

/// Renders the pixels of a row.
struct Look<'r> {
    fans: &'r [PixelFan],
    viewpoint: &'r Viewpoint<'r>,
    to_world: &'r Rotation3<f32>,
    sharp: &'r mut [f32],
}

impl Kernel for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut pixels = Pixels::none();
        for fan in self.fans {
            let ways = fan.directions.turned(self.to_world);
            let count = fan.indices.len();
            let radiances = self
                .viewpoint
                .radiances(&ways, &fan.apertures, count, &mut pixels);
            for (index, radiance) in fan.indices.iter().zip(radiances) {
                self.sharp[*index] = radiance;
            }
        }
    }
}

impl PixelFan {
    /// Of up to [`FAN`] pixels, one at least.
    fn new(lens: &PanoramicLens, pixels: &[usize]) -> Self {
        let pixel = |n: usize| pixels[n.min(pixels.len() - 1)];
        Self {
            indices: pixels.to_vec(),
            directions: Directions::new(&core::array::from_fn(|n| direction(lens, pixel(n)))),
            apertures: core::array::from_fn(|n| aperture(lens, pixel(n))),
        }
    }
}

/// Where a pixel looks, in the body frame.
fn direction(lens: &PanoramicLens, index: usize) -> Vector3<f32> {
    let view = lens.view(pixel_centre(index));
    let (sin_bearing, cos_bearing) = libm::sincosf(view.bearing_rad);
    let (sin_elevation, cos_elevation) = libm::sincosf(view.elevation_rad);
    Vector3::new(
        cos_elevation * cos_bearing,
        cos_elevation * sin_bearing,
        sin_elevation,
    )
}

/// How wide it looks.
fn aperture(lens: &PanoramicLens, index: usize) -> Aperture {
    let centre = pixel_centre(index);
    let (_, cos_elevation) = libm::sincosf(lens.view(centre).elevation_rad);
    let width = cos_elevation / lens.distance_from_centre(centre);
    Aperture::new(width, lens.elevation_per_px())
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
