//! The panoramic camera: world, lens and image sensor, from a pose to the bytes on the bus.

mod lens;
mod render;
mod sensor;
pub mod tcm8230;

pub use lens::{Direction, PanoramicLens, View};
pub use render::{AnnulusRenderer, Pose};
pub use sensor::{Exposure, ImageSensor, ImageTuning, MAX_EXPOSURE_LINES};

use crate::world::World;

/// Image width in pixels: sub-QCIF.
pub const WIDTH: usize = 128;
/// Image height in pixels.
pub const HEIGHT: usize = 96;
/// Bytes per line: U Y V Y, two bytes per pixel.
pub const LINE_BYTES: usize = 2 * WIDTH;
/// Bytes per frame.
pub const FRAME_BYTES: usize = LINE_BYTES * HEIGHT;

/// A frame in bus order: lines top to bottom, each U0 Y0 V0 Y1 U2 Y2 ...
pub type Frame = [u8; FRAME_BYTES];

/// A camera with a panoramic lens, looking at a world.
///
/// The bytes of a frame depend on nothing but world, lens, seed, tuning and the arguments of
/// [`expose`](Self::expose): every backend that asks for the same frame gets the same bytes.
#[derive(Clone, Debug)]
pub struct PanoramicCamera {
    world: World,
    renderer: AnnulusRenderer,
    sensor: ImageSensor,
    frame: Box<Frame>,
}

impl PanoramicCamera {
    /// A camera in `world` behind `lens`; `seed` fixes its noise.
    #[must_use]
    pub fn new(world: World, lens: &PanoramicLens, seed: u64) -> Self {
        Self {
            world,
            renderer: AnnulusRenderer::new(lens),
            sensor: ImageSensor::new(lens, seed),
            frame: Box::new([0; FRAME_BYTES]),
        }
    }

    /// The world the camera looks at.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The last frame.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Sets the sensor's image tuning; the default is that of an initialised chip.
    pub fn set_tuning(&mut self, tuning: ImageTuning) {
        self.sensor.set_tuning(tuning);
    }

    /// Takes frame `frame_number` from `pose` (of the optic, whose centre is the camera's).
    pub fn expose(&mut self, pose: &Pose, exposure: Exposure, frame_number: u32) -> &Frame {
        let radiance = self.renderer.render(&self.world, pose, 0.0);
        self.sensor
            .form_image(radiance, exposure, frame_number, &mut self.frame);
        &self.frame
    }

    /// The frame that the sensor puts out while it masks its output.
    pub fn black_frame(&mut self) -> &Frame {
        let (pixels, _) = self.frame.as_chunks_mut::<2>();
        pixels.fill(sensor::BLACK_PIXEL);
        &self.frame
    }
}

#[cfg(test)]
mod tests;
