//! Whole flights of the firmware's logic, compiled for this machine.

use std::sync::OnceLock;

use hil::flight::{Flown, fly_native};
use hil::record::{Phase, PlanarPose, TrackPoint, What};
use hil::scenario::{Conditions, Homing, Route, Scenario, Spacing, Storage, flow_scale};
use tests::Budgets;

fn scenario(route: Route, homing: Homing, seed: u64) -> Scenario {
    let spacing = Spacing::from_metres(2.0).expect("a spacing");
    Scenario {
        route,
        world: "arena-panels".to_owned(),
        seed,
        spacing,
        storage: Storage::PAPER,
        homing,
        conditions: Conditions::default(),
    }
}

fn fly(scenario: &Scenario) -> Flown {
    fly_native(scenario, &mut |_| ()).expect("a flight")
}

/// The default flight, for all tests that look at it.
fn u_route() -> &'static Flown {
    static FLOWN: OnceLock<Flown> = OnceLock::new();
    FLOWN.get_or_init(|| fly(&scenario(Route::U, Homing::Both, 1)))
}

#[test]
fn the_u_route_is_followed_home_and_odometry_alone_gets_lost() {
    let budgets = Budgets::load();
    let with = &u_route().summary;
    let without = fly(&scenario(Route::U, Homing::Odometry, 1)).summary;
    assert!(with.completed, "{}", with.outcome);
    assert!(without.completed, "{}", without.outcome);
    budgets.hold("home_error_m", with.home_error_m);
    budgets.hold("bytes_per_m", with.bytes_per_m);
    budgets.hold("frames_dropped", with.frames_dropped as f64);
    budgets.hold(
        "improvement_over_odometry",
        without.home_error_m / with.home_error_m,
    );
}

#[test]
fn the_u_route_is_56_m_long_and_stored_in_snapshots_two_metres_apart() {
    let Flown { summary, recording } = u_route();
    assert!(recording.odometry.len() <= usize::from(recording.odometry_stored));
    // The true path is a little longer than the way points': the drone swings.
    assert!(
        (56.0..62.0).contains(&summary.outbound_m),
        "{} m",
        summary.outbound_m
    );
    assert!(
        (27..=31).contains(&summary.snapshots),
        "{}",
        summary.snapshots
    );
    let bytes = 18 * recording.snapshots.len() + 2 * usize::from(recording.odometry_stored);
    assert_eq!(summary.memory_bytes, bytes);
}

#[test]
fn at_each_snapshot_the_filter_is_told_that_it_is_right_on_the_way_out_and_where_it_is_on_the_way_back()
 {
    let Flown { summary, recording } = u_route();
    let corrections = recording.deeds.iter().filter_map(|deed| match deed.what {
        What::Correct { shift_m, turn_rad } => Some((shift_m, turn_rad)),
        _ => None,
    });
    let (right, wrong): (Vec<_>, Vec<_>) =
        corrections.partition(|correction| *correction == ([0.0; 2], 0.0));
    assert_eq!(right.len(), summary.snapshots);
    assert_eq!(wrong.len(), recording.corrections.len());
    // Only those that move the estimate are marks in the recording, and those come on the way back.
    let led = (recording.track.iter()).find(|point| point.phase == Phase::Odometry);
    let led_s = led.expect("a way back").t;
    assert!(wrong.len() > 20);
    assert!(recording.corrections.iter().all(|mark| mark.t > led_s));
}

#[test]
fn the_way_out_ends_where_the_way_back_begins() {
    let Flown { summary, recording } = fly(&scenario(Route::Line, Homing::Both, 1));
    // A way out of 5 m that ended at home would be 10 m long.
    assert!(
        (4.5..6.0).contains(&summary.outbound_m),
        "{}",
        summary.outbound_m
    );
    let stages = recording.track.chunk_by(|a, b| a.phase == b.phase);
    let outbound = stages.filter(|stage| stage[0].phase == Phase::Outbound);
    assert_eq!(outbound.count(), 1);
}

#[test]
fn odometry_with_a_swinging_scale_strays_and_a_pilot_leads_along_the_route_all_the_same() {
    let beside_the_turn_m = |conditions| {
        let flown = fly(&Scenario {
            conditions,
            ..scenario(Route::Line, Homing::Both, 1)
        });
        let outbound = |point: &&TrackPoint| point.phase == Phase::Outbound;
        let last = flown.recording.track.iter().rfind(outbound);
        let turn = PlanarPose {
            x: -5.0,
            ..PlanarPose::default()
        };
        last.expect("a way out").truth.distance(&turn)
    };
    let steady = Conditions::default();
    let swinging = Conditions {
        flow_scale: flow_scale(0.4, 40.0),
        ..steady
    };
    let piloted = Conditions {
        piloted: true,
        ..swinging
    };
    // The drift's root mean square after 5 m is 0.3 m; a fifth to two fifths of 5 m come on top.
    let [steady_m, swinging_m, piloted_m] = [steady, swinging, piloted].map(beside_the_turn_m);
    assert!(
        steady_m < 0.9 && swinging_m > 1.0,
        "{steady_m} {swinging_m}"
    );
    // A hover wanders by centimetres.
    assert!(piloted_m < 0.15, "{piloted_m}");
}

#[test]
fn a_sequence_is_stored_at_its_own_spacing_and_without_odometry() {
    let Flown { summary, recording } = fly(&scenario(Route::Line, Homing::Sequence, 1));
    assert!(summary.completed, "{}", summary.outcome);
    assert_eq!(summary.spacing_m, 0.25);
    assert_eq!(recording.odometry_stored, 0);
    // 5 m of odometry, 0.25 m apart.
    assert!(
        (18..=21).contains(&summary.snapshots),
        "{}",
        summary.snapshots
    );
}

#[test]
fn the_same_seed_is_the_same_flight_and_another_seed_another() {
    let flight = |seed| {
        let mut flown = fly(&scenario(Route::Corner, Homing::Both, seed));
        flown.summary.wall_s = 0.0;
        flown.summary.realtime_factor = 0.0;
        let json = |value| serde_json::to_string(&value).expect("JSON");
        let summary = json(serde_json::to_value(&flown.summary).expect("JSON"));
        (
            summary,
            json(serde_json::to_value(&flown.recording).expect("JSON")),
        )
    };
    let first = flight(1);
    assert_eq!(first, flight(1));
    assert_ne!(first.1, flight(2).1);
}

#[test]
fn snapshots_are_as_far_apart_as_the_command_says() {
    let snapshots = |metres| {
        let spacing = Spacing::from_metres(metres).expect("a spacing");
        fly(&Scenario {
            spacing,
            ..scenario(Route::Line, Homing::Both, 1)
        })
        .summary
        .snapshots
    };
    // At 0, 1.1, 2.2, 3.3, 4.4 m and at 0, 2.2, 4.4 m of a leg of 5 m, give or take some centimetres.
    assert_eq!((snapshots(1.1), snapshots(2.2)), (5, 3));
}

#[test]
fn a_visual_sequence_leads_home_without_odometry() {
    let summary = fly(&scenario(Route::Line, Homing::Sequence, 1)).summary;
    assert!(summary.completed, "{}", summary.outcome);
    Budgets::load().hold("home_error_m", summary.home_error_m);
    assert_eq!(summary.memory_bytes, 18 * summary.snapshots);
}

#[test]
fn the_horizon_is_exposed_to_80_of_255() {
    let flown = fly(&scenario(Route::Line, Homing::Both, 1));
    // The first second is the exposure's, on the ground.
    let late = flown.recording.frames.iter().filter(|frame| frame.t > 1.0);
    let lumas: Vec<f32> = late.map(|frame| frame.luma).collect();
    let mean = lumas.iter().sum::<f32>() / lumas.len() as f32;
    assert!((mean - 80.0).abs() < 3.0, "mean luma {mean}");
}
