//! Whole flights of the app against a camera of a few lines and a drone that is where it should be.

use link::{
    Command, InsCorrection, Map, Message, Mode, Parser, Record, Source, Vector, WorldPoint,
    WorldPose,
};
use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::{
    Arrival, CorrectionSd, FIRST_SNAPSHOT, FlightApp, Outcome, Output, Phase, Route, Script,
    SetPoint, Settings, Step, Until,
};
use crate::ekf::{Estimate, Measurement, Position, YawError};

const FOLLOW: u8 = 0x12;
/// First run of the loop: 1 s on the ground, 1 s reset, 1 s climb, 1 s hover, and the next period.
const FIRST_CYCLE_MS: u64 = 4_100;

fn estimate(position_m: Vector3<f32>) -> Estimate {
    Estimate {
        position_m,
        velocity_m_s: Vector3::zeros(),
        velocity_body_m_s: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        variances: SVector::zeros(),
    }
}

fn command(byte: u8) -> Message {
    Message::Command(Command {
        command: byte,
        ..Command::default()
    })
}

fn vector(north: f32, east: f32) -> Message {
    Message::Vector(Vector {
        target_n: north,
        target_e: east,
        ..Vector::default()
    })
}

/// The app, the drone that follows it without delay, and the wire in between.
struct Bench {
    app: FlightApp,
    parser: Parser,
    now_ms: u64,
    position_m: Vector3<f32>,
    /// Arrives at the app in the next millisecond.
    inbound: Vec<u8>,
    /// What the app sent in the last millisecond.
    sent: Vec<Message>,
}

impl Bench {
    fn new(script: Script, settings: Settings) -> Self {
        Self {
            app: FlightApp::new(script, settings),
            parser: Parser::new(),
            now_ms: 0,
            position_m: Vector3::zeros(),
            inbound: Vec::new(),
            sent: Vec::new(),
        }
    }

    /// A bench on which the app follows as soon as it flies.
    fn following() -> Self {
        let follow = Step::Follow {
            mode: Mode::Follow,
            until: Until::Realigned(FIRST_SNAPSHOT),
        };
        let script = Script {
            steps: vec![follow],
        };
        Self::new(script, Settings::default())
    }

    fn send(&mut self, message: &Message) {
        self.inbound.extend(message.encode());
    }

    fn tick(&mut self) -> Output {
        let inbound = std::mem::take(&mut self.inbound);
        let output = self
            .app
            .tick(self.now_ms, &estimate(self.position_m), &inbound);
        let frames = self.parser.frames(&output.transmit);
        self.sent = frames.map(|frame| frame.message).collect();
        self.position_m = output.set_point.position_m;
        self.now_ms += 1;
        output
    }

    /// Ticks up to and including `until_ms`; the last output.
    fn run(&mut self, until_ms: u64) -> Output {
        loop {
            let output = self.tick();
            if self.now_ms > until_ms {
                return output;
            }
        }
    }

    fn command_bytes_sent(&self) -> Vec<u8> {
        let commands = self.sent.iter().filter_map(|message| match message {
            Message::Command(command) => Some(command.command),
            _ => None,
        });
        commands.collect()
    }

    /// Flies to the end against a camera that answers every message; `limit_ms` is the patience.
    fn fly(&mut self, limit_ms: u64, mut answer: impl FnMut(&Message) -> Vec<Message>) -> Outcome {
        while self.now_ms < limit_ms {
            self.tick();
            for message in std::mem::take(&mut self.sent) {
                for reply in answer(&message) {
                    self.send(&reply);
                }
            }
            if let Phase::Landed(outcome) = self.app.phase() {
                return outcome;
            }
        }
        panic!("still {:?} after {limit_ms} ms", self.app.phase());
    }
}

/// A camera that only echoes commands.
fn echo(message: &Message) -> Vec<Message> {
    match message {
        Message::Command(_) => vec![message.clone()],
        _ => Vec::new(),
    }
}

fn short_route() -> Route {
    Route::through(&[
        WorldPoint::from_north_east(0.0, 0.0),
        WorldPoint::from_north_east(1.0, 0.0),
    ])
}

#[test]
fn the_link_is_silent_until_the_drone_hovers() {
    let mut bench = Bench::following();
    while bench.now_ms < FIRST_CYCLE_MS {
        bench.tick();
        assert_eq!(bench.sent, [], "at {} ms", bench.now_ms);
    }
    bench.tick();
    assert!(matches!(
        bench.sent[..],
        [Message::State(_), Message::Command(_)]
    ));
}

#[test]
fn take_off_resets_the_filter_a_second_before_the_motors_start() {
    let mut bench = Bench::following();
    let mut events = Vec::new();
    let mut turning = false;
    while bench.now_ms < FIRST_CYCLE_MS {
        let at_ms = bench.now_ms;
        let output = bench.tick();
        if output.reset_filter {
            events.push(("reset", at_ms));
        }
        if output.motors != turning {
            turning = output.motors;
            events.push(("motors", at_ms));
        }
    }
    assert_eq!(events, [("reset", 1_000), ("motors", 2_000)]);
    assert_eq!(bench.position_m, Vector3::new(0.0, 0.0, 0.5));
}

#[test]
fn the_loop_runs_every_100_ms_at_its_offset() {
    let settings = Settings {
        cycle_offset_ms: 37,
        ..Settings::default()
    };
    let script = Script::single_snapshot(WorldPoint::default());
    let mut bench = Bench::new(script, settings);
    let mut cycles = Vec::new();
    while bench.now_ms < 4_400 {
        let at_ms = bench.now_ms;
        bench.tick();
        if !bench.sent.is_empty() {
            cycles.push(at_ms);
        }
    }
    assert_eq!(cycles, [4_037, 4_137, 4_237, 4_337]);
}

#[test]
fn a_command_is_sent_every_cycle_until_its_echo() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW]);
    bench.run(FIRST_CYCLE_MS + 100);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW]);
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 200);
    assert_eq!(bench.command_bytes_sent(), [], "the echo came");
    bench.send(&command(0x00));
    bench.run(FIRST_CYCLE_MS + 300);
    assert_eq!(bench.command_bytes_sent(), [FOLLOW], "the camera idles");
    assert_eq!(bench.app.counters().commands_sent, 3);
}

#[test]
fn a_vector_is_flown_in_the_next_cycle_with_x_north_and_y_west() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    bench.send(&command(FOLLOW));
    bench.run(FIRST_CYCLE_MS + 300);
    bench.send(&vector(1.0, 2.0));
    // Received in the window of this cycle, decided in the next, issued when that one's window ends.
    let hover = Vector3::new(0.0, 0.0, 0.5);
    let before = bench.run(FIRST_CYCLE_MS + 400 + 8);
    assert_eq!(before.set_point.position_m, hover);
    let after = bench.run(FIRST_CYCLE_MS + 400 + 9);
    assert_eq!(after.set_point.position_m, Vector3::new(1.0, -2.0, 0.5));
}

#[test]
fn a_vector_is_not_flown_before_both_sides_agree_on_the_mode() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    bench.send(&vector(1.0, 2.0));
    let output = bench.run(FIRST_CYCLE_MS + 500);
    assert_eq!(output.set_point.position_m, Vector3::new(0.0, 0.0, 0.5));
}

#[test]
fn a_correction_becomes_two_measurements_once() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    let correction = Message::InsCorrection(InsCorrection {
        snapshot_index: 9,
        e_to: 0.25,
        n_to: -0.5,
        psi_to: 0.125,
        ..InsCorrection::default()
    });
    let mut measurements = Vec::new();
    for _ in 0..2 {
        bench.send(&correction);
        for _ in 0..100 {
            measurements.extend(bench.tick().measurements);
        }
    }
    let CorrectionSd {
        position_m: sd_m,
        yaw_rad: sd_rad,
    } = CorrectionSd::OVERWRITE;
    let position = Position {
        position_m: Vector3::new(-0.5, -0.25, 0.5),
        sd_m,
    };
    let yaw_error = YawError {
        error_rad: 0.125,
        sd_rad,
    };
    let expected = [
        Measurement::Position(position),
        Measurement::YawError(yaw_error),
    ];
    assert_eq!(measurements, expected);
    assert_eq!(bench.app.counters().corrections_ignored, 1);
}

#[test]
fn what_arrives_on_the_ground_waits_in_200_bytes_and_is_read_in_the_air() {
    let mut bench = Bench::following();
    for _ in 0..10 {
        bench.send(&vector(1.0, 2.0));
    }
    bench.run(FIRST_CYCLE_MS - 1);
    assert_eq!(bench.app.take_received(), []);
    assert_eq!(bench.app.counters().overflowed_bytes, 290 - 200);
    bench.run(FIRST_CYCLE_MS + 20);
    let received = bench.app.take_received();
    assert_eq!(received.len(), 6, "six of 29 bytes are whole");
    assert_eq!(received[0].at_ms, FIRST_CYCLE_MS);
}

#[test]
fn the_set_point_travels_at_cruise_speed_or_jumps() {
    let place = WorldPoint { x: 3.0, y: 4.0 };
    let fly_to = Step::FlyTo {
        place,
        arrival: Arrival::WAYPOINT,
    };
    let set_point_after_a_second = |cruise_speed_m_s| {
        let settings = Settings {
            cruise_speed_m_s,
            ..Settings::default()
        };
        let steps = vec![fly_to.clone()];
        let mut bench = Bench::new(Script { steps }, settings);
        let output = bench.run(FIRST_CYCLE_MS + 950);
        output.set_point.position_m.xy()
    };
    let travelled = set_point_after_a_second(Some(0.5));
    assert!((travelled.norm() - 0.5).abs() < 1e-5, "{travelled}");
    let jumped = set_point_after_a_second(None);
    assert_eq!(jumped, nalgebra::Vector2::new(3.0, 4.0));
}

#[test]
fn a_route_is_recorded_and_flown_back_until_the_first_snapshot_is_recognised() {
    let route = short_route();
    let script = Script::record_and_return(&route, Record::ROUTE, &[20]);
    let mut bench = Bench::new(script, Settings::default());
    let mut modes = Vec::new();
    let mut following_states = 0;
    let outcome = bench.fly(60_000, |message| match message {
        Message::Command(asked) => {
            modes.push((asked.command, asked.args.to_vec()));
            vec![command(asked.command)]
        }
        Message::State(state) if modes.last().is_some_and(|mode| mode.0 == FOLLOW) => {
            following_states += 1;
            let here = state.pose().expect("the drone knows where it is");
            let home = vector(0.25, 0.0);
            let correction = InsCorrection::from_world(FIRST_SNAPSHOT, here, WorldPose::default());
            let correction = correction.expect("both poses are finite");
            match following_states {
                ..20 => vec![home],
                20 => vec![Message::InsCorrection(correction)],
                _ => Vec::new(),
            }
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
    let expected = [(0x0f, vec![]), (0x03, vec![20]), (FOLLOW, vec![])];
    assert_eq!(modes, expected);
    assert_eq!(bench.position_m, Vector3::new(0.25, 0.0, 0.0));
}

#[test]
fn odometry_alone_is_home_when_the_target_stays_at_the_start() {
    let route = short_route();
    let script = Script::record_and_return(&route, Record::ODOMETRY, &[]);
    let mut bench = Bench::new(script, Settings::default());
    let mut mode = 0;
    let outcome = bench.fly(60_000, |message| match message {
        Message::Command(asked) => {
            mode = asked.command;
            vec![command(mode)]
        }
        Message::State(_) if mode == FOLLOW => {
            let target = WorldPoint { x: 0.1, y: 0.0 };
            let vector = Vector::from_world(target, 0.0, target, Source::Odometry);
            vec![Message::Vector(vector.expect("the target is finite"))]
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
    assert_eq!(bench.position_m, Vector3::new(0.1, 0.0, 0.0));
}

#[test]
fn a_camera_that_never_echoes_ends_the_flight() {
    let script = Script::record_and_return(&short_route(), Record::ROUTE, &[]);
    let mut bench = Bench::new(script, Settings::default());
    assert_eq!(bench.fly(30_000, |_| Vec::new()), Outcome::NoEcho);
}

#[test]
fn a_camera_that_never_arrives_ends_the_flight_at_the_limit() {
    let script = Script::record_and_return(&short_route(), Record::ROUTE, &[]);
    let settings = Settings {
        follow_limit_ms: 5_000,
        ..Settings::default()
    };
    let mut bench = Bench::new(script, settings);
    assert_eq!(bench.fly(60_000, echo), Outcome::TimedOut);
}

/// Where the drone lands, and why, if it finds itself at `position_m`.
fn landing_at(position_m: Vector3<f32>) -> (SetPoint, Phase) {
    let mut bench = Bench::following();
    let mut set_point = bench.run(FIRST_CYCLE_MS).set_point;
    for now_ms in bench.now_ms..bench.now_ms + 2_000 {
        let output = bench.app.tick(now_ms, &estimate(position_m), &[]);
        set_point = output.set_point;
    }
    (set_point, bench.app.phase())
}

#[test]
fn beyond_the_fence_the_drone_lands_where_it_is() {
    let (set_point, phase) = landing_at(Vector3::new(5.0, 6.5, 0.5));
    assert_eq!(phase, Phase::Landed(Outcome::FenceBreached));
    assert_eq!(set_point.position_m, Vector3::new(5.0, 6.5, 0.0));
}

#[test]
fn above_the_ceiling_the_drone_lands() {
    let (_, phase) = landing_at(Vector3::new(0.0, 0.0, 1.1));
    assert_eq!(phase, Phase::Landed(Outcome::TooHigh));
}

#[test]
fn a_drone_that_lost_its_position_lands_at_its_set_point() {
    let (set_point, phase) = landing_at(Vector3::new(f32::NAN, 0.0, 0.5));
    assert_eq!(phase, Phase::Landed(Outcome::PositionLost));
    assert_eq!(set_point.position_m, Vector3::zeros());
}

#[test]
fn a_message_that_is_no_number_ends_the_flight() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    bench.send(&vector(f32::NAN, 0.0));
    assert_eq!(bench.fly(10_000, echo), Outcome::BrokenMessage);
}

#[test]
fn the_kill_button_stops_the_motors_at_once_and_for_good() {
    let mut bench = Bench::following();
    assert!(bench.run(FIRST_CYCLE_MS).motors);
    bench.app.kill();
    assert!(!bench.tick().motors);
    assert!(!bench.run(FIRST_CYCLE_MS + 5_000).motors);
    assert_eq!(bench.app.phase(), Phase::Landed(Outcome::Killed));
}

#[test]
fn the_land_button_lands_within_a_second_and_a_half_in_silence() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS + 50);
    bench.app.command_landing();
    let until_ms = bench.now_ms + 1_501;
    while bench.now_ms < until_ms {
        bench.tick();
        assert_eq!(bench.sent, []);
    }
    assert_eq!(bench.app.phase(), Phase::Landed(Outcome::LandCommanded));
    assert_eq!(bench.position_m.z, 0.0);
}

#[test]
fn maps_are_handed_to_the_recorder_with_their_time() {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    let map = Message::Map(Map::default());
    bench.send(&map);
    bench.run(FIRST_CYCLE_MS + 50);
    let received = bench.app.take_received();
    assert_eq!(received.len(), 1);
    assert_eq!(received[0].message, map);
    assert_eq!(received[0].at_ms, FIRST_CYCLE_MS + 1);
    assert_eq!(bench.app.take_received(), []);
}
