extern crate std;

use std::boxed::Box;
use std::vec::Vec;

use nalgebra::Complex;
use proptest::prelude::*;

use super::*;
use crate::snapshot::{Packing, SNAPSHOT_BYTES, Snapshot};
use crate::spectrum::{STORED_FREQUENCIES, VIEW_FREQUENCIES};

/// Snapshots of the paper's that fit.
const SNAPSHOT_CAPACITY: usize = 512;

const TOLERANCE_M: f32 = SIMPLIFY_TOLERANCE_M;

/// A view whose counts are all 7.
fn view() -> Spectrum {
    let mut coefficients = [Complex::new(0.0, 0.0); VIEW_FREQUENCIES];
    coefficients[..STORED_FREQUENCIES].copy_from_slice(&SNAPSHOT.dequantise());
    Spectrum::from_coefficients(coefficients)
}

const SNAPSHOT: Snapshot = Snapshot([7; SNAPSHOT_BYTES]);

/// Half a count along both axes.
const ROUNDING_M: f32 = 0.0708;

fn polyline(route: &Route) -> Vec<Point2<f32>> {
    let mut counts = [0, 0];
    let mut points = std::vec![route.point(counts)];
    for vector in route.vectors() {
        counts[0] += i32::from(vector.x);
        counts[1] += i32::from(vector.y);
        points.push(route.point(counts));
    }
    points
}

fn distance_to(polyline: &[Point2<f32>], point: Point2<f32>) -> f32 {
    let to_segment = |ends: &[Point2<f32>]| {
        let (along, from) = (ends[1] - ends[0], point - ends[0]);
        let fraction = (from.dot(&along) / along.norm_squared().max(1e-9)).clamp(0.0, 1.0);
        (from - along * fraction).norm()
    };
    polyline.windows(2).map(to_segment).fold(f32::MAX, f32::min)
}

/// A walk with steps of up to 0.5 m.
fn walks(longest: usize) -> impl Strategy<Value = Vec<Point2<f32>>> {
    prop::collection::vec((-0.5_f32..0.5, -0.5_f32..0.5), 1..longest).prop_map(|steps| {
        let mut at = Point2::new(3.217, -1.443);
        let walk = steps.into_iter().map(|(x, y)| {
            at += nalgebra::Vector2::new(x, y);
            at
        });
        walk.collect()
    })
}

#[test]
fn the_stored_forms_have_the_size_that_the_paper_gives() {
    assert_eq!(OdometryVector { x: 1, y: -1 }.to_bytes(), [0x01, 0xFF]);
    let mut route = Box::new(Route::new());
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    route.extend_to(Point2::new(20.0, 0.0)).unwrap();
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    let bytes = route.snapshots().bytes();
    assert_eq!(bytes.len(), 2 * 18);
    assert_eq!((bytes[18], &bytes[34..]), (7, &[2, 0][..]));
    let stored = StoredSnapshot {
        view: StoredView::Paper(SNAPSHOT),
        height: 2,
    };
    assert_eq!(route.top_snapshot(), Some(stored));
}

#[test]
fn a_straight_way_between_two_snapshots_takes_one_vector() {
    let mut route = Box::new(Route::new());
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    for step in 1..=7 {
        route
            .extend_to(Point2::new(step as f32 * 0.3, 0.02))
            .unwrap();
    }
    assert_eq!(route.vectors().len(), 7);
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    assert_eq!(route.vectors(), [OdometryVector { x: 21, y: 0 }]);
    assert_eq!(route.bytes(), 2 * 18 + 2);
    assert_eq!(route.bytes_without_heights(), 2 * 16 + 2);
}

#[test]
fn a_corner_stays_where_it_is() {
    let mut route = Box::new(Route::new());
    for (x, y) in [(0.3, 0.0), (0.6, 0.0), (0.9, 0.0), (0.9, 0.3), (0.9, 0.6)] {
        route.extend_to(Point2::new(x, y)).unwrap();
    }
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    let expected = [OdometryVector { x: 9, y: 0 }, OdometryVector { x: 0, y: 6 }];
    assert_eq!(route.vectors(), expected);
}

#[test]
fn a_long_straight_way_is_split_to_stay_within_a_byte() {
    let mut route = Box::new(Route::new());
    for step in 1..=100 {
        route
            .extend_to(Point2::new(step as f32 * 0.3, step as f32 * -0.15))
            .unwrap();
    }
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    // 30 m take three vectors of at most 12.7 m.
    assert_eq!(route.vectors().len(), 3);
    assert!((route.tip() - Point2::new(30.0, -15.0)).norm() < ROUNDING_M);
}

#[test]
fn a_full_route_refuses_and_stays_whole() {
    let mut route = Box::new(Route::new());
    let mut x = 0.0;
    let refused = loop {
        x += 0.3;
        if let Err(error) = route.extend_to(Point2::new(x, 0.0)) {
            break error;
        }
    };
    assert_eq!(refused, RouteFull);
    assert_eq!(route.vectors().len(), VECTOR_CAPACITY);
    assert_eq!(route.tip(), *polyline(&route).last().unwrap());
    for _ in 0..SNAPSHOT_CAPACITY {
        route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    }
    assert_eq!(route.push_snapshot(&view(), TOLERANCE_M), Err(RouteFull));
    assert_eq!(route.snapshots().len(), SNAPSHOT_CAPACITY);
}

#[test]
fn a_jump_that_does_not_fit_stores_nothing_of_it() {
    let mut route = Box::new(Route::new());
    route.extend_to(Point2::new(1.0, 1.0)).unwrap();
    for far in [1e6, 1e30, f32::MAX, f32::MIN] {
        assert_eq!(route.extend_to(Point2::new(far, 0.0)), Err(RouteFull));
    }
    assert_eq!(route.vectors().len(), 1);
    assert!((route.tip() - Point2::new(1.0, 1.0)).norm() < 1e-6);
}

#[test]
fn popping_everything_leads_back_to_the_beginning() {
    let mut route = Box::new(Route::new());
    route.begin(Point2::new(5.25, -3.5), SnapshotFormat::Paper);
    for step in 0..20 {
        route
            .extend_to(Point2::new(step as f32, step as f32 * 0.5))
            .unwrap();
    }
    while route.pop_vector().is_some() {}
    assert_eq!(route.tip(), Point2::new(5.25, -3.5));
}

#[test]
fn the_position_of_a_purely_visual_snapshot_is_known_only_at_the_beginning() {
    let mut route = Box::new(Route::new());
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    assert!(route.top_is_visual_only() && route.top_position_is_known());
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    assert!(route.top_is_visual_only() && !route.top_position_is_known());
    route.extend_to(Point2::new(1.0, 0.0)).unwrap();
    route.push_snapshot(&view(), TOLERANCE_M).unwrap();
    assert!(!route.top_is_visual_only() && route.top_position_is_known());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rounding_never_builds_up(walk in walks(300), snapshots in 1_usize..20) {
        let mut route = Box::new(Route::new());
        route.begin(Point2::new(3.217, -1.443), SnapshotFormat::Paper);
        for (index, &at) in walk.iter().enumerate() {
            route.extend_to(at).unwrap();
            prop_assert!((route.tip() - at).norm() <= ROUNDING_M);
            if index % snapshots == 0 {
                route.push_snapshot(&view(), TOLERANCE_M).unwrap();
                prop_assert!((route.tip() - at).norm() <= ROUNDING_M);
                prop_assert!((route.top_snapshot_position().unwrap() - at).norm() <= ROUNDING_M);
                prop_assert!((polyline(&route).last().unwrap() - at).norm() <= ROUNDING_M);
            }
        }
    }

    #[test]
    fn a_simplified_way_deviates_by_at_most_the_tolerance(walk in walks(120)) {
        let mut route = Box::new(Route::new());
        route.begin(Point2::new(3.217, -1.443), SnapshotFormat::Paper);
        for &at in &walk {
            route.extend_to(at).unwrap();
        }
        let stored = polyline(&route);
        route.push_snapshot(&view(), TOLERANCE_M).unwrap();
        let simplified = polyline(&route);
        prop_assert!(simplified.len() <= stored.len());
        if simplified.len() > 1 {
            for &vertex in &stored {
                let deviation = distance_to(&simplified, vertex);
                prop_assert!(deviation <= SIMPLIFY_TOLERANCE_M + 1e-4, "{deviation} m");
            }
        }
    }

    #[test]
    fn heights_grow_along_the_stack(walk in walks(200), every in 1_usize..9) {
        let mut route = Box::new(Route::new());
        for chunk in walk.chunks(every) {
            for &at in chunk {
                route.extend_to(at).unwrap();
            }
            route.push_snapshot(&view(), TOLERANCE_M).unwrap();
            prop_assert!(route.has_snapshot_at_tip());
        }
        let heights: Vec<_> = route.snapshots().iter().map(|stored| stored.height).collect();
        prop_assert!(heights.is_sorted());
        prop_assert_eq!(usize::from(*heights.last().unwrap()), route.vectors().len());
    }
}

#[test]
fn a_route_of_lean_snapshots_takes_ten_bytes_for_each_and_keeps_its_format() {
    let lean = SnapshotFormat::Packed(Packing::Lean);
    let mut route = Box::new(Route::new());
    route.begin(Point2::new(0.0, 0.0), lean);
    let mut count = 0;
    while route.push_snapshot(&view(), TOLERANCE_M).is_ok() {
        count += 1;
    }
    assert_eq!(
        (count, route.snapshots().len()),
        (SNAPSHOT_STACK_BYTES / 10, count)
    );
    assert_eq!(
        (route.bytes(), route.bytes_without_heights()),
        (10 * count, 8 * count)
    );
    route.begin(Point2::new(0.0, 0.0), SnapshotFormat::Paper);
    assert_eq!(route.snapshots().format(), lean);
    let top = route.top_snapshot().expect("a snapshot").view;
    assert_eq!(top, StoredView::quantise(&view(), lean));
    while route.pop_snapshot().is_some() {}
    route.begin(Point2::new(0.0, 0.0), SnapshotFormat::Paper);
    assert_eq!(route.snapshots().format(), SnapshotFormat::Paper);
}

#[test]
fn a_way_that_may_deviate_more_takes_fewer_vectors() {
    let vectors = |tolerance_m| {
        let mut route = Box::new(Route::new());
        for step in 0..60_u8 {
            let x = 0.3 * f32::from(step);
            route
                .extend_to(Point2::new(x, 0.25 * libm::sinf(x)))
                .unwrap();
        }
        route.push_snapshot(&view(), tolerance_m).unwrap();
        route.vectors().len()
    };
    assert!(
        vectors(0.1) > 2 * vectors(0.4),
        "{} {}",
        vectors(0.1),
        vectors(0.4)
    );
}
