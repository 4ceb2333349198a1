//! Where a drone begins to follow that is not at the end of its route.

use super::*;

/// A drone that has recorded along x, is moved, and is told to follow.
fn moved(record: u8, metres: f32, (x, y): (f32, f32)) -> (Bench, Step) {
    let mut bench = Bench::new();
    bench.record(record, metres);
    bench.command(0x00);
    bench.step(x, y, Some(&view()));
    bench.command(0x12);
    let step = bench.step(x, y, Some(&view()));
    (bench, step)
}

/// Lets it fly where it is led; where it ends.
fn fly(bench: &mut Bench, from: (f32, f32), steps: usize) -> Point2<f32> {
    let mut at = Point2::new(from.0, from.1);
    for _ in 0..steps {
        let target = bench.step(at.x, at.y, Some(&view())).vector.unwrap().target;
        at += (target - at).cap_magnitude(0.1);
    }
    at
}

#[test]
fn from_beside_the_route_it_goes_on_from_the_nearest_point() {
    for record in [0x02, 0x03, 0x07] {
        let (mut bench, step) = moved(record, 9.5, (5.2, 0.9));
        let target = step.vector.unwrap().target;
        assert!((target - Point2::new(5.2, 0.0)).norm() < 0.08, "{target:?}");
        let home = fly(&mut bench, (5.2, 0.9), 400);
        assert!(home.coords.norm() < 0.21, "{home:?}");
        assert!(bench.navigator.route().is_empty());
        let homings = bench.count(|event| matches!(event, Event::HomingStarted { .. }));
        // Those at 4, 2 and 0 m.
        assert_eq!(homings, if record == 0x02 { 0 } else { 3 });
    }
}

#[test]
fn from_half_a_metre_round_the_end_of_the_route_nothing_of_it_is_left_out() {
    for (dx, dy, left) in [
        (0.0, 0.0, 5),
        (-0.45, 0.0, 5),
        (0.0, 0.45, 5),
        (0.45, 0.0, 5),
        (-0.6, 0.0, 4),
    ] {
        let mut bench = Bench::new();
        bench.command(0x03);
        let mut x = 0.0;
        while bench.snapshots() < 5 {
            bench.step(x, 0.0, Some(&view()));
            x += 0.1;
        }
        let tip = bench.navigator.route().tip();
        bench.command(0x12);
        bench.step(tip.x + dx, tip.y + dy, Some(&view()));
        assert_eq!(bench.snapshots(), left, "{dx}, {dy}");
    }
}

#[test]
fn far_from_the_route_it_stops_safely_and_keeps_the_route() {
    for (x, y) in [(5.0, 2.1), (11.6, 0.0), (-1.5, -1.5)] {
        let (mut bench, step) = moved(0x03, 9.5, (x, y));
        assert_eq!(step.vector.unwrap().target, Point2::new(x, y));
        let at = fly(&mut bench, (x, y), 100);
        assert_eq!(at, Point2::new(x, y));
        assert_eq!(bench.count(|event| *event == Event::Lost), 1);
        assert_eq!(bench.snapshots(), 5);
        // Brought nearer, it is led home.
        bench.command(0x00);
        bench.command(0x12);
        let home = fly(&mut bench, (3.0, 1.0), 300);
        assert!(home.coords.norm() < 0.21, "{home:?}");
    }
}

#[test]
fn a_drone_that_was_stopped_between_two_points_goes_on_to_the_next() {
    // There and back: the way out runs beside the drone all the time.
    let mut bench = Bench::new();
    bench.command(0x03);
    for tenths in (0..=80).chain((0..80).rev()) {
        let at = if bench.now_ms < 5_000 + 8_150 {
            0.0
        } else {
            0.3
        };
        bench.step(tenths as f32 * 0.1, at, Some(&view()));
    }
    bench.command(0x12);
    let stopped = fly(&mut bench, (0.0, 0.3), 60);
    let left = |bench: &Bench| {
        let route = bench.navigator.route();
        (route.vectors().len(), route.snapshots().len())
    };
    let before = left(&bench);
    assert!((0.5..7.5).contains(&stopped.x), "{stopped:?}");
    bench.command(0x00);
    bench.command(0x12);
    bench.step(stopped.x, stopped.y, Some(&view()));
    assert_eq!(left(&bench), before);
}

#[test]
fn a_visual_sequence_begins_with_its_last_snapshot_wherever_the_drone_is() {
    let (bench, _) = moved(0x05, 3.0, (-8.0, 5.0));
    let last = bench.snapshots() as u16 - 1;
    assert_eq!(
        bench.events.last(),
        Some(&Event::HomingStarted { index: last })
    );
}

#[test]
fn told_to_stay_it_goes_back_to_the_last_snapshot_from_anywhere_on_the_way() {
    let mut bench = Bench::new();
    bench.record(0x03, 6.5);
    bench.command(0x11);
    bench.step(3.0, 0.2, None);
    for _ in 0..20 {
        bench.step(3.0, 0.2, None);
    }
    let step = bench.step(3.0, 0.2, None);
    let target = step.vector.unwrap().target;
    assert!((target - Point2::new(6.0, 0.0)).norm() < 0.2, "{target:?}");
    assert_eq!(bench.snapshots(), 4);
}
