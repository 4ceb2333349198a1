//! The routes of the published experiments, as waypoints.

use link::WorldPoint;

/// When a waypoint counts as reached, and how long the drone stays there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// Distance from the estimated position, m.
    pub radius_m: f32,
    /// From the first moment within that distance, ms.
    pub dwell_ms: u64,
}

impl Arrival {
    /// At a waypoint along the way (published app).
    pub const WAYPOINT: Self = Self {
        radius_m: 0.30,
        dwell_ms: 1_000,
    };
    /// At the end of a pass (published app).
    pub const PASS_END: Self = Self {
        radius_m: 0.50,
        dwell_ms: 5_000,
    };
}

/// A place on a route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Where it is.
    pub place: WorldPoint,
    /// When it is reached.
    pub arrival: Arrival,
}

/// Waypoints in the order in which they are flown. The first is where recording begins.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Route {
    /// The waypoints.
    pub waypoints: Vec<Waypoint>,
}

impl Route {
    /// A route over places of one's own; all but the last are waypoints along the way.
    pub fn through(places: &[WorldPoint]) -> Self {
        Self::passes(places, 1)
    }

    /// `passes` ways along the same places, every second one backwards.
    pub fn passes(places: &[WorldPoint], passes: usize) -> Self {
        let at = |place: &WorldPoint, arrival| Waypoint {
            place: *place,
            arrival,
        };
        let mut waypoints: Vec<_> = places
            .first()
            .map(|start| at(start, Arrival::WAYPOINT))
            .into_iter()
            .collect();
        let mut places = places.to_vec();
        for _ in 0..passes {
            if let [_, along @ .., end] = &places[..] {
                waypoints.extend(along.iter().map(|place| at(place, Arrival::WAYPOINT)));
                waypoints.push(at(end, Arrival::PASS_END));
            }
            places.reverse();
        }
        Self { waypoints }
    }

    /// The U of the paper's Fig. 6: 14 m, flown four times, 56 m in all.
    pub fn u() -> Self {
        let places = [(0.0, 0.0), (-5.0, 0.0), (-5.0, 4.0), (0.0, 4.0)];
        Self::passes(&north_east(places), 4)
    }

    /// The S of the paper's Fig. 6: 20 m, flown twice, 40 m in all.
    pub fn s() -> Self {
        Self::s_passes(2)
    }

    /// The same S, every second pass backwards.
    pub fn s_passes(passes: usize) -> Self {
        let places = [
            (0.0, 0.0),
            (-5.0, 0.0),
            (-5.0, 2.5),
            (0.0, 2.5),
            (0.0, 5.0),
            (-5.0, 5.0),
        ];
        Self::passes(&north_east(places), passes)
    }

    /// The leg of the corridor experiment, 6 m, flown there and back ten times, 120 m in all. Southward,
    /// like the first leg of the U, where the published script flies north: rooms that hold the U then
    /// hold this as well.
    pub fn corridor() -> Self {
        const ROUNDS: usize = 10;
        Self::passes(&north_east([(0.0, 0.0), (-6.0, 0.0)]), 2 * ROUNDS)
    }

    /// Straight north.
    pub fn line(length_m: f32) -> Self {
        Self::through(&north_east([(0.0, 0.0), (length_m, 0.0)]))
    }

    /// Where recording begins.
    pub fn start(&self) -> Option<WorldPoint> {
        self.waypoints.first().map(|waypoint| waypoint.place)
    }

    /// The length of the way over all waypoints, m.
    pub fn length_m(&self) -> f32 {
        let legs = self.waypoints.windows(2);
        legs.map(|leg| distance_m(leg[0].place, leg[1].place)).sum()
    }
}

fn north_east<const N: usize>(places: [(f32, f32); N]) -> [WorldPoint; N] {
    places.map(|(north, east)| WorldPoint::from_north_east(north, east))
}

/// Distance between two places, m.
pub(super) fn distance_m(a: WorldPoint, b: WorldPoint) -> f32 {
    libm::hypotf(b.x - a.x, b.y - a.y)
}

#[cfg(test)]
mod tests {
    use link::WorldPoint;

    use super::{Arrival, Route};

    #[test]
    fn the_u_is_56_m_long_and_ends_where_it_began() {
        let route = Route::u();
        assert_eq!(route.length_m(), 56.0);
        assert_eq!(route.waypoints.len(), 1 + 4 * 3);
        let end = route.waypoints.last().map(|waypoint| waypoint.place);
        assert_eq!(end, route.start());
    }

    #[test]
    fn the_s_is_40_m_long() {
        assert_eq!(Route::s().length_m(), 40.0);
    }

    #[test]
    fn the_corridor_is_120_m_long_and_ends_where_it_began() {
        let route = Route::corridor();
        assert_eq!(route.length_m(), 120.0);
        let end = route.waypoints.last().map(|waypoint| waypoint.place);
        assert_eq!(end, route.start());
    }

    #[test]
    fn the_first_corners_of_the_u_lie_south_and_then_east() {
        let route = Route::u();
        let corner = |index: usize| route.waypoints[index].place;
        assert_eq!(corner(1), WorldPoint { x: -5.0, y: 0.0 });
        assert_eq!(corner(2), WorldPoint { x: -5.0, y: -4.0 });
    }

    #[test]
    fn only_the_ends_of_passes_are_stayed_at_for_long() {
        let route = Route::u();
        let ends: Vec<_> = (0..route.waypoints.len())
            .filter(|index| route.waypoints[*index].arrival == Arrival::PASS_END)
            .collect();
        assert_eq!(ends, [3, 6, 9, 12]);
    }

    #[test]
    fn a_route_without_places_has_no_waypoints() {
        assert_eq!(Route::through(&[]), Route::default());
    }
}
