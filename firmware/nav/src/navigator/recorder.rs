//! The way out: pushing odometry vectors and snapshots.

use nalgebra::Point2;

use super::mode::Recording;
use super::parameters::{Parameters, RETURN_SPEED_M_S, THEORY_M};
use super::spacing::{Drift, catchment, deviations_within};
use super::step::{Event, Step};
use crate::pose::Pose;
use crate::route::{Route, RouteFull, VECTOR_SPACING_M};
use crate::spectrum::Spectrum;

/// Records from a command until the next.
#[derive(Clone, Debug)]
pub(super) struct Recorder {
    what: Recording,
    /// The way since the last snapshot up to `corner`, metres, in chords of the vector spacing: so
    /// the jitter of the estimate does not lengthen it.
    way_m: f32,
    /// Where the last chord ended; none before the first step.
    corner: Option<Point2<f32>>,
    /// When the last snapshot was taken, milliseconds.
    since_ms: u32,
    /// From how far away that is found, metres.
    catchment_m: f32,
    /// A snapshot is to be taken of the next view.
    snapshot_due: bool,
    stopped: bool,
}

impl Recorder {
    pub(super) const fn new(what: Recording) -> Self {
        Self {
            what,
            way_m: 0.0,
            corner: None,
            since_ms: 0,
            catchment_m: 0.0,
            // The first snapshot is taken where recording starts.
            snapshot_due: what.snapshots,
            stopped: false,
        }
    }

    pub(super) fn step(
        &mut self,
        parameters: &Parameters,
        route: &mut Route,
        (now_ms, pose): (u32, &Pose),
        view: Option<&Spectrum>,
        step: &mut Step,
    ) {
        if self.stopped {
            return;
        }
        if self.record(parameters, route, (now_ms, pose.position), view, step) == Err(RouteFull) {
            self.stopped = true;
            step.report(Event::RouteFull);
        }
    }

    fn record(
        &mut self,
        parameters: &Parameters,
        route: &mut Route,
        (now_ms, position): (u32, Point2<f32>),
        view: Option<&Spectrum>,
        step: &mut Step,
    ) -> Result<(), RouteFull> {
        if self.corner.is_none() {
            route.begin(position, parameters.snapshot_format);
        }
        if self.what.odometry && (position - route.tip()).norm() >= VECTOR_SPACING_M {
            route.extend_to(position)?;
            step.map = Some(super::map_entry(route, None));
        }
        self.measure(parameters, now_ms, position);
        match view.filter(|view| self.snapshot_due && view.is_finite()) {
            Some(view) => self.take_snapshot(parameters, route, (now_ms, position), view, step),
            None => Ok(()),
        }
    }

    /// Measures the way since the last snapshot, and decides whether the next is due.
    fn measure(&mut self, parameters: &Parameters, now_ms: u32, position: Point2<f32>) {
        let corner = *self.corner.get_or_insert(position);
        let chord = (position - corner).norm();
        if chord >= VECTOR_SPACING_M {
            self.way_m += chord;
            self.corner = Some(position);
        }
        let open_chord = self.corner.map_or(0.0, |corner| (position - corner).norm());
        let way_m = self.way_m + open_chord;
        let is_far = if !self.what.odometry {
            way_m >= parameters.sequence_spacing_m
        } else if parameters.spacing_by_theory {
            self.may_drift_away(parameters, now_ms, way_m)
        } else {
            way_m >= parameters.snapshot_spacing_m
        };
        if self.what.repeats_snapshots() && is_far {
            self.snapshot_due = true;
        }
    }

    /// Whether a drone that is back here may miss the last snapshot. The stored way is off by the drift of
    /// the way out, and the drone by that of the way back.
    fn may_drift_away(&self, parameters: &Parameters, now_ms: u32, way_m: f32) -> bool {
        let (least_m, most_m) = THEORY_M;
        let out_s = now_ms.wrapping_sub(self.since_ms) as f32 * 0.001;
        let sd_m = Drift::DEFAULT.sd_m(way_m, out_s + way_m / RETURN_SPEED_M_S);
        let off_m = sd_m * deviations_within(parameters.catchment_probability);
        way_m >= least_m && (way_m >= most_m || off_m >= self.catchment_m)
    }

    fn take_snapshot(
        &mut self,
        parameters: &Parameters,
        route: &mut Route,
        (now_ms, position): (u32, Point2<f32>),
        view: &Spectrum,
        step: &mut Step,
    ) -> Result<(), RouteFull> {
        if self.what.odometry {
            // The vectors below a snapshot shall end where it is taken, not up to 0.3 m before.
            route.extend_to(position)?;
        }
        let stored = route.push_snapshot(view, parameters.simplify_tolerance_m)?;
        self.snapshot_due = false;
        self.way_m = 0.0;
        self.corner = Some(position);
        self.since_ms = now_ms;
        if parameters.spacing_by_theory {
            let weights = &parameters.homing.weights;
            self.catchment_m = catchment(view, weights) * parameters.environment_radius_m;
        }
        let entry = super::map_entry(route, Some(stored.in_paper_form()));
        step.report(Event::SnapshotTaken {
            index: entry.snapshot_index,
            height: entry.odometry_index,
        });
        step.map = Some(entry);
        Ok(())
    }
}
