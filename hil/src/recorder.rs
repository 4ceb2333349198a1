//! Writes down what happens, as it happens.

use autopilot::app;
use link::{InsCorrection, Map, Message, Source, Vector, WorldPoint, WorldPose};

use crate::board::FirmwareLog;
use crate::board::origin::Origin;
use crate::record::{
    CorrectionMark, Deed, FrameMark, LinkDrop, LogLine, OdometryMark, Phase, PlanarPose, Recording,
    Side, SnapshotMark, TrackPoint, VectorMark, What,
};

/// A track point every 100 ms.
const TRACK_PERIOD_MS: u64 = 100;
/// Counts of an odometry vector per metre (paper: 0.1 m).
const COUNTS_PER_M: f64 = 10.0;
/// Who speaks in the lines of the firmware.
const FIRMWARE: &str = "firmware";

/// Where things stand at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct Glimpse {
    /// Where the drone is; see [`crate::record::Reference`].
    pub truth: PlanarPose,
    /// Where its filter believes it is.
    pub estimate: PlanarPose,
    /// Where the same filter without the camera's corrections believes it is.
    pub uncorrected: PlanarPose,
    /// Height above the ground, metres.
    pub height_m: f64,
}

/// Collects a [`Recording`].
#[derive(Debug)]
pub struct Recorder {
    recording: Recording,
    app_phase: app::Phase,
    /// Whether the newest vector came from homing.
    visual: bool,
    correction_index: Option<u16>,
    /// Number of vectors and where they end, from the newest MAP on the way back.
    tip: Option<(u16, PlanarPose)>,
    /// None as long as the autopilot's coordinates are the route's.
    origin: Option<PlanarPose>,
}

impl Recorder {
    /// Before the flight; `recording` holds what is known beforehand.
    pub fn new(recording: Recording) -> Self {
        Self {
            recording,
            app_phase: app::Phase::Ground,
            visual: false,
            correction_index: None,
            tip: None,
            origin: None,
        }
    }

    /// From now on the autopilot's coordinates have their origin there.
    pub fn set_origin(&mut self, origin: PlanarPose) {
        self.origin = Some(origin);
        self.tip = None;
    }

    /// An end of the link said or did something.
    pub fn deed(&mut self, now_ms: u64, what: What) {
        self.recording.deeds.push(Deed { t_ms: now_ms, what });
    }

    /// The autopilot has taken a message of the camera.
    pub fn message(&mut self, now_ms: u64, message: &Message, glimpse: &Glimpse) {
        let t = seconds(now_ms);
        match message {
            Message::Vector(vector) => self.vector(t, vector, glimpse),
            Message::Map(map) => self.map(t, map, glimpse),
            Message::InsCorrection(correction) => self.correction(t, correction, glimpse),
            Message::Command(_) | Message::State(_) | Message::Camera(_) | Message::Debug(_) => {}
        }
    }

    /// What the flight app is doing now.
    pub fn phase(&mut self, now_ms: u64, phase: app::Phase) {
        if phase != self.app_phase {
            self.app_phase = phase;
            self.line(seconds(now_ms), ("app", None), "info", format!("{phase:?}"));
        }
    }

    /// Where the drone is now. To be called every millisecond; ten times a second it is noted.
    pub fn track(&mut self, now_ms: u64, glimpse: &Glimpse) {
        if now_ms.is_multiple_of(TRACK_PERIOD_MS) {
            self.recording.track.push(TrackPoint {
                t: seconds(now_ms),
                phase: self.drawn_phase(),
                truth: glimpse.truth,
                estimate: glimpse.estimate,
                uncorrected: glimpse.uncorrected,
                height: glimpse.height_m,
            });
        }
    }

    /// A frame of the link was dropped by its receiver.
    pub fn link_drop(&mut self, now_ms: u64, side: Side, message: String, why: String) {
        let source = match side {
            Side::Camera => FIRMWARE,
            Side::Autopilot => "app",
        };
        self.drop_frame(now_ms, (source, None), side, message, why);
    }

    /// A frame of the link never got to this side.
    pub fn link_loss(&mut self, now_ms: u64, side: Side, message: String, why: String) {
        self.drop_frame(now_ms, ("rig", None), side, message, why);
    }

    fn drop_frame(
        &mut self,
        now_ms: u64,
        speaker: (&'static str, Option<Origin>),
        side: Side,
        message: String,
        why: String,
    ) {
        let t = seconds(now_ms);
        self.line(t, speaker, "warn", format!("link dropped {message}: {why}"));
        self.recording.link_drops.push(LinkDrop {
            t,
            side,
            message,
            why,
        });
    }

    /// What the rig itself has to say.
    pub fn note(&mut self, now_ms: u64, level: &str, text: String) {
        self.line(seconds(now_ms), ("rig", None), level, text);
    }

    /// What the firmware logged.
    pub fn log(&mut self, now_ms: u64, records: impl Iterator<Item = FirmwareLog>) {
        let t = seconds(now_ms);
        for record in records {
            match record {
                FirmwareLog::Frame(frame) => self.recording.frames.push(FrameMark {
                    t,
                    cycles: frame.cycles,
                    luma: frame.luma,
                    lines: frame.lines,
                    gain: frame.gain,
                }),
                FirmwareLog::LinkDrop {
                    message,
                    why,
                    origin,
                } => self.drop_frame(now_ms, (FIRMWARE, origin), Side::Camera, message, why),
                FirmwareLog::CaptureFault { name, origin } => {
                    let text = format!("capture fault: {name}");
                    self.line(t, (FIRMWARE, origin), "warn", text);
                }
                FirmwareLog::Line {
                    level,
                    text,
                    origin,
                } => self.line(t, (FIRMWARE, origin), level, text),
            }
        }
    }

    /// After the flight.
    pub fn finish(self) -> Recording {
        self.recording
    }

    fn drawn_phase(&self) -> Phase {
        match self.app_phase {
            app::Phase::Recording => Phase::Outbound,
            app::Phase::Following if self.visual => Phase::Homing,
            app::Phase::Following => Phase::Odometry,
            app::Phase::Ground
            | app::Phase::TakeOff
            | app::Phase::Landing
            | app::Phase::Landed(_) => Phase::Ground,
        }
    }

    fn on_the_map(&self, pose: PlanarPose) -> PlanarPose {
        match self.origin {
            None => pose,
            Some(origin) => origin.onward(&pose),
        }
    }

    /// Writes a line down; the speaker is who says it, and from where.
    fn line(
        &mut self,
        t: f64,
        (source, origin): (&'static str, Option<Origin>),
        level: &str,
        text: String,
    ) {
        self.recording.log.push(LogLine {
            t,
            source,
            level: level.to_owned(),
            text,
            origin,
        });
    }

    fn vector(&mut self, t: f64, vector: &Vector, glimpse: &Glimpse) {
        let (Ok(start), Ok(target), Ok(turn)) = (vector.start(), vector.target(), vector.turn())
        else {
            return;
        };
        self.visual = vector.source() == Some(Source::Visual);
        self.recording.vectors.push(VectorMark {
            t,
            visual: self.visual,
            start: PlanarPose {
                yaw: glimpse.estimate.yaw,
                ..self.on_the_map(planar(start, 0.0))
            },
            target: PlanarPose {
                yaw: turn.into(),
                ..self.on_the_map(planar(target, 0.0))
            },
            truth: glimpse.truth,
        });
    }

    fn map(&mut self, t: f64, map: &Map, glimpse: &Glimpse) {
        let (Ok(snapshot), Ok(tip)) = (map.snapshot(), map.odometry()) else {
            return;
        };
        if self.app_phase == app::Phase::Following {
            let tip = self.on_the_map(planar(tip, 0.0));
            self.followed(map.odometry_index, tip);
            return;
        }
        self.recording.odometry_stored = map.odometry_index;
        if !map.snapshot_ak_bk.is_empty() {
            self.recording.snapshots.push(SnapshotMark {
                t,
                index: map.snapshot_index,
                odometry_count: map.odometry_index,
                believed: PlanarPose {
                    yaw: glimpse.estimate.yaw,
                    ..self.on_the_map(planar(snapshot, 0.0))
                },
                truth: glimpse.truth,
                coefficients: map.snapshot_ak_bk.to_vec(),
            });
        }
    }

    /// The stack of vectors is one shorter than before: the difference of its ends is the vector
    /// that is gone.
    fn followed(&mut self, count: u16, tip: PlanarPose) {
        if let Some((before, end)) = self.tip
            && before == count + 1
        {
            let counts = |metres: f64| (metres * COUNTS_PER_M).round() as i8;
            let counts = [counts(end.x - tip.x), counts(end.y - tip.y)];
            self.recording.odometry.push(OdometryMark {
                index: count,
                counts,
            });
        }
        self.tip = Some((count, tip));
    }

    fn correction(&mut self, t: f64, correction: &InsCorrection, glimpse: &Glimpse) {
        let index = correction.snapshot_index;
        let Ok((from, to)) = correction.poses() else {
            return;
        };
        // The firmware repeats a correction while it waits for it to take effect.
        if self.correction_index.replace(index) == Some(index) {
            return;
        }
        // On the way out: where a snapshot is taken the estimate is right by definition.
        if from == to {
            return;
        }
        let mark = CorrectionMark {
            t,
            index,
            from: self.on_the_map(pose(from)),
            to: self.on_the_map(pose(to)),
            truth: glimpse.truth,
        };
        self.recording.corrections.push(mark);
    }
}

fn seconds(ms: u64) -> f64 {
    ms as f64 / 1_000.0
}

fn planar(place: WorldPoint, yaw: f32) -> PlanarPose {
    PlanarPose {
        x: place.x.into(),
        y: place.y.into(),
        yaw: yaw.into(),
    }
}

fn pose(pose: WorldPose) -> PlanarPose {
    planar(pose.point(), pose.yaw)
}
