//! The scalar measurement update and the bounds on the covariance.

use nalgebra::SVector;

use super::state::{ATTITUDE, Covariance, POSITION, State, VELOCITY};

/// No entry of the covariance exceeds this.
const MAX_COVARIANCE: f32 = 100.0;
/// No variance falls below this.
const MIN_VARIANCE: f32 = 1e-6;

/// One non-zero entry of a measurement's Jacobian row.
#[derive(Debug, Clone, Copy)]
pub struct Sensitivity {
    /// Index of the state.
    pub state: usize,
    /// Derivative of the prediction with respect to it.
    pub slope: f32,
}

impl Sensitivity {
    /// The prediction is the state itself.
    pub const fn direct(state: usize) -> Self {
        Self { state, slope: 1.0 }
    }
}

impl State {
    /// Corrects the state by one scalar: `innovation` is measurement minus prediction, `sd` the measurement's
    /// standard deviation, `row` the non-zero entries of its Jacobian.
    ///
    /// Joseph form, `(I-Kh) P (I-Kh)ᵀ + s² K Kᵀ`, as three rank-one terms. Nothing is gated.
    pub fn scalar_update(&mut self, row: &[Sensitivity], innovation: f32, sd: f32) {
        // P hᵀ from the few columns that h touches.
        let project = |p: &Covariance| {
            row.iter().fold(SVector::<f32, 9>::zeros(), |sum, h| {
                sum + p.column(h.state) * h.slope
            })
        };
        let variance = sd * sd;
        let cross = project(&self.covariance);
        let total = row.iter().map(|h| h.slope * cross[h.state]).sum::<f32>() + variance;
        let gain = cross / total;

        self.position += gain.fixed_rows::<3>(POSITION) * innovation;
        self.velocity += gain.fixed_rows::<3>(VELOCITY) * innovation;
        self.attitude_error += gain.fixed_rows::<3>(ATTITUDE) * innovation;

        let mut p = self.covariance - gain * cross.transpose();
        let remaining = project(&p) - gain * variance;
        p -= remaining * gain.transpose();
        self.covariance = p;
        self.bound_covariance();
    }

    /// Makes the covariance symmetric, cuts entries above 100 and those that are no number to 100, and lifts
    /// variances to 1e-6.
    pub fn bound_covariance(&mut self) {
        let p = &mut self.covariance;
        for i in 0..9 {
            for j in i..9 {
                let mean = 0.5 * (p[(i, j)] + p[(j, i)]);
                let bounded = if mean.is_nan() || mean > MAX_COVARIANCE {
                    MAX_COVARIANCE
                } else if i == j && mean < MIN_VARIANCE {
                    MIN_VARIANCE
                } else {
                    mean
                };
                p[(i, j)] = bounded;
                p[(j, i)] = bounded;
            }
        }
    }
}
