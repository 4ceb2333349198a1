//! The difference of two views of any number of frequencies as a quadratic in the viewer's move: the
//! equations of [`ImageDifference`](crate::homing::ImageDifference), with weights and damping.

use nalgebra::{Cholesky, Complex, Matrix3, Vector2, Vector3};

use super::coefficients::{Harmonics, MOST_FREQUENCIES};
use crate::homing::NoVectorReason;

/// Weights by frequency.
pub type Weights = [f32; MOST_FREQUENCIES];

/// Share of the mean curvature that is added to each. It decides a direction that the views leave
/// open, as along the uniform walls of a corridor, and costs nothing elsewhere.
const DAMPING: f32 = 1e-4;

/// Every frequency counts as it is.
pub const FLAT_WEIGHTS: Weights = [1.0; MOST_FREQUENCIES];

/// k^-power.
pub fn power_law(power: f32) -> Weights {
    core::array::from_fn(|index| libm::powf((index + 1) as f32, -power))
}

/// Which terms of the quadratic are used.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    /// Weights of the frequencies.
    pub weights: &'a Weights,
    /// Frequencies compared.
    pub frequencies: usize,
    /// Whether the gradient of the last frequency leans on the next.
    pub next_term: bool,
    /// Whether the residual turn is an unknown beside the move.
    pub with_turn: bool,
}

/// The minimum (x, y, φ) of the quadratic; φ is the turn of the stored view.
///
/// # Errors
/// [`NoVectorReason::IllConditioned`] without any curvature; [`NoVectorReason::NotFinite`].
pub fn minimum(
    model: &Model<'_>,
    current: &Harmonics,
    stored: &Harmonics,
) -> Result<Vector3<f32>, NoVectorReason> {
    let mut a = Matrix3::zeros();
    let mut b = Vector3::zeros();
    for index in 0..model.frequencies {
        let residual = current.0[index] - stored.0[index];
        let [gx, gy] = gradient(model, current, index);
        let turn = if model.with_turn {
            // -i k t
            let k = (index + 1) as f32;
            Complex::new(k * stored.0[index].im, -(k * stored.0[index].re))
        } else {
            Complex::new(0.0, 0.0)
        };
        let re = Vector3::new(gx.re, gy.re, turn.re);
        let im = Vector3::new(gx.im, gy.im, turn.im);
        let weight = 2.0 * model.weights[index];
        a += (re * re.transpose() + im * im.transpose()) * weight;
        b += (re * residual.re + im * residual.im) * weight;
    }
    let damping = a.trace() / 3.0 * DAMPING;
    for axis in 0..3 {
        a[(axis, axis)] += damping;
    }
    let factors = Cholesky::new(a).ok_or(NoVectorReason::IllConditioned)?;
    let h = -factors.solve(&b);
    if h.iter().all(|value| value.is_finite()) {
        Ok(h)
    } else {
        Err(NoVectorReason::NotFinite)
    }
}

/// The view after a small move by `step` (units of the distance), to first order.
pub fn moved(model: &Model<'_>, view: &Harmonics, step: Vector2<f32>) -> Harmonics {
    let mut moved = *view;
    for index in 0..model.frequencies {
        let [gx, gy] = gradient(model, view, index);
        moved.0[index] += gx * step.x + gy * step.y;
    }
    moved
}

/// g_x = ½[(k+1) c_{k+1} - (k-1) c_{k-1}], g_y = i/2 [(k+1) c_{k+1} + (k-1) c_{k-1}] (Stürzl & Mallot
/// 2006), k = index + 1.
fn gradient(model: &Model<'_>, view: &Harmonics, index: usize) -> [Complex<f32>; 2] {
    let k = (index + 1) as f32;
    let zero = Complex::new(0.0, 0.0);
    let below = match index.checked_sub(1) {
        Some(index) => view.0[index] * (k - 1.0),
        None => zero,
    };
    let above = if model.next_term || index + 1 < model.frequencies {
        view.0[index + 1] * (k + 1.0)
    } else {
        zero
    };
    let across = above + below;
    [
        (above - below) * 0.5,
        Complex::new(-(across.im * 0.5), across.re * 0.5),
    ]
}
