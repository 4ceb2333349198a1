//! A search over exact warps of the whole current view, compared by the few coefficients of the
//! memory, and one step of Fourier homing from the best.
//!
//! In coefficients a warp by ρ straight ahead is a real matrix: with ψ = θ - asin(ρ sin θ),
//!
//! ```text
//! c'_k = Σ_m [ G_k,m c_m + G_k,-m conj(c_m) ],   G_k,±m = 1/π ∫ cos(mψ ∓ kθ) dθ over 0..π
//! ```
//!
//! Frequency zero stays out of it. A warp towards α is the same between two rotations, c_m e^{imα}
//! and t_k e^{ikα}. So the difference Σ w_k |c'_k - t_k|² of the moved view from the stored one is, as a
//! function of α, a Fourier series whose coefficients are sums of products of two coefficients, each
//! times a factor that the distance alone decides: the correlation theorem, by which all directions
//! cost little more than one.
//!
//! The products, the sums and the series are in 16 and 32 bits, two products an instruction.

mod series;
mod tables;
mod terms;

use core::f32::consts::TAU;

use nalgebra::{Complex, Vector2};

use self::series::{Multipliers, Products, Sums, Waves};
use self::tables::Factors;
use self::terms::{CROSS, CROSS_PAIRS, HARMONICS, OWN, OWN_PAIRS};
use super::coefficients::{CoefficientCode, Harmonics, MOST_FREQUENCIES};
use super::fourier::check_contrast;
use super::quadratic::{self, Model, Weights};
use super::{Homeward, HomingMethod, Luma, Memory};
use crate::homing::NoVectorReason;
use crate::horizon::BEARING_STEP_RAD;
use crate::spectrum::rotate;

/// Distances in the table.
pub const DISTANCES: usize = 8;
/// Frequencies that are compared at most.
const MOST_COMPARED: usize = 16;
/// Frequencies of the current view that are warped.
const IN: usize = 20;
/// Directions tried: every 10 degrees.
const DIRECTIONS: u8 = 36;
/// The last step is held to this, in units of the distance.
const POLISH_BOUND: f32 = 0.15;

/// What can be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WarpParameters {
    /// The memory; of its frequencies the lowest 16 are compared.
    pub code: CoefficientCode,
    /// Weights are k^-power.
    pub power: f32,
    /// The farthest move tried, in units of the distance; below 1.
    pub farthest: f32,
    /// Rotations of [`rotation_step`](Self::rotation_step) tried to either side; 0 trusts the heading.
    pub rotations: u8,
    /// In steps of 2.8 degrees.
    pub rotation_step: u8,
    /// Whether a step of Fourier homing follows.
    pub polish: bool,
}

/// The search over warps.
#[derive(Clone, Debug)]
pub struct WarpSearch {
    parameters: WarpParameters,
    weights: Weights,
    distances: [f32; DISTANCES],
    /// How many terms of each harmonic count.
    lengths: [u8; HARMONICS],
    /// The same with one frequency more, because the gradient of the last leans on it.
    polish_lengths: [u8; HARMONICS],
    own_lengths: [u8; HARMONICS],
    /// Of the stored view's products with the current one.
    cross: Factors<CROSS_PAIRS>,
    /// Of the current view's products with itself.
    own: Factors<OWN_PAIRS>,
    waves: Waves,
    /// Unit vectors in the directions that are tried.
    bearings: [Complex<f32>; DIRECTIONS as usize],
}

impl WarpSearch {
    /// One that has no tables yet, and finds nothing until it [adopts](Self::adopt) parameters: for
    /// a static, where 19 KiB had better not pass over the stack.
    pub const fn blank() -> Self {
        Self {
            parameters: WarpParameters {
                code: CoefficientCode {
                    frequencies: 1,
                    bits: 8,
                    range: 1.0,
                },
                power: 0.0,
                farthest: f32::NAN,
                rotations: 0,
                rotation_step: 0,
                polish: false,
            },
            weights: [0.0; MOST_FREQUENCIES],
            distances: [0.0; DISTANCES],
            lengths: [0; HARMONICS],
            polish_lengths: [0; HARMONICS],
            own_lengths: [0; HARMONICS],
            bearings: [Complex::new(1.0, 0.0); DIRECTIONS as usize],
            cross: tables::empty(),
            own: tables::empty(),
            waves: Waves::NONE,
        }
    }

    /// A method of these parameters; its tables are computed here.
    pub fn new(parameters: WarpParameters) -> Self {
        let mut search = Self::blank();
        search.adopt(parameters);
        search
    }

    /// Takes other parameters. The larger table is computed anew only for another farthest move.
    pub fn adopt(&mut self, parameters: WarpParameters) {
        let same_moves = parameters.farthest == self.parameters.farthest;
        self.weights = quadratic::power_law(parameters.power);
        self.parameters = parameters;
        if !same_moves {
            self.fill_cross();
        }
        self.fill_own();
    }

    fn fill_cross(&mut self) {
        let farthest = self.parameters.farthest.clamp(0.0, 0.99);
        for (index, distance) in self.distances.iter_mut().enumerate() {
            *distance = farthest * (index + 1) as f32 / DISTANCES as f32;
        }
        self.waves.fill();
        for (direction, bearing) in (0_u8..).zip(&mut self.bearings) {
            let angle = TAU * f32::from(direction) / f32::from(DIRECTIONS);
            *bearing = Complex::new(libm::cosf(angle), libm::sinf(angle));
        }
        self.own_lengths = OWN.up_to(IN);
        tables::fill_cross(&mut self.cross, &self.distances);
    }

    fn fill_own(&mut self) {
        let compared = self.compared();
        self.lengths = CROSS.up_to(compared);
        self.polish_lengths = CROSS.up_to(compared + 1);
        tables::fill_own(&mut self.own, &self.cross, &self.weights, compared);
    }

    /// The moves that are tried, in units of the surroundings' distance.
    pub const fn distances(&self) -> [f32; DISTANCES] {
        self.distances
    }

    /// Its parameters.
    pub const fn parameters(&self) -> WarpParameters {
        self.parameters
    }

    fn compared(&self) -> usize {
        self.parameters.code.kept().min(MOST_COMPARED)
    }

    /// The coefficients that are compared, and one more, of a view after a move straight ahead.
    pub(super) fn warped(&self, view: &Harmonics, distance: usize) -> Harmonics {
        let mut moved = Harmonics::NONE;
        for (harmonic, length) in self.polish_lengths.iter().enumerate() {
            let start = CROSS.places(harmonic).start;
            for place in start..start + usize::from(*length) {
                let term = CROSS.all[place];
                let [row, column] = [term.first, term.second].map(|k| usize::from(k) - 1);
                let c = view.0[column];
                let c = if term.is_apart() { c } else { c.conj() };
                moved.0[row] += c * (tables::counts(&self.cross, place, distance) / tables::ONE);
            }
        }
        moved
    }

    /// Counts per luma, so that neither view has more than can be summed up. None for what is no
    /// number.
    fn scale(&self, seen: &Harmonics, stored: &Harmonics) -> Option<f32> {
        let larger = seen.variance(IN).max(stored.variance(self.compared()));
        let scale = series::SIZE / libm::sqrtf(2.0 * larger);
        (scale > 0.0).then_some(scale)
    }

    /// Tries all moves, with all turns.
    fn try_all(&self, seen: &Harmonics, stored: &Harmonics, scale: f32) -> Best {
        let seen = self.current(seen, scale);
        let mut best = Best::NONE;
        let step = f32::from(self.parameters.rotation_step) * BEARING_STEP_RAD;
        let bound = i16::from(self.parameters.rotations);
        for rotation in -bound..=bound {
            let rotation = f32::from(rotation) * step;
            let common = self.common(&seen.multipliers, stored, rotation, scale);
            for distance in 0..DISTANCES {
                self.waves
                    .differences(&seen.power, &common, distance, |direction, difference| {
                        best.offer(difference, [direction, distance], rotation);
                    });
            }
        }
        best
    }

    /// What does not depend on the stored view.
    fn current(&self, seen: &Harmonics, scale: f32) -> Current {
        let counts = series::counts(&seen.0[..IN], scale);
        let multipliers = Multipliers::of(&counts);
        let products = Products::of(&OWN, &self.own_lengths, &counts, &multipliers);
        Current {
            power: series::sums(&OWN, &self.own_lengths, &products, &self.own),
            multipliers,
        }
    }

    /// What the moved view and the stored one, turned back by `rotation`, have in common.
    fn common(&self, seen: &Multipliers, stored: &Harmonics, rotation: f32, scale: f32) -> Sums {
        let mut goal = *stored;
        for (c, weight) in goal.0.iter_mut().zip(&self.weights) {
            *c *= *weight;
        }
        let goal = &mut goal.0[..self.compared()];
        if rotation != 0.0 {
            rotate(goal, -rotation);
        }
        let counts = series::counts(goal, scale);
        let products = Products::of(&CROSS, &self.lengths, &counts, seen);
        series::sums(&CROSS, &self.lengths, &products, &self.cross)
    }

    /// Σ w_k |c_k|² of a stored view.
    fn weighted_power(&self, stored: &Harmonics) -> f32 {
        let weighted = stored.0.iter().zip(&self.weights).take(self.compared());
        weighted.map(|(c, weight)| weight * c.norm_sqr()).sum()
    }

    /// One step of Fourier homing from the best guess. Where the views leave it open, the guess stays.
    fn polish(&self, seen: &Harmonics, stored: &Harmonics, best: &Best, found: &mut Homeward) {
        let bearing = self.bearings[best.direction];
        let mut ahead = *seen;
        turn(&mut ahead.0[..IN], bearing);
        let mut moved = self.warped(&ahead, best.distance);
        turn(&mut moved.0[..terms::ROWS], bearing.conj());
        let mut goal = *stored;
        if best.rotation != 0.0 {
            rotate(&mut goal.0[..MOST_COMPARED], -best.rotation);
        }
        let model = Model {
            weights: &self.weights,
            frequencies: self.compared(),
            next_term: true,
            with_turn: self.parameters.rotations > 0,
        };
        if let Ok(step) = quadratic::minimum(&model, &moved, &goal) {
            found.displacement += step.xy().cap_magnitude(POLISH_BOUND);
            found.rotation -= step.z;
        }
        // Nearer to here than to any guess the view itself is what to step from.
        if found.displacement.norm() < 0.5 * self.distances[0]
            && let Ok(step) = quadratic::minimum(&model, seen, &goal)
        {
            found.displacement = step.xy().cap_magnitude(POLISH_BOUND);
            found.rotation = best.rotation - step.z;
        }
    }
}

/// The current view as the search takes it.
struct Current {
    multipliers: Multipliers,
    /// The weighted power after a move.
    power: Sums,
}

#[cfg(test)]
impl WarpSearch {
    /// The differences of a view, moved by a distance in every direction, from a stored one, luma².
    pub(super) fn differences(
        &self,
        seen: &Harmonics,
        stored: &Harmonics,
        distance: usize,
    ) -> [f32; DIRECTIONS as usize] {
        let scale = self.scale(seen, stored).unwrap();
        let stored_power = self.weighted_power(stored);
        let mut found = [0.0; DIRECTIONS as usize];
        let seen = self.current(seen, scale);
        let common = self.common(&seen.multipliers, stored, 0.0, scale);
        self.waves
            .differences(&seen.power, &common, distance, |direction, difference| {
                let difference = difference as f32 / series::counts_per_square_luma(scale);
                found[direction] = difference + stored_power;
            });
        found
    }
}

/// Turns the viewer of c_1, c_2, ... by the angle of a unit vector.
fn turn(coefficients: &mut [Complex<f32>], by: Complex<f32>) {
    let mut power = by;
    for coefficient in coefficients {
        *coefficient *= power;
        power *= by;
    }
}

/// The guesses that fit best.
struct Best {
    /// In counts, less the power of the stored view.
    difference: i32,
    direction: usize,
    distance: usize,
    rotation: f32,
    /// The least difference for each direction.
    by_direction: [i32; DIRECTIONS as usize],
}

impl Best {
    const NONE: Self = Self {
        difference: i32::MAX,
        direction: 0,
        distance: 0,
        rotation: 0.0,
        by_direction: [i32::MAX; DIRECTIONS as usize],
    };

    fn offer(&mut self, difference: i32, [direction, distance]: [usize; 2], rotation: f32) {
        let here = &mut self.by_direction[direction];
        *here = difference.min(*here);
        if difference < self.difference {
            self.difference = difference;
            self.direction = direction;
            self.distance = distance;
            self.rotation = rotation;
        }
    }

    /// How much worse the best guess is that points more than 90 degrees elsewhere: 0 as good, 1
    /// infinitely worse. `stored` is the power of the stored view, counts.
    fn distinctness(&self, stored: f32) -> f32 {
        let directions = usize::from(DIRECTIONS);
        let opposite = (directions / 4 + 1..directions - directions / 4)
            .map(|turn| self.by_direction[(self.direction + turn) % directions]);
        let [this, other] = [self.difference, opposite.fold(i32::MAX, i32::min)]
            .map(|difference| (difference as f32 + stored).max(1.0));
        (1.0 - this / other).clamp(0.0, 1.0)
    }
}

impl HomingMethod for WarpSearch {
    type Seen = Harmonics;

    fn bytes(&self) -> usize {
        self.parameters.code.bytes()
    }

    fn remember(&self, view: &Luma) -> Memory {
        self.parameters.code.encode(&Harmonics::of(view))
    }

    fn see(&self, view: &Luma) -> Harmonics {
        Harmonics::of(view)
    }

    fn home(&self, seen: &Harmonics, memory: &Memory) -> Result<Homeward, NoVectorReason> {
        let stored = self.parameters.code.decode(memory);
        check_contrast(seen, &stored, self.compared())?;
        let scale = self.scale(seen, &stored).ok_or(NoVectorReason::NotFinite)?;
        let best = self.try_all(seen, &stored, scale);
        let bearing = self.bearings[best.direction];
        let towards = Vector2::new(bearing.re, bearing.im);
        let power = self.weighted_power(&stored) * series::counts_per_square_luma(scale);
        let mut found = Homeward {
            displacement: towards * self.distances[best.distance],
            rotation: best.rotation,
            quality: best.distinctness(power),
        };
        if self.parameters.polish {
            self.polish(seen, &stored, &best, &mut found);
        }
        Ok(found)
    }
}
