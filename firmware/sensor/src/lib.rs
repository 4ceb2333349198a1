//! Image-sensor drivers over `embedded-hal-async` I2C.
//!
//! A driver knows the sensor's registers and its arithmetic; pins, clocks, delays and time-outs
//! belong to the board that holds it. Every sensor is an [`ImageSensor`]; the first is the
//! [`Tcm8230`].
#![no_std]

mod error;
pub mod tcm8230;

use core::time::Duration;

pub use error::Error;
pub use tcm8230::Tcm8230;

/// What one frame looks like on the parallel bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Geometry {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// Bytes of each pixel; on an 8-bit bus this is also the number of pixel clocks.
    pub bytes_per_pixel: u8,
    /// Offset of the luma byte within a pixel.
    pub luma_offset: u8,
}

impl Geometry {
    /// Bytes, and pixel clocks, of one line.
    pub const fn line_bytes(self) -> usize {
        self.width as usize * self.bytes_per_pixel as usize
    }

    /// Bytes of one frame.
    pub const fn frame_bytes(self) -> usize {
        self.line_bytes() * self.height as usize
    }
}

/// An image sensor whose shutter and gain are set by hand.
///
/// The futures are cancel-safe in this sense: after a dropped one the sensor may hold old or new
/// values in each register, never a value nobody asked for; the bus itself is the board's to free.
#[expect(
    async_fn_in_trait,
    reason = "callers are generic over the sensor and never need the futures to be Send"
)]
pub trait ImageSensor {
    /// The I2C bus's own error.
    type BusError: embedded_hal_async::i2c::Error;

    /// Asks the sensor who it is.
    ///
    /// # Errors
    /// [`Error::Bus`] where nobody answers, [`Error::NotFound`] where somebody else does.
    async fn probe(&mut self) -> Result<(), Error<Self::BusError>>;

    /// Brings the sensor from reset to streaming frames of [`geometry`](Self::geometry) with its
    /// automatic exposure and white balance off and the given shutter and gain
    /// (as [`set_exposure`](Self::set_exposure) takes them).
    ///
    /// # Errors
    /// [`Error::Bus`]: the sensor may be half set up; reset it and begin again.
    async fn init(&mut self, lines: u16, gain: f32) -> Result<(), Error<Self::BusError>>;

    /// Sets the shutter in lines and the analogue gain as a factor, together: no frame is exposed
    /// with one of the two. Values outside the sensor's range are clamped to it.
    ///
    /// # Errors
    /// [`Error::Bus`]: the sensor holds the old or the new exposure.
    async fn set_exposure(&mut self, lines: u16, gain: f32) -> Result<(), Error<Self::BusError>>;

    /// The frames it sends.
    fn geometry(&self) -> Geometry;

    /// The time of one line: the unit of the shutter.
    fn line_time(&self) -> Duration;

    /// The longest shutter in lines; the shortest is 1.
    fn max_lines(&self) -> u16;

    /// How many frames after the one in which a new exposure is written show it in full.
    fn latency_frames(&self) -> u8;

    /// Frames after [`init`](Self::init) that carry no picture yet.
    fn settling_frames(&self) -> u8;
}
