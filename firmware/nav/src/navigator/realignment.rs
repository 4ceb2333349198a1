//! Setting the autopilot's estimate right at a snapshot.

use nalgebra::Point2;

use super::parameters::{Parameters, has_passed};
use super::step::Correction;
use crate::pose::Pose;

/// Numbers the corrections and keeps them apart in time.
#[derive(Clone, Debug)]
pub(super) struct Realigner {
    last_index: u16,
    last_ms: Option<u32>,
}

impl Realigner {
    pub(super) const fn new() -> Self {
        Self {
            last_index: 0,
            last_ms: None,
        }
    }

    /// Whether the last correction is long enough ago that the next cannot contradict it.
    pub(super) fn is_ready(&self, parameters: &Parameters, now_ms: u32) -> bool {
        self.last_ms
            .is_none_or(|last| has_passed(last, now_ms, parameters.realignment_interval_ms))
    }

    /// The correction that moves nothing: a route's coordinates are those of the estimate when it was recorded, so
    /// where a snapshot is taken the estimate is right by definition. None too soon after another one.
    ///
    /// An autopilot's filter that is never told where it is gets less and less sure of its place and heading, and
    /// of the two together: tens of metres from where it started, the flow of a drone that turns a corner moves
    /// its place by up to half a metre in a tenth of a second (crazyflie-firmware kalman_core; a kilometre of the
    /// rig's). Told, it is sure, and goes on from there.
    pub(super) fn anchor(
        &mut self,
        parameters: &Parameters,
        now_ms: u32,
        pose: &Pose,
    ) -> Option<Correction> {
        self.is_ready(parameters, now_ms)
            .then(|| self.realign(now_ms, pose, pose.position, 0.0))
    }

    /// The correction of a drone that is at `recorded`, where the snapshot's viewer is turned
    /// counter-clockwise by `rotation` against the current one.
    ///
    /// Both views are aligned with the heading estimated when they were taken. An estimate that has
    /// drifted by δ counter-clockwise since the snapshot turns the aligned panorama by δ counter-
    /// clockwise, which looks like a viewer turned by -δ; the snapshot's viewer, not turned, then is
    /// `rotation` = +δ ahead of the current one. So the heading to assume is the estimate less the
    /// rotation.
    pub(super) fn realign(
        &mut self,
        now_ms: u32,
        estimate: &Pose,
        recorded: Point2<f32>,
        rotation: f32,
    ) -> Correction {
        self.last_ms = Some(now_ms);
        // Index zero means "none" to the receiver.
        self.last_index = self.last_index.checked_add(1).unwrap_or(1);
        Correction {
            index: self.last_index,
            from: *estimate,
            to: Pose::new(recorded, estimate.heading - rotation),
        }
    }
}
