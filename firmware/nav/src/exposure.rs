//! Autoexposure on the horizon alone: the mean luma of a frame in, shutter and gain out.
//!
//! A sensor's own exposure control meters the whole image, the dark middle and the bright rim of a
//! panoramic lens included; the paper therefore regulates the horizon's mean luma itself.

/// What the sensor is set to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Exposure {
    /// Shutter time in sensor lines.
    pub shutter_lines: u16,
    /// Analogue gain, linear: 1 is 0 dB.
    pub gain: f32,
}

impl Exposure {
    /// Shutter times gain, lines: what the luma follows.
    fn product(&self) -> f32 {
        f32::from(self.shutter_lines) * self.gain
    }
}

/// What is known of the sensor, and how the control behaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExposureParameters {
    /// The mean luma to hold, 0..=255.
    pub set_point: f32,
    /// No change within this distance of the set-point, luma.
    pub dead_band: f32,
    /// Luma of a black scene.
    pub black_level: f32,
    /// Luma above black grows as exposure to this power: the sensor's gamma, 1 where it is off.
    pub gamma: f32,
    /// The shutter's shortest time, lines.
    pub shutter_min_lines: u16,
    /// The shutter's longest time, lines.
    pub shutter_max_lines: u16,
    /// The greatest analogue gain, linear.
    pub gain_max: f32,
    /// Frames after a change that do not show it yet, or not for certain.
    pub latency_frames: u8,
    /// Share of the logarithmic error that one change corrects, 0..=1.
    pub damping: f32,
    /// The greatest factor of one change, up or down.
    pub ratio_limit: f32,
    /// The setting before the first frame.
    pub initial: Exposure,
}

impl ExposureParameters {
    /// TCM8230MD with its gamma on, as after reset.
    ///
    /// - 80 of 255: paper, "Image processing". Dead band 3: a change of one line in twenty moves the
    ///   luma by 2 of 80.
    /// - Gamma 0.55 and black level 12: data sheet, GAMSW and BRIGHT after reset.
    /// - 1..=525 lines and 0..24 dB: data sheet, ESRSPD in normal mode and AG.
    /// - 3 frames: shutter and gain latch at the vertical sync after the write, a rolling shutter then
    ///   already integrates the next frame, so that the second frame is the first to show the change;
    ///   one more because the write falls anywhere in a frame.
    /// - Damping 0.7 holds the loop stable for any true gamma between 0.25 and 1: each change leaves
    ///   1 - 0.7 γ_true / γ of the logarithmic error, between -0.3 and 0.7 of it.
    /// - A factor of 4 at most: a saturated frame says only that there is too much light.
    pub const DEFAULT: Self = Self {
        set_point: 80.0,
        dead_band: 3.0,
        black_level: 12.0,
        gamma: 0.55,
        shutter_min_lines: 1,
        shutter_max_lines: 525,
        gain_max: 16.0,
        latency_frames: 3,
        damping: 0.7,
        ratio_limit: 4.0,
        initial: Exposure {
            shutter_lines: 135,
            gain: 1.0,
        },
    };
}

impl Default for ExposureParameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The controller: one mean luma for each frame in, a new setting out where one is needed.
///
/// It waits until a change shows before it judges again, so that latency cannot make it oscillate.
#[derive(Clone, Debug)]
pub struct ExposureController {
    parameters: ExposureParameters,
    current: Exposure,
    frames_to_skip: u8,
}

impl ExposureController {
    /// A controller whose sensor is set to [`ExposureParameters::initial`] and shows it after the
    /// latency.
    pub const fn new(parameters: ExposureParameters) -> Self {
        Self {
            current: parameters.initial,
            frames_to_skip: parameters.latency_frames,
            parameters,
        }
    }

    /// The setting that the sensor should have.
    pub const fn current(&self) -> Exposure {
        self.current
    }

    /// Takes the mean luma of the horizon of the newest frame. Returns a setting to write to the
    /// sensor now, or none where nothing is to change. Not finite values count as no frame.
    pub fn update(&mut self, mean_luma: f32) -> Option<Exposure> {
        if !mean_luma.is_finite() {
            return None;
        }
        if let Some(left) = self.frames_to_skip.checked_sub(1) {
            self.frames_to_skip = left;
            return None;
        }
        let p = &self.parameters;
        if (mean_luma - p.set_point).abs() <= p.dead_band {
            return None;
        }
        let next = self.split(self.current.product() * self.ratio(mean_luma));
        if next == self.current {
            return None;
        }
        self.current = next;
        self.frames_to_skip = self.parameters.latency_frames;
        Some(next)
    }

    /// The factor on the exposure: ((set-point - b) / (mean - b))^(damping / γ), limited.
    fn ratio(&self, mean_luma: f32) -> f32 {
        let p = &self.parameters;
        // At or below black nothing is measured; one count above it bounds the quotient.
        let measured = (mean_luma - p.black_level).max(1.0);
        let wanted = (p.set_point - p.black_level).max(1.0);
        let ratio = libm::powf(wanted / measured, p.damping / p.gamma);
        // Not `clamp`, which panics where the limits are the wrong way round.
        ratio.max(1.0 / p.ratio_limit).min(p.ratio_limit)
    }

    /// Shutter first, because gain amplifies noise as well; gain for what the longest shutter lacks.
    fn split(&self, product: f32) -> Exposure {
        let p = &self.parameters;
        let shortest = f32::from(p.shutter_min_lines);
        let longest = f32::from(p.shutter_max_lines);
        let lines = libm::roundf(product.max(shortest).min(longest));
        Exposure {
            shutter_lines: lines as u16,
            gain: if product > longest {
                (product / longest).min(p.gain_max)
            } else {
                1.0
            },
        }
    }
}

#[cfg(test)]
mod tests;
