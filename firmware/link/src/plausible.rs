//! Which coordinates and headings are believed.
//!
//! Nothing on the link but a 16-bit sum vouches for a number, and what passes here becomes a place
//! to fly to or a point of the route.

use core::error::Error;
use core::f32::consts::TAU;
use core::fmt;

/// Farthest from the world's origin that a coordinate can be, m. A desert ant forages within a
/// kilometre of its nest, and the Crazyflie's filter resets itself at a tenth of it (crazyflie-firmware
/// `kalman_supervisor`): no flight gets there.
pub const MAX_COORDINATE_M: f32 = 1000.0;

/// Largest heading, or turn, either way, rad: four turns. The Crazyflie reports its yaw within half
/// a turn, and a correction adds half a turn at most; who unwraps his yaw may have turned round a few
/// times. An f32 tells headings of this size apart to 2e-6 rad.
pub const MAX_HEADING_RAD: f32 = 4.0 * TAU;

/// Why a coordinate or a heading is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Implausible {
    /// It is NaN or infinite.
    NotFinite,
    /// It is beyond [`MAX_COORDINATE_M`] or [`MAX_HEADING_RAD`].
    TooLarge,
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a coordinate or a heading is not a finite number"),
            Self::TooLarge => write!(
                f,
                "a coordinate is beyond {MAX_COORDINATE_M} m or a heading beyond four turns"
            ),
        }
    }
}

impl Error for Implausible {}

/// Whether a coordinate, m, can be believed.
pub(crate) fn coordinate(metres: f32) -> Result<(), Implausible> {
    within(metres, MAX_COORDINATE_M)
}

/// Whether a heading or a turn, rad, can be believed.
pub(crate) fn heading(radians: f32) -> Result<(), Implausible> {
    within(radians, MAX_HEADING_RAD)
}

fn within(value: f32, limit: f32) -> Result<(), Implausible> {
    if !value.is_finite() {
        Err(Implausible::NotFinite)
    } else if value.abs() > limit {
        Err(Implausible::TooLarge)
    } else {
        Ok(())
    }
}
