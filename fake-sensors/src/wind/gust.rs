//! One gust.

use core::f64::consts::PI;

use nalgebra::Vector3;

/// A gust in the form of one minus a cosine, as aircraft are certified against (14 CFR 25.341(a)(2)): it rises to
/// its peak, falls again and is gone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gust {
    /// Velocity of the air at the peak, on top of the wind, in the world, m/s.
    pub peak_m_s: Vector3<f64>,
    /// When it sets in, s.
    pub from_s: f64,
    /// Time from there to the peak, s; the fall takes as long.
    pub rise_s: f64,
}

impl Gust {
    /// Its velocity at an instant, m/s.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Vector3<f64> {
        let since_s = time_s - self.from_s;
        if !(0.0..2.0 * self.rise_s).contains(&since_s) {
            return Vector3::zeros();
        }
        self.peak_m_s * (0.5 * (1.0 - libm::cos(PI * since_s / self.rise_s)))
    }
}
