//! The frequencies above those that the paper's snapshot needs, for routes that remember them.

use nalgebra::Complex;

use super::{VIEW_FREQUENCIES, unit};
use crate::horizon::{BEARINGS, Horizon, SUMMED};

/// How many there are: k = 10..=17. A snapshot stores frequencies up to 16, and the gradient of the
/// sixteenth needs the next.
pub const DETAIL_FREQUENCIES: usize = 8;

/// 2 cos(2πk / 128).
const TWICE_COSINES: [f32; DETAIL_FREQUENCIES] = [
    1.763_842_5,
    1.715_457_2,
    1.662_939_2,
    1.606_415_1,
    1.546_021,
    1.481_902_2,
    core::f32::consts::SQRT_2,
    1.343_118,
];

/// c_10..c_17, luma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail(pub [Complex<f32>; DETAIL_FREQUENCIES]);

impl Detail {
    /// By Goertzel's recurrence (1958): with s_n = x_n + 2 cos ω s_{n-1} - s_{n-2} and ω = 2πk/128,
    /// Σ x_n e^{-iωn} = e^{iω} s_127 - s_126. Two operations a value and frequency, and no table of
    /// cosines.
    pub(super) fn of(horizon: &Horizon) -> Self {
        let [mut newest, mut before] = [[0.0; DETAIL_FREQUENCIES]; 2];
        for sum in horizon.sums() {
            let value = f32::from(*sum);
            for (newest, (before, twice_cosine)) in
                newest.iter_mut().zip(before.iter_mut().zip(&TWICE_COSINES))
            {
                let next = value + twice_cosine * *newest - *before;
                *before = core::mem::replace(newest, next);
            }
        }
        const SCALE: f32 = 2.0 / (BEARINGS * SUMMED) as f32;
        let sums = core::array::from_fn(|index| {
            let cos = 0.5 * TWICE_COSINES[index];
            let sin = libm::sqrtf(1.0 - cos * cos);
            Complex::new(cos * newest[index] - before[index], sin * newest[index]) * SCALE
        });
        Self(sums).rotated(-horizon.residual_rad())
    }

    /// What a viewer at the same place sees who is turned counter-clockwise by `angle` (radians).
    pub(super) fn rotated(mut self, angle: f32) -> Self {
        let step = unit(angle);
        let mut turn = unit((VIEW_FREQUENCIES + 1) as f32 * angle);
        for coefficient in &mut self.0 {
            *coefficient *= turn;
            turn *= step;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;
    use crate::spectrum::Spectrum;

    /// A horizon of 24 frequencies, seen by a viewer who is turned.
    fn horizon(turn: f64, residual_rad: f32) -> Horizon {
        let luma = core::array::from_fn(|n| {
            let bearing = n as f64 * TAU / BEARINGS as f64 + turn;
            let waves = (1_u8..=24).map(|k| {
                let k = f64::from(k);
                6.0 * libm::cos(k * bearing + k * k)
            });
            (120.0 + waves.sum::<f64>()) as f32
        });
        Horizon::new(luma, residual_rad)
    }

    #[test]
    fn the_detail_is_that_of_the_definition() {
        let horizon = horizon(0.3, 0.0);
        for (k, c) in (10_u8..).zip(Detail::of(&horizon).0) {
            let terms = horizon.luma().into_iter().enumerate().map(|(n, luma)| {
                let angle = f64::from(k) * n as f64 * TAU / BEARINGS as f64;
                Complex::new(libm::cos(angle), -libm::sin(angle)) * f64::from(luma)
            });
            let exact = terms.sum::<Complex<f64>>() * (2.0 / BEARINGS as f64);
            let off = Complex::new(f64::from(c.re), f64::from(c.im)) - exact;
            assert!(off.norm_sqr() < 1e-6, "{k}: {c} {exact}");
        }
    }

    #[test]
    fn what_the_horizon_left_of_the_turn_is_made_up_for() {
        let level = Spectrum::with_detail(&horizon(0.0, 0.0));
        let turned = Spectrum::with_detail(&horizon(0.02, 0.02));
        let pairs = level.detail().into_iter().zip(turned.detail());
        for (a, b) in pairs.flat_map(|(a, b)| a.0.into_iter().zip(b.0)) {
            // Sixteenths of luma, rounded.
            assert!((a - b).norm_sqr() < 4e-4, "{a} {b}");
        }
        assert!(level.rotated(0.4).rotated(-0.4).detail().is_some());
    }
}
