//! Fourier homing with everything that can be chosen (Stürzl & Mallot 2006): the size of the memory,
//! the weights, the iterations, the unknowns and the coarse rotation.
//!
//! [`homing::home`](crate::homing::home) is this at 8 frequencies of 8 bits with fixed arrays: the
//! fast path that flies.

use core::f32::consts::TAU;

use nalgebra::Vector2;

use super::coefficients::{CoefficientCode, Harmonics};
use super::quadratic::{self, Model, Weights};
use super::{Homeward, HomingMethod, LEAST_VARIANCE, Luma, Memory};
use crate::homing::NoVectorReason;
use crate::horizon::BEARING_STEP_RAD;
use crate::spectrum::rotate;

/// A step beyond this, in units of the distance, is more than the linear model bears.
const STEP_BOUND: f32 = 0.3;

/// What the solution is sought for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknowns {
    /// x and y: the heading is trusted.
    Move,
    /// x, y and a residual turn.
    MoveAndTurn,
}

/// How the views are turned to each other beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// Not at all: the heading is known.
    None,
    /// All rotations within so many steps of 2.8 degrees to either side are tried (the paper's way).
    Tried(u8),
    /// By the phases, from the lowest frequency up (Stürzl & Mallot 2006): each frequency corrects
    /// the estimate by the turn nearest to it, weighted by its power and by k².
    Phases,
}

/// What can be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourierParameters {
    /// The memory.
    pub code: CoefficientCode,
    /// Weights are k^-power; 0 is the plain sum of squared differences.
    pub power: f32,
    /// Solutions; before each further one the current view is moved by the last.
    pub iterations: u8,
    /// Whether the gradient of the last frequency uses its successor in the current view.
    pub next_term: bool,
    /// 2 x 2 or 3 x 3.
    pub unknowns: Unknowns,
    /// The coarse rotation.
    pub alignment: Alignment,
}

/// Fourier homing.
#[derive(Clone, Debug)]
pub struct Fourier {
    parameters: FourierParameters,
    weights: Weights,
}

impl Fourier {
    /// A method of these parameters.
    pub fn new(parameters: FourierParameters) -> Self {
        Self {
            parameters,
            weights: quadratic::power_law(parameters.power),
        }
    }

    /// Its parameters.
    pub const fn parameters(&self) -> FourierParameters {
        self.parameters
    }

    fn model(&self) -> Model<'_> {
        Model {
            weights: &self.weights,
            frequencies: self.parameters.code.kept(),
            next_term: self.parameters.next_term,
            with_turn: self.parameters.unknowns == Unknowns::MoveAndTurn,
        }
    }
}

impl HomingMethod for Fourier {
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
        let model = self.model();
        let mut stored = self.parameters.code.decode(memory);
        check_contrast(seen, &stored, model.frequencies)?;
        let coarse = coarse_rotation(self.parameters.alignment, &model, seen, &stored);
        rotate(&mut stored.0[..model.frequencies], -coarse);

        let mut view = *seen;
        let mut displacement = Vector2::zeros();
        let mut rotation = coarse;
        for _ in 0..self.parameters.iterations.max(1) {
            let minimum = quadratic::minimum(&model, &view, &stored)?;
            let step = minimum.xy().cap_magnitude(STEP_BOUND);
            displacement += step;
            rotation -= minimum.z;
            view = quadratic::moved(&model, &view, step);
            rotate(&mut stored.0[..model.frequencies], minimum.z);
        }
        if !displacement.norm().is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        Ok(Homeward {
            displacement,
            rotation,
            quality: agreement(&model, &view, &stored),
        })
    }
}

/// Refuses views without contrast, and what is no number.
pub(super) fn check_contrast(
    seen: &Harmonics,
    stored: &Harmonics,
    frequencies: usize,
) -> Result<(), NoVectorReason> {
    for view in [seen, stored] {
        let variance = view.variance(frequencies);
        if !variance.is_finite() {
            return Err(NoVectorReason::NotFinite);
        }
        if variance < LEAST_VARIANCE {
            return Err(NoVectorReason::NoContrast);
        }
    }
    Ok(())
}

/// 1 where the views are alike, 0 where they are no more alike than two that have nothing in common:
/// one less the weighted difference over the sum of both powers.
fn agreement(model: &Model<'_>, view: &Harmonics, stored: &Harmonics) -> f32 {
    let [mut difference, mut power] = [0.0; 2];
    for index in 0..model.frequencies {
        let weight = model.weights[index];
        difference += weight * (view.0[index] - stored.0[index]).norm_sqr();
        power += weight * (view.0[index].norm_sqr() + stored.0[index].norm_sqr());
    }
    (1.0 - difference / power).max(0.0)
}

/// How far the stored view's viewer is turned counter-clockwise against the current one, radians.
fn coarse_rotation(
    alignment: Alignment,
    model: &Model<'_>,
    current: &Harmonics,
    stored: &Harmonics,
) -> f32 {
    match alignment {
        Alignment::None => 0.0,
        Alignment::Tried(bound) => best_rotation(bound, model, current, stored),
        Alignment::Phases => rotation_by_phases(model, current, stored),
    }
}

/// argmax over the rotations s of Σ w_k Re(c_k conj(t_k) e^{iks}).
pub(crate) fn best_rotation(
    bound: u8,
    model: &Model<'_>,
    current: &Harmonics,
    stored: &Harmonics,
) -> f32 {
    let bound = i16::from(bound.min(64));
    let mut product = Harmonics::NONE;
    for index in 0..model.frequencies {
        let weight = model.weights[index];
        product.0[index] = current.0[index] * stored.0[index].conj() * weight;
    }
    let product = &mut product.0[..model.frequencies];
    rotate(product, -f32::from(bound) * BEARING_STEP_RAD);
    let mut best = (0, f32::NEG_INFINITY);
    for steps in -bound..=bound {
        let score = product.iter().map(|term| term.re).sum();
        if score > best.1 {
            best = (steps, score);
        }
        rotate(product, BEARING_STEP_RAD);
    }
    f32::from(best.0) * BEARING_STEP_RAD
}

fn rotation_by_phases(model: &Model<'_>, current: &Harmonics, stored: &Harmonics) -> f32 {
    let [mut turn, mut weights] = [0.0_f32; 2];
    for index in 0..model.frequencies {
        let k = (index + 1) as f32;
        let product = stored.0[index] * current.0[index].conj();
        let phase = libm::atan2f(product.im, product.re);
        let turns = libm::roundf((k * turn - phase) / TAU);
        let by_this = (phase + TAU * turns) / k;
        let weight = libm::sqrtf(product.norm_sqr()) * k * k;
        if weight > 0.0 {
            turn = (weights * turn + weight * by_this) / (weights + weight);
            weights += weight;
        }
    }
    turn
}
