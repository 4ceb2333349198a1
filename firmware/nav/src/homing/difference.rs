//! The difference of two views as a quadratic in the viewer's move.

use nalgebra::{Cholesky, Complex, Matrix2, Matrix3, Vector2, Vector3};

use super::{NoVectorReason, Weights};
use crate::spectrum::{STORED_FREQUENCIES, Spectrum, StoredCoefficients, VIEW_FREQUENCIES};

/// The least ratio of the smaller to the larger curvature over the two directions of the plane.
/// Textured rooms have 0.2 and more; a view that is uniform but for the two ends of a corridor has
/// less than 0.05, and there the variance of the error along the corridor is twenty times that across.
const LEAST_CURVATURE_RATIO: f32 = 0.05;

/// E2(h) = ½ hᵀA h + bᵀh + c over h = (x, y, φ): x and y in units of R, φ the turn of the stored view
/// in radians (paper, "Homing implementation"; Stürzl & Mallot 2006).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageDifference {
    a: Matrix3<f32>,
    b: Vector3<f32>,
    c: f32,
}

impl ImageDifference {
    /// The difference between the current view and a stored one that is already turned to fit.
    ///
    /// With J_k = (g_x,k, g_y,k, -ik t_k) and r_k = c_k - t_k: A_ij = 2 Σ w_k Re(conj(J_ki) J_kj),
    /// b_i = 2 Σ w_k Re(conj(J_ki) r_k), c = Σ w_k |r_k|².
    pub fn between(current: &Spectrum, stored: &StoredCoefficients, weights: &Weights) -> Self {
        let mut difference = Self {
            a: Matrix3::zeros(),
            b: Vector3::zeros(),
            c: 0.0,
        };
        for index in 0..STORED_FREQUENCIES {
            let k = (index + 1) as f32;
            let t = stored[index];
            let residual = current.coefficients()[index] - t;
            let [gx, gy] = gradient(current, index);
            let turn = Complex::new(k * t.im, -(k * t.re));
            let re = Vector3::new(gx.re, gy.re, turn.re);
            let im = Vector3::new(gx.im, gy.im, turn.im);
            let w = weights[index];
            difference.a += (re * re.transpose() + im * im.transpose()) * (2.0 * w);
            difference.b += (re * residual.re + im * residual.im) * (2.0 * w);
            difference.c += residual.norm_sqr() * w;
        }
        difference
    }

    /// c: the difference at h = 0, luma².
    pub const fn constant(&self) -> f32 {
        self.c
    }

    /// The minimum (x, y, φ) = -A⁻¹ b.
    ///
    /// # Errors
    ///
    /// [`NoVectorReason::IllConditioned`] where the curvature in the plane, with φ free, is lopsided
    /// beyond use or none at all; [`NoVectorReason::NotFinite`].
    pub fn minimum(&self) -> Result<Vector3<f32>, NoVectorReason> {
        let coupling = Vector2::new(self.a.m13, self.a.m23);
        if self.a.m33 <= 0.0 {
            return Err(NoVectorReason::IllConditioned);
        }
        let plane = plane(&self.a) - coupling * coupling.transpose() / self.a.m33;
        check_curvature(&plane)?;
        let factors = Cholesky::new(self.a).ok_or(NoVectorReason::IllConditioned)?;
        finite(-factors.solve(&self.b))
    }

    /// The minimum (x, y) with φ held at zero: for a heading that is trusted.
    ///
    /// # Errors
    ///
    /// As [`Self::minimum`].
    pub fn minimum_without_turn(&self) -> Result<Vector2<f32>, NoVectorReason> {
        let plane = plane(&self.a);
        check_curvature(&plane)?;
        let factors = Cholesky::new(plane).ok_or(NoVectorReason::IllConditioned)?;
        finite(-factors.solve(&self.b.xy()))
    }
}

/// The view after a move by `step` (units of R), to first order. The ninth term has no tenth to lean
/// on and keeps its value.
pub(super) fn moved(view: &Spectrum, step: Vector2<f32>) -> Spectrum {
    let mut coefficients = *view.coefficients();
    for (index, c) in coefficients[..STORED_FREQUENCIES].iter_mut().enumerate() {
        let [gx, gy] = gradient(view, index);
        *c += gx * step.x + gy * step.y;
    }
    Spectrum::from_coefficients(coefficients)
}

/// How c_k changes with the viewer's move north and west, k = index + 1 (at most 8):
/// g_x = ½[(k+1) c_{k+1} - (k-1) c_{k-1}], g_y = i/2 [(k+1) c_{k+1} + (k-1) c_{k-1}].
fn gradient(view: &Spectrum, index: usize) -> [Complex<f32>; 2] {
    const _: () = assert!(VIEW_FREQUENCIES > STORED_FREQUENCIES);
    let k = (index + 1) as f32;
    let c = view.coefficients();
    let below = match index.checked_sub(1) {
        Some(index) => c[index] * (k - 1.0),
        None => Complex::new(0.0, 0.0),
    };
    let above = c[index + 1] * (k + 1.0);
    let across = above + below;
    [
        (above - below) * 0.5,
        Complex::new(-(across.im * 0.5), across.re * 0.5),
    ]
}

fn plane(a: &Matrix3<f32>) -> Matrix2<f32> {
    a.fixed_view::<2, 2>(0, 0).into_owned()
}

/// Refuses a curvature whose smaller eigenvalue is too small a part of the larger.
fn check_curvature(plane: &Matrix2<f32>) -> Result<(), NoVectorReason> {
    let middle = 0.5 * plane.trace();
    let half_gap = libm::hypotf(0.5 * (plane.m11 - plane.m22), plane.m12);
    let (least, greatest) = (middle - half_gap, middle + half_gap);
    if !greatest.is_finite() {
        return Err(NoVectorReason::NotFinite);
    }
    if greatest > 0.0 && least >= LEAST_CURVATURE_RATIO * greatest {
        Ok(())
    } else {
        Err(NoVectorReason::IllConditioned)
    }
}

fn finite<const N: usize>(
    h: nalgebra::SVector<f32, N>,
) -> Result<nalgebra::SVector<f32, N>, NoVectorReason> {
    if h.iter().all(|value| value.is_finite()) {
        Ok(h)
    } else {
        Err(NoVectorReason::NotFinite)
    }
}
