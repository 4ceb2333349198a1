//! Where the drone believes it is, in the plane.

use core::f32::consts::{PI, TAU};

use nalgebra::Point2;

/// The farthest coordinate taken for real, metres. Beyond it an f32 no longer resolves a millimetre,
/// and a flight of minutes does not get there.
pub const FARTHEST_M: f32 = 10_000.0;

/// Position and heading in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Metres: x north, y west.
    pub position: Point2<f32>,
    /// Radians, counter-clockwise from north.
    pub heading: f32,
}

impl Pose {
    /// A pose from its parts.
    pub const fn new(position: Point2<f32>, heading: f32) -> Self {
        Self { position, heading }
    }

    /// Whether all parts are finite and the position lies within [`FARTHEST_M`].
    ///
    /// A Kalman filter that diverged reports NaN or worse; neither may enter the route.
    pub fn is_plausible(&self) -> bool {
        let within = |coordinate: f32| coordinate.abs() <= FARTHEST_M;
        within(self.position.x) && within(self.position.y) && self.heading.is_finite()
    }
}

/// The same angle in [-π, π). Not finite in, not finite out.
pub fn wrap_angle(angle: f32) -> f32 {
    let wrapped = angle - TAU * libm::floorf((angle + PI) / TAU);
    // Rounding may leave the interval by one unit in the last place.
    if wrapped >= PI {
        wrapped - TAU
    } else {
        wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_keeps_the_direction() {
        for tenths in -200..200 {
            let angle = tenths as f32 * 0.1;
            let wrapped = wrap_angle(angle);
            assert!((-PI..PI).contains(&wrapped), "{angle} became {wrapped}");
            assert!((libm::sinf(angle) - libm::sinf(wrapped)).abs() < 1e-5);
            assert!((libm::cosf(angle) - libm::cosf(wrapped)).abs() < 1e-5);
        }
    }

    #[test]
    fn a_pose_that_is_not_finite_is_not_plausible() {
        let here = Pose::new(Point2::new(1.0, -2.0), 0.3);
        assert!(here.is_plausible());
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(!Pose::new(Point2::new(bad, 0.0), 0.0).is_plausible());
            assert!(!Pose::new(Point2::new(0.0, bad), 0.0).is_plausible());
            assert!(!Pose::new(Point2::new(0.0, 0.0), bad).is_plausible());
        }
        assert!(!Pose::new(Point2::new(1e9, 0.0), 0.0).is_plausible());
    }
}
