//! What the autopilot is told of where the drone is: when a snapshot is taken, and when one is left.

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

#[test]
fn where_a_snapshot_is_taken_the_estimate_is_said_to_be_right() {
    let mut bench = Bench::new();
    bench.command(0x03);
    let mut said = Vec::new();
    for tenths in 0..=45_u8 {
        let (x, y) = (0.1 * f32::from(tenths), 0.02 * f32::from(tenths));
        let step = bench.step(x, y, Some(&view()));
        assert_eq!(step.correction.is_some(), step.has_snapshot());
        said.extend(step.correction.map(|correction| (correction, x, y)));
    }
    let indices: Vec<u16> = said.iter().map(|(said, ..)| said.index).collect();
    assert_eq!(indices, [1, 2, 3]);
    for (said, x, y) in said {
        assert_eq!(said.from, Pose::new(Point2::new(x, y), 0.0));
        assert_eq!(said.to, said.from);
    }
}

#[test]
fn a_sequence_that_stores_no_way_says_nothing_of_the_estimate() {
    let mut bench = Bench::new();
    bench.command(0x05);
    for tenths in 0..=40_u8 {
        let step = bench.step(0.1 * f32::from(tenths), 0.0, Some(&view()));
        assert_eq!(step.correction, None);
    }
    assert!(bench.snapshots() > 12);
}

#[test]
fn snapshots_that_follow_at_once_are_said_to_be_right_once_a_second() {
    let mut bench = Bench::new();
    bench.navigator.set_snapshot_spacing(0.3);
    bench.command(0x03);
    let said: Vec<u8> = (0..=40_u8)
        .filter(|tenths| {
            let step = bench.step(0.1 * f32::from(*tenths), 0.0, Some(&view()));
            step.correction.is_some()
        })
        .collect();
    assert!(bench.snapshots() > 10);
    assert!(said.len() > 3, "{said:?}");
    assert!(said.windows(2).all(|two| two[1] - two[0] >= 10), "{said:?}");
}
