//! Tables S1 to S4: the home vector is watched while something is moved round the robot.
//!
//! The robot stands half a metre from its snapshot. Then somebody comes, a chair is set down, or a cupboard that was
//! there is pushed aside. Measured is how far the vector moves, whether it still leads home, and whether its quality
//! falls. The text of the paper speaks of "some robustness against small, dynamic objects" and has no figures; its
//! condition for coming home is a vector within 90 degrees of the way.

use core::f32::consts::TAU;

use fake_sensors::world::World;
use nav::methods::{Fourier, Homeward, HomingMethod, Memory, presets};

use super::computed::Order;
use super::{ExperimentError, Row, rooms};
use crate::catchment::grid::Grid;
use crate::catchment::judge::SURROUNDINGS_M;
use crate::catchment::place::Scenery;
use crate::catchment::render::{self, Extras, Pillar, Stand};
use crate::metrics::quantile;
use crate::parallel;

/// Snapshots of each room: where nothing is said, and at most.
const SNAPSHOTS: [u64; 2] = [9, 36];
/// How high the published flights are, metres.
const EYE_M: f32 = 0.5;
/// How far the robot stands from its snapshot, metres, and on how many sides of it.
const AWAY_M: f32 = 0.5;
const SIDES: u8 = 4;
/// Where objects come to: metres from the robot, and on how many sides of it.
const NEAR_M: [f32; 3] = [1.0, 1.5, 2.5];
const BEARINGS: u8 = 12;
/// How far a cupboard is pushed round the robot: a twelfth of the circle, 0.5 to 1.3 m.
const PUSHED_RAD: f32 = TAU / 12.0;
/// The paper's snapshot, bytes.
const BYTES: u8 = 16;
/// Share of the vectors that has to lead home: what "some robustness" is taken for here.
const ENOUGH: f64 = 0.95;

/// What is moved.
#[derive(Clone, Copy, Debug)]
struct Object {
    /// In words, as the row's name.
    what: &'static str,
    radius_m: f32,
    height_m: f32,
    radiance: f32,
    /// It stood near by when the snapshot was taken, and is pushed aside; else it comes from outside.
    was_there: bool,
    /// Whether it is what the paper calls small and dynamic, and so is held to the bound.
    is_small: bool,
}

/// Half breadths and heights are those of people and furniture; radiances are those of dark clothes, wood and white
/// paint.
const OBJECTS: [Object; 3] = [
    Object {
        what: "a chair is set down",
        radius_m: 0.25,
        height_m: 0.9,
        radiance: 0.15,
        was_there: false,
        is_small: true,
    },
    Object {
        what: "somebody comes",
        radius_m: 0.22,
        height_m: 1.75,
        radiance: 0.08,
        was_there: false,
        is_small: true,
    },
    Object {
        what: "a cupboard is pushed aside",
        radius_m: 0.4,
        height_m: 1.8,
        radiance: 0.6,
        was_there: true,
        is_small: false,
    },
];

/// A home vector before and after something moved.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Watched {
    /// How far its tip moves, metres.
    moved_m: f64,
    /// By what angle it turns, degrees.
    turned_deg: f64,
    /// Its angle to the way home, before and afterwards, degrees.
    off_deg: [f64; 2],
    /// Whether its quality is lower afterwards.
    told: bool,
}

/// A row for each object.
pub fn rows(order: &mut Order<'_>) -> Result<Vec<Row>, ExperimentError> {
    let [usual, most] = SNAPSHOTS;
    let snapshots = order.seeds.unwrap_or(usual).clamp(usual, most) as usize;
    let places = [rooms::lounge(rooms::PAPER_ROOM_M)?, rooms::office()?];
    let parts = (OBJECTS.len() * places.len()) as f64;
    let mut rows = Vec::new();
    for (number, object) in OBJECTS.iter().enumerate() {
        let mut watched = Vec::new();
        for (room, place) in places.iter().enumerate() {
            let Scenery::World(world) = &place.scenery else {
                continue;
            };
            let watch = Watch::new(world, &place.grid, object);
            let stands = stands(&place.grid, snapshots);
            let of_place =
                parallel::map(&stands, |(goal_m, at_m)| watch.at(*goal_m, *at_m), |_| ());
            watched.extend(of_place.into_iter().flatten());
            (order.progress)((number * places.len() + room + 1) as f64 / parts);
        }
        rows.push(judged(object, &watched));
    }
    Ok(rows)
}

/// Each snapshot's place with each free place beside it where the robot stands, metres.
fn stands(grid: &Grid, snapshots: usize) -> Vec<([f32; 2], [f32; 2])> {
    let goals = grid.lattice(snapshots).into_iter();
    goals
        .flat_map(|index| {
            let goal_m = grid.position_m(index);
            (0..SIDES)
                .map(|side| TAU * f32::from(side) / f32::from(SIDES))
                .map(move |bearing| (goal_m, beside(goal_m, bearing, AWAY_M)))
        })
        .filter(|(_, at_m)| is_free(grid, *at_m))
        .collect()
}

/// The place that lies `away_m` from another in a direction, counter-clockwise from x.
fn beside([x, y]: [f32; 2], bearing: f32, away_m: f32) -> [f32; 2] {
    [
        x + away_m * libm::cosf(bearing),
        y + away_m * libm::sinf(bearing),
    ]
}

/// Whether a place lies on the grid, and the position nearest to it is free.
fn is_free(grid: &Grid, at_m: [f32; 2]) -> bool {
    let [column, row] = grid.cell(at_m).map(|cell| libm::floorf(cell + 0.5));
    let is_on_it =
        (0.0..grid.columns as f32).contains(&column) && (0.0..grid.rows as f32).contains(&row);
    is_on_it && grid.free[row as usize * grid.columns + column as usize]
}

/// One object in one room, and the method whose home vector is watched.
struct Watch<'w> {
    world: &'w World,
    grid: &'w Grid,
    object: &'w Object,
    method: Fourier,
}

impl<'w> Watch<'w> {
    fn new(world: &'w World, grid: &'w Grid, object: &'w Object) -> Self {
        Self {
            world,
            grid,
            object,
            method: Fourier::new(presets::fourier(BYTES)),
        }
    }

    /// What becomes of the vector from `at_m` to a snapshot at `goal_m`, for each free place of the object.
    fn at(&self, goal_m: [f32; 2], at_m: [f32; 2]) -> Vec<Watched> {
        let untouched = self.memory(goal_m, None);
        let undisturbed = self.vector(at_m, None, &untouched);
        let mut watched = Vec::new();
        for near_m in NEAR_M {
            for number in 0..BEARINGS {
                let bearing = TAU * f32::from(number) / f32::from(BEARINGS);
                let to_m = beside(at_m, bearing, near_m);
                if !is_free(self.grid, to_m) || self.is_upon(goal_m, to_m) {
                    continue;
                }
                let [before, after] = if self.object.was_there {
                    let from_m = beside(at_m, bearing - PUSHED_RAD, near_m);
                    if !is_free(self.grid, from_m) || self.is_upon(goal_m, from_m) {
                        continue;
                    }
                    let memory = self.memory(goal_m, Some(from_m));
                    [from_m, to_m].map(|object_m| self.vector(at_m, Some(object_m), &memory))
                } else {
                    [undisturbed, self.vector(at_m, Some(to_m), &untouched)]
                };
                watched.extend(compared(before, after, goal_m, at_m));
            }
        }
        watched
    }

    /// Whether the object would stand on the snapshot's place.
    fn is_upon(&self, goal_m: [f32; 2], object_m: [f32; 2]) -> bool {
        let away_m = libm::hypotf(goal_m[0] - object_m[0], goal_m[1] - object_m[1]);
        away_m <= self.object.radius_m
    }

    fn memory(&self, at_m: [f32; 2], object_m: Option<[f32; 2]>) -> Memory {
        self.method.remember(&self.view(at_m, object_m))
    }

    fn vector(
        &self,
        at_m: [f32; 2],
        object_m: Option<[f32; 2]>,
        memory: &Memory,
    ) -> Option<Homeward> {
        let seen = self.method.see(&self.view(at_m, object_m));
        self.method.home(&seen, memory).ok()
    }

    fn view(&self, [x, y]: [f32; 2], object_m: Option<[f32; 2]>) -> nav::methods::Luma {
        let stand = Stand {
            position_m: [x, y, EYE_M],
            turn_rad: 0.0,
            tilt_rad: [0.0; 2],
        };
        let pillar = |at_m| Pillar {
            at_m,
            radius_m: self.object.radius_m,
            height_m: self.object.height_m,
            radiance: self.object.radiance,
        };
        let extras = Extras {
            pillars: object_m.map(pillar).into_iter().collect(),
            light: None,
        };
        render::view(self.world, &stand, &extras)
    }
}

/// Two vectors compared. None where there was none before; where there is none afterwards, it counts as one of
/// length zero that leads away from home.
fn compared(
    before: Option<Homeward>,
    after: Option<Homeward>,
    goal_m: [f32; 2],
    at_m: [f32; 2],
) -> Option<Watched> {
    let before = before?;
    let home_m = nalgebra::Vector2::new(goal_m[0] - at_m[0], goal_m[1] - at_m[1]);
    let degrees = |a: &nalgebra::Vector2<f32>, b: &nalgebra::Vector2<f32>| {
        f64::from(libm::fabsf(libm::atan2f(a.perp(b), a.dot(b))).to_degrees())
    };
    let Some(after) = after else {
        return Some(Watched {
            moved_m: f64::from(SURROUNDINGS_M * before.displacement.norm()),
            turned_deg: 180.0,
            off_deg: [degrees(&home_m, &before.displacement), 180.0],
            told: true,
        });
    };
    Some(Watched {
        moved_m: f64::from(SURROUNDINGS_M * (after.displacement - before.displacement).norm()),
        turned_deg: degrees(&before.displacement, &after.displacement),
        off_deg: [&before, &after].map(|way| degrees(&home_m, &way.displacement)),
        told: after.quality < before.quality,
    })
}

/// The row of an object.
fn judged(object: &Object, watched: &[Watched]) -> Row {
    let share = |holds: fn(&Watched) -> bool| {
        watched.iter().filter(|watched| holds(watched)).count() as f64 / watched.len().max(1) as f64
    };
    let quantiles = |of: fn(&Watched) -> f64| {
        let mut sorted: Vec<f64> = watched.iter().map(of).collect();
        sorted.sort_by(f64::total_cmp);
        [0.5, 0.95].map(|share| quantile(&sorted, share))
    };
    let [moved_m, most_moved_m] = quantiles(|watched| watched.moved_m);
    let [turned_deg, most_turned_deg] = quantiles(|watched| watched.turned_deg);
    let before = share(|watched| watched.off_deg[0] < 90.0);
    let home = share(|watched| watched.off_deg[1] < 90.0);
    let told = share(|watched| watched.told);
    let bound = match object.is_small {
        true => format!("≥ {:.0} %", 100.0 * ENOUGH),
        false => "not small: without a bound".to_owned(),
    };
    Row {
        seeds: watched.len(),
        kept: object.is_small.then_some(home >= ENOUGH),
        ..Row::of(
            format!("tables S1 to S4: {}, 1 to 2.5 m away", object.what),
            "“some robustness against small, dynamic objects”; no figures in the text",
            format!(
                "{:.1} % of the vectors within 90° of home ({bound}), {:.1} % before; it moves by {moved_m:.2} m and \
                 {turned_deg:.0}° in the median, {most_moved_m:.2} m and {most_turned_deg:.0}° in 95 of 100; its quality \
                 falls in {:.0} %",
                100.0 * home,
                100.0 * before,
                100.0 * told
            ),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    fn vector(x: f32, y: f32, quality: f32) -> Option<Homeward> {
        Some(Homeward {
            displacement: Vector2::new(x, y),
            rotation: 0.0,
            quality,
        })
    }

    #[test]
    fn a_vector_that_turns_by_a_right_angle_is_told_by_its_angle_and_its_tip() {
        let [goal_m, at_m] = [[0.5, 0.0], [0.0, 0.0]];
        let found = compared(vector(0.3, 0.0, 0.9), vector(0.0, 0.4, 0.8), goal_m, at_m);
        let found = found.expect("two vectors");
        // Legs of 0.3 and 0.4 make a hypotenuse of 0.5, in units of 2 m.
        assert!((found.moved_m - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.turned_deg - 90.0).abs() < 1e-4, "{found:?}");
        assert!(found.off_deg[0].abs() < 1e-4, "{found:?}");
        assert!((found.off_deg[1] - 90.0).abs() < 1e-4, "{found:?}");
        assert!(found.told);
    }

    #[test]
    fn a_vector_that_is_lost_leads_nowhere_and_says_so() {
        let lost = compared(vector(0.3, 0.0, 0.9), None, [0.5, 0.0], [0.0, 0.0]);
        let lost = lost.expect("one before");
        assert!(lost.told && lost.off_deg[1] > 90.0, "{lost:?}");
        assert_eq!(
            compared(None, vector(0.3, 0.0, 0.9), [0.5, 0.0], [0.0; 2]),
            None
        );
    }

    #[test]
    fn nineteen_of_twenty_vectors_have_to_lead_home() {
        let watched = |off_deg| Watched {
            moved_m: 0.1,
            turned_deg: 10.0,
            off_deg: [10.0, off_deg],
            told: true,
        };
        let [chair, _, cupboard] = &OBJECTS;
        let mut all = vec![watched(20.0); 19];
        all.push(watched(120.0));
        assert_eq!(judged(chair, &all).kept, Some(true));
        all.push(watched(120.0));
        assert_eq!(judged(chair, &all).kept, Some(false));
        // The paper claims nothing of what is large.
        assert_eq!(judged(cupboard, &all).kept, None);
    }

    #[test]
    fn what_stands_before_a_wall_of_the_office_turns_the_vector_and_what_is_not_there_does_not() {
        let place = rooms::office().expect("the office");
        let Scenery::World(world) = &place.scenery else {
            panic!("a rendered place");
        };
        let (goal_m, at_m) = stands(&place.grid, 1)[0];
        let somebody = &OBJECTS[1];
        let found = Watch::new(world, &place.grid, somebody).at(goal_m, at_m);
        assert!(found.len() > 2 * usize::from(BEARINGS), "{}", found.len());
        assert!(found.iter().any(|watched| watched.moved_m > 0.01));
        let nobody = Object {
            height_m: 0.0,
            ..*somebody
        };
        let found = Watch::new(world, &place.grid, &nobody).at(goal_m, at_m);
        assert!(
            found
                .iter()
                .all(|watched| watched.moved_m == 0.0 && !watched.told)
        );
    }
}
