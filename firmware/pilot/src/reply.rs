//! A step of the navigator as messages, in the order of what must not be lost: the set-point, the
//! correction of the filter, then what only the operator's log reads.

use heapless::Vec;
use link::{Command, InsCorrection, Map, Message, Source, Vector, WorldPoint, WorldPose};
use nalgebra::Point2;
use nav::{MapEntry, Pose, SetPoint, Step};

use crate::Outbox;

/// Encodes what a step asks for. What is implausible is not sent: the autopilot checks nothing.
pub fn push(step: &Step, outbox: &mut Outbox) {
    if let Some(vector) = step.vector.as_ref().and_then(vector) {
        send(Message::Vector(vector), outbox);
    }
    if let Some(correction) = &step.correction {
        let (from, to) = (world_pose(&correction.from), world_pose(&correction.to));
        if let Ok(correction) = InsCorrection::from_world(correction.index, from, to) {
            send(Message::InsCorrection(correction), outbox);
        }
    }
    if let Some(map) = step.map.as_ref().and_then(map) {
        send(Message::Map(map), outbox);
    }
}

/// Says which mode holds.
pub fn push_mode(mode: u8, outbox: &mut Outbox) {
    send(
        Message::Command(Command {
            command: mode,
            args: Vec::new(),
        }),
        outbox,
    );
}

fn send(message: Message, outbox: &mut Outbox) {
    outbox.push(&message.encode());
}

fn vector(set_point: &SetPoint) -> Option<Vector> {
    let source = match set_point.source {
        nav::Source::Visual => Source::Visual,
        nav::Source::Odometry => Source::Odometry,
    };
    let (target, start) = (
        world_point(&set_point.target),
        world_point(&set_point.start),
    );
    Vector::from_world(target, set_point.delta_yaw, start, source).ok()
}

fn map(entry: &MapEntry) -> Option<Map> {
    let coefficients = entry.snapshot.map_or(Vec::new(), |snapshot| {
        // 16 of at most 226.
        Vec::from_slice(snapshot.bytes()).unwrap_or_default()
    });
    Map::from_world(
        (entry.snapshot_index, world_point(&entry.snapshot_position)),
        (entry.odometry_index, world_point(&entry.odometry_position)),
        coefficients,
    )
    .ok()
}

fn world_point(point: &Point2<f32>) -> WorldPoint {
    WorldPoint {
        x: point.x,
        y: point.y,
    }
}

fn world_pose(pose: &Pose) -> WorldPose {
    WorldPose {
        x: pose.position.x,
        y: pose.position.y,
        yaw: pose.heading,
    }
}
