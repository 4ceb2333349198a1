//! Homing by searching for the move that makes the views alike (Franz, Schölkopf, Mallot & Bülthoff
//! 1998; the paper's "Search", on a grid of bearings and distances).
//!
//! A thing that would be seen at bearing θ after a move by ρ towards α is seen now at
//! θ - asin(ρ sin(θ - α)): exact on the circle of equal distance.

use core::f32::consts::TAU;

use super::grey::{self, Curve, LowPass, Pixels};
use super::{Homeward, HomingMethod, LEAST_VARIANCE, Luma, MOST_BYTES, Memory};
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
    shifts: [[[f32; 1]; BEARINGS]; MOST_DISTANCES],
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
                [libm::asinf(distance * libm::sinf(bearing))]
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

    /// All moves and turns that are tried.
    pub fn guesses(&self) -> impl Iterator<Item = Guess> + use<> {
        let parameters = self.parameters;
        let bound = i16::from(parameters.rotations);
        (0..parameters.directions).flat_map(move |direction| {
            let turn = f32::from(direction) / f32::from(parameters.directions);
            (0..usize::from(parameters.distances)).flat_map(move |distance| {
                (-bound..=bound).map(move |rotation| Guess {
                    direction: TAU * turn,
                    distance,
                    rotation: f32::from(rotation) * ROTATION_STEP_RAD,
                })
            })
        })
    }

    /// Where each pixel of a memory would look after a move and a turn.
    pub fn gaze(&self, guess: &Guess) -> Gaze {
        let lines = self.lines(guess);
        let all = 0..self.bytes() * lines.per_pixel;
        Gaze {
            sights: all.map(|n| self.sight(guess, &lines, n)).collect(),
            sights_per_pixel: lines.per_pixel,
        }
    }

    fn lines(&self, guess: &Guess) -> Lines {
        let (per_pixel, ring) = match self.parameters.resolution {
            Resolution::Memory => (1, self.bytes()),
            Resolution::Full => (SIGHTS_PER_PIXEL, BEARINGS),
        };
        let step = TAU / (self.bytes() * per_pixel) as f32;
        Lines {
            per_pixel,
            ring,
            step,
            first: guess.rotation - 0.5 * step * (per_pixel - 1) as f32,
        }
    }

    fn sight(&self, guess: &Guess, lines: &Lines, n: usize) -> Sight {
        let bearing = lines.first + lines.step * n as f32;
        let shifts = &self.shifts[guess.distance];
        let [shift] = Sight::at(bearing - guess.direction, BEARINGS).of(shifts);
        Sight::at(bearing - shift, lines.ring)
    }

    /// [`differences`] of one ring, without a buffer: for the board, where a [`Gaze`] costs more than it
    /// saves.
    fn difference(&self, seen: &[[f32; 1]], stored: &Pixels, guess: &Guess) -> f32 {
        let lines = self.lines(guess);
        let [mut sum, mut squares] = [0.0; 2];
        for (n, stored) in stored.iter().enumerate() {
            let mut luma = 0.0;
            for line in n * lines.per_pixel..(n + 1) * lines.per_pixel {
                let [seen] = self.sight(guess, &lines, line).of(seen);
                luma += seen;
            }
            let difference = luma / lines.per_pixel as f32 - stored;
            sum += difference;
            squares += difference * difference;
        }
        squares - sum * sum / stored.len() as f32
    }

    /// The grey values of a memory as they are compared.
    pub fn stored(&self, memory: &Memory) -> Pixels {
        let pixels = grey::from_bytes(memory, self.bytes());
        self.filter.curve(&pixels).value
    }

    /// What the best guess, with its difference from the memory, comes to.
    ///
    /// # Errors
    /// [`NoVectorReason`] where it is no way home.
    pub fn homeward(
        &self,
        (difference, guess): (f32, Guess),
        stored: &Pixels,
    ) -> Result<Homeward, NoVectorReason> {
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

impl SearchParameters {
    fn distance(&self, index: usize) -> f32 {
        self.farthest * (index + 1) as f32 / f32::from(self.distances)
    }
}

/// A move and a turn that are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    direction: f32,
    distance: usize,
    rotation: f32,
}

/// The lines of sight of a guess: how many a pixel has, on a ring of how many values, the angle between
/// them and the first's bearing, radians.
struct Lines {
    per_pixel: usize,
    ring: usize,
    step: f32,
    first: f32,
}

/// The lines of sight on the current view after a move and a turn; the same for all views.
#[derive(Clone, Debug)]
pub struct Gaze {
    sights: heapless::Vec<Sight, { MOST_BYTES * SIGHTS_PER_PIXEL }>,
    sights_per_pixel: usize,
}

impl Gaze {
    /// What the memory's pixels would see of rings of grey values that lie side by side.
    pub fn warped<const RINGS: usize>(&self, seen: &[[f32; RINGS]]) -> Warped<RINGS> {
        let pixels = self.sights.chunks(self.sights_per_pixel).map(|sights| {
            let mut luma = [0.0; RINGS];
            for sight in sights {
                for (luma, seen) in luma.iter_mut().zip(sight.of(seen)) {
                    *luma += seen;
                }
            }
            luma.map(|luma| luma / self.sights_per_pixel as f32)
        });
        pixels.collect()
    }
}

/// Rings of pixels side by side.
pub type Warped<const RINGS: usize> = heapless::Vec<[f32; RINGS], MOST_BYTES>;

/// The differences of rings of pixels from one that is stored, all without their means.
pub fn differences<const RINGS: usize>(warped: &Warped<RINGS>, stored: &Pixels) -> [f32; RINGS] {
    let [mut sum, mut squares] = [[0.0; RINGS]; 2];
    for (warped, stored) in warped.iter().zip(stored) {
        for ring in 0..RINGS {
            let difference = warped[ring] - stored;
            sum[ring] += difference;
            squares[ring] += difference * difference;
        }
    }
    core::array::from_fn(|ring| squares[ring] - sum[ring] * sum[ring] / stored.len() as f32)
}

/// A place between two values of a ring.
#[derive(Clone, Copy, Debug)]
struct Sight {
    index: u16,
    next: u16,
    /// How far it is from the one towards the other.
    part: f32,
}

impl Sight {
    /// At a bearing, on a ring of so many values.
    fn at(bearing: f32, count: usize) -> Self {
        let count = count as i32;
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
        Self {
            index: index as u16,
            next: next as u16,
            part: place - below as f32,
        }
    }

    /// The values there, by linear interpolation.
    fn of<const RINGS: usize>(self, rings: &[[f32; RINGS]]) -> [f32; RINGS] {
        let values = |index: u16| rings.get(usize::from(index)).unwrap_or(&[0.0; RINGS]);
        let [here, next] = [self.index, self.next].map(values);
        core::array::from_fn(|ring| here[ring] + (next[ring] - here[ring]) * self.part)
    }
}

impl HomingMethod for Search {
    /// A ring of grey values.
    type Seen = heapless::Vec<[f32; 1], BEARINGS>;

    fn bytes(&self) -> usize {
        grey::count(self.parameters.pixels)
    }

    fn remember(&self, view: &Luma) -> Memory {
        grey::to_bytes(&grey::pixels(view, self.bytes()))
    }

    fn see(&self, view: &Luma) -> Self::Seen {
        match self.parameters.resolution {
            Resolution::Full => view.iter().map(|luma| [*luma]).collect(),
            Resolution::Memory => {
                let Curve { value, .. } = self.filter.curve(&grey::pixels(view, self.bytes()));
                value.iter().map(|luma| [*luma]).collect()
            }
        }
    }

    fn home(&self, seen: &Self::Seen, memory: &Memory) -> Result<Homeward, NoVectorReason> {
        let stored = self.stored(memory);
        let mut best: Option<(f32, Guess)> = None;
        for guess in self.guesses() {
            let difference = self.difference(seen, &stored, &guess);
            if best.is_none_or(|(least, _)| difference < least) {
                best = Some((difference, guess));
            }
        }
        self.homeward(best.ok_or(NoVectorReason::NotFinite)?, &stored)
    }
}
