//! Whole flights of the navigator in a kinematic simulation: out along a route, back by its memory.

mod drone;
mod random;
mod routes;
mod world;

use drone::Drone;
use nalgebra::Point2;
use nav::{Event, Navigator, Parameters, Spectrum};
use world::Room;

/// The paper's U, four times 14 m: out, back, out and back, so that 56 m are flown before the turn.
const U: [(f32, f32); 4] = [(0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0)];
const PASSES: usize = 4;
const SEEDS: [u64; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

const IDLE: u8 = 0x00;
const ODOMETRY: u8 = 0x02;
const BOTH: u8 = 0x03;
const SEQUENCE: u8 = 0x05;
const SINGLE: u8 = 0x01;
const STAY: u8 = 0x11;
const FOLLOW: u8 = 0x12;

struct Flight {
    room: Room,
    drone: Drone,
    navigator: Navigator,
    events: Vec<Event>,
    /// The camera is covered.
    dark: bool,
}

impl Flight {
    fn new(seed: u64) -> Self {
        Self {
            room: Room::new(seed, Point2::new(-2.5, -3.0)),
            drone: Drone::new(seed, Point2::origin()),
            navigator: Navigator::new(Parameters::DEFAULT),
            events: Vec::new(),
            dark: false,
        }
    }

    fn command(&mut self, byte: u8) {
        self.navigator.command(byte).expect("a command of the app");
    }

    /// One period: STATE to the navigator, its set-point and correction to the autopilot. Where there is
    /// a script, it leads instead.
    fn period(&mut self, script: Option<Point2<f32>>) {
        let view = if self.dark {
            Spectrum::from_coefficients(Default::default())
        } else {
            self.drone.view(&self.room)
        };
        let step = self
            .navigator
            .step(self.drone.now_ms, &self.drone.estimate, Some(&view));
        self.events.extend(step.events.iter().copied());
        let target = step.vector.map(|vector| vector.target);
        self.drone.fly(script.or(target));
        if let Some(correction) = step.correction {
            self.drone.correct(&correction);
        }
    }

    fn fly_out(&mut self, way: impl IntoIterator<Item = (f32, f32)>) {
        for (x, y) in way {
            let target = Point2::new(x, y);
            while (self.drone.estimate.position - target).norm() > 0.1 {
                self.period(Some(target));
            }
        }
    }

    /// Lets the navigator lead until it has finished; panics if it does not within ten minutes.
    fn fly_home(&mut self) {
        self.fly_home_within(6_000);
    }

    /// The same within so many periods.
    fn fly_home_within(&mut self, periods: usize) {
        for _ in 0..periods {
            self.period(None);
            if self.events.contains(&Event::RouteFinished) {
                return (0..20).for_each(|_| self.period(None));
            }
        }
        panic!("never came home: {:?}", self.events.last());
    }

    fn events_of(&self, kind: impl Fn(&Event) -> bool) -> usize {
        self.events.iter().filter(|event| kind(event)).count()
    }

    fn corrections(&self) -> usize {
        self.events_of(|event| matches!(event, Event::Realigned { .. }))
    }

    fn home_error(&self) -> f32 {
        self.drone.position.coords.norm()
    }
}

fn u_route() -> impl Iterator<Item = (f32, f32)> {
    (0..PASSES).flat_map(|pass| {
        let mut way = U;
        if pass % 2 == 1 {
            way.reverse();
        }
        way
    })
}

fn out_and_back(seed: u64, recording: u8) -> Flight {
    let mut flight = Flight::new(seed);
    flight.command(recording);
    flight.fly_out(u_route());
    flight.command(FOLLOW);
    flight.fly_home();
    flight
}

#[test]
fn with_snapshots_every_flight_of_56_m_comes_home_within_half_a_metre() {
    for seed in SEEDS {
        let flight = out_and_back(seed, BOTH);
        println!(
            "seed {seed}: {:.2} m in {} s",
            flight.home_error(),
            flight.drone.now_ms / 1000
        );
        assert!(flight.home_error() < 0.5, "seed {seed}");
        assert!(flight.navigator.route().is_empty());
    }
}

#[test]
fn by_odometry_alone_most_flights_do_not() {
    let lost = SEEDS
        .iter()
        .map(|&seed| out_and_back(seed, ODOMETRY).home_error())
        .inspect(|error| println!("{error:.2} m"))
        .filter(|&error| error > 0.5)
        .count();
    assert!(lost > SEEDS.len() / 2, "only {lost} were lost");
}

#[test]
fn the_u_route_takes_no_more_memory_than_in_the_paper() {
    let mut flight = Flight::new(1);
    flight.command(BOTH);
    flight.fly_out(u_route());
    let route = flight.navigator.route();
    println!(
        "{} snapshots, {} vectors, {} B, without heights {} B",
        route.snapshots().len(),
        route.vectors().len(),
        route.bytes(),
        route.bytes_without_heights()
    );
    // Paper: 31 snapshots of 16 B and 2 to 3 vectors of 2 B between them, 0.65 kB for 56 m.
    assert!((27..=31).contains(&route.snapshots().len()));
    assert!(route.bytes_without_heights() <= 650);
}

#[test]
fn a_drifted_heading_is_corrected_not_doubled() {
    for drift in [-0.25_f32, -0.1, 0.1, 0.25] {
        let mut flight = Flight::new(5);
        flight.command(SINGLE);
        flight.period(Some(Point2::origin()));
        flight.drone.heading -= drift;
        let before = flight.drone.north_error();
        flight.command(STAY);
        (0..100).for_each(|_| flight.period(None));
        let after = flight.drone.north_error();
        assert!((before - drift).abs() < 0.05);
        assert_eq!(flight.corrections(), 1);
        assert!(after.abs() < 0.05, "{before} rad became {after} rad");
    }
}

#[test]
fn told_to_stay_the_drone_flies_to_the_snapshot_from_a_metre_away_and_stays() {
    let mut arrived = 0;
    for seed in SEEDS {
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-0.7, 0.7), (-0.7, -0.7)] {
            let mut flight = Flight::new(seed);
            flight.command(SINGLE);
            flight.period(Some(Point2::origin()));
            flight.command(IDLE);
            flight.fly_out([(x, y)]);
            flight.command(STAY);
            (0..400).for_each(|_| flight.period(None));
            arrived += usize::from(flight.home_error() < 0.5);
        }
    }
    // Paper, Fig. 4: eight of nine.
    assert!(9 * arrived >= 8 * 32, "only {arrived} of 32");
}

#[test]
fn a_visual_sequence_leads_home_without_a_single_odometry_vector() {
    let mut flight = Flight::new(2);
    flight.command(SEQUENCE);
    flight.fly_out([(3.0, 0.0)]);
    assert!(flight.navigator.route().vectors().is_empty());
    assert!((11..=13).contains(&flight.navigator.route().snapshots().len()));
    // The estimate is worthless on the way back.
    flight.drone.estimate.position += nalgebra::Vector2::new(5.0, -7.0);
    flight.command(FOLLOW);
    flight.fly_home();
    assert!(flight.home_error() < 0.5, "{} m", flight.home_error());
}

#[test]
fn in_the_dark_the_route_is_followed_by_odometry_and_nothing_is_realigned() {
    let mut flight = Flight::new(4);
    flight.command(BOTH);
    flight.fly_out([(4.0, 0.0)]);
    flight.dark = true;
    flight.command(FOLLOW);
    flight.fly_home();
    assert_eq!(flight.corrections(), 0);
    assert!(flight.events_of(|event| matches!(event, Event::NoVector { .. })) >= 2);
    assert!(flight.home_error() < 1.0, "{} m", flight.home_error());
}
