//! What a camera does when the autopilot suddenly counts from another origin.

#[path = "../conversation/bench.rs"]
mod bench;

use bench::{Bench, patches, uniform};
use link::{Message, Mode, Record, State};
use pilot::{Event, Frame, REACH_M};
use proptest::prelude::*;

const ROUTE: u8 = Mode::Record(Record::ROUTE).byte();
const FOLLOW: u8 = Mode::Follow.byte();
const IDLE: u8 = Mode::Idle.byte();
const CLEAR: u8 = Mode::Clear.byte();

/// A restart: boot, the operator's way to the button, take-off.
const RESTART_MS: u32 = 9_000;

/// Metres in a STATE period at 1 m/s.
const STEP_M: f32 = 0.1;

/// A drone on a line to the north, in a world that looks the same everywhere.
struct Flight {
    bench: Bench,
    frame: Frame,
    /// Metres north of the start of the route.
    north: f32,
    /// Where the autopilot's origin is, metres north of the start of the route.
    origin: f32,
    events: Vec<Event>,
    /// The farthest that a target was from the autopilot's own position, metres.
    farthest: f32,
}

impl Flight {
    /// Has recorded `metres` to the north, with a snapshot every half metre, and still records.
    fn out(metres: f32) -> Self {
        let mut flight = Self {
            bench: Bench::new(),
            frame: patches(),
            north: 0.0,
            origin: 0.0,
            events: vec![],
            farthest: 0.0,
        };
        flight.bench.command(ROUTE, &[5]);
        while flight.north < metres {
            flight.state();
            flight.north += STEP_M;
        }
        flight
    }

    /// One period at a standstill: the target north of the start of the route, if there is one.
    fn state(&mut self) -> Option<f32> {
        self.bench.see(&self.frame);
        let north = self.north - self.origin;
        let answer = self.bench.state(north, 0.0, 0.0);
        self.events.extend(&self.bench.events);
        let vector = answer.iter().find_map(|message| match message {
            Message::Vector(vector) => Some(vector),
            _ => None,
        })?;
        self.farthest = self.farthest.max((vector.target_n - north).abs());
        Some(vector.target_n + self.origin)
    }

    /// Flies where the camera leads, for as long.
    fn follow(&mut self, periods: usize) {
        for _ in 0..periods {
            if let Some(target) = self.state() {
                self.north += (target - self.north).clamp(-STEP_M, STEP_M);
            }
        }
    }

    /// The autopilot is away for `ms`, and counts from here afterwards.
    fn new_origin(&mut self, ms: u32) {
        self.bench.wait(ms);
        self.origin = self.north;
    }

    fn count(&self, event: Event) -> usize {
        self.events.iter().filter(|other| **other == event).count()
    }
}

#[test]
fn after_a_restart_where_the_drone_fell_the_way_back_goes_on_in_the_new_coordinates() {
    let mut flight = Flight::out(3.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(40);
    assert!((0.5..2.5).contains(&flight.north), "in mid-route");
    flight.new_origin(RESTART_MS);
    assert_eq!(flight.state(), None, "a single pose may be a broken one");
    flight.follow(400);
    assert_eq!(flight.count(Event::NewOrigin), 1);
    assert_eq!(flight.count(Event::RouteFinished), 1);
    assert!(flight.north.abs() < 0.2, "home: {}", flight.north);
    assert!(flight.farthest < 1.0, "target {} m away", flight.farthest);
}

#[test]
fn after_a_restart_while_recording_the_route_leads_home_from_where_the_drone_fell() {
    let mut flight = Flight::out(3.0);
    flight.new_origin(RESTART_MS);
    flight.state();
    flight.bench.command(FOLLOW, &[]);
    flight.follow(500);
    assert_eq!(flight.count(Event::NewOrigin), 1);
    assert!(flight.north.abs() < 0.2, "home: {}", flight.north);
    assert!(flight.farthest < 1.0, "target {} m away", flight.farthest);
}

#[test]
fn a_filter_that_resets_itself_in_the_air_is_found_out_within_two_periods() {
    let mut flight = Flight::out(3.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(3);
    flight.new_origin(0);
    assert_eq!(flight.state(), None);
    assert!(flight.state().is_some());
    assert_eq!(flight.count(Event::NewOrigin), 1);
    flight.follow(500);
    assert!(flight.north.abs() < 0.2, "home: {}", flight.north);
    assert!(flight.farthest < 1.0, "target {} m away", flight.farthest);
}

/// A flight that followed its route until the drone was carried to where it looks different.
fn carried(frame: Frame) -> Flight {
    let mut flight = Flight::out(3.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(10);
    flight.new_origin(RESTART_MS);
    flight.frame = frame;
    flight.follow(50);
    flight
}

#[test]
fn a_drone_that_may_have_been_carried_stays_where_it_is() {
    for frame in [elsewhere(), uniform(0)] {
        let mut flight = carried(frame);
        assert_eq!(flight.count(Event::Lost), 1, "said once");
        assert_eq!(flight.north, flight.origin);
        // The restarted app asks for the mode that holds already.
        flight.bench.command(FOLLOW, &[]);
        flight.follow(50);
        assert_eq!(flight.north, flight.origin);
        assert_eq!(flight.count(Event::NewOrigin), 0);
    }
}

#[test]
fn a_lost_drone_looks_round_again_when_a_new_mode_is_asked_for() {
    let mut flight = carried(elsewhere());
    flight.bench.command(IDLE, &[]);
    flight.follow(1);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(20);
    assert_eq!(flight.north, flight.origin, "it still looks different");
    flight.bench.command(IDLE, &[]);
    flight.frame = patches();
    flight.follow(1);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(500);
    assert_eq!(flight.count(Event::NewOrigin), 1);
    assert_eq!(flight.count(Event::RouteFinished), 1);
}

#[test]
fn a_lost_drone_that_is_told_to_forget_the_route_records_a_new_one() {
    let mut flight = carried(elsewhere());
    flight.bench.command(CLEAR, &[]);
    flight.follow(2);
    flight.bench.command(ROUTE, &[5]);
    flight.follow(2);
    let route = flight.bench.pilot.navigator().route();
    assert_eq!(route.snapshots().len(), 1);
    assert_eq!(route.tip().x, 0.0, "in the new coordinates");
}

#[test]
fn while_lost_nothing_is_recorded() {
    let mut flight = Flight::out(3.0);
    let stored = flight.bench.pilot.navigator().route().bytes();
    flight.new_origin(RESTART_MS);
    flight.frame = elsewhere();
    for _ in 0..30 {
        assert_eq!(flight.state(), None);
        flight.north += STEP_M;
    }
    assert_eq!(flight.count(Event::Lost), 1);
    assert_eq!(flight.bench.pilot.navigator().route().bytes(), stored);
}

#[test]
fn a_single_broken_pose_is_not_answered_and_changes_nothing() {
    let way_back = |broken: bool| {
        let mut flight = Flight::out(2.0);
        flight.bench.command(FOLLOW, &[]);
        flight.follow(5);
        if broken {
            flight.bench.see(&flight.frame);
            assert_eq!(flight.bench.state(700.0, -3.0, 0.1), []);
            assert_eq!(flight.bench.events, [Event::PoseDoubtful]);
        } else {
            flight.bench.wait(100);
        }
        let targets: Vec<_> = (0..50).map(|_| flight.state()).collect();
        targets
    };
    assert_eq!(way_back(true), way_back(false));
}

#[test]
fn poses_that_never_agree_stop_the_drone() {
    let mut flight = Flight::out(2.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(2);
    for jump in 1..=15_u8 {
        flight.north = 20.0 + 20.0 * f32::from(jump);
        flight.state();
    }
    assert_eq!(flight.count(Event::PoseDoubtful), 1);
    assert_eq!(flight.count(Event::Lost), 1);
    assert!(flight.farthest < 0.5);
}

#[test]
fn when_the_link_was_away_in_the_air_the_flight_goes_on() {
    let mut flight = Flight::out(3.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(2);
    // It has flown on to its last target meanwhile.
    flight.north -= 0.4;
    flight.bench.wait(5_000);
    flight.follow(500);
    assert_eq!(
        flight.count(Event::NewOrigin) + flight.count(Event::Lost),
        0
    );
    assert!(flight.north.abs() < 0.2, "home: {}", flight.north);
}

#[test]
fn a_route_that_is_farther_away_than_any_vector_is_not_flown_to() {
    let mut flight = Flight::out(1.0);
    flight.bench.command(IDLE, &[]);
    while flight.north < 25.0 {
        flight.state();
        flight.north += STEP_M;
    }
    flight.bench.command(FOLLOW, &[]);
    flight.follow(20);
    assert_eq!(flight.count(Event::Lost), 1);
    assert!(flight.farthest < 0.1, "it stays");
}

#[test]
fn without_a_route_any_take_off_will_do() {
    let mut bench = Bench::new();
    for origin in [0.0, 30.0, -200.0] {
        bench.see(&patches());
        bench.state(origin, 0.0, 0.0);
        assert_eq!(bench.events, []);
        bench.wait(RESTART_MS);
    }
}

#[test]
fn a_drone_that_is_home_says_so_every_second() {
    let mut flight = Flight::out(1.0);
    flight.bench.command(FOLLOW, &[]);
    flight.follow(300);
    assert_eq!(flight.count(Event::RouteFinished), 1);
    let mut maps = 0;
    for _ in 0..100 {
        let answer = flight.bench.state(flight.north, 0.0, 0.0);
        maps += answer
            .iter()
            .filter(|message| matches!(message, Message::Map(map) if map.snapshot_index == 0))
            .count();
    }
    assert!((9..=11).contains(&maps), "{maps} in ten seconds");
}

/// The patches in another order.
fn elsewhere() -> Frame {
    let mut frame = patches();
    for pixel in frame.chunks_exact_mut(2) {
        pixel[1] = pixel[1].wrapping_mul(37).rotate_left(3);
    }
    frame
}

/// What an autopilot may do to a camera in a period.
#[derive(Clone, Debug)]
enum Turn {
    Command(u8),
    Silence(u32),
    NewOrigin,
    Pose(f32, f32, f32),
    Fly(f32, f32),
}

fn turns() -> impl Strategy<Value = Turn> {
    const MODES: &[u8] = &[
        0x00, 0x0F, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12, 0x33_u8,
    ];
    let far = || prop_oneof![3 => -20.0_f32..20.0, 1 => -999.0_f32..999.0];
    prop_oneof![
        1 => prop::sample::select(MODES).prop_map(Turn::Command),
        1 => (0_u32..20_000).prop_map(Turn::Silence),
        1 => Just(Turn::NewOrigin),
        1 => (far(), far(), -4.0_f32..4.0).prop_map(|(n, e, psi)| Turn::Pose(n, e, psi)),
        12 => (-0.2_f32..0.2, -0.2_f32..0.2).prop_map(|(n, e)| Turn::Fly(n, e)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whatever_poses_come_no_target_is_farther_away_than_a_vector_and_homing_reach(
        turns in prop::collection::vec((turns(), any::<bool>()), 1..300),
    ) {
        let mut bench = Bench::new();
        bench.command(ROUTE, &[10]);
        let (mut north, mut east, mut psi) = (0.0, 0.0, 0.0);
        for (turn, sees_patches) in turns {
            match turn {
                Turn::Command(mode) => drop(bench.command(mode, &[])),
                Turn::Silence(ms) => bench.wait(ms),
                Turn::NewOrigin => (north, east, psi) = (0.0, 0.0, 0.0),
                Turn::Pose(n, e, turned) => (north, east, psi) = (n, e, turned),
                Turn::Fly(n, e) => (north, east) = (north + n, east + e),
            }
            bench.see(&if sees_patches { patches() } else { elsewhere() });
            let state = State { ins_n: north, ins_e: east, psi, ..State::default() };
            bench.wait(100);
            for message in bench.hear(&Message::State(state)) {
                if let Message::Vector(vector) = message {
                    let (n, e) = (vector.target_n - north, vector.target_e - east);
                    prop_assert!(n.hypot(e) <= REACH_M + 1e-3, "{vector:?} at {north} {east}");
                }
            }
        }
    }
}
