//! At a snapshot: homing, arriving and realigning.

use nalgebra::Point2;

use super::{Context, Follower, Phase, by_odometry};
use crate::homing::NoVectorReason;
use crate::navigator::homing_run::{Ending, HomingRun, is_of_another_place};
use crate::navigator::step::{Event, SetPoint, Step};
use crate::route::Route;

/// What homing has seen in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sight {
    /// The snapshot's place.
    Place,
    /// Something that does not tell.
    Unclear,
    /// Another place.
    OtherPlace,
    /// Nothing: a covered camera, or darkness.
    Nothing,
}

impl Sight {
    /// What a run has seen that ends without a vector to be trusted.
    pub(super) fn without_vector(run: &HomingRun) -> Self {
        match run.failure() {
            Some(NoVectorReason::NoView | NoVectorReason::NoContrast) => Self::Nothing,
            Some(NoVectorReason::OtherPlace) => Self::OtherPlace,
            Some(NoVectorReason::NotFinite | NoVectorReason::IllConditioned) | None => {
                Self::Unclear
            }
        }
    }
}

impl Follower {
    /// One step of homing.
    pub(super) fn home(
        &mut self,
        mut run: HomingRun,
        done: bool,
        context: &mut Context,
        step: &mut Step,
    ) -> SetPoint {
        let Some(top) = context.route.top_snapshot() else {
            return by_odometry(run.target(), context.pose);
        };
        let set_point = run.step(
            context.parameters,
            &top.view,
            context.pose,
            (context.view, context.seen_from),
            step,
        );
        self.phase = Phase::Homing { run, done };
        let ending = ending(self.stays, context);
        match run.arrival(context.parameters, (context.now_ms, context.pose), &ending) {
            Some(by) if !done && may_realign(context) => {
                step.report(Event::Arrived { by });
                self.leave(&run, set_point, context, step)
            }
            _ => set_point,
        }
    }

    /// Ends homing: realigns the pose if that is possible, and consumes the snapshot.
    fn leave(
        &mut self,
        run: &HomingRun,
        set_point: SetPoint,
        context: &mut Context,
        step: &mut Step,
    ) -> SetPoint {
        match self.sight(run, context) {
            Sight::Place => self.realign(run, context, step),
            sight => {
                self.miss(run, sight, context, step);
                set_point
            }
        }
    }

    /// What was seen of the snapshot in the end.
    fn sight(&self, run: &HomingRun, context: &Context) -> Sight {
        let elsewhere = || {
            let top = context.route.top_snapshot();
            top.zip(context.view)
                .is_some_and(|(top, view)| is_of_another_place(context.parameters, &top.view, view))
        };
        if run.is_trustworthy() {
            // Who tells the drone to stay says where it is.
            if !self.stays && elsewhere() {
                Sight::OtherPlace
            } else {
                Sight::Place
            }
        } else {
            Sight::without_vector(run)
        }
    }

    /// Goes on from the snapshot with the pose that it was taken at.
    fn realign(&mut self, run: &HomingRun, context: &mut Context, step: &mut Step) -> SetPoint {
        // Without odometry nobody knows where the snapshot was taken, but the heading is known.
        let estimate = context.pose.position;
        let recorded = recorded_position(context.route);
        // The drone leaves short of the snapshot, but knows how far: that counts in its true place.
        let here = recorded
            .zip(run.place(context.parameters))
            .map_or(estimate, |(recorded, place)| recorded + (estimate - place));
        if !self.stays {
            context.route.pop_snapshot();
        }
        let correction =
            context
                .realigner
                .realign(context.now_ms, context.pose, here, run.rotation());
        step.report(Event::Realigned {
            index: correction.index,
        });
        step.correction = Some(correction);
        self.other_places = 0;
        self.unseen_m = 0.0;
        self.heading_is_known = true;
        // The next leg begins at the snapshot and makes up for that; home is where homing has led to.
        let at = if context.route.is_empty() {
            here
        } else {
            recorded.unwrap_or(estimate)
        };
        self.phase = Phase::Settling {
            since_ms: context.now_ms,
            correction,
            at,
        };
        by_odometry(at, context.pose)
    }
}

/// When homing at the last snapshot may end.
fn ending(stays: bool, context: &Context) -> Ending {
    let parameters = context.parameters;
    if stays {
        // It may have begun far away: it takes as long as it takes.
        Ending {
            time_limit_ms: None,
            radius_m: Some(parameters.arrival_radius_m),
        }
    } else if context.route.snapshots().len() == 1 {
        // At home precision matters and nothing follows: the drone takes all its time.
        Ending {
            time_limit_ms: Some(parameters.final_homing_time_ms),
            radius_m: None,
        }
    } else if context.route.top_is_visual_only() {
        // Nothing but homing takes the drone along: leaving as early as after an odometry leg would
        // leave it behind.
        Ending {
            time_limit_ms: Some(parameters.sequence_homing_time_ms),
            radius_m: Some(parameters.sequence_arrival_radius_m),
        }
    } else {
        Ending {
            time_limit_ms: Some(parameters.homing_time_ms),
            radius_m: Some(parameters.arrival_radius_m),
        }
    }
}

/// Whether a realignment now would not follow too soon on the last.
fn may_realign(context: &Context) -> bool {
    context
        .realigner
        .is_ready(context.parameters, context.now_ms)
}

/// Where the last snapshot was taken, as far as the vectors tell.
pub(super) fn recorded_position(route: &Route) -> Option<Point2<f32>> {
    route
        .top_snapshot_position()
        .filter(|_| route.top_position_is_known())
}
