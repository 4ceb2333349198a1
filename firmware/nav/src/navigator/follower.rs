//! The way back: popping the stacks, leg by leg.

mod arrival;
mod entry;
pub(super) mod search;

use nalgebra::Point2;

use super::homing_run::HomingRun;
use super::map_entry;
use super::parameters::{Parameters, has_passed};
use super::realignment::Realigner;
use super::step::{Correction, Event, SetPoint, Source, Step};
use crate::pose::Pose;
use crate::route::Route;
use crate::spectrum::Spectrum;

/// Follows from a command until the next.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    /// Stay at the last snapshot instead of consuming the route.
    stays: bool,
    phase: Phase,
    /// The last snapshot has been searched for.
    searched: bool,
    /// Snapshots in a row where the views were of another place.
    other_places: u8,
    /// Way by odometry since the last realignment, metres.
    unseen_m: f32,
    /// Whether the heading was realigned since following began.
    heading_is_known: bool,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    /// Before the first step after a command or, where the drone is known to be `on_its_way`, after a gap.
    Starting { on_its_way: bool },
    /// By odometry towards the route's tip.
    Leg { since_ms: u32 },
    /// At the last snapshot. `done`: it has been reached, and the drone stays.
    Homing { run: HomingRun, done: bool },
    /// Round the place where the last snapshot is expected.
    Searching {
        run: HomingRun,
        expected: Point2<f32>,
    },
    /// Waiting for a correction to take effect.
    Settling {
        since_ms: u32,
        correction: Correction,
        at: Point2<f32>,
    },
    /// Nothing left to do. `told_ms`: when the autopilot was told how much of the route is left; none
    /// where there was no route.
    Holding {
        at: Point2<f32>,
        told_ms: Option<u32>,
    },
}

/// What a step has at hand.
pub(super) struct Context<'a> {
    pub(super) parameters: &'a Parameters,
    pub(super) route: &'a mut Route,
    pub(super) realigner: &'a mut Realigner,
    pub(super) now_ms: u32,
    pub(super) pose: &'a Pose,
    pub(super) view: Option<&'a Spectrum>,
    /// Where the view was seen from.
    pub(super) seen_from: Point2<f32>,
}

impl Follower {
    pub(super) const fn new(stays: bool) -> Self {
        Self {
            stays,
            phase: Phase::Starting { on_its_way: false },
            searched: false,
            other_places: 0,
            unseen_m: 0.0,
            heading_is_known: false,
        }
    }

    pub(super) fn resume(&mut self) {
        if !matches!(self.phase, Phase::Holding { .. } | Phase::Starting { .. }) {
            self.phase = Phase::Starting { on_its_way: true };
            self.heading_is_known = false;
        }
    }

    pub(super) fn step(&mut self, context: &mut Context, step: &mut Step) {
        match self.phase {
            Phase::Starting { on_its_way } => self.start(on_its_way, context, step),
            Phase::Settling { since_ms, at, .. } => {
                let settling_ms = context.parameters.settling_time_ms;
                if has_passed(since_ms, context.now_ms, settling_ms) {
                    self.go_on(at, context, step);
                }
            }
            Phase::Holding {
                at,
                told_ms: Some(told_ms),
            } if has_passed(told_ms, context.now_ms, context.parameters.home_period_ms) => {
                step.map = Some(map_entry(context.route, None));
                self.hold(at, context);
            }
            Phase::Leg { .. }
            | Phase::Homing { .. }
            | Phase::Searching { .. }
            | Phase::Holding { .. } => {}
        }
        if let Phase::Leg { since_ms } = self.phase {
            self.advance(since_ms, context, step);
        }
        step.vector = Some(self.set_point(context, step));
    }

    fn start(&mut self, on_its_way: bool, context: &mut Context, step: &mut Step) {
        let here = context.pose.position;
        if context.route.is_empty() || (self.stays && context.route.snapshots().is_empty()) {
            step.report(Event::RouteEmpty);
            self.phase = Phase::Holding {
                at: here,
                told_ms: None,
            };
        } else if self.stays {
            // It may be far away, and the camera leads; odometry is what is left in the dark.
            let fallback = arrival::recorded_position(context.route).unwrap_or(here);
            self.start_homing(here, fallback, context, step);
        } else if on_its_way || entry::enter(context) {
            self.start_next(here, context, step);
        } else {
            self.stop(here, context, step);
        }
    }

    /// What comes after a snapshot is done with; the drone rests `at`.
    fn go_on(&mut self, at: Point2<f32>, context: &mut Context, step: &mut Step) {
        if self.stays {
            let run = HomingRun::new(context.parameters, context.now_ms, at, at);
            self.phase = Phase::Homing { run, done: true };
        } else if context.route.is_empty() {
            self.finish(at, context, step);
        } else {
            self.start_next(at, context, step);
        }
    }

    /// On to the next snapshot: by sight where no odometry leads there, else by odometry.
    fn start_next(&mut self, at: Point2<f32>, context: &mut Context, step: &mut Step) {
        if context.route.has_snapshot_at_tip() && context.route.top_is_visual_only() {
            self.start_homing(at, at, context, step);
        } else {
            self.start_leg(context, step);
        }
    }

    fn start_leg(&mut self, context: &mut Context, step: &mut Step) {
        self.phase = Phase::Leg {
            since_ms: context.now_ms,
        };
        let entry = map_entry(context.route, None);
        step.report(Event::LegStarted {
            height: entry.odometry_index,
        });
        step.map = Some(entry);
    }

    /// Pops the vectors whose ends are reached, until the next end, a snapshot or home.
    fn advance(&mut self, since_ms: u32, context: &mut Context, step: &mut Step) {
        let reach = context.parameters.acceptance_radius_m;
        let mut popped = false;
        loop {
            let tip = context.route.tip();
            if (context.pose.position - tip).norm() > reach {
                break;
            }
            if context.route.has_snapshot_at_tip() {
                return self.start_homing(tip, tip, context, step);
            }
            let Some(vector) = context.route.pop_vector() else {
                return self.finish(tip, context, step);
            };
            self.unseen_m += vector.metres().norm();
            popped = true;
        }
        if popped {
            self.start_leg(context, step);
        } else if has_passed(since_ms, context.now_ms, context.parameters.leg_time_ms) {
            self.stop(context.route.tip(), context, step);
        }
    }

    /// Homing at the last snapshot, with the set-point at first at `target`, and at `fallback` while
    /// there is no vector.
    fn start_homing(
        &mut self,
        target: Point2<f32>,
        fallback: Point2<f32>,
        context: &mut Context,
        step: &mut Step,
    ) {
        let parameters = context.parameters;
        let mut run = HomingRun::new(parameters, context.now_ms, target, fallback)
            .reaching_out()
            .turned_at_most(self.turn_limit(parameters));
        if context.route.top_is_visual_only() {
            run = run.trusted_after(parameters.few_vectors);
        }
        self.searched = false;
        self.phase = Phase::Homing { run, done: false };
        let snapshot = context
            .route
            .top_snapshot()
            .map(|top| top.view.in_paper_form());
        let entry = map_entry(context.route, snapshot);
        step.report(Event::HomingStarted {
            index: entry.snapshot_index,
        });
        step.map = Some(entry);
    }

    /// How far the drone may be turned against its own estimate, radians. Wider, the rotation search finds
    /// other parts of the room that look alike, and one wrong turn taken for true leads off the route.
    /// Along a visual sequence nobody measures the way since the last realignment: any turn may be.
    fn turn_limit(&self, parameters: &Parameters) -> f32 {
        if self.heading_is_known && self.unseen_m > 0.0 {
            parameters.heading_error_rad + parameters.heading_drift_rad_m * self.unseen_m
        } else {
            f32::INFINITY
        }
    }

    fn finish(&mut self, at: Point2<f32>, context: &Context, step: &mut Step) {
        step.report(Event::RouteFinished);
        self.hold(at, context);
    }

    /// The safe stop of a drone that is lost: it holds where it was sent last, and the autopilot is told,
    /// as at home, what is left of the route. The route stays, for another try.
    fn stop(&mut self, at: Point2<f32>, context: &Context, step: &mut Step) {
        step.report(Event::Lost);
        step.map = Some(map_entry(context.route, None));
        self.hold(at, context);
    }

    fn hold(&mut self, at: Point2<f32>, context: &Context) {
        let told_ms = Some(context.now_ms);
        self.phase = Phase::Holding { at, told_ms };
    }

    fn set_point(&mut self, context: &mut Context, step: &mut Step) -> SetPoint {
        let target = match self.phase {
            Phase::Homing { run, done } => return self.home(run, done, context, step),
            Phase::Searching { run, expected } => {
                return self.search(run, expected, context, step);
            }
            Phase::Settling { correction, at, .. } => {
                step.correction = Some(correction);
                at
            }
            Phase::Holding { at, .. } => at,
            Phase::Leg { .. } | Phase::Starting { .. } => context.route.tip(),
        };
        by_odometry(target, context.pose)
    }
}

fn by_odometry(target: Point2<f32>, pose: &Pose) -> SetPoint {
    SetPoint {
        source: Source::Odometry,
        target,
        start: pose.position,
        delta_yaw: 0.0,
    }
}
