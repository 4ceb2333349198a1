//! Where the drone believes it is, in the plane.

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

#[cfg(test)]
mod tests {
    use super::*;

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
