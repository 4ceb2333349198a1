//! Lamps on the mains: their light rises and falls twice a period, and a rolling shutter turns that into bands.

use core::f64::consts::TAU;

use super::sensor::MAX_EXPOSURE_LINES;
use super::tcm8230::line_slot;

/// Scan lines of a frame.
const LINES_PER_FRAME: f64 = MAX_EXPOSURE_LINES as f64;
/// Scan lines of an output slot.
const LINES_PER_SLOT: f64 = 2.0;

/// Light that swings about its mean: 1 + d sin(2π t / T).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flicker {
    /// The swing, d, as a share of the mean, 0..=1. Incandescent lamps about 0.1, fluorescent ones on
    /// a choke about 0.3.
    pub depth: f32,
    /// The period, T, in scan lines: 134.6 for 100 Hz at 21 MHz. Not zero.
    pub period_lines: f64,
}

impl Flicker {
    /// Light that does not flicker.
    pub const NONE: Self = Self {
        depth: 0.0,
        period_lines: 1.0,
    };

    /// The mean light over the exposure of a row, `lines` long, that ends when the row is read out, as
    /// a share of the mean over all time:
    ///
    /// (1/L) ∫ (1 + d sin(2π t / T)) dt over [e - L, e] = 1 + d sin(πL/T) / (πL/T) sin(2π (e - L/2) / T).
    ///
    /// It is 1 for every row where L is a multiple of T. Frames follow one another without a break:
    /// frame n begins n times 525 lines after the light rose through its mean.
    pub(super) fn share(&self, frame_number: u32, row: usize, lines: u16) -> f32 {
        if self.depth == 0.0 {
            return 1.0;
        }
        let length = f64::from(lines) / self.period_lines;
        let end_lines =
            LINES_PER_FRAME * f64::from(frame_number) + LINES_PER_SLOT * line_slot(row) as f64;
        let middle = end_lines / self.period_lines - 0.5 * length;
        let half_turn = 0.5 * TAU * length;
        let smoothed = libm::sin(half_turn) / half_turn * libm::sin(TAU * middle);
        1.0 + self.depth * smoothed as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::HEIGHT;

    const PERIOD_LINES: f64 = 134.6;

    fn flicker() -> Flicker {
        Flicker {
            depth: 0.3,
            period_lines: PERIOD_LINES,
        }
    }

    /// Half the difference of the brightest and the darkest row of ten frames.
    fn swing(lines: u16) -> f32 {
        let shares = (0..10)
            .flat_map(|frame| (0..HEIGHT).map(move |row| flicker().share(frame, row, lines)));
        let (low, high) = shares.fold((f32::MAX, f32::MIN), |(low, high), share| {
            (low.min(share), high.max(share))
        });
        0.5 * (high - low)
    }

    #[test]
    fn bands_vanish_at_whole_periods_and_nowhere_else() {
        for lines in [135, 269, 404] {
            assert!(swing(lines) < 0.003, "{lines}: {}", swing(lines));
        }
        // |sin(πL/T) / (πL/T)| of 0.3: all of it at one line, 2/π at half a period, 2/3π at one and a half.
        for (lines, expected) in [(1, 0.3), (67, 0.191), (202, 0.0637), (336, 0.0382)] {
            assert!(
                (swing(lines) - expected).abs() < 0.003,
                "{lines}: {}",
                swing(lines)
            );
        }
    }

    #[test]
    fn a_row_gathers_what_the_lamp_sheds_while_it_is_exposed() {
        for (frame, row, lines) in [(0, 0, 1_u16), (3, 17, 60), (9, 95, 135), (7, 40, 500)] {
            let end = 525.0 * f64::from(frame) + 2.0 * line_slot(row) as f64;
            let steps = 10_000;
            let sum: f64 = (0..steps)
                .map(|step| {
                    let time = end - f64::from(lines) * (f64::from(step) + 0.5) / f64::from(steps);
                    1.0 + 0.3 * libm::sin(TAU * time / PERIOD_LINES)
                })
                .sum();
            let share = f64::from(flicker().share(frame, row, lines));
            assert!((share - sum / f64::from(steps)).abs() < 1e-5);
        }
    }

    #[test]
    fn steady_light_is_exactly_one() {
        assert_eq!(Flicker::NONE.share(3, 5, 77), 1.0);
    }
}
