//! Routes that are begun anew, entered half-way, or longer than the memory.

use super::*;

/// A corner of 9 m.
const CORNER: [(f32, f32); 2] = [(5.0, 0.0), (5.0, 4.0)];

/// Lets the navigator lead for so many seconds.
fn led_for(flight: &mut Flight, seconds: usize) {
    flight.command(FOLLOW);
    (0..10 * seconds).for_each(|_| flight.period(None));
    assert!(!flight.navigator.route().is_empty());
}

/// The way that is stored, metres.
fn stored_m(flight: &Flight) -> f32 {
    let vectors = flight.navigator.route().vectors();
    vectors.iter().map(|vector| vector.metres().norm()).sum()
}

#[test]
fn after_a_way_back_that_was_stopped_another_way_is_recorded_from_there_and_both_lead_home() {
    for seed in SEEDS {
        let mut flight = Flight::new(seed);
        flight.command(BOTH);
        flight.fly_out(CORNER);
        led_for(&mut flight, 10);
        flight.command(IDLE);
        let stopped = flight.drone.estimate.position;
        let (left_m, snapshots) = (
            stored_m(&flight),
            flight.navigator.route().snapshots().len(),
        );
        assert!(left_m < 7.5, "{left_m} m are left of 9 m");
        flight.command(BOTH);
        flight.period(Some(stopped));
        let route = flight.navigator.route();
        assert!((route.tip() - stopped).norm() < 0.3);
        assert_eq!(
            route.snapshots().len(),
            snapshots + 1,
            "one where recording begins"
        );
        flight.fly_out([(6.5, 1.0), (6.5, -2.0)]);
        let way_m = stored_m(&flight) - left_m;
        assert!((3.5..9.0).contains(&way_m), "{way_m}");
        flight.command(FOLLOW);
        flight.fly_home();
        assert!(flight.home_error() < 0.5, "{seed}: {}", flight.home_error());
        assert!(flight.navigator.route().is_empty());
    }
}

#[test]
fn a_recording_after_the_way_home_is_a_route_of_its_own() {
    let mut flight = Flight::new(3);
    flight.command(BOTH);
    flight.fly_out([(2.0, 0.0)]);
    flight.command(FOLLOW);
    flight.fly_home();
    flight.command(IDLE);
    flight.fly_out([(0.0, 3.0)]);
    flight.events.clear();
    flight.command(BOTH);
    flight.fly_out([(3.0, 3.0)]);
    flight.command(FOLLOW);
    flight.fly_home();
    let from_its_beginning = (flight.drone.position - Point2::new(0.0, 3.0)).norm();
    assert!(from_its_beginning < 0.5, "{from_its_beginning}");
}

#[test]
fn a_drone_that_was_flown_half_way_back_by_hand_is_led_home_from_there() {
    for seed in SEEDS {
        let mut flight = Flight::new(seed);
        flight.command(BOTH);
        flight.fly_out(CORNER);
        flight.command(IDLE);
        flight.fly_out([(5.5, 0.5), (4.0, 0.7)]);
        flight.command(FOLLOW);
        flight.period(None);
        assert!(stored_m(&flight) < 4.5);
        flight.fly_home();
        assert!(flight.home_error() < 0.5, "{seed}: {}", flight.home_error());
        // The snapshots at 4, 2 and 0 m, and not those beyond.
        let homings = flight.events_of(|event| matches!(event, Event::HomingStarted { .. }));
        assert!((2..=3).contains(&homings), "{homings}");
    }
}

#[test]
fn a_way_of_more_than_five_hundred_snapshots_is_followed_home_by_every_second() {
    let mut flight = Flight::new(2);
    flight.navigator.set_snapshot_spacing(0.3);
    flight.command(BOTH);
    flight.fly_out(u_route().chain(u_route()).chain(u_route()).chain(u_route()));
    let thinned = flight.events_of(|event| matches!(event, Event::ThinnedOut { .. }));
    let full = flight.events_of(|event| matches!(event, Event::SnapshotsFull | Event::RouteFull));
    assert_eq!((thinned, full), (1, 0));
    let snapshots = flight.navigator.route().snapshots().len();
    // 512 on the first 154 m, then 0.6 m apart on all of the 224 m.
    assert!((256..512).contains(&snapshots), "{snapshots}");
    flight.command(FOLLOW);
    flight.fly_home_within(20_000);
    assert!(flight.home_error() < 0.5, "{}", flight.home_error());
    assert!(flight.navigator.route().is_empty());
}
