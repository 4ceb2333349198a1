//! Whole flights: how they go and how they end.

use link::{InsCorrection, Map, Message, Record, Source, Vector, WorldPoint, WorldPose};
use nalgebra::{Rotation2, Vector2, Vector3};

use super::{Bench, FIRST_CYCLE_MS, FOLLOW, command, estimate, vector};
use crate::app::{Arrival, Outcome, Phase, Route, Script, Settings, Step};
use crate::controller::SetPoint;

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
        let holds = output.set_point != SetPoint::MotorsOff;
        if holds != turning {
            turning = holds;
            events.push(("motors", at_ms));
        }
    }
    assert_eq!(events, [("reset", 1_000), ("motors", 2_000)]);
    assert_eq!(bench.position_m, Vector3::new(0.0, 0.0, 0.5));
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
        bench.run(FIRST_CYCLE_MS + 950);
        bench.position_m.xy()
    };
    let travelled = set_point_after_a_second(Some(0.5));
    assert!((travelled.norm() - 0.5).abs() < 1e-5, "{travelled}");
    let jumped = set_point_after_a_second(None);
    assert_eq!(jumped, Vector2::new(3.0, 4.0));
}

/// What a leg of 7 m becomes on the ground whose filter turns away by a degree a second.
fn flown_with_a_turning_filter(is_piloted: bool) -> Vec<Vector2<f32>> {
    let fly_to = Step::FlyTo {
        place: WorldPoint { x: 7.0, y: 0.0 },
        arrival: Arrival::WAYPOINT,
    };
    let steps = vec![fly_to];
    let mut bench = Bench::new(Script { steps }, Settings::default());
    let mut flown = Vec::new();
    while bench.now_ms < FIRST_CYCLE_MS || bench.app.phase() == Phase::Recording {
        let believed = bench.position_m.xy();
        let turned_rad = (bench.now_ms as f32 / 1_000.0).to_radians();
        let on_the_ground = Rotation2::new(turned_rad) * believed;
        if is_piloted {
            bench.app.set_seen(WorldPose {
                x: on_the_ground.x,
                y: on_the_ground.y,
                yaw: turned_rad,
            });
        }
        flown.push(on_the_ground);
        bench.tick();
    }
    flown
}

#[test]
fn a_pilot_keeps_the_way_on_the_ground_while_the_filter_turns_away() {
    let aside_m = |flown: &[Vector2<f32>]| flown.iter().map(|at| at.y.abs()).fold(0.0, f32::max);
    let farthest_m = |flown: &[Vector2<f32>]| flown.iter().map(|at| at.x).fold(0.0, f32::max);
    let piloted = flown_with_a_turning_filter(true);
    // Between two cycles the filter turns by a tenth of a degree: 1.2 cm at 7 m.
    assert!(aside_m(&piloted) < 0.02, "{}", aside_m(&piloted));
    assert!((farthest_m(&piloted) - 7.0).abs() < 0.02);
    // By odometry alone the leg's end is turned by the 18 degrees of 4 and 14 s.
    let alone = aside_m(&flown_with_a_turning_filter(false));
    assert!(alone > 2.0, "{alone}");
}

/// What a camera does on the way back from `short_route`, in its n-th answer to a STATE: it works
/// at snapshot 1, realigns there, and goes home to snapshot 0.
fn on_the_way_back(n: usize, here: WorldPose) -> Vec<Message> {
    let active = |snapshot_index| {
        Message::Map(Map {
            snapshot_index,
            ..Map::default()
        })
    };
    let realign = |index| {
        let correction = InsCorrection::from_world(index, here, here);
        Message::InsCorrection(correction.expect("the drone knows where it is"))
    };
    match n {
        1 => vec![vector(0.75, 0.0), active(1)],
        20 => vec![vector(0.5, 0.0), realign(1)],
        40 => vec![vector(0.25, 0.0), active(0)],
        60 => vec![realign(2)],
        _ => Vec::new(),
    }
}

#[test]
fn a_route_is_recorded_and_flown_back_until_its_first_snapshot_is_recognised() {
    let script = Script::record_and_return(&short_route(), Record::ROUTE, &[20]);
    let mut bench = Bench::new(script, Settings::default());
    let mut modes = Vec::new();
    let mut answers = 0;
    let outcome = bench.fly(60_000, |message| match message {
        Message::Command(asked) => {
            modes.push((asked.command, asked.args.to_vec()));
            vec![command(asked.command)]
        }
        Message::State(state) if modes.last().is_some_and(|mode| mode.0 == FOLLOW) => {
            answers += 1;
            on_the_way_back(answers, state.pose().expect("the drone knows where it is"))
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
    let expected = [(0x0f, vec![]), (0x03, vec![20]), (FOLLOW, vec![])];
    assert_eq!(modes, expected);
    assert_eq!(bench.app.counters().corrections_applied, 2);
    assert_eq!(bench.position_m, Vector3::new(0.25, 0.0, 0.0));
    // The second that follows the correction, and the end of the script.
    assert!((70..=73).contains(&answers), "{answers}");
}

#[test]
fn a_camera_that_rests_at_its_first_snapshot_without_a_correction_is_home_too() {
    let script = Script::record_and_return(&short_route(), Record::ROUTE, &[]);
    let mut bench = Bench::new(script, Settings::default());
    let mut mode = 0;
    let outcome = bench.fly(60_000, |message| match message {
        Message::Command(asked) => {
            mode = asked.command;
            vec![command(mode)]
        }
        Message::State(_) if mode == FOLLOW => {
            vec![vector(0.25, 0.0), Message::Map(Map::default())]
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
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

/// The last place that the drone is sent to, and why it lands, if it finds itself at `position_m`.
fn landing_at(position_m: Vector3<f32>) -> (Vector3<f32>, Phase) {
    let mut bench = Bench::following();
    bench.run(FIRST_CYCLE_MS);
    let mut last_m = bench.position_m;
    for now_ms in bench.now_ms..bench.now_ms + 2_000 {
        let output = bench.app.tick(now_ms, &estimate(position_m), &[]);
        if let SetPoint::Hold { position_m, .. } = output.set_point {
            last_m = position_m;
        }
    }
    (last_m, bench.app.phase())
}

#[test]
fn beyond_the_fence_the_drone_lands_where_it_is() {
    let (place_m, phase) = landing_at(Vector3::new(5.0, 6.5, 0.5));
    assert_eq!(phase, Phase::Landed(Outcome::FenceBreached));
    assert_eq!(place_m.xy(), Vector2::new(5.0, 6.5));
}

#[test]
fn above_the_ceiling_the_drone_lands() {
    let (_, phase) = landing_at(Vector3::new(0.0, 0.0, 1.1));
    assert_eq!(phase, Phase::Landed(Outcome::TooHigh));
}

#[test]
fn a_drone_that_lost_its_position_lands_at_its_set_point() {
    let (place_m, phase) = landing_at(Vector3::new(f32::NAN, 0.0, 0.5));
    assert_eq!(phase, Phase::Landed(Outcome::PositionLost));
    assert_eq!(place_m.xy(), Vector2::zeros());
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
    bench.run(FIRST_CYCLE_MS);
    bench.app.kill();
    assert_eq!(bench.tick().set_point, SetPoint::MotorsOff);
    let later = bench.run(FIRST_CYCLE_MS + 5_000);
    assert_eq!(later.set_point, SetPoint::MotorsOff);
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
fn a_single_snapshot_is_taken_left_and_homed_to_for_20_s() {
    let start = WorldPoint { x: 1.0, y: 1.0 };
    let mut bench = Bench::new(Script::single_snapshot(start), Settings::default());
    let mut modes = Vec::new();
    let mut homing_states = 0;
    let outcome = bench.fly(60_000, |message| match message {
        Message::Command(asked) => {
            modes.push(asked.command);
            vec![message.clone()]
        }
        Message::State(_) if modes.last() == Some(&0x11) => {
            homing_states += 1;
            vec![vector(0.5, -0.25)]
        }
        _ => Vec::new(),
    });
    assert_eq!(outcome, Outcome::Completed);
    assert_eq!(modes, [0x0f, 0x01, 0x00, 0x11]);
    assert_eq!(bench.position_m.xy(), Vector2::new(0.5, 0.25));
    // 20 s of cycles; the STATE of the first leaves before its COMMAND and is not counted.
    assert_eq!(homing_states, 200);
}
