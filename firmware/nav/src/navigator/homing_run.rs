//! Homing at one snapshot: from the first view there to arrival.

use nalgebra::{Point2, Vector2};

use super::parameters::{Parameters, has_passed};
use super::step::{Arrival, Event, SetPoint, Source, Step};
use crate::homing::{self, HomingVector, NoVectorReason};
use crate::pose::Pose;
use crate::snapshot::Snapshot;
use crate::spectrum::Spectrum;

/// The state of homing at one snapshot.
#[derive(Clone, Debug)]
pub(super) struct HomingRun {
    started_ms: u32,
    /// Where odometry believes the snapshot: the target while there is no vector.
    fallback: Point2<f32>,
    /// The low-passed set-point.
    target: Point2<f32>,
    /// The low-passed vector.
    filtered: Option<Filtered>,
    /// Vectors so far.
    vectors: u16,
    /// Why the newest view gave none.
    failure: Option<NoVectorReason>,
    least_difference: f32,
    frames_since_least: u16,
}

#[derive(Clone, Copy, Debug)]
struct Filtered {
    offset_m: Vector2<f32>,
    rotation: f32,
}

impl HomingRun {
    pub(super) const fn new(now_ms: u32, fallback: Point2<f32>) -> Self {
        Self {
            started_ms: now_ms,
            fallback,
            target: fallback,
            filtered: None,
            vectors: 0,
            failure: None,
            least_difference: f32::INFINITY,
            frames_since_least: 0,
        }
    }

    /// Takes a view into account and gives the set-point.
    pub(super) fn step(
        &mut self,
        parameters: &Parameters,
        snapshot: &Snapshot,
        pose: &Pose,
        view: Option<&Spectrum>,
        step: &mut Step,
    ) -> SetPoint {
        let homing = view
            .ok_or(NoVectorReason::NoView)
            .and_then(|view| homing::home(view, snapshot, &parameters.homing));
        match homing {
            Ok(vector) => {
                self.failure = None;
                self.follow(parameters, pose, &vector);
            }
            Err(reason) => {
                if self.failure.replace(reason) != Some(reason) {
                    step.report(Event::NoVector { reason });
                }
                // A frame that is merely late leaves the target; a blind view falls back, softly.
                if reason != NoVectorReason::NoView {
                    self.target += (self.fallback - self.target) * parameters.smoothing;
                }
            }
        }
        SetPoint {
            source: if self.failure.is_none() {
                Source::Visual
            } else {
                Source::Odometry
            },
            target: self.target,
            start: pose.position,
            delta_yaw: self.filtered.map_or(0.0, |filtered| filtered.rotation),
        }
    }

    fn follow(&mut self, parameters: &Parameters, pose: &Pose, vector: &HomingVector) {
        let offset_m = vector.displacement * parameters.environment_radius_m;
        let goal = pose.position + offset_m.cap_magnitude(parameters.homing_step_m);
        self.target += (goal - self.target) * parameters.smoothing;
        self.filtered = Some(match self.filtered {
            None => Filtered {
                offset_m,
                rotation: vector.rotation,
            },
            Some(old) => Filtered {
                offset_m: old.offset_m + (offset_m - old.offset_m) * parameters.smoothing,
                rotation: old.rotation + (vector.rotation - old.rotation) * parameters.smoothing,
            },
        });
        self.vectors = self.vectors.saturating_add(1);
        if vector.difference < self.least_difference {
            self.least_difference = vector.difference;
            self.frames_since_least = 0;
        } else {
            self.frames_since_least = self.frames_since_least.saturating_add(1);
        }
    }

    /// Whether, and how, the drone has arrived after `limit_ms`.
    pub(super) fn arrival(
        &self,
        parameters: &Parameters,
        now_ms: u32,
        limit_ms: u32,
    ) -> Option<Arrival> {
        if has_passed(self.started_ms, now_ms, limit_ms) {
            return Some(Arrival::TimeOut);
        }
        if !self.is_trustworthy(parameters) {
            return None;
        }
        if self.offset_m() < parameters.arrival_radius_m {
            return Some(Arrival::Near);
        }
        let patience = parameters.frames_without_minimum;
        (patience > 0 && self.frames_since_least >= patience).then_some(Arrival::NoNewMinimum)
    }

    /// Whether the low-passed vector is good enough to realign the pose: it rests on enough views,
    /// the newest among them.
    pub(super) fn is_trustworthy(&self, parameters: &Parameters) -> bool {
        self.vectors >= parameters.least_vectors && self.failure.is_none()
    }

    /// How far away the snapshot looks, metres.
    pub(super) fn offset_m(&self) -> f32 {
        self.filtered
            .map_or(f32::INFINITY, |filtered| filtered.offset_m.norm())
    }

    /// How far the snapshot's viewer is turned counter-clockwise against the current one, radians.
    pub(super) fn rotation(&self) -> f32 {
        self.filtered.map_or(0.0, |filtered| filtered.rotation)
    }

    /// The set-point.
    pub(super) fn target(&self) -> Point2<f32> {
        self.target
    }
}
