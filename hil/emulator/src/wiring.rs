//! What is soldered to the chip: the seam between the emulated STM32F407 and the world around it.
//!
//! The emulator calls these methods in the order of virtual time. Nothing here knows what a drone
//! is; a test may wire a blinking LED.

use crate::time::Nanos;

/// One pin of a GPIO port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pin {
    /// The port's letter: 'A'..='I'.
    pub port: char,
    /// 0..=15.
    pub number: u8,
}

/// What a parallel camera does at its next signal edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraSignal<'a> {
    /// VSYNC enters the level at which data is valid.
    FrameStart,
    /// The last byte of a line has been clocked out; HSYNC framed exactly these bytes.
    Line(&'a [u8]),
    /// VSYNC leaves the level at which data is valid.
    FrameEnd,
}

/// The devices around the chip. Every method has a default: an empty board.
pub trait Wiring {
    /// An output pin changed its level.
    fn pin_changed(&mut self, _now: Nanos, _pin: Pin, _high: bool) {}

    /// A timer or MCO clock output on a pin changed its frequency (`None`: stopped), in hertz.
    fn clock_changed(&mut self, _now: Nanos, _pin: Pin, _hertz: Option<f64>) {}

    /// A start condition and an address on I2C bus `bus` (1..=3). True: somebody acknowledged.
    fn i2c_start(&mut self, _now: Nanos, _bus: u8, _address: u8, _read: bool) -> bool {
        false
    }

    /// A byte from the chip. True: acknowledged.
    fn i2c_write(&mut self, _now: Nanos, _bus: u8, _byte: u8) -> bool {
        false
    }

    /// A byte for the chip.
    fn i2c_read(&mut self, _now: Nanos, _bus: u8) -> u8 {
        0xff
    }

    /// A stop condition.
    fn i2c_stop(&mut self, _now: Nanos, _bus: u8) {}

    /// When the camera on the DCMI port has its next edge; `None` while it is silent.
    /// May change after any call above.
    fn camera_next(&self) -> Option<Nanos> {
        None
    }

    /// Performs the edge that is due at `now` = `camera_next()`.
    fn camera_signal(&mut self, _now: Nanos) -> Option<CameraSignal<'_>> {
        None
    }
}

/// A bare chip.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwired;

impl Wiring for Unwired {}
