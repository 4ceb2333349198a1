//! The image sensor's pixels and luma chain: light to bytes.
//!
//! Per pixel: radiance x exposure x vignetting, photon and read noise, clipping at full well, then
//! gain, gamma, contrast and black level as in the TCM8230MD's data path, and UYVY packing.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::blemish::{BadPixel, Blemishes};
use super::flicker::Flicker;
use super::lens::PanoramicLens;
use super::pattern::TestPattern;
use super::{HEIGHT, Line, WIDTH};
use crate::vectors::{self, Kernel, split, within};

/// Longest shutter of the normal mode: one frame of scan lines.
pub const MAX_EXPOSURE_LINES: u16 = 525;
/// Shutter at which white (radiance 1) in the world's own light just saturates at gain 1: sets the
/// lamps of the room such that a grey room (0.22) reaches the usual mean luma of 80 at about 150
/// lines, 11 ms at 21 MHz. Indoor light for an F2.8 lens; an assumption.
const WHITE_LINES: f32 = 125.0;
/// Electrons at saturation, gain 1: typical of 3.75 um pixels of 2004; an assumption.
const FULL_WELL_E: f32 = 9_000.0;
/// Read noise in electrons, standard deviation; an assumption, as above.
const READ_NOISE_E: f32 = 20.0;
/// Focal length of the sensor's own lens in pixels of 128 x 96 (57.4 degrees across).
const FOCAL_LENGTH_PX: f32 = 117.0;
/// Exponent of the sensor's gamma correction.
const GAMMA: f32 = 0.55;
/// Neutral chroma, as in the data sheet's blanking bytes.
const NEUTRAL: u8 = 0x80;
/// Chroma and luma of a masked pixel: the data sheet's blanking bytes.
pub(super) const BLACK_PIXEL: [u8; 2] = [NEUTRAL, 0x00];

/// Stream of the seed that frame 0 takes its noise from: "came" in ASCII, clear of the streams that
/// other sensors take from the same seed.
const FIRST_STREAM: u64 = u64::from_be_bytes(*b"came\0\0\0\0");

/// Shutter and analogue gain of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Integration time in scan lines, 1..=525. A line gathers the same light whatever the clock:
    /// the world's lamps are set for 21 MHz.
    pub lines: u16,
    /// Analogue gain, 1..=16.
    pub gain: f32,
}

/// The chip's image tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageTuning {
    /// Gamma 0.55 instead of a linear characteristic.
    pub gamma: bool,
    /// Factor on luma.
    pub contrast: f32,
    /// Luma counts added last.
    pub black_level: f32,
    /// Gain after the converter, 1..2.
    pub digital_gain: f32,
    /// Bad pixels take the mean of their neighbours.
    pub blemish_correction: bool,
    /// A picture of the chip's own, instead of what it sees.
    pub test_pattern: Option<TestPattern>,
}

impl Default for ImageTuning {
    /// The chip's reset values, but for gamma, which a driver that meters light switches off.
    fn default() -> Self {
        Self {
            gamma: false,
            contrast: 154.0 / 128.0,
            black_level: 12.0,
            digital_gain: 1.0,
            blemish_correction: true,
            test_pattern: None,
        }
    }
}

/// The sensor's converter has 10 bits.
const CONVERTER_LEVELS: usize = 1 << 10;

impl ImageTuning {
    /// Luma of every converter level.
    fn tone_curve(&self) -> Vec<u8> {
        let top = (CONVERTER_LEVELS - 1) as f32;
        (0..CONVERTER_LEVELS)
            .map(|level| self.luma(level as f32 / top))
            .collect()
    }

    /// Luma of a pixel at `fraction` of the converter's range (0..=1).
    fn luma(&self, fraction: f32) -> u8 {
        let linear = (fraction * self.digital_gain).min(1.0);
        let shaped = if self.gamma {
            libm::powf(linear, GAMMA)
        } else {
            linear
        };
        // The cast saturates at 0 and 255.
        (255.0 * self.contrast * shaped + self.black_level + 0.5) as u8
    }
}

/// Turns radiance into frames.
#[derive(Clone, Debug)]
pub struct ImageSensor {
    tuning: ImageTuning,
    tone_curve: Vec<u8>,
    /// The lamps' strength over that of the world's own.
    light: f32,
    flicker: Flicker,
    frame_number: u32,
    /// Light that reaches each pixel: the lens's fall-off, and dust.
    shading: Vec<f32>,
    blemishes: Blemishes,
    /// The start of the noise; each frame has a stream of its own.
    noise: ChaCha8Rng,
    noise_bits: Vec<[u8; 4]>,
}

impl ImageSensor {
    /// A sensor whose optical axis goes through the middle of `lens`'s ring; `seed` fixes its noise and
    /// its blemishes.
    #[must_use]
    pub fn new(lens: &PanoramicLens, seed: u64) -> Self {
        let blemishes = Blemishes::new(lens, seed);
        let shading = (0..WIDTH * HEIGHT)
            .map(|index| {
                let centre = [(index % WIDTH) as f32 + 0.5, (index / WIDTH) as f32 + 0.5];
                cos_fourth(lens.distance_from_centre(centre)) * blemishes.transmission(centre)
            })
            .collect();
        Self {
            tuning: ImageTuning::default(),
            tone_curve: ImageTuning::default().tone_curve(),
            light: 1.0,
            flicker: Flicker::NONE,
            frame_number: 0,
            shading,
            blemishes,
            noise: ChaCha8Rng::seed_from_u64(seed),
            noise_bits: vec![[0; 4]; WIDTH * HEIGHT],
        }
    }

    /// Sets the image tuning.
    pub fn set_tuning(&mut self, tuning: ImageTuning) {
        if tuning != self.tuning {
            self.tuning = tuning;
            self.tone_curve = tuning.tone_curve();
        }
    }

    /// Turns all lamps up or down: `light` times the world's own.
    pub fn set_light(&mut self, light: f32) {
        self.light = light;
    }

    /// Lets all lamps flicker; they do not before.
    pub fn set_flicker(&mut self, flicker: Flicker) {
        self.flicker = flicker;
    }

    /// Begins frame `frame_number`: its noise, and where the lamps' flicker stands.
    pub fn begin_frame(&mut self, frame_number: u32) {
        self.frame_number = frame_number;
        let mut noise = self.noise.clone();
        noise.set_stream(FIRST_STREAM + u64::from(frame_number));
        noise.fill_bytes(self.noise_bits.as_flattened_mut());
    }

    /// Forms row `row` (below [`HEIGHT`]) of the frame from its `radiance` ([`WIDTH`] values).
    pub fn form_row(&self, row: usize, radiance: &[f32], exposure: Exposure, line: &mut Line) {
        if let Some(pattern) = self.tuning.test_pattern {
            pattern.draw(&self.tone_curve, line);
            return;
        }
        let pixels = row * WIDTH..(row + 1) * WIDTH;
        let (shading, bits) = (
            &self.shading[pixels.clone()],
            &self.noise_bits[pixels.clone()],
        );
        let light = self.light * self.flicker.share(self.frame_number, row, exposure.lines);
        let electrons_per_radiance = light * FULL_WELL_E * f32::from(exposure.lines) / WHITE_LINES;
        let top = (CONVERTER_LEVELS - 1) as f32;
        let levels_per_electron = exposure.gain * top / FULL_WELL_E;
        // Two passes: the first has no branches and no tables, and the compiler takes several pixels at once.
        let mut levels = [0; WIDTH];
        vectors::run(Convert {
            radiance,
            shading,
            bits,
            electrons_per_radiance,
            levels_per_electron,
            levels: &mut levels,
        });
        let (pixels, _) = line.as_chunks_mut::<2>();
        for (pixel, level) in pixels.iter_mut().zip(levels) {
            *pixel = [NEUTRAL, self.tone_curve[level]];
        }
        self.spoil(row, pixels);
    }

    /// Bad pixels, or what the chip makes of them: the mean of the pixels beside them.
    fn spoil(&self, row: usize, pixels: &mut [[u8; 2]]) {
        for (column, kind) in self.blemishes.bad_in(row) {
            let luma = |column: usize| u16::from(pixels[column][1]);
            pixels[column][1] = if self.tuning.blemish_correction {
                let (left, right) = (column.saturating_sub(1), (column + 1).min(WIDTH - 1));
                ((luma(left) + luma(right)) / 2) as u8
            } else {
                match kind {
                    BadPixel::Dead => self.tone_curve[0],
                    BadPixel::Hot => self.tone_curve[CONVERTER_LEVELS - 1],
                }
            };
        }
    }
}

/// What the converter makes of the light on some pixels.
struct Convert<'p> {
    radiance: &'p [f32],
    shading: &'p [f32],
    /// Noise.
    bits: &'p [[u8; 4]],
    electrons_per_radiance: f32,
    levels_per_electron: f32,
    levels: &'p mut [usize],
}

impl Kernel for Convert<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let top = (CONVERTER_LEVELS - 1) as f32;
        let lit = self.radiance.iter().zip(self.shading);
        for ((level, (light, shading)), &bits) in self.levels.iter_mut().zip(lit).zip(self.bits) {
            let expected = light * shading * self.electrons_per_radiance;
            let sigma = (expected + READ_NOISE_E * READ_NOISE_E).sqrt();
            let electrons = (expected + sigma * deviate(bits)).min(FULL_WELL_E);
            (*level, _) = split(within(electrons * self.levels_per_electron + 0.5, top));
        }
    }
}

/// Natural fall-off of a lens: cos^4 of the field angle.
fn cos_fourth(radius_px: f32) -> f32 {
    let tan = radius_px / FOCAL_LENGTH_PX;
    let cos_squared = 1.0 / (1.0 + tan * tan);
    cos_squared * cos_squared
}

/// A deviate of mean 0 and variance 1: the sum of four even deviates (Irwin-Hall), normal out to
/// 3.4 standard deviations, and thirty times cheaper than a logarithm and a sine per pixel.
#[inline(always)]
fn deviate(bits: [u8; 4]) -> f32 {
    /// Four times the mean of a byte.
    const MEAN: f32 = 510.0;
    /// 1 / sqrt(4 (256^2 - 1) / 12).
    const SCALE: f32 = 0.006_765_875;
    let word = u32::from_le_bytes(bits);
    let pairs = (word & 0x00ff_00ff) + (word >> 8 & 0x00ff_00ff);
    let sum = (pairs & 0xffff) + (pairs >> 16);
    (sum as i32 as f32 - MEAN) * SCALE
}
