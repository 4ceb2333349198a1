//! The way out: pushing odometry vectors and snapshots, as long as there is room and beyond.
//!
//! | what is full | what is done |
//! |---|---|
//! | snapshots | every second is dropped, and from now on they are twice as far apart: up to 10 m |
//! | snapshots that are that far apart, or spaced by theory | no more of them are taken: odometry goes on alone |
//! | vectors | the way since the last snapshot is simplified |
//! | vectors of a way that is simple already, or a visual sequence | recording ends |

use nalgebra::Point2;

use super::mode::Recording;
use super::parameters::{Parameters, RETURN_SPEED_M_S, THEORY_M};
use super::spacing::{Drift, catchment, deviations_within};
use super::step::{Event, Step};
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
    /// How often the route was thinned out: so often is the way between snapshots doubled.
    thinned: u8,
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
            thinned: 0,
            stopped: false,
        }
    }

    /// Whether the way is stored, in the coordinates of the estimate.
    pub(super) const fn stores_odometry(&self) -> bool {
        self.what.odometry
    }

    pub(super) fn step(
        &mut self,
        parameters: &Parameters,
        route: &mut Route,
        now: (u32, Point2<f32>),
        view: Option<&Spectrum>,
        step: &mut Step,
    ) {
        if self.stopped {
            return;
        }
        if self.record(parameters, route, now, view, step) == Err(RouteFull) {
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
            extend(parameters, route, position)?;
            step.map = Some(super::map_entry(route, None));
        }
        self.measure(parameters, now_ms, position);
        let Some(view) = view.filter(|view| self.snapshot_due && view.is_finite()) else {
            return Ok(());
        };
        if route.snapshots().is_full() && !self.make_room(parameters, route, step) {
            if !self.what.odometry {
                return Err(RouteFull);
            }
            self.what.snapshots = false;
            self.snapshot_due = false;
            step.report(Event::SnapshotsFull);
            return Ok(());
        }
        self.take_snapshot(parameters, route, (now_ms, position), view, step)
    }

    /// Whether there is room for another snapshot now: half as many lead home along the same way, as long as
    /// they are no farther apart than theory ever lets them be.
    fn make_room(&mut self, parameters: &Parameters, route: &mut Route, step: &mut Step) -> bool {
        let (_, most_m) = THEORY_M;
        let is_dense = !parameters.spacing_by_theory && 2.0 * self.spacing_m(parameters) <= most_m;
        if !(is_dense && self.what.odometry && route.thin_out()) {
            return false;
        }
        self.thinned += 1;
        let entry = super::map_entry(route, None);
        step.report(Event::ThinnedOut {
            last: entry.snapshot_index,
        });
        true
    }

    /// The way between two snapshots along odometry, where it is fixed, metres.
    fn spacing_m(&self, parameters: &Parameters) -> f32 {
        let doubled = 1_u8.checked_shl(self.thinned.into()).unwrap_or(u8::MAX);
        parameters.snapshot_spacing_m * f32::from(doubled)
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
            way_m >= self.spacing_m(parameters)
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
            extend(parameters, route, position)?;
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

/// Stores the way to `position`, and where there is no room for it makes some.
#[inline(never)] // Flash counts more than cycles here.
fn extend(
    parameters: &Parameters,
    route: &mut Route,
    position: Point2<f32>,
) -> Result<(), RouteFull> {
    match route.extend_to(position) {
        Err(RouteFull) if route.straighten(parameters.simplify_tolerance_m) => {
            route.extend_to(position)
        }
        result => result,
    }
}
