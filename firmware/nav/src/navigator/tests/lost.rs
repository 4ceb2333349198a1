//! What becomes of a drone that does not find a snapshot.

use nalgebra::{Point2, Vector2};

use super::*;
use crate::navigator::follower::search::offset;
use crate::navigator::homing_run::is_of_another_place;
use crate::snapshot::StoredView;

const DEFAULT: Parameters = Parameters::DEFAULT;

/// The five legs of the search, 8 spacings in all.
const SEARCH_MS: u32 = (8.0 * DEFAULT.search_spacing_m / DEFAULT.search_speed_m_s * 1e3) as u32;

/// From the expected place to the corner of the search.
const SEARCH_REACH_M: f32 = DEFAULT.search_spacing_m * core::f32::consts::SQRT_2;

/// A view that has nothing in common with [`view`].
fn elsewhere() -> Spectrum {
    Spectrum::from_coefficients(core::array::from_fn(|index| {
        let k = (index + 1) as f32;
        Complex::new(20.0 * libm::sinf(5.1 * k), 20.0 * libm::cosf(3.3 * k * k)) / k
    }))
}

/// Bright ends north and south: the view of a long corridor, which does not tell where along it.
fn corridor() -> Spectrum {
    Spectrum::from_coefficients(core::array::from_fn(|index| {
        Complex::new(if index % 2 == 1 { 20.0 } else { 0.0 }, 0.0)
    }))
}

/// A drone that flies where it is told, and sees.
struct Drone {
    bench: Bench,
    at: Point2<f32>,
    targets: Vec<Point2<f32>>,
}

impl Drone {
    /// After recording along x.
    fn returning(metres: f32) -> Self {
        Self::returning_from(metres, &view())
    }

    /// The same where everything looks like `view`.
    fn returning_from(metres: f32, view: &Spectrum) -> Self {
        let mut bench = Bench::new();
        bench.command(0x03);
        for tenths in 0..=(metres * 10.0) as u16 {
            bench.step(f32::from(tenths) * 0.1, 0.0, Some(view));
        }
        bench.command(0x12);
        Self {
            bench,
            at: Point2::new(metres, 0.0),
            targets: Vec::new(),
        }
    }

    fn fly(&mut self, steps: usize, sees: impl Fn(Point2<f32>) -> Option<Spectrum>) {
        for _ in 0..steps {
            let seen = sees(self.at);
            let step = self.bench.step(self.at.x, self.at.y, seen.as_ref());
            let target = step.vector.unwrap().target;
            self.at += (target - self.at).cap_magnitude(0.1);
            self.targets.push(target);
        }
    }

    fn said(&self, event: Event) -> usize {
        self.bench.count(|said| *said == event)
    }

    fn searches(&self) -> usize {
        self.bench
            .count(|event| matches!(event, Event::SearchStarted { .. }))
    }

    fn realignments(&self) -> usize {
        self.bench
            .count(|event| matches!(event, Event::Realigned { .. }))
    }
}

#[test]
fn the_search_looks_at_all_of_its_square_and_is_over_in_thirteen_seconds() {
    let path: Vec<_> = (0..20_000)
        .step_by(20)
        .map_while(|ms| offset(&DEFAULT, ms))
        .collect();
    assert_eq!(path[0], Vector2::zeros());
    assert!(path.len() as u32 * 20 - SEARCH_MS <= 20);
    for pair in path.windows(2) {
        // 0.25 m/s: no jump.
        assert!((pair[1] - pair[0]).norm() < 0.0051);
    }
    assert!(
        path.iter()
            .all(|place| place.norm() <= SEARCH_REACH_M + 1e-4)
    );
    let half = DEFAULT.search_spacing_m;
    for (x, y) in (-10..=10).flat_map(|x| (-10..=10).map(move |y| (x, y))) {
        let place = Vector2::new(x as f32, y as f32) * (half / 10.0);
        let nearest = path.iter().map(|seen| (seen - place).norm());
        let nearest = nearest.fold(f32::MAX, f32::min);
        // Half a spacing between two legs, and what the square's open end leaves out.
        assert!(nearest <= 0.71 * half, "{place:?}: {nearest} m");
    }
}

#[test]
fn views_of_two_places_are_told_apart_and_the_same_view_is_of_one() {
    let stored = StoredView::quantise(&view(), SnapshotFormat::Paper);
    assert!(is_of_another_place(&DEFAULT, &stored, &elsewhere()));
    assert!(!is_of_another_place(&DEFAULT, &stored, &view()));
    assert!(!is_of_another_place(&DEFAULT, &stored, &dark()));
}

#[test]
fn another_place_is_searched_and_the_next_snapshot_and_then_the_drone_stops() {
    let mut drone = Drone::returning(6.5);
    drone.fly(600, |_| Some(elsewhere()));
    assert_eq!((drone.searches(), drone.said(Event::Lost)), (2, 1));
    assert_eq!(
        (drone.realignments(), drone.said(Event::RouteFinished)),
        (0, 0)
    );
    // Taken at 0, 2, 4 and 6 m. The last is given up, the one before it is not: it may be tried again.
    assert_eq!(drone.bench.snapshots(), 3);
    let held = &drone.targets[500..];
    assert!(held.iter().all(|target| *target == held[0]));
    assert!((held[0] - Point2::new(4.0, 0.0)).norm() < DEFAULT.leash_m);
}

#[test]
fn a_lost_drone_tells_the_autopilot_once_a_second_which_snapshot_it_did_not_find() {
    let mut drone = Drone::returning(4.5);
    drone.fly(500, |_| Some(elsewhere()));
    assert_eq!(drone.said(Event::Lost), 1);
    let maps: Vec<_> = (0..30)
        .filter_map(|_| drone.bench.step(drone.at.x, drone.at.y, None).map)
        .collect();
    assert_eq!(maps.len(), 3);
    assert!(
        maps.iter()
            .all(|map| map.snapshot_index == 1 && map.odometry_index == 1)
    );
}

#[test]
fn a_lost_drone_that_is_told_to_follow_again_tries_the_same_snapshot_again() {
    let mut drone = Drone::returning(4.5);
    drone.fly(500, |_| Some(elsewhere()));
    assert_eq!(drone.said(Event::Lost), 1);
    drone.bench.command(0x00);
    drone.bench.command(0x12);
    drone.fly(400, |_| Some(view()));
    assert_eq!(
        (drone.realignments(), drone.said(Event::RouteFinished)),
        (2, 1)
    );
}

#[test]
fn a_snapshot_that_is_seen_only_beside_its_place_is_found_by_the_search() {
    let mut drone = Drone::returning(2.5);
    // Blotted out up to 0.35 m from where it was taken: there is a view, but no vector.
    let sees = |at: Point2<f32>| {
        let mut coefficients = *view().coefficients();
        if (at - Point2::new(2.0, 0.0)).norm() < 0.35 {
            coefficients[0].re = f32::NAN;
        }
        Some(Spectrum::from_coefficients(coefficients))
    };
    while drone.searches() == 0 {
        drone.fly(1, sees);
    }
    assert_eq!(drone.realignments(), 0);
    drone.fly(300, sees);
    assert_eq!((drone.searches(), drone.said(Event::Lost)), (1, 0));
    assert_eq!(
        (drone.realignments(), drone.said(Event::RouteFinished)),
        (2, 1)
    );
}

#[test]
fn a_view_that_does_not_tell_is_searched_for_but_does_not_stop_the_drone_on_a_short_way() {
    let mut drone = Drone::returning_from(4.5, &corridor());
    drone.fly(900, |_| Some(corridor()));
    assert_eq!((drone.searches(), drone.said(Event::Lost)), (3, 0));
    assert_eq!(drone.said(Event::RouteFinished), 1);
    let beside = |target: &Point2<f32>| target.y.abs();
    let farthest = drone.targets.iter().map(beside).fold(0.0, f32::max);
    assert!((0.3..=0.4).contains(&farthest), "{farthest} m");
}

#[test]
fn darkness_is_not_searched_and_stops_the_drone_only_after_twenty_metres() {
    for blind in [None, Some(dark())] {
        let mut near = Drone::returning(18.5);
        near.fly(1_200, |_| blind);
        assert_eq!((near.searches(), near.said(Event::Lost)), (0, 0));
        assert_eq!(near.said(Event::RouteFinished), 1);
        let mut far = Drone::returning(30.5);
        far.fly(1_200, |_| blind);
        assert_eq!((far.searches(), far.said(Event::Lost)), (0, 1));
        assert_eq!(far.said(Event::RouteFinished), 0);
        // The first snapshot past 20 m from the route's end.
        assert!((7.9..=10.1).contains(&far.at.x), "{} m", far.at.x);
    }
}

#[test]
fn a_sight_of_the_route_begins_the_twenty_metres_anew() {
    let mut drone = Drone::returning(30.5);
    let lit = |at: Point2<f32>| (14.0..16.5).contains(&at.x);
    drone.fly(1_500, |at| Some(if lit(at) { view() } else { dark() }));
    assert_eq!(
        (drone.said(Event::Lost), drone.said(Event::RouteFinished)),
        (0, 1)
    );
}

#[test]
fn a_home_that_looks_like_another_place_is_not_called_home() {
    let mut drone = Drone::returning(2.5);
    drone.fly(600, |at| {
        Some(if at.x > 1.0 { view() } else { elsewhere() })
    });
    assert_eq!(
        (drone.said(Event::Lost), drone.said(Event::RouteFinished)),
        (1, 0)
    );
    assert!(drone.at.coords.norm() < DEFAULT.leash_m);
}

#[test]
fn a_drone_that_cannot_get_to_the_next_point_stops_after_a_minute() {
    let mut bench = Bench::new();
    bench.record(0x03, 4.5);
    bench.command(0x12);
    let lost = |bench: &Bench| bench.count(|event| *event == Event::Lost);
    let mut targets = Vec::new();
    for _ in 0..620 {
        assert!(lost(&bench) == 0 || targets.len() >= 595);
        targets.push(bench.step(5.0, 1.0, Some(&view())).vector.unwrap().target);
    }
    assert_eq!(lost(&bench), 1);
    assert!(targets.iter().all(|target| *target == targets[0]));
}

/// What the drone may see on the way back.
fn sights() -> impl Strategy<Value = Option<Spectrum>> {
    prop_oneof![
        1 => Just(None),
        1 => Just(Some(dark())),
        2 => Just(Some(elsewhere())),
        1 => Just(Some(corridor())),
        2 => Just(Some(view())),
        2 => views(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn whatever_the_drone_sees_it_stays_by_its_route_and_comes_to_an_end(
        corner in (2.0_f32..5.0, -4.0_f32..4.0),
        sights in prop::collection::vec((sights(), 1_usize..80), 1..40),
        obedience in 0.0_f32..1.0,
        gust in (-0.3_f32..0.3, -0.3_f32..0.3),
    ) {
        let mut bench = Bench::new();
        let out = [(0.0, 0.0), (corner.0, 0.0), corner];
        bench.command(0x03);
        for legs in out.windows(2) {
            for part in 0..=50_u16 {
                let share = f32::from(part) / 50.0;
                let along = |from: f32, to: f32| from + (to - from) * share;
                bench.step(along(legs[0].0, legs[1].0), along(legs[0].1, legs[1].1), Some(&view()));
            }
        }
        let route = bench.navigator.route();
        let mut points = std::vec![route.tip()];
        let mut rest = route.clone();
        while rest.pop_vector().is_some() {
            points.push(rest.tip());
        }
        // To each point a minute, and at each snapshot homing twice, a search, and a second for the
        // realignment before.
        let at_snapshot_ms = 2 * DEFAULT.final_homing_time_ms + SEARCH_MS + 2_000;
        let longest_ms = DEFAULT.leg_time_ms * points.len() as u32
            + at_snapshot_ms * route.snapshots().len() as u32;
        bench.command(0x12);
        let mut at = Point2::new(corner.0, corner.1);
        let mut seen = sights.iter().flat_map(|(sight, steps)| std::iter::repeat_n(sight, *steps)).cycle();
        let ended = |event: &Event| matches!(event, Event::Lost | Event::RouteFinished);
        for _ in 0..longest_ms / PERIOD_MS {
            let sight = seen.next().and_then(Option::as_ref);
            let target = bench.step(at.x, at.y, sight).vector.unwrap().target;
            at += (target - at).cap_magnitude(0.1) * obedience + Vector2::new(gust.0, gust.1) * 0.1;
            let away = points.iter().map(|point| (target - point).norm()).fold(f32::MAX, f32::min);
            prop_assert!(away <= DEFAULT.leash_m + SEARCH_REACH_M, "{away} m");
            if bench.count(ended) > 0 {
                break;
            }
        }
        prop_assert_eq!(bench.count(ended), 1);
        let held = bench.step(at.x, at.y, None).vector.unwrap().target;
        for _ in 0..50 {
            prop_assert_eq!(bench.step(9.0, 9.0, Some(&elsewhere())).vector.unwrap().target, held);
        }
    }
}
