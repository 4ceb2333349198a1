//! Homing by searching for the move that makes the views alike (Franz, Schölkopf, Mallot & Bülthoff
//! 1998; the paper's "Search", on a grid of bearings and distances).
//!
//! A thing that would be seen at bearing θ after a move by ρ towards α is seen now at
//! θ - asin(ρ sin(θ - α)): exact on the circle of equal distance.

use core::f32::consts::TAU;

use super::grey::{self, Curve, LowPass, Pixels};
use super::{Homeward, HomingMethod, LEAST_VARIANCE, Luma, Memory};
use crate::homing::NoVectorReason;
use crate::horizon::BEARINGS;
use nalgebra::Vector2;

/// Distances that are tried at most.
const MOST_DISTANCES: usize = 8;

/// The step of the rotation search, radians: 10 degrees, as the directions have.
const ROTATION_STEP_RAD: f32 = TAU / 36.0;

/// Lines of sight for each pixel of a memory when the whole current view is warped.
const SIGHTS_PER_PIXEL: usize = 4;

/// What is warped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolution {
    /// The current view with no more pixels than the memory has.
    Memory,
    /// All 128 bearings of the current view.
    Full,
}

/// What can be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchParameters {
    /// Pixels and bytes of a memory.
    pub pixels: u8,
    /// Frequencies of the memory's pixels that are compared; as many as there are at most.
    pub low_pass: u8,
    /// Directions tried.
    pub directions: u8,
    /// Distances tried, evenly up to the farthest; at most 8.
    pub distances: u8,
    /// The farthest of them, in units of the surroundings' distance; below 1.
    pub farthest: f32,
    /// Rotations of 10 degrees tried to either side; 0 trusts the heading.
    pub rotations: u8,
    /// What is warped.
    pub resolution: Resolution,
}

/// Homing by searching.
#[derive(Clone, Debug)]
pub struct Search {
    parameters: SearchParameters,
    filter: LowPass,
    /// asin(ρ sin φ) by distance and by φ = 2πn / 128, radians.
    shifts: [[f32; BEARINGS]; MOST_DISTANCES],
}

impl Search {
    /// A method of these parameters; its warp tables are computed here.
    pub fn new(parameters: SearchParameters) -> Self {
        let distances = parameters.distances.clamp(1, MOST_DISTANCES as u8);
        let parameters = SearchParameters {
            distances,
            directions: parameters.directions.max(1),
            farthest: parameters.farthest.clamp(0.0, 0.99),
            ..parameters
        };
        let shifts = core::array::from_fn(|index| {
            let distance = parameters.distance(index).min(parameters.farthest);
            core::array::from_fn(|n| {
                let bearing = TAU * n as f32 / BEARINGS as f32;
                libm::asinf(distance * libm::sinf(bearing))
            })
        });
        Self {
            parameters,
            filter: LowPass::new(grey::count(parameters.pixels), parameters.low_pass),
            shifts,
        }
    }

    /// Its parameters, as far as they could be met.
    pub const fn parameters(&self) -> SearchParameters {
        self.parameters
    }

    /// The difference between the memory and the view after a move, both without their means.
    fn difference(&self, seen: &[f32], stored: &Pixels, guess: &Guess) -> f32 {
        let [mut sum, mut squares] = [0.0; 2];
        let sights = match self.parameters.resolution {
            Resolution::Memory => 1,
            Resolution::Full => SIGHTS_PER_PIXEL,
        };
        let step = TAU / (stored.len() * sights) as f32;
        let first = guess.rotation - 0.5 * step * (sights - 1) as f32;
        for (n, stored) in stored.iter().enumerate() {
            let mut luma = 0.0;
            for sight in 0..sights {
                let bearing = first + step * (n * sights + sight) as f32;
                luma += self.warped(seen, bearing, guess);
            }
            let difference = luma / sights as f32 - stored;
            sum += difference;
            squares += difference * difference;
        }
        squares - sum * sum / stored.len() as f32
    }

    /// Luma at a bearing after the move.
    fn warped(&self, seen: &[f32], bearing: f32, guess: &Guess) -> f32 {
        let shift = ring(&self.shifts[guess.distance], bearing - guess.direction);
        ring(seen, bearing - shift)
    }
}

impl SearchParameters {
    fn distance(&self, index: usize) -> f32 {
        self.farthest * (index + 1) as f32 / f32::from(self.distances)
    }
}

/// A move and a turn that are tried.
#[derive(Clone, Copy)]
struct Guess {
    direction: f32,
    distance: usize,
    rotation: f32,
}

/// A ring of values at a bearing, by linear interpolation.
fn ring(values: &[f32], bearing: f32) -> f32 {
    let count = values.len() as i32;
    let place = bearing * (count as f32 / TAU);
    let towards_zero = place as i32;
    let below = towards_zero - i32::from(towards_zero as f32 > place);
    // Most are on the ring already, and a division takes as long as all the rest.
    let index = if (0..count).contains(&below) {
        below
    } else {
        below.rem_euclid(count)
    };
    let next = if index + 1 == count { 0 } else { index + 1 };
    let [value, next] = [index, next].map(|index| values[index as usize]);
    value + (next - value) * (place - below as f32)
}

impl HomingMethod for Search {
    /// A ring of grey values.
    type Seen = heapless::Vec<f32, BEARINGS>;

    fn bytes(&self) -> usize {
        grey::count(self.parameters.pixels)
    }

    fn remember(&self, view: &Luma) -> Memory {
        grey::to_bytes(&grey::pixels(view, self.bytes()))
    }

    fn see(&self, view: &Luma) -> Self::Seen {
        match self.parameters.resolution {
            Resolution::Full => view.iter().copied().collect(),
            Resolution::Memory => {
                let Curve { value, .. } = self.filter.curve(&grey::pixels(view, self.bytes()));
                value.iter().copied().collect()
            }
        }
    }

    fn home(&self, seen: &Self::Seen, memory: &Memory) -> Result<Homeward, NoVectorReason> {
        let Curve { value: stored, .. } =
            self.filter.curve(&grey::from_bytes(memory, self.bytes()));
        let bound = i16::from(self.parameters.rotations);
        let mut best: Option<(f32, Guess)> = None;
        for direction in 0..self.parameters.directions {
            let turn = f32::from(direction) / f32::from(self.parameters.directions);
            for distance in 0..usize::from(self.parameters.distances) {
                for rotation in -bound..=bound {
                    let guess = Guess {
                        direction: TAU * turn,
                        distance,
                        rotation: f32::from(rotation) * ROTATION_STEP_RAD,
                    };
                    let difference = self.difference(seen, &stored, &guess);
                    if best.is_none_or(|(least, _)| difference < least) {
                        best = Some((difference, guess));
                    }
                }
            }
        }
        let (difference, guess) = best.ok_or(NoVectorReason::NotFinite)?;
        let power: f32 = stored.iter().map(|luma| luma * luma).sum();
        if !difference.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        if power < LEAST_VARIANCE * stored.len() as f32 {
            return Err(NoVectorReason::NoContrast);
        }
        let direction = Vector2::new(libm::cosf(guess.direction), libm::sinf(guess.direction));
        Ok(Homeward {
            displacement: direction * self.parameters.distance(guess.distance),
            rotation: guess.rotation,
            quality: (1.0 - difference / power).max(0.0),
        })
    }
}
