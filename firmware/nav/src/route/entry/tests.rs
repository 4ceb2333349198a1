extern crate std;

use std::boxed::Box;
use std::vec::Vec;

use nalgebra::Vector2;
use proptest::prelude::*;

use super::*;
use crate::route::SIMPLIFY_TOLERANCE_M;
use crate::snapshot::SnapshotFormat;
use crate::spectrum::{Spectrum, VIEW_FREQUENCIES};

/// What a metre of odometry is off by.
const DRIFT: f32 = 0.05;

/// Half a count along both axes.
const ROUNDING_M: f32 = 0.0708;

/// A route through these places from the first on, with a snapshot at each.
fn route(places: &[(f32, f32)]) -> Box<Route> {
    let mut route = Box::new(Route::new());
    let start = Point2::new(places[0].0, places[0].1);
    route.begin(start, SnapshotFormat::Paper);
    let view = Spectrum::from_coefficients([nalgebra::Complex::new(3.0, 1.0); VIEW_FREQUENCIES]);
    for &(x, y) in places {
        route.extend_to(Point2::new(x, y)).unwrap();
        route.push_snapshot(&view, SIMPLIFY_TOLERANCE_M).unwrap();
    }
    route
}

/// The same, cut where a drone enters that is here; how far away that is.
fn entered(places: &[(f32, f32)], (x, y): (f32, f32)) -> (Box<Route>, f32) {
    let mut route = route(places);
    let entry = route.entry(Point2::new(x, y), DRIFT);
    route.cut(&entry);
    (route, entry.distance_m)
}

fn is_near(tip: Point2<f32>, (x, y): (f32, f32)) -> bool {
    (tip - Point2::new(x, y)).norm() <= ROUNDING_M
}

fn heights(route: &Route) -> Vec<u16> {
    route
        .snapshots()
        .iter()
        .map(|stored| stored.height)
        .collect()
}

#[test]
fn beside_the_way_the_rest_of_it_begins_at_the_nearest_point_of_a_vector() {
    let corner = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0)];
    for (here, tip, expected) in [
        ((2.5, 0.4), (2.5, 0.0), &[0][..]),
        ((5.7, 2.0), (6.0, 2.0), &[0, 1]),
        ((6.2, -0.3), (6.0, 0.0), &[0, 1]),
        ((7.0, 5.0), (6.0, 4.0), &[0, 1, 2]),
        ((-1.0, -1.0), (0.0, 0.0), &[0]),
    ] {
        let (route, distance_m) = entered(&corner, here);
        let away = Vector2::new(here.0 - tip.0, here.1 - tip.1).norm();
        assert!(is_near(route.tip(), tip), "{here:?}: {:?}", route.tip());
        assert!((distance_m - away).abs() < 0.02, "{here:?}: {distance_m}");
        assert_eq!(heights(&route), expected, "{here:?}");
    }
}

#[test]
fn on_a_way_to_and_fro_the_last_pass_counts_however_near_the_first() {
    // Off by 0.2 m after each 10 m.
    let (route, _) = entered(&[(0.0, 0.0), (10.0, 0.1), (0.0, 0.3)], (4.0, 0.0));
    assert!(is_near(route.tip(), (4.0, 0.22)), "{:?}", route.tip());
    assert_eq!(heights(&route), [0, 1]);
}

#[test]
fn where_the_way_crosses_itself_the_loop_is_flown_once_more() {
    let crossed = [(0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 4.0), (4.0, -4.0)];
    let (route, _) = entered(&crossed, (4.05, 0.0));
    assert!(is_near(route.tip(), (4.0, 0.0)));
    assert_eq!(route.vectors().len(), 4);
}

#[test]
fn an_old_part_of_the_way_is_entered_where_no_newer_one_is_near() {
    let (route, _) = entered(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)], (3.0, 0.5));
    assert!(is_near(route.tip(), (3.0, 0.0)));
    assert_eq!(route.vectors().len(), 1);
}

#[test]
fn a_drone_on_its_way_to_the_end_of_the_route_loses_nothing_of_it() {
    let mut route = route(&[(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)]);
    route.pop_snapshot();
    route.pop_vector();
    for x in [0.5, 5.0, 9.5] {
        let entry = route.entry(Point2::new(x, 0.1), DRIFT);
        assert!((entry.distance_m - 0.1).abs() < 1e-3);
        route.cut(&entry);
        assert!(is_near(route.tip(), (10.0, 0.0)), "{x}");
        assert_eq!(heights(&route), [0, 1]);
    }
    // Recorded on from there, the way is another.
    route.extend_to(Point2::new(10.0, 5.0)).unwrap();
    assert!((route.entry(Point2::new(5.0, 5.0), DRIFT).distance_m - 5.0).abs() < 1e-3);
    let entry = route.entry(Point2::new(5.0, 0.1), DRIFT);
    route.cut(&entry);
    assert!(is_near(route.tip(), (5.0, 0.0)));
}

fn walks() -> impl Strategy<Value = Vec<(f32, f32)>> {
    prop::collection::vec((-9.0_f32..9.0, -9.0_f32..9.0), 2..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn what_is_left_is_the_lower_part_of_the_route_up_to_the_point_that_was_found(
        places in walks(),
        here in (-12.0_f32..12.0, -12.0_f32..12.0),
    ) {
        let whole = route(&places);
        let (left, distance_m) = entered(&places, here);
        prop_assert!(left.vectors().len() <= whole.vectors().len());
        let same = left.vectors().len().saturating_sub(1);
        prop_assert_eq!(&left.vectors()[..same], &whole.vectors()[..same]);
        prop_assert!(whole.snapshots().bytes().starts_with(left.snapshots().bytes()));
        let tops = heights(&left);
        prop_assert!(tops.iter().all(|&top| usize::from(top) <= left.vectors().len()));
        let away = (left.tip() - Point2::new(here.0, here.1)).norm();
        prop_assert!((away - distance_m).abs() <= ROUNDING_M + 1e-3, "{away}, {distance_m}");
        // Every snapshot is where it was.
        let (mut left, mut whole) = (left, whole);
        while left.snapshots().len() < whole.snapshots().len() {
            whole.pop_snapshot();
        }
        while let (Some(a), Some(b)) = (left.top_snapshot_position(), whole.top_snapshot_position()) {
            prop_assert!((a - b).norm() < 1e-4);
            left.pop_snapshot();
            whole.pop_snapshot();
        }
    }

    #[test]
    fn no_point_of_the_way_is_nearer_by_more_than_the_drift_up_to_there(
        places in walks(),
        here in (-12.0_f32..12.0, -12.0_f32..12.0),
    ) {
        let here = Point2::new(here.0, here.1);
        let mut route = route(&places);
        let found = route.entry(here, DRIFT);
        // Down the way in steps of a fifth of each vector.
        let (mut end, mut way_m) = (route.tip(), 0.0);
        while let Some(vector) = route.pop_vector() {
            let vector = vector.metres();
            way_m += vector.norm();
            for fifth in 0..=5_u8 {
                let away = (end - vector * (f32::from(fifth) / 5.0) - here).norm();
                prop_assert!(found.distance_m <= away + DRIFT * way_m + 1e-3, "{found:?}");
            }
            end -= vector;
        }
    }
}
