//! How fast the drone goes, and where it was when the camera saw what is looked at now.

use nalgebra::{Point2, Vector2};

use super::parameters::Parameters;

/// Between two STATE messages, seconds. The nominal period and not the clock: so what is decided follows
/// from the messages alone, and the same messages lead to the same decisions on every board.
const PERIOD_S: f32 = 0.1;
/// The fastest that this drone flies, metres a second; what looks faster is a correction of the estimate.
const FASTEST_M_S: f32 = 1.5;

/// The last pose that was told.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    last: Option<Point2<f32>>,
}

impl Motion {
    pub(super) const fn new() -> Self {
        Self { last: None }
    }

    /// Where the newest view was seen from, by a drone that is at `position` now.
    pub(super) fn seen_from(
        &mut self,
        parameters: &Parameters,
        position: Point2<f32>,
    ) -> Point2<f32> {
        let last = self.last.replace(position);
        position - velocity(last, position) * parameters.view_age_s
    }
}

/// Velocity of a drone that came to `position` from the last pose, metres a second: zero where there is none,
/// or where it is too far away to have been flown from.
fn velocity(last: Option<Point2<f32>>, position: Point2<f32>) -> Vector2<f32> {
    let way = last.map_or_else(Vector2::zeros, |last| position - last);
    // Written so that NaN is no speed.
    if way.norm() < FASTEST_M_S * PERIOD_S {
        way / PERIOD_S
    } else {
        Vector2::zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: Parameters = Parameters::DEFAULT;

    /// How far behind the second of two poses its view was seen from, metres.
    fn behind(way_m: f32) -> f32 {
        let mut motion = Motion::new();
        motion.seen_from(&PARAMETERS, Point2::origin());
        let here = Point2::new(way_m, 0.0);
        let seen_from = motion.seen_from(&PARAMETERS, here);
        assert!(seen_from.y == 0.0);
        here.x - seen_from.x
    }

    #[test]
    fn a_drone_in_flight_is_ahead_of_what_it_sees() {
        let half_a_metre_a_second = behind(0.05);
        assert!((half_a_metre_a_second - 0.5 * PARAMETERS.view_age_s).abs() < 1e-6);
        assert_eq!(behind(0.0), 0.0);
    }

    #[test]
    fn a_correction_of_the_estimate_is_no_flight() {
        assert_eq!(behind(0.5), 0.0);
    }

    #[test]
    fn the_first_view_was_seen_from_here() {
        let here = Point2::new(3.0, 4.0);
        assert_eq!(Motion::new().seen_from(&PARAMETERS, here), here);
    }
}
