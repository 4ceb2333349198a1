//! Where the autopilot's coordinates lie in the route's.

use nalgebra::{Isometry2, Point2, Vector2};
use nav::{Correction, MapEntry, Pose, SetPoint, Step};

/// A turn and a shift in the plane. An autopilot that starts afresh counts from where it stands and
/// calls its heading north; the route keeps the coordinates in which it was recorded.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    to_route: Isometry2<f32>,
    turn: f32,
}

impl Anchor {
    /// The anchor by which the autopilot's pose `theirs` is the route's pose `ours`.
    pub fn between(theirs: &Pose, ours: &Pose) -> Self {
        let turn = ours.heading - theirs.heading;
        let turned = Isometry2::rotation(turn) * theirs.position;
        let shift = ours.position - turned;
        Self {
            to_route: Isometry2::new(Vector2::new(shift.x, shift.y), turn),
            turn,
        }
    }

    /// A pose of the autopilot in the route's coordinates.
    pub fn to_route(self, pose: &Pose) -> Pose {
        Pose::new(self.to_route * pose.position, pose.heading + self.turn)
    }

    /// All that a step gives out, in the autopilot's coordinates.
    pub fn to_autopilot(self, step: Step) -> Step {
        Step {
            vector: step.vector.map(|vector| SetPoint {
                target: self.place(&vector.target),
                start: self.place(&vector.start),
                ..vector
            }),
            correction: step.correction.map(|correction| Correction {
                from: self.pose(&correction.from),
                to: self.pose(&correction.to),
                ..correction
            }),
            map: step.map.map(|map| MapEntry {
                snapshot_position: self.place(&map.snapshot_position),
                odometry_position: self.place(&map.odometry_position),
                ..map
            }),
            events: step.events,
        }
    }

    fn place(self, place: &Point2<f32>) -> Point2<f32> {
        self.to_route.inverse_transform_point(place)
    }

    fn pose(self, pose: &Pose) -> Pose {
        Pose::new(self.place(&pose.position), pose.heading - self.turn)
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::FRAC_PI_2;

    use super::*;

    fn is_near(a: &Pose, b: &Pose) -> bool {
        (a.position - b.position).norm() < 1e-5 && (a.heading - b.heading).abs() < 1e-5
    }

    #[test]
    fn a_drone_that_starts_afresh_facing_west_has_the_routes_north_on_its_right() {
        let fell = Pose::new(Point2::new(-5.0, -4.0), FRAC_PI_2);
        let anchor = Anchor::between(&Pose::new(Point2::origin(), 0.0), &fell);
        let ahead = Pose::new(Point2::new(1.0, 0.0), 0.0);
        let west = Pose::new(Point2::new(-5.0, -3.0), FRAC_PI_2);
        assert!(is_near(&anchor.to_route(&ahead), &west));
        let north_of_the_fall = anchor.place(&Point2::new(-4.0, -4.0));
        assert!((north_of_the_fall - Point2::new(0.0, -1.0)).norm() < 1e-5);
    }

    #[test]
    fn there_and_back_is_where_it_was() {
        let theirs = Pose::new(Point2::new(0.3, -0.1), 0.2);
        let ours = Pose::new(Point2::new(-3.0, 2.0), -1.1);
        let anchor = Anchor::between(&theirs, &ours);
        assert!(is_near(&anchor.to_route(&theirs), &ours));
        assert!(is_near(&anchor.pose(&ours), &theirs));
    }
}
