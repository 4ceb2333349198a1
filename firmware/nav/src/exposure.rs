//! Autoexposure on the horizon band alone: the luma of a frame in, shutter and gain out.
//!
//! A sensor's own exposure control meters the whole image, the dark middle and the bright rim of a
//! panoramic lens included; the paper therefore regulates the horizon's mean luma itself ("Image
//! processing": 80 of 255).
//!
//! The luma chain is known, so a correction is no step of a regulator but the solution of an equation
//! ([`LumaHistogram`]): exact upwards, and too dark rather than too bright downwards. Three corrections
//! therefore arrive from anywhere: at worst two that find the range, by the greatest factor, and one
//! that is exact. Each is judged when it shows for certain, so that latency cannot make it oscillate:
//! with 3 frames of latency, corrections at frames 1, 4 and 7, and it holds from frame 10 on.

mod histogram;
mod setting;

pub use histogram::LumaHistogram;

use histogram::LumaScale;

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
    /// From this luma on a sample counts as clipped.
    pub clipped_from: u8,
    /// Luma above black grows as exposure to this power: the sensor's gamma, 1 where it is off. It
    /// must be the true one: with half of it every correction is twice as large as it should be.
    pub gamma: f32,
    /// The time of one line of the shutter, seconds.
    pub line_time_s: f32,
    /// How often a second the lamps flicker: twice the mains' frequency. 0 for none.
    pub flicker_hz: f32,
    /// The shutter's shortest time, lines.
    pub shutter_min_lines: u16,
    /// The shutter's longest time, lines.
    pub shutter_max_lines: u16,
    /// The greatest analogue gain, linear.
    pub gain_max: f32,
    /// The sensor's gains are this over a whole number: its gain code of gain 1.
    pub gain_unity_code: u8,
    /// A setting asked for at frame n shows in full at frame n + this, at the latest.
    pub latency_frames: u8,
    /// The greatest factor of one change, up or down.
    pub ratio_limit: f32,
    /// The setting before the first frame.
    pub initial: Exposure,
}

impl ExposureParameters {
    /// TCM8230MD at 21 MHz with its gamma on, as after reset, under lamps on 50 Hz.
    ///
    /// - 80 of 255: paper, "Image processing". Dead band 1.5: it holds within 3 although the mean of a
    ///   noisy frame is off by half a count, and that of 768 samples from that of all pixels by as much.
    /// - Gamma 0.55 and black level 12: data sheet, GAMSW and BRIGHT after reset. Clipped from 250 on:
    ///   the last few counts before white are not linear in any sensor.
    /// - 1..=525 lines of 1560 clocks and 0..24 dB in steps of 192/AG: data sheet, ESRSPD in normal mode
    ///   and AG.
    /// - 3 frames: shutter and gain latch at the vertical sync after the write, a rolling shutter then
    ///   already integrates the next frame, so that the second frame is the first to show the change;
    ///   one more because the data sheet does not say so.
    /// - A factor of 100 at most: twice that covers 1..=8400, the whole range of shutter times gain, and
    ///   once is the most that is still visible from below (68 counts above black become 0.7).
    pub const DEFAULT: Self = Self {
        set_point: 80.0,
        dead_band: 1.5,
        black_level: 12.0,
        clipped_from: 250,
        gamma: 0.55,
        line_time_s: 1560.0 / 21e6,
        flicker_hz: 100.0,
        shutter_min_lines: 1,
        shutter_max_lines: 525,
        gain_max: 16.0,
        gain_unity_code: 192,
        latency_frames: 3,
        ratio_limit: 100.0,
        initial: Exposure {
            shutter_lines: 135,
            gain: 1.0,
        },
    };

    /// Whether there can be such a sensor and such a wish.
    fn are_possible(&self) -> bool {
        let is_positive = |value: f32| value > 0.0 && value.is_finite();
        let shutters = self.shutter_min_lines..=self.shutter_max_lines;
        let white = f32::from(self.clipped_from);
        [self.gamma, self.line_time_s].into_iter().all(is_positive)
            && [self.ratio_limit, self.gain_max]
                .into_iter()
                .all(|factor| factor >= 1.0 && factor.is_finite())
            && (0.0..self.set_point).contains(&self.black_level)
            && (self.black_level..white).contains(&self.set_point)
            && (0.0..white).contains(&self.dead_band)
            && (0.0..f32::INFINITY).contains(&self.flicker_hz)
            && self.gain_unity_code > 0
            && self.shutter_min_lines > 0
            && shutters.contains(&self.initial.shutter_lines)
            && (1.0..=self.gain_max).contains(&self.initial.gain)
    }
}

impl Default for ExposureParameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The controller: the luma of each frame in, a new setting out where one is needed.
///
/// With parameters that no sensor can have it never moves.
#[derive(Clone, Debug)]
pub struct ExposureController {
    parameters: ExposureParameters,
    can_move: bool,
    current: Exposure,
    /// The current setting has the most shutter and the least gain that it can have. The initial one
    /// need not.
    is_shutter_first: bool,
    frames_to_skip: u8,
}

impl ExposureController {
    /// A controller whose sensor is set to [`ExposureParameters::initial`] and shows it.
    pub fn new(parameters: ExposureParameters) -> Self {
        Self {
            can_move: parameters.are_possible(),
            current: parameters.initial,
            is_shutter_first: false,
            frames_to_skip: 0,
            parameters,
        }
    }

    /// The setting that the sensor should have.
    pub const fn current(&self) -> Exposure {
        self.current
    }

    /// Takes the mean luma of the newest frame's horizon band, and a way to its histogram, which is
    /// asked for only where the setting has to change. Returns a setting to write to the sensor now,
    /// or none where nothing is to change. A luma that is not finite counts as no frame.
    pub fn update(
        &mut self,
        mean_luma: f32,
        histogram: impl FnOnce() -> LumaHistogram,
    ) -> Option<Exposure> {
        if !mean_luma.is_finite() || !self.can_move {
            return None;
        }
        if let Some(left) = self.frames_to_skip.checked_sub(1) {
            self.frames_to_skip = left;
            return None;
        }
        let error = mean_luma - self.parameters.set_point;
        let ratio = if error.abs() > self.parameters.dead_band {
            self.ratio(&histogram())?
        } else if self.is_shutter_first {
            return None;
        } else {
            1.0
        };
        self.is_shutter_first = true;
        let next = setting::setting(&self.parameters, self.current.product() * ratio);
        if next == self.current {
            return None;
        }
        self.current = next;
        self.frames_to_skip = self.parameters.latency_frames.saturating_sub(1);
        Some(next)
    }

    /// The factor on the exposure: k^(1/γ), within L either way. Downwards the limit is L^((1 + q) / 2)
    /// where a share q of the samples is clipped: all of L where nothing else is seen, hardly more than
    /// its root where most is seen, as too dark a frame is noisy.
    fn ratio(&self, histogram: &LumaHistogram) -> Option<f32> {
        let p = &self.parameters;
        let correction = histogram.correction(&LumaScale {
            black: p.black_level,
            clipped_from: p.clipped_from,
            wanted: p.set_point,
        })?;
        let ratio = libm::powf(correction.factor, 1.0 / p.gamma);
        let least = libm::powf(p.ratio_limit, -0.5 * (1.0 + correction.clipped));
        Some(ratio.max(least).min(p.ratio_limit))
    }
}

#[cfg(test)]
mod tests;
