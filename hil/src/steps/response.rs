//! What a step response is like in a few numbers.

use serde::Serialize;

/// Half the band in which a response counts as settled, as a share of the step.
const SETTLED_WITHIN: f64 = 0.05;

/// Figures of a response to a step. Shares are of the step's size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// From a tenth of the way to nine tenths, seconds.
    pub rise_s: f64,
    /// How far beyond the goal, as a share.
    pub overshoot: f64,
    /// From the step until the response stays within 5 % of the goal, seconds.
    pub settling_s: f64,
    /// The fastest change, in the step's unit per second.
    pub fastest: f64,
}

impl Figures {
    /// Of a curve in steps of `step_s` that starts at zero and is to reach `size`; none if it does not come within
    /// reach or does not settle.
    pub fn of(curve: &[f64], step_s: f64, size: f64) -> Option<Self> {
        let share = |value: &f64| value / size;
        let reaches = |level| curve.iter().position(|value| share(value) >= level);
        let tenth = reaches(0.1)?;
        let nine_tenths = reaches(0.9)?;
        let unsettled = curve
            .iter()
            .rposition(|value| (share(value) - 1.0).abs() > SETTLED_WITHIN)
            .map_or(0, |last| last + 1);
        if unsettled == curve.len() {
            return None;
        }
        let highest = curve.iter().map(share).fold(0.0, f64::max);
        let fastest = curve
            .windows(2)
            .map(|pair| ((pair[1] - pair[0]) / step_s).abs())
            .fold(0.0, f64::max);
        Some(Self {
            rise_s: (nine_tenths - tenth) as f64 * step_s,
            overshoot: (highest - 1.0).max(0.0),
            settling_s: unsettled as f64 * step_s,
            fastest,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.001;

    fn curve(of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..10_000).map(|k| of(f64::from(k) * STEP_S)).collect()
    }

    #[test]
    fn a_first_order_lag_rises_in_ln_nine_and_settles_in_ln_twenty_time_constants() {
        let figures = Figures::of(&curve(|t| 2.0 * (1.0 - (-t / 0.5).exp())), STEP_S, 2.0);
        let figures = figures.expect("it settles");
        assert!((figures.rise_s - 0.5 * 9.0_f64.ln()).abs() < 0.002);
        assert!((figures.settling_s - 0.5 * 20.0_f64.ln()).abs() < 0.002);
        assert_eq!(figures.overshoot, 0.0);
        assert!((figures.fastest - 4.0).abs() < 0.01);
    }

    #[test]
    fn a_second_order_oscillation_overshoots_by_its_damping() {
        // Damping 0.5, 2 rad/s; the sign of the step does not matter.
        let (zeta, omega) = (0.5_f64, 2.0_f64);
        let root = (1.0 - zeta * zeta).sqrt();
        let response = curve(|t| {
            let phase = omega * root * t;
            let swing = phase.cos() + zeta / root * phase.sin();
            -3.0 * (1.0 - (-zeta * omega * t).exp() * swing)
        });
        let figures = Figures::of(&response, STEP_S, -3.0).expect("it settles");
        let expected = (-core::f64::consts::PI * zeta / root).exp();
        assert!((figures.overshoot - expected).abs() < 1e-4);
    }

    #[test]
    fn what_never_arrives_has_no_figures() {
        assert_eq!(Figures::of(&curve(|t| 0.05 * t), STEP_S, 1.0), None);
        assert_eq!(Figures::of(&curve(f64::sin), STEP_S, 1.0), None);
        assert_eq!(Figures::of(&[], STEP_S, 1.0), None);
    }
}
