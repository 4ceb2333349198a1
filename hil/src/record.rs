//! What a flight leaves behind: everything that happened, in the order of time, as plain data.
//!
//! Positions are in the route's frame: x north, y west, metres, origin at the true start. Headings
//! are radians, counter-clockwise from north.

use core::f64::consts::TAU;

use link::Message;
use nav::OdometryVector;
use serde::Serialize;

use crate::board::origin::{Origin, Place};
use crate::scenario::SnapshotForm;

/// What the drone was doing; the colours of the paper's Fig. 6 follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// On the ground, taking off or landing.
    Ground,
    /// Recording the route (red).
    Outbound,
    /// Inbound, led by odometry (yellow).
    Odometry,
    /// Inbound, led by the camera (blue).
    Homing,
}

/// Position and heading in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PlanarPose {
    /// North, metres.
    pub x: f64,
    /// West, metres.
    pub y: f64,
    /// Counter-clockwise from north, radians.
    pub yaw: f64,
}

impl PlanarPose {
    /// The pose that is `further` in the frame of this one.
    pub fn onward(&self, further: &Self) -> Self {
        let (sin, cos) = libm::sincos(self.yaw);
        Self {
            x: self.x + further.x * cos - further.y * sin,
            y: self.y + further.x * sin + further.y * cos,
            yaw: libm::remainder(self.yaw + further.yaw, TAU),
        }
    }

    /// Distance in the plane, metres.
    pub fn distance(&self, other: &Self) -> f64 {
        libm::hypot(self.x - other.x, self.y - other.y)
    }
}

/// The flight ten times a second.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TrackPoint {
    /// Flight time, seconds.
    pub t: f64,
    /// What the drone was doing.
    pub phase: Phase,
    /// Where it was.
    pub truth: PlanarPose,
    /// Where its filter believed it was.
    pub estimate: PlanarPose,
    /// Where the same filter, never corrected by the camera, believed it was.
    pub uncorrected: PlanarPose,
    /// Height above the ground, metres.
    pub height: f64,
}

/// A snapshot as the firmware reported it (MAP message) while recording.
#[derive(Clone, Debug, Serialize)]
pub struct SnapshotMark {
    /// Flight time, seconds.
    pub t: f64,
    /// The firmware's index, from 0.
    pub index: u16,
    /// Odometry vectors below it on the stack.
    pub odometry_count: u16,
    /// Where the firmware believed it was taken.
    pub believed: PlanarPose,
    /// Where it was taken.
    pub truth: PlanarPose,
    /// a_1..a_8, b_1..b_8 in counts of the paper's form, whatever the form of the route.
    pub coefficients: Vec<i8>,
}

/// A set-point of the firmware (VECTOR message).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct VectorMark {
    /// Flight time, seconds.
    pub t: f64,
    /// True: from homing. False: from odometry.
    pub visual: bool,
    /// Where the drone believed it was.
    pub start: PlanarPose,
    /// Where it was told to go; `yaw` is the turn asked for.
    pub target: PlanarPose,
    /// Where it was.
    pub truth: PlanarPose,
}

/// A realignment of the filter at a snapshot (INS_CORRECTION message).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CorrectionMark {
    /// Flight time, seconds.
    pub t: f64,
    /// The firmware's correction index.
    pub index: u16,
    /// The estimate before.
    pub from: PlanarPose,
    /// The estimate after.
    pub to: PlanarPose,
    /// Where the drone was.
    pub truth: PlanarPose,
}

/// An odometry vector as it is followed on the way back, oldest last.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct OdometryMark {
    /// Index on the firmware's odometry stack, from 0.
    pub index: u16,
    /// The vector as stored, in counts of 0.1 m (x north, y west).
    pub counts: [i8; 2],
}

/// One camera frame as the firmware logged it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FrameMark {
    /// Flight time, seconds.
    pub t: f64,
    /// Processor cycles from frame to spectrum, by the firmware's own cycle counter; none where
    /// no processor was emulated.
    pub cycles: Option<u32>,
    /// Mean luma of the horizon, 0..=255.
    pub luma: f32,
    /// Shutter, sensor lines.
    pub lines: u16,
    /// Analogue gain, 1 = 0 dB.
    pub gain: f32,
}

/// One line of the flight's log.
#[derive(Clone, Debug, Serialize)]
pub struct LogLine {
    /// Flight time, seconds.
    pub t: f64,
    /// Who speaks: `firmware`, `app` or `rig`.
    pub source: &'static str,
    /// error, warn, info, debug or trace.
    pub level: String,
    /// What was said.
    pub text: String,
    /// When by the firmware's clock, and by which of its log statements; none for lines of others
    /// and of firmware that is not an image.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
}

impl LogLine {
    /// The log statement, where it is known.
    pub fn place(&self) -> Option<&Place> {
        self.origin.as_ref()?.place.as_ref()
    }
}

/// A vertical wall or panel seen from above.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct WallSegment {
    /// One end: x north, y west, metres.
    pub from: [f64; 2],
    /// The other end.
    pub to: [f64; 2],
}

/// An end of the link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The camera board: it dropped a frame of the autopilot.
    Camera,
    /// The autopilot: it dropped a frame of the camera board.
    Autopilot,
}

/// A frame of the link that its receiver dropped, or that never got there because nobody was there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkDrop {
    /// Flight time, seconds.
    pub t: f64,
    /// Which end dropped it.
    pub side: Side,
    /// The message that the frame's header names; `?` where it could not be read.
    pub message: String,
    /// Why, for people.
    pub why: String,
}

/// Something that an end of the link said or did.
#[derive(Clone, Debug)]
pub struct Deed {
    /// Flight time, milliseconds.
    pub t_ms: u64,
    /// What.
    pub what: What,
}

/// What an end of the link said or did. Coordinates are the autopilot's own.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all deeds are messages: boxes would cost more than they save"
)]
pub enum What {
    /// A message went onto the wire, before anything could happen to it.
    Sent {
        /// From this end.
        by: Side,
        /// What it says.
        message: Message,
    },
    /// The flight app lets the drone fly to another place than before: x north, y west, metres.
    FlyTo([f32; 2]),
    /// The flight app told its filter that the drone is elsewhere and turned; or by nothing, that it is right.
    Correct {
        /// From the estimate: x north, y west, metres.
        shift_m: [f32; 2],
        /// Counter-clockwise, radians.
        turn_rad: f32,
    },
}

/// What stands for the true pose in a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// The true pose.
    #[default]
    Truth,
    /// The drone's own estimate: nothing else is known. Errors against it are not seen.
    Estimate,
}

/// Everything that happened.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Recording {
    /// What every `truth` in this recording is.
    pub reference: Reference,
    /// The world from above.
    pub plan: Vec<WallSegment>,
    /// The way points of the scripted route, metres.
    pub route: Vec<[f64; 2]>,
    /// Ten points a second.
    pub track: Vec<TrackPoint>,
    /// How they were stored.
    pub snapshot_form: SnapshotForm,
    /// In the order in which they were taken.
    pub snapshots: Vec<SnapshotMark>,
    /// Vectors that the firmware had stored when it turned to follow the route, or when the flight
    /// ended before.
    pub odometry_stored: u16,
    /// Those of them that were seen to be followed, newest first. Vectors that are left behind in one
    /// step are not told apart.
    pub odometry: Vec<OdometryMark>,
    /// Every VECTOR.
    pub vectors: Vec<VectorMark>,
    /// Every new INS_CORRECTION that moves the estimate.
    pub corrections: Vec<CorrectionMark>,
    /// Every frame that was processed.
    pub frames: Vec<FrameMark>,
    /// Every frame of the link that its receiver dropped.
    pub link_drops: Vec<LinkDrop>,
    /// The log.
    pub log: Vec<LogLine>,
    /// What was said on the link and done about it, in order. Not part of the folder.
    #[serde(skip)]
    pub deeds: Vec<Deed>,
}

impl Recording {
    /// Snapshots that the firmware stored on the way out. Where the report of one was lost on the link,
    /// the index of a later one tells.
    pub fn snapshots_stored(&self) -> usize {
        let by_index = self
            .snapshots
            .iter()
            .map(|mark| usize::from(mark.index) + 1);
        by_index.max().unwrap_or(0).max(self.snapshots.len())
    }

    /// What the route took when the way out ended.
    pub fn memory(&self) -> RouteMemory {
        RouteMemory {
            snapshots: self.snapshot_form.format().bytes() * self.snapshots_stored(),
            counts: COUNT_BYTES * self.snapshots_stored(),
            vectors: OdometryVector::BYTES * usize::from(self.odometry_stored),
        }
    }
}

/// Bytes of an odometry count (paper, Fig. 8).
const COUNT_BYTES: usize = size_of::<u16>();

/// The route memory by its use, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RouteMemory {
    /// Coefficients.
    pub snapshots: usize,
    /// The place of each snapshot on the odometry stack.
    pub counts: usize,
    /// Odometry vectors.
    pub vectors: usize,
}

impl RouteMemory {
    /// As the paper counts.
    pub fn without_counts(&self) -> usize {
        self.snapshots + self.vectors
    }

    /// All of it.
    pub fn with_counts(&self) -> usize {
        self.without_counts() + self.counts
    }
}
