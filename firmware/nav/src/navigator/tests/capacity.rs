//! What becomes of a way that is longer than the memory.

use super::*;
use crate::route::VECTOR_CAPACITY;

/// Records along x in steps of 0.1 m, with a snapshot so often; what was said, and where.
fn record(record: u8, spacing_m: f32, metres: usize) -> (Bench, Vec<(f32, Event)>) {
    let mut bench = Bench::new();
    bench.navigator.set_snapshot_spacing(spacing_m);
    bench.command(record);
    let mut said = Vec::new();
    for tenths in 0..=10 * metres {
        let x = tenths as f32 * 0.1;
        let step = bench.step(x, 0.0, Some(&view()));
        let full = step.events.into_iter().filter(|event| {
            matches!(
                event,
                Event::ThinnedOut { .. } | Event::SnapshotsFull | Event::RouteFull
            )
        });
        said.extend(full.map(|event| (x, event)));
    }
    (bench, said)
}

/// Where the snapshots were taken, metres.
fn places(bench: &Bench) -> Vec<f32> {
    let vectors = bench.navigator.route().vectors();
    let along = |height: u16| {
        let below = &vectors[..usize::from(height)];
        below.iter().map(|vector| vector.metres().x).sum()
    };
    let snapshots = bench.navigator.route().snapshots().iter();
    snapshots.map(|stored| along(stored.height)).collect()
}

#[test]
fn a_route_that_is_full_keeps_every_second_snapshot_and_goes_on_half_as_dense() {
    // 512 snapshots, 0.5 m apart, reach 255.5 m; 1 m apart, 511 m.
    let (bench, said) = record(0x03, 0.5, 400);
    let [(full_m, Event::ThinnedOut { last: 255 })] = said[..] else {
        panic!("{said:?}");
    };
    assert!((255.0..310.0).contains(&full_m), "{full_m}");
    let places = places(&bench);
    assert_eq!(places[0], 0.0);
    let gaps: Vec<f32> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gaps.iter().all(|gap| (0.9..1.45).contains(gap)), "{gaps:?}");
    assert!(places.last().unwrap() + 1.4 > 400.0);
}

#[test]
fn snapshots_that_are_sparse_already_stay_and_the_rest_of_the_way_is_odometry() {
    let theory = |bench: &mut Bench| bench.navigator.space_snapshots_by_theory();
    let sparse = |bench: &mut Bench| bench.navigator.set_snapshot_spacing(5.5);
    for space in [theory as fn(&mut Bench), sparse] {
        let mut bench = Bench::new();
        // A full stack of snapshots that odometry leads to.
        bench.navigator.set_snapshot_spacing(0.4);
        bench.command(0x03);
        let mut x = 0.0;
        while bench.snapshots() < SNAPSHOT_CAPACITY {
            bench.step(x, 0.0, Some(&view()));
            x += 0.1;
        }
        bench.command(0x00);
        space(&mut bench);
        bench.command(0x07);
        for _ in 0..300 {
            bench.step(x, 0.0, Some(&view()));
            x += 0.1;
        }
        assert_eq!(bench.snapshots(), SNAPSHOT_CAPACITY);
        assert_eq!(bench.count(|event| *event == Event::SnapshotsFull), 1);
        assert!((bench.navigator.route().tip().x - x).abs() < 0.5);
    }
}

#[test]
fn a_visual_sequence_that_is_full_ends_there() {
    let (bench, said) = record(0x05, 0.5, 200);
    assert_eq!(bench.snapshots(), SNAPSHOT_CAPACITY);
    assert!(matches!(said[..], [(_, Event::RouteFull)]), "{said:?}");
}

#[test]
fn odometry_alone_is_simplified_when_it_is_full() {
    // One vector every 0.3 to 0.4 m: 2048 are 614 m and more.
    let (bench, said) = record(0x02, 2.0, 900);
    assert_eq!(said, []);
    let route = bench.navigator.route();
    assert!(route.vectors().len() < VECTOR_CAPACITY);
    assert!((route.tip().x - 900.0).abs() < 0.4);
}

#[test]
fn a_way_that_cannot_be_simplified_ends_where_it_is_full_and_is_not_followed_from_far_beyond() {
    let mut bench = Bench::new();
    bench.command(0x02);
    // Half a metre north, half a metre west, and so on: no point of that can be left out.
    let at = |step: usize| {
        let steps = |half: usize| (step.div_ceil(2) * (1 - half) + step / 2 * half) as f32 * 0.5;
        (steps(0), steps(1))
    };
    for step in 0..VECTOR_CAPACITY + 20 {
        let (x, y) = at(step);
        bench.step(x, y, None);
    }
    assert_eq!(bench.count(|event| *event == Event::RouteFull), 1);
    assert_eq!(bench.navigator.route().vectors().len(), VECTOR_CAPACITY);
    let (x, y) = at(VECTOR_CAPACITY + 19);
    bench.command(0x12);
    let step = bench.step(x, y, None);
    assert_eq!(step.vector.unwrap().target, Point2::new(x, y));
    assert_eq!(bench.count(|event| *event == Event::Lost), 1);
    assert_eq!(bench.navigator.route().vectors().len(), VECTOR_CAPACITY);
}
