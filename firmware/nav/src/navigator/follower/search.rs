//! A snapshot that homing did not find: the search round the place where it is expected, then the next
//! snapshot, then a safe stop.

use nalgebra::{Point2, Vector2};

use super::arrival::Sight;
use super::{Context, Follower, Phase, by_odometry};
use crate::navigator::homing_run::HomingRun;
use crate::navigator::map_entry;
use crate::navigator::parameters::Parameters;
use crate::navigator::step::{Event, SetPoint, Step};

/// The turns of an expanding square search, in spacings, from the expected place on: legs of 1, 1, 2, 2
/// and 2, which look at all of a square of two spacings (IAMSAR Manual, vol. III).
const TURNS: [Vector2<f32>; 6] = [
    Vector2::new(0.0, 0.0),
    Vector2::new(1.0, 0.0),
    Vector2::new(1.0, 1.0),
    Vector2::new(-1.0, 1.0),
    Vector2::new(-1.0, -1.0),
    Vector2::new(1.0, -1.0),
];

impl Follower {
    /// Homing at the last snapshot has not found it: looks round once where there is something to see,
    /// else goes on, unless the drone is lost.
    pub(super) fn miss(
        &mut self,
        run: &HomingRun,
        sight: Sight,
        context: &mut Context,
        step: &mut Step,
    ) {
        // No odometry leads to the snapshots of a visual sequence: nobody expects them anywhere.
        let searchable =
            !context.route.top_is_visual_only() || context.route.snapshots().len() == 1;
        if sight != Sight::Nothing && searchable && !self.searched {
            return self.start_search(run, context, step);
        }
        if sight == Sight::OtherPlace {
            self.other_places = self.other_places.saturating_add(1);
        }
        if self.is_lost(sight, context) {
            return self.stop(run.target(), context, step);
        }
        context.route.pop_snapshot();
        self.go_on(run.target(), context, step);
    }

    /// Whether to stop rather than look for the next snapshot.
    fn is_lost(&self, sight: Sight, context: &Context) -> bool {
        let parameters = context.parameters;
        // Behind the last snapshot there is no other that could tell.
        let home_is_elsewhere = sight == Sight::OtherPlace && context.route.snapshots().len() == 1;
        home_is_elsewhere
            || self.other_places >= parameters.most_other_places
            || self.unseen_m > parameters.farthest_unseen_m
    }

    fn start_search(&mut self, run: &HomingRun, context: &mut Context, step: &mut Step) {
        let expected = run.fallback();
        self.searched = true;
        let run = self
            .anew(run, expected, context)
            .trusted_after(context.parameters.few_vectors);
        self.phase = Phase::Searching { run, expected };
        step.report(Event::SearchStarted {
            index: map_entry(context.route, None).snapshot_index,
        });
    }

    /// Homing from where another run was.
    fn anew(&self, run: &HomingRun, expected: Point2<f32>, context: &Context) -> HomingRun {
        HomingRun::new(context.parameters, context.now_ms, run.target(), expected)
            .turned_at_most(self.turn_limit(context.parameters))
    }

    /// One step of the search.
    pub(super) fn search(
        &mut self,
        mut run: HomingRun,
        expected: Point2<f32>,
        context: &mut Context,
        step: &mut Step,
    ) -> SetPoint {
        let parameters = context.parameters;
        let elapsed_ms = context.now_ms.wrapping_sub(run.started_ms());
        let top = context.route.top_snapshot();
        let Some((offset, top)) = offset(parameters, elapsed_ms).zip(top) else {
            let set_point = by_odometry(run.target(), context.pose);
            let sight = Sight::without_vector(&run);
            self.miss(&run, sight, context, step);
            return set_point;
        };
        let sight = (context.view, context.seen_from);
        let place = expected + offset;
        let set_point =
            run.step_in_search(parameters, (&top.view, place), context.pose, sight, step);
        self.phase = if run.is_trustworthy() {
            let run = self.anew(&run, expected, context);
            Phase::Homing { run, done: false }
        } else {
            Phase::Searching { run, expected }
        };
        set_point
    }
}

/// Where the search leads to after a time, from the expected place; none when it is over.
pub(in crate::navigator) fn offset(
    parameters: &Parameters,
    elapsed_ms: u32,
) -> Option<Vector2<f32>> {
    let mut rest =
        elapsed_ms as f32 * 0.001 * parameters.search_speed_m_s / parameters.search_spacing_m;
    for turns in TURNS.windows(2) {
        let leg = turns[1] - turns[0];
        let length = leg.norm();
        if rest < length {
            return Some((turns[0] + leg * (rest / length)) * parameters.search_spacing_m);
        }
        rest -= length;
    }
    None
}
