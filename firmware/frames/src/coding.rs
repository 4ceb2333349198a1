//! How the bytes of a frame are written into its pieces.
//!
//! As they are, or, where every byte but the luma is neutral, as the steps of the luma from pixel to
//! pixel, a nibble each: 0 to 14 are steps of -7 to 7; 15 says that the two nibbles behind it are the
//! luma itself, the upper first. A piece begins at a luma of zero. An odd nibble at its end is a 15
//! with nothing behind it.
//!
//! Of the frames of a TCM8230MD without colour, 24,576 bytes, the luma are half, and the steps, with
//! the sensor's noise of two units, 36 % to 41 %: at 3 Mbaud 12, 24 and 29 to 33 frames a second,
//! where the camera gives 25.6. (Runs of equal luma are rare: the noise is on the dark corners, too.)

use crate::shape::Shape;

/// The chroma of grey.
pub const NEUTRAL: u8 = 0x80;

/// The step of nibble 0 is minus this.
const LARGEST_STEP: u8 = 7;

/// Fills the last byte of a piece: an escape that is never finished.
pub(crate) const PADDING: u8 = ESCAPE;

/// What is no step.
const ESCAPE: u8 = 0xf;

/// The ways to write a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// The bytes.
    Bytes,
    /// The steps of the luma.
    Steps,
}

impl Coding {
    /// The shorter one that says all of `frame`.
    pub(crate) fn of(frame: &[u8], shape: &Shape) -> Self {
        let size = usize::from(shape.bytes_per_pixel.max(1));
        let luma = usize::from(shape.luma_offset);
        let mut bytes = frame.iter().enumerate();
        if bytes.all(|(at, byte)| at % size == luma || *byte == NEUTRAL) {
            Self::Steps
        } else {
            Self::Bytes
        }
    }
}

/// The nibbles of one pixel behind one of luma `previous`, and how many they are.
pub(crate) fn nibbles(previous: u8, luma: u8) -> ([u8; 3], usize) {
    let step = luma.wrapping_sub(previous).wrapping_add(LARGEST_STEP);
    if step < ESCAPE {
        ([step, 0, 0], 1)
    } else {
        ([ESCAPE, luma >> 4, luma & 0xf], 3)
    }
}

/// What the next nibble is.
#[derive(Clone, Copy, Debug)]
enum Expected {
    Step,
    Upper,
    Lower { upper: u8 },
}

/// Writes what a piece says into a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Painter {
    coding: Coding,
    /// Where the next byte goes.
    at: usize,
    luma: u8,
    expected: Expected,
}

impl Painter {
    /// For a piece that begins at byte `at` of the frame.
    pub(crate) const fn new(coding: Coding, at: usize) -> Self {
        Self {
            coding,
            at,
            luma: 0,
            expected: Expected::Step,
        }
    }

    /// Where the byte behind the last one went, or would have gone.
    pub(crate) const fn at(&self) -> usize {
        self.at
    }

    /// Takes a byte of the piece. What lies beyond the frame is written nowhere.
    pub(crate) fn push(&mut self, byte: u8, shape: &Shape, frame: &mut [u8]) {
        match self.coding {
            Coding::Bytes => self.write(byte, frame),
            Coding::Steps => {
                for nibble in [byte >> 4, byte & 0xf] {
                    self.nibble(nibble, shape, frame);
                }
            }
        }
    }

    fn nibble(&mut self, nibble: u8, shape: &Shape, frame: &mut [u8]) {
        self.expected = match self.expected {
            Expected::Step if nibble == ESCAPE => Expected::Upper,
            Expected::Step => {
                let step = nibble.wrapping_sub(LARGEST_STEP);
                self.pixel(self.luma.wrapping_add(step), shape, frame);
                Expected::Step
            }
            Expected::Upper => Expected::Lower { upper: nibble },
            Expected::Lower { upper } => {
                self.pixel(upper << 4 | nibble, shape, frame);
                Expected::Step
            }
        };
    }

    fn pixel(&mut self, luma: u8, shape: &Shape, frame: &mut [u8]) {
        self.luma = luma;
        for offset in 0..shape.bytes_per_pixel {
            let is_luma = offset == shape.luma_offset;
            self.write(if is_luma { luma } else { NEUTRAL }, frame);
        }
    }

    fn write(&mut self, byte: u8, frame: &mut [u8]) {
        if let Some(place) = frame.get_mut(self.at) {
            *place = byte;
        }
        self.at += 1;
    }
}
