//! Matched-filter descent in image distances (Möller & Vardy 2006), with its Newton variants (Möller,
//! Vardy, Kreft & Ruwisch 2007), on a ring of pixels.
//!
//! The distance D(h) = Σ (S - C_h)² of the remembered view S from the current one, moved by h, falls
//! along v = Σ (S - C) G, G = (-C' sin θ, C' cos θ). Newton's step is H⁻¹ v with H = Σ G Gᵀ (Gauss-
//! Newton) less, for the full Hessian, Σ (S - C) C'' (sin² θ, -sin θ cos θ; ·, cos² θ).
//!
//! The heading is trusted: there is no rotation search.

use nalgebra::{Matrix2, Vector2};

use super::grey::{self, Curve, LowPass};
use super::{Homeward, HomingMethod, LEAST_VARIANCE, Luma, Memory};
use crate::homing::NoVectorReason;

/// How the way down is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slope {
    /// Along the gradient.
    Descent,
    /// Newton's step without second derivatives of the image.
    GaussNewton,
    /// Newton's step; where the distance is not convex, along the gradient.
    Newton,
}

/// What can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MfdidParameters {
    /// Pixels of both views, and bytes of a memory.
    pub pixels: u8,
    /// Frequencies that the low-pass filter keeps.
    pub low_pass: u8,
    /// The way down.
    pub slope: Slope,
}

/// Matched-filter descent in image distances.
#[derive(Clone, Debug)]
pub struct Mfdid {
    parameters: MfdidParameters,
    filter: LowPass,
}

/// The current view, filtered, and its curvature.
#[derive(Clone, Debug)]
pub struct MfdidSeen {
    curve: Curve,
    curvature: Matrix2<f32>,
}

impl Mfdid {
    /// A method of these parameters.
    pub fn new(parameters: MfdidParameters) -> Self {
        Self {
            parameters,
            filter: LowPass::new(grey::count(parameters.pixels), parameters.low_pass),
        }
    }

    /// How the picture changes at pixel n with a move north and west.
    fn change(&self, curve: &Curve, n: usize) -> Vector2<f32> {
        let direction = self.filter.direction(n);
        Vector2::new(-direction.im, direction.re) * curve.slope[n]
    }
}

impl HomingMethod for Mfdid {
    type Seen = MfdidSeen;

    fn bytes(&self) -> usize {
        grey::count(self.parameters.pixels)
    }

    fn remember(&self, view: &Luma) -> Memory {
        grey::to_bytes(&grey::pixels(view, self.bytes()))
    }

    fn see(&self, view: &Luma) -> MfdidSeen {
        let curve = self.filter.curve(&grey::pixels(view, self.bytes()));
        let mut curvature = Matrix2::zeros();
        for n in 0..self.bytes() {
            let change = self.change(&curve, n);
            curvature += change * change.transpose();
        }
        MfdidSeen { curve, curvature }
    }

    fn home(&self, seen: &MfdidSeen, memory: &Memory) -> Result<Homeward, NoVectorReason> {
        let stored = self.filter.curve(&grey::from_bytes(memory, self.bytes()));
        let mut descent = Vector2::zeros();
        let mut second = Matrix2::zeros();
        let [mut distance, mut power] = [0.0; 2];
        for n in 0..self.bytes() {
            let residual = stored.value[n] - seen.curve.value[n];
            descent += self.change(&seen.curve, n) * residual;
            let direction = self.filter.direction(n);
            let across = Vector2::new(-direction.im, direction.re);
            second += across * across.transpose() * (residual * seen.curve.bend[n]);
            distance += residual * residual;
            power += stored.value[n] * stored.value[n] + seen.curve.value[n] * seen.curve.value[n];
        }
        let plain = descent / (0.5 * seen.curvature.trace());
        let displacement = match self.parameters.slope {
            Slope::Descent => plain,
            Slope::GaussNewton => newton(&seen.curvature, &descent).unwrap_or(plain),
            Slope::Newton => newton(&(seen.curvature - second), &descent).unwrap_or(plain),
        };
        if seen.curvature.trace() < LEAST_VARIANCE * self.bytes() as f32 {
            return Err(NoVectorReason::NoContrast);
        }
        if !displacement.norm().is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        Ok(Homeward {
            displacement,
            rotation: 0.0,
            quality: (1.0 - distance / power).max(0.0),
        })
    }
}

/// H⁻¹ v, where H is positive definite.
fn newton(curvature: &Matrix2<f32>, descent: &Vector2<f32>) -> Option<Vector2<f32>> {
    let factors = curvature.cholesky()?;
    Some(factors.solve(descent))
}
