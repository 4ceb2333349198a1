//! Take-off and landing: set-points straight up and straight down.

use super::settings::FLIGHT_HEIGHT_M;

/// From the filter's reset to the climb, ms (published app).
pub const RESET_MS: u64 = 1_000;
/// The climb, ms (published app).
pub const CLIMB_MS: u64 = 1_000;
/// From the end of the climb to the first cycle of the loop, ms (published app).
pub const HOVER_MS: u64 = 1_000;
/// The descent, ms (published app).
pub const DESCENT_MS: u64 = 1_500;

/// Height to hold `elapsed_ms` into the climb, m.
pub fn climb_m(elapsed_ms: u64) -> f32 {
    FLIGHT_HEIGHT_M * eased(elapsed_ms, CLIMB_MS)
}

/// Height to hold `elapsed_ms` into the descent from `height_m`, m.
pub fn descent_m(elapsed_ms: u64, height_m: f32) -> f32 {
    height_m * (1.0 - eased(elapsed_ms, DESCENT_MS))
}

/// From 0 to 1 with the least jerk, at rest at both ends (Flash & Hogan 1985), as the high-level
/// commander's polynomial is.
fn eased(elapsed_ms: u64, duration_ms: u64) -> f32 {
    let t = elapsed_ms.min(duration_ms) as f32 / duration_ms as f32;
    t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

#[cfg(test)]
mod tests {
    use super::{climb_m, descent_m};

    #[test]
    fn the_climb_goes_from_the_ground_to_half_a_metre_and_stays_there() {
        assert_eq!(climb_m(0), 0.0);
        assert_eq!(climb_m(500), 0.25);
        assert_eq!(climb_m(1_000), 0.5);
        assert_eq!(climb_m(9_999), 0.5);
    }

    #[test]
    fn the_descent_ends_on_the_ground() {
        assert_eq!(descent_m(0, 0.5), 0.5);
        assert_eq!(descent_m(1_500, 0.5), 0.0);
    }
}
