//! A pilot who sees the drone and leads it along the ground, whatever its filter believes.

use link::{WorldPoint, WorldPose};

/// Where the drone is, beside where its filter believes it is, at one instant.
///
/// Places on the ground are those of the script, relative to the take-off; places in the filter's coordinates drift
/// away from them.
#[derive(Debug, Clone, Copy)]
pub struct Pilot {
    /// On the ground, as the pilot sees it.
    pub seen: WorldPose,
    /// In the filter's coordinates.
    pub believed: WorldPose,
}

impl Pilot {
    /// The place on the ground that the filter would call `place`.
    pub fn on_the_ground(&self, place: WorldPoint) -> WorldPoint {
        carry(place, &self.believed, &self.seen)
    }

    /// What the filter calls a `place` on the ground.
    pub fn in_the_filter(&self, place: WorldPoint) -> WorldPoint {
        carry(place, &self.seen, &self.believed)
    }
}

/// The place that lies to the pose `to` as `place` lies to the pose `from`.
fn carry(place: WorldPoint, from: &WorldPose, to: &WorldPose) -> WorldPoint {
    let (sin, cos) = libm::sincosf(to.yaw - from.yaw);
    let (x, y) = (place.x - from.x, place.y - from.y);
    WorldPoint {
        x: to.x + x * cos - y * sin,
        y: to.y + x * sin + y * cos,
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn what_lies_ahead_of_the_drone_lies_ahead_of_it_in_the_filters_coordinates() {
        let seen = WorldPose {
            x: 1.0,
            y: 2.0,
            yaw: FRAC_PI_2,
        };
        let believed = WorldPose {
            x: 5.0,
            y: -3.0,
            yaw: 0.0,
        };
        let pilot = Pilot { seen, believed };
        // The drone looks west: 4 m ahead.
        let ahead = WorldPoint { x: 1.0, y: 6.0 };
        let place = pilot.in_the_filter(ahead);
        assert!((place.x - 9.0).abs() < 1e-5 && (place.y + 3.0).abs() < 1e-5);
        let back = pilot.on_the_ground(place);
        assert!((back.x - ahead.x).abs() < 1e-5 && (back.y - ahead.y).abs() < 1e-5);
    }
}
