//! The difference of two views as a quadratic in the viewer's move.

use nalgebra::{Complex, Vector2, Vector3};

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
    /// A over x and y.
    plane: Plane,
    /// A between φ and x, y.
    coupling: Vector2<f32>,
    /// A over φ.
    turn: f32,
    /// b over x and y.
    pull: Vector2<f32>,
    /// b over φ.
    twist: f32,
    /// c.
    constant: f32,
}

/// A symmetric matrix over x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    xx: f32,
    xy: f32,
    yy: f32,
}

impl ImageDifference {
    /// The difference between the current view and a stored one that is already turned to fit.
    ///
    /// With J_k = (g_x,k, g_y,k, -ik t_k) and r_k = c_k - t_k: A_ij = 2 Σ w_k Re(conj(J_ki) J_kj),
    /// b_i = 2 Σ w_k Re(conj(J_ki) r_k), c = Σ w_k |r_k|². In `gradient`'s d and s, g_x = ½ d and
    /// g_y = ½ is, so that Re(conj(g_x) z) = ½ Re(conj(d) z) and Re(conj(g_y) z) = ½ Im(conj(s) z).
    #[inline(never)]
    pub fn between(current: &Spectrum, stored: &StoredCoefficients, weights: &Weights) -> Self {
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        let [mut x_turn, mut y_turn, mut turn_turn] = [0.0; 3];
        let [mut x_pull, mut y_pull, mut twist, mut constant] = [0.0; 4];
        for index in 0..STORED_FREQUENCIES {
            let w = weights[index];
            let [d, s] = gradient(current, index);
            let t = stored[index];
            let r = current.coefficients()[index] - t;
            let kt = t * (index + 1) as f32;
            let [wd, ws, wkt] = [d * w, s * w, kt * w];
            xx += re(wd, d);
            yy += re(ws, s);
            xy -= im(wd, s);
            // -i z turns real into imaginary parts.
            x_turn += im(wd, kt);
            y_turn -= re(ws, kt);
            turn_turn += re(wkt, kt);
            x_pull += re(wd, r);
            y_pull += im(ws, r);
            twist -= im(wkt, r);
            constant += re(r, r) * w;
        }
        Self {
            plane: Plane {
                xx: 0.5 * xx,
                xy: 0.5 * xy,
                yy: 0.5 * yy,
            },
            coupling: Vector2::new(x_turn, y_turn),
            turn: 2.0 * turn_turn,
            pull: Vector2::new(x_pull, y_pull),
            twist: 2.0 * twist,
            constant,
        }
    }

    /// c: the difference at h = 0, luma².
    pub const fn constant(&self) -> f32 {
        self.constant
    }

    /// The larger eigenvalue of A over x and y: how fast the difference grows along the direction in which
    /// it grows fastest, luma².
    pub fn largest_curvature(&self) -> f32 {
        let Plane { xx, xy, yy } = self.plane;
        let half = 0.5 * (xx - yy);
        0.5 * (xx + yy) + libm::sqrtf(half * half + xy * xy)
    }

    /// The minimum (x, y, φ) = -A⁻¹ b: φ is eliminated first, the curvature that is left in the plane is
    /// looked at, and x and y follow by Cramer's rule.
    ///
    /// # Errors
    ///
    /// [`NoVectorReason::IllConditioned`] where the curvature in the plane, with φ free, is lopsided
    /// beyond use or none at all; [`NoVectorReason::NotFinite`].
    #[inline(never)]
    pub fn minimum(&self) -> Result<Vector3<f32>, NoVectorReason> {
        if self.turn <= 0.0 {
            return Err(NoVectorReason::IllConditioned);
        }
        let share = self.coupling / self.turn;
        let plane = Plane {
            xx: self.plane.xx - share.x * self.coupling.x,
            xy: self.plane.xy - share.x * self.coupling.y,
            yy: self.plane.yy - share.y * self.coupling.y,
        };
        let step = plane.minimum(&(self.pull - share * self.twist))?;
        let turn = -(self.twist / self.turn + share.dot(&step));
        finite(Vector3::new(step.x, step.y, turn))
    }

    /// The minimum (x, y) with φ held at zero: for a heading that is trusted.
    ///
    /// # Errors
    ///
    /// As [`Self::minimum`].
    pub fn minimum_without_turn(&self) -> Result<Vector2<f32>, NoVectorReason> {
        finite(self.plane.minimum(&self.pull)?)
    }
}

impl Plane {
    /// -A⁻¹ b, unless the smaller eigenvalue is too small a part ρ of the larger. With their sum S and
    /// their product D that is D < ρ / (1 + ρ)² S²: no root needs to be taken.
    fn minimum(&self, b: &Vector2<f32>) -> Result<Vector2<f32>, NoVectorReason> {
        const LEAST_PRODUCT: f32 =
            LEAST_CURVATURE_RATIO / ((1.0 + LEAST_CURVATURE_RATIO) * (1.0 + LEAST_CURVATURE_RATIO));
        let sum = self.xx + self.yy;
        let product = self.xx * self.yy - self.xy * self.xy;
        if !sum.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        // Written so that NaN fails.
        if sum > 0.0 && product >= LEAST_PRODUCT * (sum * sum) {
            Ok(Vector2::new(
                (self.xy * b.y - self.yy * b.x) / product,
                (self.xy * b.x - self.xx * b.y) / product,
            ))
        } else {
            Err(NoVectorReason::IllConditioned)
        }
    }
}

/// Re(conj(a) b).
#[inline(always)]
fn re(a: Complex<f32>, b: Complex<f32>) -> f32 {
    a.re * b.re + a.im * b.im
}

/// Im(conj(a) b).
#[inline(always)]
fn im(a: Complex<f32>, b: Complex<f32>) -> f32 {
    a.re * b.im - a.im * b.re
}

/// The view after a move by `step` (units of R), to first order. The ninth term has no tenth to lean
/// on and keeps its value.
pub(super) fn moved(view: &Spectrum, step: Vector2<f32>) -> Spectrum {
    let (x, y) = (0.5 * step.x, 0.5 * step.y);
    let mut coefficients = *view.coefficients();
    for (index, c) in coefficients[..STORED_FREQUENCIES].iter_mut().enumerate() {
        let [d, s] = gradient(view, index);
        *c += Complex::new(d.re * x - s.im * y, d.im * x + s.re * y);
    }
    Spectrum::from_coefficients(coefficients)
}

/// How c_k changes with the viewer's move, k = index + 1 (at most 8): by g_x = ½ d to the north and by
/// g_y = ½ is to the west, d = (k+1) c_{k+1} - (k-1) c_{k-1} and s = (k+1) c_{k+1} + (k-1) c_{k-1}.
#[inline(always)]
fn gradient(view: &Spectrum, index: usize) -> [Complex<f32>; 2] {
    const _: () = assert!(VIEW_FREQUENCIES > STORED_FREQUENCIES);
    let k = (index + 1) as f32;
    let c = view.coefficients();
    // There is no c_0 to see, and it would count zero times.
    let below = c[index.saturating_sub(1)] * (k - 1.0);
    let above = c[index + 1] * (k + 1.0);
    [above - below, above + below]
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
