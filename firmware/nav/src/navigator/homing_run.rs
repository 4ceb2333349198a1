//! Homing at one snapshot: from the first view there to arrival.

use nalgebra::Point2;

use super::parameters::{Parameters, has_passed};
use super::place_fit::PlaceFit;
use super::step::{Arrival, Event, SetPoint, Source, Step};
use crate::homing::{self, HomingParameters, HomingVector, NoVectorReason, Resemblance};
use crate::pose::Pose;
use crate::snapshot::StoredView;
use crate::spectrum::Spectrum;

/// Steps without a view, half a second, after which the camera counts as silent.
const CAMERA_IS_SILENT: u8 = 5;

/// The state of homing at one snapshot.
#[derive(Clone, Copy, Debug)]
pub(super) struct HomingRun {
    started_ms: u32,
    /// The target while there is no vector.
    fallback: Point2<f32>,
    /// The farthest of the set-point from there, metres.
    reach_m: f32,
    /// The farthest turn that is believed, radians.
    turn_limit: f32,
    /// Vectors needed before what is seen is trusted.
    least_vectors: u16,
    /// The low-passed set-point.
    target: Point2<f32>,
    /// Where the snapshot is.
    fit: Option<PlaceFit>,
    /// Vectors so far.
    vectors: u16,
    /// Why there is none now.
    failure: Option<NoVectorReason>,
    /// Steps without a view since the last one.
    missing_views: u8,
    least_difference: f32,
    frames_since_least: u16,
}

/// When homing may end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    /// At the latest; none for as long as it takes.
    pub(super) time_limit_ms: Option<u32>,
    /// Nearer than this, metres, it ends as soon as the views say so; none never ends it early.
    pub(super) radius_m: Option<f32>,
}

impl HomingRun {
    /// Homing that begins with the set-point at `target`, and keeps it by `fallback`.
    pub(super) const fn new(
        parameters: &Parameters,
        now_ms: u32,
        target: Point2<f32>,
        fallback: Point2<f32>,
    ) -> Self {
        Self {
            started_ms: now_ms,
            fallback,
            reach_m: parameters.leash_m,
            turn_limit: f32::INFINITY,
            least_vectors: parameters.least_vectors,
            target,
            fit: None,
            vectors: 0,
            failure: None,
            missing_views: 0,
            least_difference: f32::INFINITY,
            frames_since_least: 0,
        }
    }

    /// The same, with as much more reach as the target is away from the fallback at the beginning.
    pub(super) fn reaching_out(mut self) -> Self {
        self.reach_m += (self.target - self.fallback).norm();
        self
    }

    /// The same where the heading is known but for `turn_limit` radians.
    pub(super) const fn turned_at_most(mut self, turn_limit: f32) -> Self {
        self.turn_limit = turn_limit;
        self
    }

    /// The same, to be trusted after `vectors`.
    pub(super) const fn trusted_after(mut self, vectors: u16) -> Self {
        self.least_vectors = vectors;
        self
    }

    /// Takes a view, and where it was seen from, into account and gives the set-point.
    pub(super) fn step(
        &mut self,
        parameters: &Parameters,
        stored: &StoredView,
        pose: &Pose,
        (view, seen_from): (Option<&Spectrum>, Point2<f32>),
        step: &mut Step,
    ) -> SetPoint {
        let homing = self.homing(parameters, pose);
        let vector = view.map(|view| vector(homing, self.turn_limit, stored, view));
        self.take(parameters, (pose, seen_from), vector, step)
    }

    /// The same on a search: the target without a vector is another in each step, and a vector to
    /// another place is none.
    pub(super) fn step_in_search(
        &mut self,
        parameters: &Parameters,
        (stored, place): (&StoredView, Point2<f32>),
        pose: &Pose,
        (view, seen_from): (Option<&Spectrum>, Point2<f32>),
        step: &mut Step,
    ) -> SetPoint {
        self.fallback = place;
        let vector = view.map(|view| {
            if is_of_another_place(parameters, stored, view) {
                Err(NoVectorReason::OtherPlace)
            } else {
                vector(parameters.homing, self.turn_limit, stored, view)
            }
        });
        self.take(parameters, (pose, seen_from), vector, step)
    }

    fn take(
        &mut self,
        parameters: &Parameters,
        (pose, seen_from): (&Pose, Point2<f32>),
        vector: Option<Result<HomingVector, NoVectorReason>>,
        step: &mut Step,
    ) -> SetPoint {
        self.missing_views = match vector {
            Some(_) => 0,
            None => self.missing_views.saturating_add(1),
        };
        match vector {
            Some(Ok(vector)) => {
                self.failure = None;
                self.follow(parameters, seen_from, &vector);
            }
            Some(Err(reason)) => self.fall_back(parameters, reason, step),
            // Frames and steps are not in phase: a single step without a view means nothing.
            None if self.missing_views < CAMERA_IS_SILENT => {}
            None => self.fall_back(parameters, NoVectorReason::NoView, step),
        }
        SetPoint {
            source: if self.failure.is_none() {
                Source::Visual
            } else {
                Source::Odometry
            },
            target: self.target,
            start: pose.position,
            delta_yaw: self.rotation(),
        }
    }

    /// The settings of homing, by how far away odometry has the snapshot.
    fn homing(&self, parameters: &Parameters, pose: &Pose) -> HomingParameters {
        if (pose.position - self.fallback).norm() > parameters.far_m {
            parameters.homing.seen_from_afar()
        } else {
            parameters.homing
        }
    }

    /// Goes towards the fallback, softly, because a single bad view shall not make the drone jump.
    fn fall_back(&mut self, parameters: &Parameters, reason: NoVectorReason, step: &mut Step) {
        if self.failure.replace(reason) != Some(reason) {
            step.report(Event::NoVector { reason });
        }
        self.target += (self.fallback - self.target) * parameters.smoothing;
    }

    fn follow(&mut self, parameters: &Parameters, seen_from: Point2<f32>, vector: &HomingVector) {
        let fit = match self.fit {
            None => PlaceFit::to(seen_from, vector),
            Some(fit) => fit.and(parameters, seen_from, vector),
        };
        self.fit = Some(fit);
        let way = fit.place(parameters) - seen_from;
        let goal = seen_from + way.cap_magnitude(parameters.homing_step_m);
        self.target += (goal - self.target) * parameters.smoothing;
        let strayed = self.target - self.fallback;
        if strayed.norm() > self.reach_m {
            self.target = self.fallback + strayed.cap_magnitude(self.reach_m);
        }
        self.vectors = self.vectors.saturating_add(1);
        if vector.difference < self.least_difference {
            self.least_difference = vector.difference;
            self.frames_since_least = 0;
        } else {
            self.frames_since_least = self.frames_since_least.saturating_add(1);
        }
    }

    /// Whether, and how, homing has ended.
    pub(super) fn arrival(
        &self,
        parameters: &Parameters,
        (now_ms, pose): (u32, &Pose),
        ending: &Ending,
    ) -> Option<Arrival> {
        let is_over = |limit_ms| has_passed(self.started_ms, now_ms, limit_ms);
        if ending.time_limit_ms.is_some_and(is_over) {
            return Some(Arrival::TimeOut);
        }
        let radius_m = ending.radius_m.filter(|_| self.is_trustworthy())?;
        if self.way_m(parameters, pose) < radius_m {
            return Some(Arrival::Near);
        }
        let patience = parameters.frames_without_minimum;
        (patience > 0 && self.frames_since_least >= patience).then_some(Arrival::NoNewMinimum)
    }

    /// Whether what is seen is good enough to realign the pose: it rests on enough views, the newest
    /// among them.
    pub(super) fn is_trustworthy(&self) -> bool {
        self.vectors >= self.least_vectors && self.failure.is_none()
    }

    /// How far away the snapshot looks, metres.
    fn way_m(&self, parameters: &Parameters, pose: &Pose) -> f32 {
        self.place(parameters)
            .map_or(f32::INFINITY, |place| (place - pose.position).norm())
    }

    /// Where the snapshot was taken, by sight, in the coordinates of the estimate.
    pub(super) fn place(&self, parameters: &Parameters) -> Option<Point2<f32>> {
        self.fit.map(|fit| fit.place(parameters))
    }

    /// How far the snapshot's viewer is turned counter-clockwise against the current one, radians.
    pub(super) fn rotation(&self) -> f32 {
        self.fit.map_or(0.0, |fit| fit.rotation())
    }

    /// The set-point.
    pub(super) fn target(&self) -> Point2<f32> {
        self.target
    }

    /// Why there is no vector now.
    pub(super) fn failure(&self) -> Option<NoVectorReason> {
        self.failure
    }

    /// The target while there is no vector.
    pub(super) fn fallback(&self) -> Point2<f32> {
        self.fallback
    }

    /// When it began, milliseconds.
    pub(super) fn started_ms(&self) -> u32 {
        self.started_ms
    }
}

/// The homing vector of a view, or why there is none: a turn beyond the limit is not believed.
fn vector(
    homing: HomingParameters,
    turn_limit: f32,
    stored: &StoredView,
    view: &Spectrum,
) -> Result<HomingVector, NoVectorReason> {
    let homing = homing.turned_at_most(turn_limit);
    let vector = match stored {
        StoredView::Paper(snapshot) => homing::home(view, snapshot, &homing),
        StoredView::Packed(snapshot) => homing::home_packed(view, snapshot, &homing),
    }?;
    if vector.rotation.abs() > turn_limit {
        return Err(NoVectorReason::IllConditioned);
    }
    Ok(vector)
}

/// Whether a view is of another place than the snapshot. False where the views cannot be compared.
pub(super) fn is_of_another_place(
    parameters: &Parameters,
    stored: &StoredView,
    view: &Spectrum,
) -> bool {
    Resemblance::of(view, &stored.in_paper_form(), &parameters.homing)
        .is_ok_and(|seen| seen.difference > parameters.other_place)
}
