//! What the navigator decides in one step.

use nalgebra::Point2;

use crate::homing::NoVectorReason;
use crate::pose::Pose;
use crate::snapshot::Snapshot;

/// The most events of one step.
pub const EVENTS_PER_STEP: usize = 8;

/// Everything that one step gives out. Nothing in it is ever NaN or infinite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Step {
    /// Where to fly; none where the autopilot shall keep what it has.
    pub vector: Option<SetPoint>,
    /// A realignment of the autopilot's estimate; or, where a snapshot was taken, the word that it is right.
    pub correction: Option<Correction>,
    /// What was pushed on the route, or where the next target lies.
    pub map: Option<MapEntry>,
    /// What happened, in order.
    pub events: heapless::Vec<Event, EVENTS_PER_STEP>,
}

impl Step {
    /// Whether a snapshot was taken.
    pub(super) fn has_snapshot(&self) -> bool {
        self.map
            .as_ref()
            .is_some_and(|entry| entry.snapshot.is_some())
    }

    pub(super) fn report(&mut self, event: Event) {
        // No step has more than five: a leg begins, is over at once, and homing begins without a view.
        let _ = self.events.push(event);
    }
}

/// Who leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Source {
    /// The camera.
    Visual,
    /// Path integration.
    Odometry,
}

/// Where to fly, in the frame of the autopilot's estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetPoint {
    /// Who leads.
    pub source: Source,
    /// Where to: metres, x north, y west.
    pub target: Point2<f32>,
    /// Where from: the position of this step.
    pub start: Point2<f32>,
    /// The turn that would align the view with the snapshot, radians, counter-clockwise; zero under
    /// odometry.
    pub delta_yaw: f32,
}

/// The estimate at a snapshot, and what it should be: where a snapshot is taken, itself. On the way back it is
/// repeated, unchanged, while the navigator waits for it to take effect; the receiver applies an index once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Not zero, and another one for each new correction.
    pub index: u16,
    /// The pose as estimated.
    pub from: Pose,
    /// The pose as recorded. Its heading is less than a turn away from `from`'s and not wrapped, so
    /// that the difference is the turn to make.
    pub to: Pose,
}

/// The route's end as it is being stored or followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapEntry {
    /// Index of the last snapshot, from zero.
    pub snapshot_index: u16,
    /// Where it was taken.
    pub snapshot_position: Point2<f32>,
    /// Odometry vectors stored.
    pub odometry_index: u16,
    /// Where they end.
    pub odometry_position: Point2<f32>,
    /// The last snapshot, where it was just taken or is the new target.
    pub snapshot: Option<Snapshot>,
}

/// How homing at a snapshot ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Arrival {
    /// The time was up.
    TimeOut,
    /// The homing vector became short.
    Near,
    /// The difference of the images found no new minimum.
    NoNewMinimum,
}

/// Something worth a line in a log.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Event {
    /// A snapshot was pushed.
    SnapshotTaken {
        /// Its index, from zero.
        index: u16,
        /// Odometry vectors below it.
        height: u16,
    },
    /// There was no room for another snapshot: every second was dropped, and from now on they are twice as far
    /// apart.
    ThinnedOut {
        /// Index of the last that is left, from zero.
        last: u16,
    },
    /// There is no room for another snapshot: from now on odometry is recorded alone.
    SnapshotsFull,
    /// The route is full: recording has stopped, what is stored is whole. A drone that is told to follow it
    /// from farther than 2 m beyond its end is lost.
    RouteFull,
    /// There is nothing to follow: holding the position.
    RouteEmpty,
    /// The way to the next point of the route has begun.
    LegStarted {
        /// Odometry vectors below that point.
        height: u16,
    },
    /// Homing at a snapshot has begun.
    HomingStarted {
        /// Its index, from zero.
        index: u16,
    },
    /// The snapshot was not found where it is expected: the search round there has begun.
    SearchStarted {
        /// The snapshot's index, from zero.
        index: u16,
    },
    /// There is no homing vector; reported when it begins.
    NoVector {
        /// Why.
        reason: NoVectorReason,
    },
    /// Homing at a snapshot has ended.
    Arrived {
        /// How.
        by: Arrival,
    },
    /// The pose was realigned.
    Realigned {
        /// The correction's index.
        index: u16,
    },
    /// The route is consumed: holding at home.
    RouteFinished,
    /// The pose is not plausible: the step was skipped.
    InvalidPose,
    /// The drone cannot be where the pose says: it is not answered unless the next one agrees.
    PoseDoubtful,
    /// The autopilot counts from a new origin, and the view is that of the last known place: the
    /// route goes on from there.
    NewOrigin,
    /// Nobody knows where the drone is on the route: it stays where it is until the next command, and
    /// nothing is recorded.
    Lost,
}
