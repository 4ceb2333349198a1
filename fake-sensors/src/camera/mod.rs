//! The panoramic camera: world, lens and image sensor, from a pose to the bytes on the bus.

mod blemish;
mod flicker;
mod lens;
mod pattern;
mod render;
mod sensor;
pub mod tcm8230;

pub use blemish::{BadPixel, Blemishes};
pub use flicker::Flicker;
pub use lens::{Direction, PanoramicLens, View};
pub use pattern::TestPattern;
pub use render::{AnnulusRenderer, Moment, Pose};
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

/// A line in bus order.
pub type Line = [u8; LINE_BYTES];

/// A camera with a panoramic lens, looking at a world.
///
/// The shutter rolls: a frame is [begun](Self::begin_frame), and each row [lit](Self::light_row) at a
/// moment of its own and then [read out](Self::read_row). Its bytes depend on nothing but world, lens,
/// seed, tuning and the arguments of those three: every backend that asks for the same frame gets the same bytes.
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

    /// Turns all lamps up or down: `light` times the world's own.
    pub fn set_light(&mut self, light: f32) {
        self.sensor.set_light(light);
    }

    /// Lets all lamps flicker; they do not before.
    pub fn set_flicker(&mut self, flicker: Flicker) {
        self.sensor.set_flicker(flicker);
    }

    /// Takes frame `frame_number` all at one moment (the pose is that of the optic, whose centre is
    /// the camera's).
    pub fn expose(&mut self, moment: &Moment, exposure: Exposure, frame_number: u32) -> &Frame {
        self.begin_frame(frame_number);
        self.renderer.render_rows(0..HEIGHT, &self.world, moment);
        for row in 0..HEIGHT {
            self.read_row(row, exposure);
        }
        &self.frame
    }

    /// Begins frame `frame_number`.
    pub fn begin_frame(&mut self, frame_number: u32) {
        self.sensor.begin_frame(frame_number);
    }

    /// Lets the light of `moment` fall on row `row` (below [`HEIGHT`]).
    pub fn light_row(&mut self, row: usize, moment: &Moment) {
        self.renderer.render_rows(row..row + 1, &self.world, moment);
    }

    /// Reads row `row` (below [`HEIGHT`]) out. The optic blurs: the rows next to it must have their
    /// light as well.
    pub fn read_row(&mut self, row: usize, exposure: Exposure) -> &Line {
        let (lines, _) = self.frame.as_chunks_mut::<LINE_BYTES>();
        let line = &mut lines[row];
        self.sensor
            .form_row(row, self.renderer.row(row), exposure, line);
        line
    }

    /// The frame that the sensor puts out while it masks its output.
    #[must_use]
    pub fn black_frame() -> Box<Frame> {
        let mut frame = Box::new([0; FRAME_BYTES]);
        let (pixels, _) = frame.as_chunks_mut::<2>();
        pixels.fill(sensor::BLACK_PIXEL);
        frame
    }
}

#[cfg(test)]
mod tests;
