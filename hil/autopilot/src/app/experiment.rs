//! The scripted experiments of the published app, by their slot on the operator's screen.

use link::{Mode, Record, WorldPoint};

use super::route::{Arrival, Route};
use super::script::{Script, Step, Until, command};

/// Starts of the single-snapshot experiment: a grid of five by five, 1 m apart, about the snapshot.
const GRID: [f32; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
/// How long it homes from each, ms.
const GRID_HOMING_MS: u64 = 20_000;
/// Legs of the snapshot-distance experiment, m.
const DISTANCES_M: [f32; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];
/// How long it homes behind each, ms.
const DISTANCE_HOMING_MS: u64 = 2_000;
/// Leg of the corridor experiment, m (the paper's text says about 5 m; the script flies 6 m).
const CORRIDOR_M: f32 = 6.0;
/// How often it is flown there and back.
const CORRIDOR_ROUNDS: usize = 10;
/// How long it homes at its start after each round, ms.
const CORRIDOR_HOMING_MS: u64 = 4_000;

/// An experiment of the app's newest published version (branch `visualhoming`, June 2023).
///
/// Geometry and times are the published ones. Which commands a script sends on its way is our
/// reading where the document of an experiment does not tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Experiment {
    /// Hover; the operator's buttons go to the camera.
    Idle,
    /// One snapshot at the origin, homed to from 25 starts (the paper's Fig. 4).
    SingleSnapshot,
    /// One snapshot at the origin, homed to after legs of 1 to 5 m, to measure how far odometry is off
    /// (Fig. 5A and B).
    Rmse,
    /// There and back in the corridor, homing to one snapshot after each round (Fig. 5C and D).
    CorridorBoth,
    /// The same by odometry alone.
    CorridorOdometry,
    /// The U, followed home with snapshots and odometry (Fig. 6B).
    UBoth,
    /// The U by odometry alone.
    UOdometry,
    /// There in the corridor and back along a sequence of snapshots.
    CorridorSnapshots,
    /// The S by odometry alone (Fig. 6A).
    SOdometry,
    /// The S with snapshots and odometry.
    SBoth,
    /// The S along a sequence of snapshots (Fig. 6C).
    SSnapshots,
}

impl Experiment {
    /// All, by slot.
    pub const ALL: [Self; 11] = [
        Self::Idle,
        Self::SingleSnapshot,
        Self::Rmse,
        Self::CorridorBoth,
        Self::CorridorOdometry,
        Self::UBoth,
        Self::UOdometry,
        Self::CorridorSnapshots,
        Self::SOdometry,
        Self::SBoth,
        Self::SSnapshots,
    ];

    /// Passes along the S, and rounds of the five distances, in the published flights.
    pub const REPEATS: usize = 2;

    /// The experiment in a slot (`vh.sw_experiment`).
    pub fn in_slot(slot: u8) -> Option<Self> {
        Self::ALL.get(usize::from(slot)).copied()
    }

    /// Its slot, 0 to 10.
    pub const fn slot(self) -> u8 {
        self as u8
    }

    /// Its name on the operator's screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::SingleSnapshot => "single snapshot",
            Self::Rmse => "RMSE",
            Self::CorridorBoth => "corr both",
            Self::CorridorOdometry => "corr odo",
            Self::UBoth => "U both",
            Self::UOdometry => "U odo",
            Self::CorridorSnapshots => "corr snapshots",
            Self::SOdometry => "S odo",
            Self::SBoth => "S both",
            Self::SSnapshots => "S snapshots",
        }
    }

    /// Its script. `repeats` is the number of passes along the S and of rounds of the distances;
    /// [`Self::REPEATS`] as published. The other experiments have fixed numbers.
    pub fn script(self, repeats: usize) -> Script {
        let home_along = |route: &Route, record| Script::record_and_return(route, record, &[]);
        match self {
            Self::Idle => Script {
                steps: vec![Step::Buttons],
            },
            Self::SingleSnapshot => single_snapshot_grid(),
            Self::Rmse => {
                let legs = std::iter::repeat_n(DISTANCES_M, repeats).flatten();
                to_one_snapshot(legs, DISTANCE_HOMING_MS)
            }
            Self::CorridorBoth => {
                let legs = std::iter::repeat_n(CORRIDOR_M, CORRIDOR_ROUNDS);
                to_one_snapshot(legs, CORRIDOR_HOMING_MS)
            }
            Self::CorridorOdometry => Script {
                steps: (0..CORRIDOR_ROUNDS)
                    .flat_map(|_| there_and_back(CORRIDOR_M))
                    .collect(),
            },
            Self::CorridorSnapshots => corridor_sequences(),
            Self::UBoth => home_along(&Route::u(), Record::ROUTE),
            Self::UOdometry => home_along(&Route::u(), Record::ODOMETRY),
            Self::SBoth => home_along(&Route::s_passes(repeats), Record::ROUTE),
            Self::SOdometry => home_along(&Route::s_passes(repeats), Record::ODOMETRY),
            Self::SSnapshots => home_along(&Route::s_passes(repeats), Record::SEQUENCE),
        }
    }
}

const ORIGIN: WorldPoint = WorldPoint { x: 0.0, y: 0.0 };

fn single_snapshot_grid() -> Script {
    let mut steps = take_one_snapshot();
    for north in GRID {
        for east in GRID {
            steps.push(fly_to(north, east));
            steps.extend(home_to_it(GRID_HOMING_MS));
        }
    }
    Script { steps }
}

/// After each leg there and back, home to the snapshot at the start, and realign there.
fn to_one_snapshot(legs_m: impl Iterator<Item = f32>, homing_ms: u64) -> Script {
    let mut steps = take_one_snapshot();
    for leg_m in legs_m {
        steps.extend(there_and_back(leg_m));
        steps.extend(home_to_it(homing_ms));
    }
    Script { steps }
}

fn corridor_sequences() -> Script {
    let round = || {
        [
            command(Mode::Clear, &[]),
            command(Mode::Record(Record::SEQUENCE), &[]),
            fly_to(CORRIDOR_M, 0.0),
            Step::Follow {
                mode: Mode::Follow,
                until: Until::Home,
            },
        ]
    };
    Script {
        steps: (0..CORRIDOR_ROUNDS).flat_map(|_| round()).collect(),
    }
}

fn take_one_snapshot() -> Vec<Step> {
    vec![
        command(Mode::Clear, &[]),
        command(Mode::Record(Record::SINGLE_SNAPSHOT), &[]),
        command(Mode::Idle, &[]),
    ]
}

fn home_to_it(homing_ms: u64) -> [Step; 3] {
    [
        Step::Follow {
            mode: Mode::FollowAndStay,
            until: Until::Elapsed(homing_ms),
        },
        Step::Realign { place: ORIGIN },
        command(Mode::Idle, &[]),
    ]
}

fn there_and_back(leg_m: f32) -> [Step; 2] {
    [fly_to(leg_m, 0.0), fly_to(0.0, 0.0)]
}

fn fly_to(north: f32, east: f32) -> Step {
    Step::FlyTo {
        place: WorldPoint::from_north_east(north, east),
        arrival: Arrival::WAYPOINT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places that a script flies to, (north, east).
    fn places(experiment: Experiment, repeats: usize) -> Vec<(f32, f32)> {
        let steps = experiment.script(repeats).steps.into_iter();
        steps
            .filter_map(|step| match step {
                Step::FlyTo { place, .. } => Some((place.x, -place.y)),
                _ => None,
            })
            .collect()
    }

    /// For how long each following lasts, where it has a fixed time.
    fn homing_ms(experiment: Experiment) -> Vec<u64> {
        let steps = experiment.script(1).steps.into_iter();
        steps
            .filter_map(|step| match step {
                Step::Follow {
                    until: Until::Elapsed(ms),
                    ..
                } => Some(ms),
                _ => None,
            })
            .collect()
    }

    fn recorded(experiment: Experiment) -> Vec<u8> {
        let steps = experiment.script(2).steps.into_iter();
        let mut modes: Vec<_> = steps
            .filter_map(|step| match step {
                Step::Command {
                    mode: Mode::Record(record),
                    args,
                } => {
                    assert_eq!(args, [], "the published app sends no arguments");
                    Some(Mode::Record(record).byte())
                }
                _ => None,
            })
            .collect();
        modes.dedup();
        modes
    }

    #[test]
    fn every_slot_has_its_experiment_with_its_published_name() {
        let names = [
            "idle",
            "single snapshot",
            "RMSE",
            "corr both",
            "corr odo",
            "U both",
            "U odo",
            "corr snapshots",
            "S odo",
            "S both",
            "S snapshots",
        ];
        for (slot, name) in (0..).zip(names) {
            let experiment = Experiment::in_slot(slot).expect("a slot");
            assert_eq!((experiment.slot(), experiment.name()), (slot, name));
        }
        assert_eq!(Experiment::in_slot(11), None);
    }

    #[test]
    fn the_grid_has_25_starts_within_two_metres_and_homes_20_s_from_each() {
        let places = places(Experiment::SingleSnapshot, 1);
        assert_eq!(places.len(), 25);
        assert_eq!(places[0], (-2.0, -2.0));
        assert_eq!(places[1], (-2.0, -1.0));
        assert_eq!(places[12], (0.0, 0.0));
        assert_eq!(places[24], (2.0, 2.0));
        assert_eq!(homing_ms(Experiment::SingleSnapshot), [20_000; 25]);
    }

    #[test]
    fn the_distances_are_one_to_five_metres_cycled_with_2_s_of_homing() {
        let far: Vec<_> = places(Experiment::Rmse, 2)
            .chunks(2)
            .map(|leg| {
                assert_eq!(leg[1], (0.0, 0.0));
                leg[0].0
            })
            .collect();
        assert_eq!(far, [1.0, 2.0, 3.0, 4.0, 5.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(homing_ms(Experiment::Rmse), [2_000; 5]);
    }

    #[test]
    fn the_corridor_is_flown_ten_times_there_and_back_with_4_s_of_homing_at_its_start() {
        let rounds: Vec<_> = [(6.0, 0.0), (0.0, 0.0)].repeat(10);
        assert_eq!(places(Experiment::CorridorBoth, 1), rounds);
        assert_eq!(places(Experiment::CorridorOdometry, 1), rounds);
        assert_eq!(homing_ms(Experiment::CorridorBoth), [4_000; 10]);
        assert_eq!(homing_ms(Experiment::CorridorOdometry), []);
        assert_eq!(places(Experiment::CorridorSnapshots, 1), [(6.0, 0.0); 10]);
    }

    #[test]
    fn the_s_has_as_many_passes_as_repeats() {
        assert_eq!(places(Experiment::SBoth, 2).len(), 1 + 2 * 5);
        assert_eq!(places(Experiment::SSnapshots, 3).len(), 1 + 3 * 5);
    }

    #[test]
    fn each_variant_records_what_its_name_says() {
        let modes = Experiment::ALL.map(recorded);
        let expected: [&[u8]; 11] = [
            &[],
            &[0x01],
            &[0x01],
            &[0x01],
            &[],
            &[0x03],
            &[0x02],
            &[0x05],
            &[0x02],
            &[0x03],
            &[0x05],
        ];
        assert_eq!(modes, expected);
    }

    #[test]
    fn where_a_script_homes_to_one_snapshot_it_realigns_at_once_and_lets_the_camera_rest() {
        for experiment in [
            Experiment::SingleSnapshot,
            Experiment::Rmse,
            Experiment::CorridorBoth,
        ] {
            let steps = experiment.script(1).steps;
            for (index, step) in steps.iter().enumerate() {
                if matches!(step, Step::Follow { .. }) {
                    assert_eq!(steps[index + 1], Step::Realign { place: ORIGIN });
                    assert_eq!(steps[index + 2], command(Mode::Idle, &[]));
                }
            }
        }
    }
}
