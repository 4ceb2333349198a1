//! What a drone believes that leaves a snapshot without having got there.

use super::*;

/// The view after a move to the north by `metres` among things that are `radius_m` away, to first order
/// (g_x of [`crate::homing`]).
fn after_a_move(view: &Spectrum, metres: f32, radius_m: f32) -> Spectrum {
    let mut moved = *view.coefficients();
    let c = view.coefficients();
    for index in 0..VIEW_FREQUENCIES - 1 {
        let k = (index + 1) as f32;
        let below = c[index.saturating_sub(1)] * (k - 1.0);
        moved[index] += (c[index + 1] * (k + 1.0) - below) * (0.5 * metres / radius_m);
    }
    Spectrum::from_coefficients(moved)
}

/// Near enough for the view to change by the first order.
const BEHIND_M: f32 = 0.05;

/// The first correction of a drone that stands still near the last snapshot of a route, where that looks as
/// from [`BEHIND_M`] behind it, and that snapshot's place.
fn correction_of_a_drone_that_stands(radius_m: f32) -> (Correction, f32) {
    let mut bench = Bench::new();
    bench.record(0x03, 2.2);
    let top = bench.navigator.route().top_snapshot_position();
    let place = top.expect("a snapshot").x;
    bench.command(0x12);
    let seen = after_a_move(&view(), BEHIND_M, radius_m);
    let correction = (0..100)
        .find_map(|_| bench.step(place + BEHIND_M, 0.0, Some(&seen)).correction)
        .expect("homing ends");
    (correction, place)
}

#[test]
fn what_is_left_of_the_way_to_a_snapshot_is_not_denied() {
    let radius_m = Parameters::DEFAULT.environment_radius_m;
    let (correction, place) = correction_of_a_drone_that_stands(radius_m);
    assert!((correction.from.position.x - (place + BEHIND_M)).abs() < 1e-5);
    // The stored view is rounded to counts, which looks like some centimetres of way.
    let (there, _) = correction_of_a_drone_that_stands(f32::INFINITY);
    let left = correction.to.position.x - there.to.position.x;
    assert!((left - BEHIND_M).abs() < 0.01, "{left}");
}

#[test]
fn a_drone_that_sees_itself_at_the_snapshot_is_there() {
    let (correction, place) = correction_of_a_drone_that_stands(f32::INFINITY);
    let left = correction.to.position.x - place;
    assert!(left.abs() < 0.03, "{left}");
}
