//! One run: a snapshot, a start, the way back.

use autopilot::app::{self, Arrival, Script, Step};
use fake_sensors::camera::tcm8230::Tcm8230;
use fake_sensors::world::World;
use link::{Message, Mode, Record, WorldPoint};
use pilot::Pilot;
use serde::Serialize;

use crate::board::native::{EXTCLK_HZ, Native};
use crate::board::{Board, BoardError};
use crate::flight::aircraft::Aircraft;
use crate::flight::wire::Wire;
use crate::flight::{self, FlightError};
use crate::scenario::Scenario;

/// Time between two points of a path, milliseconds.
const PATH_PERIOD_MS: u64 = 100;

/// A run that has ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Of the flight.
    pub seed: u64,
    /// Where the snapshot was taken: x north, y west, metres.
    pub snapshot_m: [f64; 2],
    /// Where the drone really was while it homed.
    pub path_m: Vec<[f64; 2]>,
}

impl Run {
    /// How far from the snapshot it ended; infinite if it never homed.
    pub fn end_error_m(&self) -> f64 {
        let [x, y] = self.snapshot_m;
        let end = self.path_m.last();
        end.map_or(f64::INFINITY, |end| libm::hypot(end[0] - x, end[1] - y))
    }
}

/// Flies to the middle of the world's free space, takes a snapshot, flies on by `start_m` and homes. The scenario's
/// route is not flown.
///
/// # Errors
/// [`FlightError`].
pub fn fly(scenario: &Scenario, start_m: [f64; 2]) -> Result<Run, FlightError> {
    let world = World::open(&scenario.world, scenario.seed)?;
    let parameters = pilot::Parameters::DEFAULT;
    let pilot = Pilot::new(&parameters).map_err(BoardError::Calibration)?;
    let initial = pilot.exposure();
    let chip = Tcm8230::streaming(0, EXTCLK_HZ, initial.shutter_lines, initial.gain);
    let mut board = Native::new(pilot, flight::camera(scenario, &world, chip));
    let script = script(middle_m(&world), start_m);
    let mut aircraft = Aircraft::flying(scenario, &scenario.route.waypoints(), script);
    let mut wire = Wire::new(scenario.conditions.corrupted_share, scenario.seed);
    let mut run = Run {
        seed: scenario.seed,
        snapshot_m: [f64::INFINITY; 2],
        path_m: Vec::new(),
    };
    let mut from_board = Vec::new();
    for now_ms in 0.. {
        board.look_from(aircraft.camera_pose());
        let mut to_board = aircraft.tick(now_ms, &from_board);
        let position = aircraft.truth().position_m;
        let at_m = [position.x, position.y];
        let mut sent = wire.carry_to_camera(&mut to_board).into_iter();
        if sent.any(|message| asks_for_snapshot(&message)) {
            run.snapshot_m = at_m;
        }
        match aircraft.phase() {
            app::Phase::Following if now_ms.is_multiple_of(PATH_PERIOD_MS) => {
                run.path_m.push(at_m);
            }
            app::Phase::Landing | app::Phase::Landed(_) => break,
            _ => {}
        }
        board.transmit(&to_board);
        board.advance()?;
        from_board.clear();
        board.receive(&mut from_board);
        wire.carry_to_autopilot(&mut from_board);
    }
    Ok(run)
}

fn asks_for_snapshot(message: &Message) -> bool {
    let wanted = Mode::Record(Record::SINGLE_SNAPSHOT).byte();
    matches!(message, Message::Command(command) if command.command == wanted)
}

/// The published script, flown in the middle.
fn script(middle_m: [f64; 2], start_m: [f64; 2]) -> Script {
    let place = |[x, y]: [f64; 2]| WorldPoint {
        x: x as f32,
        y: y as f32,
    };
    let start_m = [0, 1].map(|axis: usize| middle_m[axis] + start_m[axis]);
    let mut script = Script::single_snapshot(place(start_m));
    let to_the_middle = Step::FlyTo {
        place: place(middle_m),
        arrival: Arrival::WAYPOINT,
    };
    script.steps.insert(0, to_the_middle);
    script
}

fn middle_m(world: &World) -> [f64; 2] {
    world.free().map_or([0.0; 2], |free| {
        [0, 1].map(|axis: usize| 0.5 * f64::from(free.low_m[axis] + free.high_m[axis]))
    })
}
