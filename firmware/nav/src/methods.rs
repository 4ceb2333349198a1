//! Homing methods side by side: the three that the paper compares, and one that searches with the
//! memory of the first.
//!
//! | method | literature | remembers | cost per frame |
//! | --- | --- | --- | --- |
//! | [`Fourier`] | Stürzl & Mallot 2006 | coefficients | an FFT, 30 operations a frequency and iteration |
//! | [`Search`] | Franz, Schölkopf, Mallot & Bülthoff 1998 | grey values | directions x distances x pixels |
//! | [`Mfdid`] | Möller & Vardy 2006; Möller, Vardy, Kreft & Ruwisch 2007 | grey values | pixels x frequencies |
//! | [`WarpSearch`] | the search of the second, compared by the coefficients of the first | coefficients | directions x distances x frequencies² |
//!
//! All take the surroundings to lie on a circle round the viewer. A move by h = (x, y), in units of
//! its radius, turns the view I(θ) into I(θ - asin(x sin θ - y cos θ)).
//!
//! Views are 128 luma values that are north-aligned as well as the heading is known; bearings as
//! everywhere in this crate.

mod coefficients;
mod fourier;
mod grey;
mod mfdid;
pub mod presets;
pub(crate) mod quadratic;
pub mod search;
mod warp_search;

use nalgebra::Vector2;

use crate::homing::NoVectorReason;
use crate::horizon::BEARINGS;

pub use coefficients::{CoefficientCode, Harmonics, MOST_FREQUENCIES};
pub(crate) use fourier::best_rotation;
pub use fourier::{Alignment, Fourier, FourierParameters, Unknowns};
pub use grey::Pixels;
pub use mfdid::{Mfdid, MfdidParameters, MfdidSeen, Slope};
pub use search::{Resolution, Search, SearchParameters};
pub use warp_search::{WarpParameters, WarpSearch};

/// A view: luma by bearing.
pub type Luma = [f32; BEARINGS];

/// The longest memory of a view, bytes.
pub const MOST_BYTES: usize = 64;

/// What is kept of a view.
pub type Memory = heapless::Vec<u8, MOST_BYTES>;

/// Below this variance (luma²) of what is compared there is nothing to go by: not even one grey value
/// in a thousand differs by one.
const LEAST_VARIANCE: f32 = 1e-3;

/// The way to where a memory was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homeward {
    /// From here to there, in units of the surroundings' distance, in the frame to which the current
    /// view is aligned (x north, y west).
    pub displacement: Vector2<f32>,
    /// How far the remembered view's viewer is turned counter-clockwise against the current one,
    /// radians; zero from a method that trusts the heading.
    pub rotation: f32,
    /// How far the vector can be trusted: 0 not at all, 1 as far as a view can tell. What it is made
    /// from is the method's affair.
    pub quality: f32,
}

/// A way to find home by sight.
pub trait HomingMethod {
    /// What the method makes of the current view, once per frame.
    type Seen;

    /// Bytes of a memory; at most [`MOST_BYTES`].
    fn bytes(&self) -> usize;

    /// What is kept of a view.
    fn remember(&self, view: &Luma) -> Memory;

    /// What homing needs of the current view.
    fn see(&self, view: &Luma) -> Self::Seen;

    /// The way from the current view to a remembered one.
    ///
    /// # Errors
    /// [`NoVectorReason`] where the views do not determine one.
    fn home(&self, seen: &Self::Seen, memory: &Memory) -> Result<Homeward, NoVectorReason>;
}

#[cfg(test)]
mod tests;
