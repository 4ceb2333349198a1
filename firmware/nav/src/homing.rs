//! Fourier homing: from two spectra to the way home (Stürzl & Mallot 2006, as the paper runs it).
//!
//! All visible things are taken to lie on a circle of radius R round the viewer. A move by h, in units
//! of R, changes the coefficients to first order by g_x x + g_y y. With a residual turn φ of the stored
//! view t the difference of the images is the quadratic
//!
//! ```text
//! E2(h) = Σ_k w_k |c_k + g_x,k x + g_y,k y - t_k e^{ikφ}|²  ≈  ½ hᵀA h + bᵀh + c,   h = (x, y, φ)
//! ```
//!
//! whose minimum is the homing vector. Before, the stored view is turned to where it fits best, by
//! trying all rotations.

mod alignment;
mod difference;
mod packed;
mod resemblance;

use nalgebra::Vector2;

use crate::horizon::BEARING_STEP_RAD;
use crate::snapshot::Snapshot;
use crate::spectrum::{STORED_FREQUENCIES, Spectrum, rotate};

pub use alignment::{align_within, align128};
pub use difference::ImageDifference;
pub use packed::home_packed;
pub use resemblance::Resemblance;

/// Weights of the frequencies k = 1..=8.
pub type Weights = [f32; STORED_FREQUENCIES];

/// Every frequency counts as it is: the plain sum of squared differences by Parseval's theorem.
pub const FLAT_WEIGHTS: Weights = [1.0; STORED_FREQUENCIES];

/// How homing is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingParameters {
    /// Weights of the frequencies.
    pub weights: Weights,
    /// Solutions of the 3 x 3 system; before each further one the current view is moved by the last.
    pub iterations: u8,
    /// Bound of the rotation search, in steps of 2.8 degrees to either side.
    pub rotation_bound: u8,
    /// Bound of the displacement, units of R. Beyond it the linear model means nothing.
    pub displacement_bound: f32,
    /// Bound of the residual turn φ, radians; a solution beyond it is none.
    pub turn_bound: f32,
    /// Below this variance (luma²) of a view's k = 1..=8 there is nothing to see.
    pub least_variance: f32,
}

impl HomingParameters {
    /// What the closed loop works best with.
    ///
    /// - Flat weights and one iteration: homing starts some 0.3 m away, where accuracy counts more
    ///   than a wide basin, and each new frame is an iteration of its own.
    /// - Rotations within ±11 steps (±31 degrees): the north estimate is better than that, and far
    ///   views without a bound are off by more than 45 degrees in a quarter of all cases.
    /// - 0.3 R: the step that Stürzl & Mallot's linear model bears.
    /// - 0.5 rad: where the views match, φ is below 0.2, and e^{ikφ} is no longer linear in φ even for
    ///   small k. A turn, other than a displacement, goes into the pose in full; better none than a
    ///   wild one.
    /// - 1 luma²: a standard deviation of one count; a dark or uniform frame has less, a textured
    ///   room some hundreds.
    pub const DEFAULT: Self = Self {
        weights: FLAT_WEIGHTS,
        iterations: 1,
        rotation_bound: 11,
        displacement_bound: 0.3,
        turn_bound: 0.5,
        least_variance: 1.0,
    };

    /// The same from a metre away and more.
    ///
    /// - Weights by k^-1: the lower a frequency, the farther away the linear model still points home.
    /// - Rotations within ±2 steps (±5.6 degrees): a move by d turns what is abeam by asin(d/R), 24
    ///   degrees for 2 of 5 m, and a search as wide as that takes the move for a turn. A heading strays
    ///   by a few degrees in the minute since the snapshot, and φ follows beyond.
    pub(crate) fn seen_from_afar(mut self) -> Self {
        for (weight, k) in self.weights.iter_mut().zip(1_u8..) {
            *weight /= f32::from(k);
        }
        self.rotation_bound = self.rotation_bound.min(2);
        self
    }

    /// The same with a rotation search within `turn` radians, where that is narrower.
    pub(crate) fn turned_at_most(mut self, turn: f32) -> Self {
        // Saturates where the turn is unbounded.
        let steps = libm::floorf(turn / BEARING_STEP_RAD) as u8;
        self.rotation_bound = self.rotation_bound.min(steps);
        self
    }
}

impl Default for HomingParameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Where the snapshot was taken, seen from here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingVector {
    /// From here to there, in units of the surroundings' distance R; in the frame to which the current
    /// view is aligned (x north, y west).
    pub displacement: Vector2<f32>,
    /// How far the snapshot's viewer is turned counter-clockwise against the current one, radians: the
    /// coarse alignment less the residual φ, because φ turns the stored view towards the current one.
    pub rotation: f32,
    /// Σ w_k |c_k - t_k|² after the coarse alignment, luma²: how different the two views are.
    pub difference: f32,
}

/// Why there is no homing vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NoVectorReason {
    /// No view arrived.
    NoView,
    /// A coefficient, or the solution, is NaN or infinite.
    NotFinite,
    /// A view has next to no contrast: darkness, glare, uniform walls all round.
    NoContrast,
    /// The views leave a direction undetermined, as between the uniform walls of a corridor, match so
    /// badly that the linear model means nothing, or would have the drone turned farther than it can be.
    IllConditioned,
    /// The views differ too much to be of one place.
    OtherPlace,
}

/// The homing vector from the current view to a snapshot.
///
/// # Errors
///
/// [`NoVectorReason`] where the views do not determine one. A vector is finite; its displacement is
/// clipped to [`HomingParameters::displacement_bound`].
#[inline(never)]
pub fn home(
    current: &Spectrum,
    snapshot: &Snapshot,
    parameters: &HomingParameters,
) -> Result<HomingVector, NoVectorReason> {
    let mut stored = snapshot.dequantise();
    for view in [&current.coefficients()[..STORED_FREQUENCIES], &stored[..]] {
        // Parseval: the variance of the view is half the sum of its squared coefficients.
        let variance = 0.5 * view.iter().map(|c| c.norm_sqr()).sum::<f32>();
        if !variance.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        if variance < parameters.least_variance {
            return Err(NoVectorReason::NoContrast);
        }
    }

    let steps = align_within(
        current,
        &stored,
        &parameters.weights,
        parameters.rotation_bound,
    );
    let coarse = f32::from(steps) * BEARING_STEP_RAD;
    rotate(&mut stored, -coarse);

    let mut nearer;
    let mut view = current;
    let mut displacement = Vector2::zeros();
    let mut rotation = coarse;
    let mut difference = None;
    for left in (0..parameters.iterations.max(1)).rev() {
        let image = ImageDifference::between(view, &stored, &parameters.weights);
        let step = image.minimum()?;
        difference.get_or_insert(image.constant());
        displacement += step.xy();
        rotation -= step.z;
        if left > 0 {
            nearer = difference::moved(view, step.xy());
            view = &nearer;
            rotate(&mut stored, step.z);
        }
    }
    let vector = HomingVector {
        displacement: displacement.cap_magnitude(parameters.displacement_bound),
        rotation,
        difference: difference.unwrap_or_default(),
    };
    if (vector.rotation - coarse).abs() > parameters.turn_bound {
        return Err(NoVectorReason::IllConditioned);
    }
    let [x, y] = vector.displacement.into();
    if [x, y, vector.rotation, vector.difference]
        .into_iter()
        .all(f32::is_finite)
    {
        Ok(vector)
    } else {
        Err(NoVectorReason::NotFinite)
    }
}

#[cfg(test)]
mod tests;
