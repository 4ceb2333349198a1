//! Which turns of a view are believed.

use super::*;

/// Follows a line with three snapshots, the views on the way back turned by these angles, degrees; which
/// of them realigned the heading, and to what, degrees.
fn headings_told(turned_by: [f32; 3]) -> Vec<Option<f32>> {
    let mut bench = Bench::new();
    bench.record(0x03, 4.1);
    bench.command(0x12);
    let mut x = 4.1_f32;
    let mut told = std::vec![None; 3];
    // A snapshot that is not found is searched for: 13 s.
    for _ in 0..800 {
        let left = bench.snapshots();
        let turn = turned_by[3 - left.max(1)].to_radians();
        let step = bench.step(x, 0.0, Some(&view().rotated(turn)));
        x += (step.vector.unwrap().target.x - x).clamp(-0.1, 0.1);
        if bench.snapshots() < left {
            let turn = |it: Correction| it.to.heading - it.from.heading;
            told[3 - left] = step.correction.map(|it| turn(it).to_degrees());
        }
    }
    assert!(bench.navigator.route().is_empty());
    told
}

#[test]
fn a_turn_that_no_odometry_is_off_by_is_not_believed_once_the_heading_was_realigned() {
    // 2 m on, 11.5 degrees and 2.3 are the most.
    for (turned_by, told) in [
        ([25.0, 9.0, -9.0], [true, true, true]),
        ([25.0, 25.0, 9.0], [true, false, true]),
        ([9.0, -25.0, -25.0], [true, false, false]),
    ] {
        let found = headings_told(turned_by);
        assert_eq!(found.iter().map(Option::is_some).collect::<Vec<_>>(), told);
        for (found, turned_by) in found.iter().zip(turned_by) {
            assert!(found.is_none_or(|found| (found.abs() - turned_by.abs()).abs() < 1.0));
        }
    }
}

#[test]
fn along_a_visual_sequence_any_turn_is_believed() {
    let mut bench = Bench::new();
    bench.record(0x05, 0.6);
    let recorded = bench.snapshots();
    bench.command(0x12);
    for _ in 0..300 {
        let turned = view().rotated(25_f32.to_radians());
        bench.step(0.0, 0.0, Some(&turned));
    }
    let realigned = bench.count(|event| matches!(event, Event::Realigned { .. }));
    assert!(recorded > 1);
    assert_eq!(realigned, recorded);
}

#[test]
fn the_longer_the_way_since_a_realignment_the_farther_a_turn_is_believed() {
    // 4 m after the first: 11.5 degrees and 4.6.
    assert!(headings_told([0.0, 30.0, 15.0])[2].is_some());
    assert!(headings_told([0.0, 0.0, 15.0])[2].is_none());
}
