//! All views that a comparison needs: those that are remembered, and that from each position.

use core::f32::consts::TAU;

use fake_sensors::random::Normal;
use fake_sensors::world::World;
use nav::methods::Luma;

use super::condition::Condition;
use super::grid::Grid;
use super::place::{EYE_M, Place, Scenery};
use super::render::{self, Extras, Pillar, SideLight, Stand};
use crate::parallel;

/// The seed of what a condition draws at random.
const SEED: u64 = 11;

/// Things that stand about and are moved: how many, how far in from the edge of the place (metres),
/// how far along it they are moved.
const FURNITURE: usize = 6;
const FROM_THE_EDGE_M: f32 = 0.25;
const MOVED_M: f32 = 1.2;
/// Half the breadth of a person, and a person's height, metres.
const PERSON_M: [f32; 2] = [0.22, 1.75];
/// How far away somebody walks by, metres.
const WALKS_BY_M: [f32; 2] = [1.0, 2.5];
/// The radiance of somebody's clothes.
const CLOTHES: f32 = 0.08;

/// The view from a position at homing time.
#[derive(Clone, Debug)]
pub struct Current {
    /// Luma by bearing from what the robot takes for north.
    pub view: Luma,
    /// How far that is turned counter-clockwise from north, radians.
    pub turn_rad: f32,
}

/// A remembered view.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Its position on the grid.
    pub index: usize,
    /// Luma by bearing from north.
    pub view: Luma,
}

/// The views of a place under a condition.
#[derive(Clone, Debug)]
pub struct Survey {
    /// The place's name.
    pub place: String,
    /// The condition.
    pub condition: Condition,
    /// The positions.
    pub grid: Grid,
    /// What is homed to.
    pub goals: Vec<Goal>,
    /// By position; none where it is not free.
    pub currents: Vec<Option<Current>>,
}

/// Pictures cannot be taken again under another condition.
#[derive(Debug, thiserror::Error)]
#[error("{place}: its pictures are as they were taken, `{condition}` cannot be made from them")]
pub struct Unsuited {
    place: String,
    condition: Condition,
}

impl Survey {
    /// Looks round everywhere; `goals` views, about, are remembered. `done` hears how many positions
    /// are done.
    ///
    /// # Errors
    /// [`Unsuited`], where the place is a set of pictures and the condition is not about them.
    pub fn take(
        place: &Place,
        condition: Condition,
        goals: usize,
        done: impl FnMut(usize),
    ) -> Result<Self, Unsuited> {
        if matches!(place.scenery, Scenery::Pictures(_)) && !condition.suits_pictures() {
            return Err(Unsuited {
                place: place.name.clone(),
                condition,
            });
        }
        let grid = place.grid.clone();
        let looker = Looker {
            place,
            condition,
            grid: &grid,
        };
        let indices: Vec<usize> = (0..grid.free.len()).collect();
        let currents = parallel::map(&indices, |index| looker.current(*index), done);
        let goals = grid.lattice(goals);
        let goals = goals.into_iter().filter_map(|index| {
            let view = looker.remembered(index)?;
            Some(Goal { index, view })
        });
        Ok(Self {
            place: place.name.clone(),
            condition,
            goals: goals.collect(),
            currents,
            grid,
        })
    }
}

struct Looker<'a> {
    place: &'a Place,
    condition: Condition,
    grid: &'a Grid,
}

impl Looker<'_> {
    fn remembered(&self, index: usize) -> Option<Luma> {
        if !self.grid.free[index] {
            return None;
        }
        match &self.place.scenery {
            Scenery::Pictures(pictures) => pictures.view(index, 0.0),
            Scenery::World(world) => {
                let stand = self.stand(index);
                Some(render::view(world, &stand, &self.furniture(0.0)))
            }
        }
    }

    fn current(&self, index: usize) -> Option<Current> {
        if !self.grid.free[index] {
            return None;
        }
        // Each position draws from a stream of its own.
        let mut random = Normal::new(SEED, index as u64);
        let mut within = |bound: f32| bound * (2.0 * random.uniform() as f32 - 1.0);
        let turn_rad = within(self.condition.heading_deg().to_radians());
        let mut view = match &self.place.scenery {
            Scenery::Pictures(pictures) => pictures.view(index, turn_rad)?,
            Scenery::World(world) => self.rendered(world, index, turn_rad, &mut within),
        };
        if let Condition::Noise(luma) = self.condition {
            let mut noise = Normal::new(SEED + 1, index as u64);
            for value in &mut view {
                *value += luma * noise.sample() as f32;
            }
        }
        Some(Current { view, turn_rad })
    }

    fn rendered(
        &self,
        world: &World,
        index: usize,
        turn_rad: f32,
        within: &mut impl FnMut(f32) -> f32,
    ) -> Luma {
        let mut stand = Stand {
            turn_rad,
            ..self.stand(index)
        };
        let mut extras = self.furniture(MOVED_M);
        match self.condition {
            Condition::Tilt(degrees) => {
                stand.tilt_rad = [0, 1].map(|_| within(degrees.to_radians()))
            }
            Condition::Height(metres) => stand.position_m[2] += metres,
            Condition::Person => {
                let bearing = within(0.5 * TAU);
                let [near_m, far_m] = WALKS_BY_M;
                let away_m = 0.5 * (near_m + far_m) + within(0.5 * (far_m - near_m));
                let [x, y, _] = stand.position_m;
                extras.pillars.push(Pillar {
                    at_m: [
                        x + away_m * libm::cosf(bearing),
                        y + away_m * libm::sinf(bearing),
                    ],
                    radius_m: PERSON_M[0],
                    height_m: PERSON_M[1],
                    radiance: CLOTHES,
                });
            }
            Condition::Light(share) => {
                let [low_m, high_m] = self.corners_m();
                extras.light = Some(SideLight {
                    middle_m: [0, 1].map(|axis: usize| 0.5 * (low_m[axis] + high_m[axis])),
                    reach_m: 0.5 * libm::hypotf(high_m[0] - low_m[0], high_m[1] - low_m[1]),
                    share,
                });
            }
            Condition::None
            | Condition::Heading(_)
            | Condition::Noise(_)
            | Condition::Furniture => {}
        }
        render::view(world, &stand, &extras)
    }

    fn stand(&self, index: usize) -> Stand {
        let [x, y] = self.grid.position_m(index);
        Stand {
            position_m: [x, y, EYE_M],
            turn_rad: 0.0,
            tilt_rad: [0.0; 2],
        }
    }

    fn corners_m(&self) -> [[f32; 2]; 2] {
        [0, self.grid.free.len() - 1].map(|index| self.grid.position_m(index))
    }

    /// Cupboards and plants along the edges, each moved along its edge by so many metres.
    fn furniture(&self, moved_m: f32) -> Extras {
        if self.condition != Condition::Furniture {
            return Extras::default();
        }
        let [low_m, high_m] = self.corners_m();
        let mut random = Normal::new(SEED + 2, 0);
        let pillars = (0..FURNITURE).map(|number| {
            let mut uniform = || random.uniform() as f32;
            let along_axis = number % 2;
            let across_axis = 1 - along_axis;
            let [low, high] = [low_m[along_axis], high_m[along_axis]];
            // Backwards where there is no room ahead.
            let start = low + (high - low) * uniform();
            let along = if start + moved_m > high {
                start - moved_m
            } else {
                start + moved_m
            };
            let mut at_m = [0.0; 2];
            at_m[along_axis] = along;
            at_m[across_axis] = if number % 4 < 2 {
                low_m[across_axis] - FROM_THE_EDGE_M
            } else {
                high_m[across_axis] + FROM_THE_EDGE_M
            };
            Pillar {
                at_m,
                radius_m: 0.15 + 0.25 * uniform(),
                height_m: 0.7 + 1.2 * uniform(),
                radiance: 0.05 + 0.6 * uniform(),
            }
        });
        Extras {
            pillars: pillars.collect(),
            light: None,
        }
    }
}
