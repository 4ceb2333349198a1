//! The autoexposure over the whole grid of conditions: every light, initial setting, latency and gamma, in scenes that
//! fool a meter.
//!
//! The pieces are the real ones: the emulated TCM8230MD's registers, latching and latency; its pixels, noise and luma
//! chain; the lens map and the controller as the firmware's pilot runs them. The camera stands still, so a scene is
//! rendered once, and the light on the sensor turned up and down.
//!
//! Frames count from the first that the controller sees: frame 1 shows the initial setting. A condition is met if frame
//! 10 and all after it hold 80 +- 3. That luma is not the controller's own: it is the mean of all pixels that look up to
//! 17 degrees above or below the horizon, by the fake lens.

mod condition;
mod eye;
mod plot;
mod scene;

pub use condition::{Condition, Grid};
pub use eye::expose;
pub use plot::picture;
pub use scene::Scene;

use serde::Serialize;

/// The mean luma that is to be held (paper, "Image processing").
pub const SET_POINT: f64 = 80.0;
/// How far from it the mean luma may be.
pub const TOLERANCE: f64 = 3.0;
/// The frame from which on it has to be held.
pub const DEADLINE: usize = 10;
/// Frames that are looked at: long enough to see an oscillation.
pub const FRAMES: usize = 30;

/// What happened in one condition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The condition.
    pub condition: Condition,
    /// Whether the darkest setting is not too bright for it and the brightest not too dark.
    pub is_reachable: bool,
    /// Mean luma of the horizon band on frames 1, 2, ...
    pub lumas: Vec<f64>,
}

impl Outcome {
    /// The frame from which on the luma is held, counted from 1. One more than were looked at if it never is.
    pub fn frames(&self) -> usize {
        let misses = |luma: &f64| (luma - SET_POINT).abs() > TOLERANCE;
        self.lumas
            .iter()
            .rposition(misses)
            .map_or(1, |last| last + 2)
    }

    /// The greatest distance from the set-point at the deadline and after it, luma.
    pub fn error(&self) -> f64 {
        let held = self.lumas.iter().skip(DEADLINE - 1);
        held.map(|luma| (luma - SET_POINT).abs())
            .fold(0.0, f64::max)
    }

    fn is_settled(&self) -> bool {
        self.is_reachable && self.lumas.len() >= DEADLINE && self.frames() <= DEADLINE
    }
}

/// What happened over the grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Conditions that were tried.
    pub conditions: usize,
    /// Those in which frame 10 and all after it hold 80 +- 3.
    pub settled_within_10: usize,
    /// Those in which no setting could. The grid is laid so that there are none; they would count as not met.
    pub unreachable: usize,
    /// The frame from which on the slowest condition holds.
    pub worst_frames: usize,
    /// The greatest distance from 80 at frame 10 and after, luma.
    pub worst_error: f64,
}

impl Verdict {
    /// Sums up.
    pub fn of(outcomes: &[Outcome]) -> Self {
        let count =
            |is: fn(&Outcome) -> bool| outcomes.iter().filter(|outcome| is(outcome)).count();
        Self {
            conditions: outcomes.len(),
            settled_within_10: count(Outcome::is_settled),
            unreachable: count(|outcome| !outcome.is_reachable),
            worst_frames: outcomes.iter().map(Outcome::frames).max().unwrap_or(0),
            worst_error: outcomes.iter().map(Outcome::error).fold(0.0, f64::max),
        }
    }

    /// Whether every condition is met.
    pub fn holds(&self) -> bool {
        self.conditions > 0 && self.settled_within_10 == self.conditions
    }
}

/// The outcomes from the worst on: latest first, of those that settle on the same frame the one with the greatest error.
pub fn worst(outcomes: &[Outcome], count: usize) -> Vec<&Outcome> {
    let mut sorted: Vec<&Outcome> = outcomes.iter().collect();
    sorted.sort_by(|a, b| {
        let by_frames = b.frames().cmp(&a.frames());
        by_frames.then(b.error().total_cmp(&a.error()))
    });
    sorted.truncate(count);
    sorted
}

#[cfg(test)]
mod tests;
