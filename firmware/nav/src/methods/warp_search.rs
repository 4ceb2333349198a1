//! A search over exact warps of the whole current view, compared by the few coefficients of the
//! memory, and one step of Fourier homing from the best.
//!
//! In coefficients a warp by ρ straight ahead is a real matrix: with ψ = θ - asin(ρ sin θ),
//!
//! ```text
//! c'_k = Σ_m [ (G_k,m + G_k,-m) Re c_m + i (G_k,m - G_k,-m) Im c_m ],   G_k,m = 1/π ∫ cos(mψ - kθ) dθ over 0..π
//! ```
//!
//! so that the real parts go through 2/π ∫ cos mψ cos kθ and the imaginary ones through
//! 2/π ∫ sin mψ sin kθ. Frequency zero stays out of it. A warp towards α is the same between two
//! rotations. One matrix a distance is all the table there is.

use core::f32::consts::{PI, TAU};

use nalgebra::{Complex, Vector2};

use super::coefficients::{CoefficientCode, Harmonics};
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
/// Samples of the half circle under the integrals.
const SAMPLES: usize = 128;
/// The last step is held to this, in units of the distance.
const POLISH_BOUND: f32 = 0.15;

/// A matrix by column: what each frequency of the current view adds to all of the moved one.
type Columns = [[f32; MOST_COMPARED]; IN];

/// Sums that are carried at once while a view is warped: as many as registers hold.
const BLOCK: usize = 8;

/// The lowest coefficients of a moved view.
type Moved = [Complex<f32>; MOST_COMPARED];

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
    /// For the real parts, by distance.
    even: [Columns; DISTANCES],
    /// For the imaginary parts.
    odd: [Columns; DISTANCES],
}

impl WarpSearch {
    /// A method of these parameters; its tables are computed here.
    pub fn new(parameters: WarpParameters) -> Self {
        let mut search = Self {
            parameters,
            weights: quadratic::power_law(parameters.power),
            distances: [0.0; DISTANCES],
            even: [[[0.0; MOST_COMPARED]; IN]; DISTANCES],
            odd: [[[0.0; MOST_COMPARED]; IN]; DISTANCES],
        };
        search.fill();
        search
    }

    /// Takes other parameters. The tables are computed anew only for another farthest move: on the
    /// board, 26 KiB had better stay where they are.
    pub fn adopt(&mut self, parameters: WarpParameters) {
        let same_tables = parameters.farthest == self.parameters.farthest;
        self.weights = quadratic::power_law(parameters.power);
        self.parameters = parameters;
        if !same_tables {
            self.fill();
        }
    }

    fn fill(&mut self) {
        let farthest = self.parameters.farthest.clamp(0.0, 0.99);
        let tables = self.even.iter_mut().zip(&mut self.odd);
        for (index, (distance, (even, odd))) in self.distances.iter_mut().zip(tables).enumerate() {
            *distance = farthest * (index + 1) as f32 / DISTANCES as f32;
            fill(even, odd, *distance);
        }
    }

    /// The moves that are tried, in units of the surroundings' distance.
    pub const fn distances(&self) -> [f32; DISTANCES] {
        self.distances
    }

    fn compared(&self) -> usize {
        self.parameters.code.kept().min(MOST_COMPARED)
    }

    /// The view after a move straight ahead: `count` of its coefficients at least, the rest zero.
    pub(super) fn warped(&self, view: &Harmonics, distance: usize, count: usize) -> Moved {
        let mut moved = [Complex::new(0.0, 0.0); MOST_COMPARED];
        let blocks = count.div_ceil(BLOCK);
        for (block, moved) in moved.chunks_exact_mut(BLOCK).take(blocks).enumerate() {
            let re = product(&self.even[distance], block, view, |c| c.re);
            let im = product(&self.odd[distance], block, view, |c| c.im);
            for (c, (re, im)) in moved.iter_mut().zip(re.into_iter().zip(im)) {
                *c = Complex::new(re, im);
            }
        }
        moved
    }

    /// Tries the rotations of one moved view.
    fn compare(&self, moved: &Moved, stored: &Harmonics, best: &mut Best, at: [u8; 2]) {
        let compared = self.compared();
        let mut power = 0.0;
        let mut product = [Complex::new(0.0, 0.0); MOST_COMPARED];
        for index in 0..compared {
            let weight = self.weights[index];
            power += weight * (moved[index].norm_sqr() + stored.0[index].norm_sqr());
            product[index] = moved[index] * stored.0[index].conj() * weight;
        }
        let product = &mut product[..compared];
        let step = f32::from(self.parameters.rotation_step) * BEARING_STEP_RAD;
        let bound = i16::from(self.parameters.rotations);
        if bound > 0 {
            rotate(product, -f32::from(bound) * step);
        }
        for rotation in -bound..=bound {
            let alike: f32 = product.iter().map(|term| term.re).sum();
            best.offer(power - 2.0 * alike, at, f32::from(rotation) * step);
            if bound > 0 {
                rotate(product, step);
            }
        }
    }
}

/// A block of a matrix times one part of a view's coefficients.
fn product(
    columns: &Columns,
    block: usize,
    view: &Harmonics,
    part: impl Fn(&Complex<f32>) -> f32,
) -> [f32; BLOCK] {
    let mut sums = [0.0; BLOCK];
    for (column, c) in columns.iter().zip(&view.0) {
        let part = part(c);
        let factors = &column[block * BLOCK..(block + 1) * BLOCK];
        for (sum, factor) in sums.iter_mut().zip(factors) {
            *sum += factor * part;
        }
    }
    sums
}

/// The guesses that fit best.
struct Best {
    difference: f32,
    direction: u8,
    distance: u8,
    rotation: f32,
    /// The least difference for each direction.
    by_direction: [f32; DIRECTIONS as usize],
}

impl Best {
    fn offer(&mut self, difference: f32, [direction, distance]: [u8; 2], rotation: f32) {
        let here = &mut self.by_direction[usize::from(direction)];
        *here = here.min(difference);
        if difference < self.difference {
            self.difference = difference;
            self.direction = direction;
            self.distance = distance;
            self.rotation = rotation;
        }
    }

    /// How much worse the best guess is that points more than 90 degrees elsewhere: 0 as good, 1
    /// infinitely worse.
    fn distinctness(&self) -> f32 {
        let quarter = DIRECTIONS / 4;
        let opposite = (quarter + 1..DIRECTIONS - quarter)
            .map(|turn| self.by_direction[usize::from((self.direction + turn) % DIRECTIONS)]);
        let other = opposite.fold(f32::INFINITY, f32::min);
        (1.0 - self.difference / other).clamp(0.0, 1.0)
    }
}

/// The matrices of a warp by `distance`.
fn fill(even: &mut Columns, odd: &mut Columns, distance: f32) {
    *even = [[0.0; MOST_COMPARED]; IN];
    *odd = [[0.0; MOST_COMPARED]; IN];
    let share = 2.0 / SAMPLES as f32;
    for sample in 0..SAMPLES {
        let theta = PI * (sample as f32 + 0.5) / SAMPLES as f32;
        let psi = theta - libm::asinf(distance * libm::sinf(theta));
        let [out, source] =
            [theta, psi].map(|angle| Complex::new(libm::cosf(angle), libm::sinf(angle)));
        let mut wave = source;
        for (even, odd) in even.iter_mut().zip(odd.iter_mut()) {
            let mut echo = out;
            for (even, odd) in even.iter_mut().zip(odd.iter_mut()) {
                *even += share * wave.re * echo.re;
                *odd += share * wave.im * echo.im;
                echo *= out;
            }
            wave *= source;
        }
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
        let mut best = Best {
            difference: f32::INFINITY,
            direction: 0,
            distance: 0,
            rotation: 0.0,
            by_direction: [f32::INFINITY; DIRECTIONS as usize],
        };
        let step = TAU / f32::from(DIRECTIONS);
        let [mut ahead, mut goal] = [*seen, stored];
        for direction in 0..DIRECTIONS {
            for distance in 0..DISTANCES as u8 {
                let moved = self.warped(&ahead, usize::from(distance), self.compared());
                self.compare(&moved, &goal, &mut best, [direction, distance]);
            }
            rotate(&mut ahead.0[..IN], step);
            rotate(&mut goal.0[..MOST_COMPARED], step);
        }
        if !best.difference.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        let angle = f32::from(best.direction) * step;
        let towards = Vector2::new(libm::cosf(angle), libm::sinf(angle));
        let mut found = Homeward {
            displacement: towards * self.distances[usize::from(best.distance)],
            rotation: best.rotation,
            quality: best.distinctness(),
        };
        if self.parameters.polish {
            self.polish(seen, &stored, &best, &mut found);
        }
        Ok(found)
    }
}

impl WarpSearch {
    /// One step of Fourier homing from the best guess. Where the views leave it open, the guess stays.
    fn polish(&self, seen: &Harmonics, stored: &Harmonics, best: &Best, found: &mut Homeward) {
        let angle = f32::from(best.direction) * (TAU / f32::from(DIRECTIONS));
        let mut ahead = *seen;
        rotate(&mut ahead.0[..IN], angle);
        let mut moved = Harmonics::NONE;
        // The gradient of the last frequency leans on the next.
        let count = self.compared() + 1;
        let warped = self.warped(&ahead, usize::from(best.distance), count);
        moved.0[..MOST_COMPARED].copy_from_slice(&warped);
        rotate(&mut moved.0[..MOST_COMPARED], -angle);
        let mut goal = *stored;
        rotate(&mut goal.0[..MOST_COMPARED], -best.rotation);
        let model = Model {
            weights: &self.weights,
            frequencies: self.compared(),
            next_term: self.compared() < MOST_COMPARED,
            with_turn: self.parameters.rotations > 0,
        };
        if let Ok(step) = quadratic::minimum(&model, &moved, &goal) {
            found.displacement += step.xy().cap_magnitude(POLISH_BOUND);
            found.rotation -= step.z;
        }
    }
}
