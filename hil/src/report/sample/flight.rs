//! The made-up way out and back: drift grows on the way out, homing takes it away on the way back.

use core::f64::consts::TAU;

use super::Noise;
use crate::record::{
    CorrectionMark, OdometryMark, Phase, PlanarPose, Recording, SnapshotMark, TrackPoint,
    VectorMark,
};

const SPEED_M_PER_S: f64 = 0.4;
const SPACING_M: f64 = 2.0;
const HOMING_S: f64 = 3.0;
const TRACK_HZ: f64 = 10.0;

/// U there and back, twice over: 56 m.
const ROUTE: [[f64; 2]; 13] = [
    [0.0, 0.0],
    [5.0, 0.0],
    [5.0, -4.0],
    [0.0, -4.0],
    [5.0, -4.0],
    [5.0, 0.0],
    [0.0, 0.0],
    [5.0, 0.0],
    [5.0, -4.0],
    [0.0, -4.0],
    [5.0, -4.0],
    [5.0, 0.0],
    [0.0, 0.0],
];

/// Flies out and back; the flight time at the end, seconds.
pub fn fly(recording: &mut Recording, noise: &mut Noise) -> f64 {
    recording.route = ROUTE.to_vec();
    let t = fly_out(recording, noise);
    let mut back = WayBack {
        t,
        side: 0.0,
        offset: drift(t),
    };
    for index in (0..recording.snapshots.len()).rev() {
        back.follow_odometry(recording, noise, SPACING_M * index as f64);
        back.home(recording, noise, SPACING_M * index as f64);
        back.realign(recording, noise, index as u16);
    }
    back.t
}

/// The place after so many metres of the route.
fn along(metres: f64) -> PlanarPose {
    let mut left = metres;
    let mut pose = PlanarPose::default();
    for leg in ROUTE.windows(2) {
        let [dx, dy] = [leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]];
        let length = libm::hypot(dx, dy);
        let part = (left / length).clamp(0.0, 1.0);
        pose = moved(
            PlanarPose::default(),
            leg[0][0] + part * dx,
            leg[0][1] + part * dy,
            0.0,
        );
        if left <= length {
            break;
        }
        left -= length;
    }
    pose
}

fn moved(pose: PlanarPose, x: f64, y: f64, yaw: f64) -> PlanarPose {
    PlanarPose {
        x: pose.x + x,
        y: pose.y + y,
        yaw: pose.yaw + yaw,
    }
}

fn shifted(pose: PlanarPose, by: PlanarPose) -> PlanarPose {
    moved(pose, by.x, by.y, by.yaw)
}

/// What the uncorrected filter has gone wrong after so many seconds.
fn drift(t: f64) -> PlanarPose {
    PlanarPose {
        x: 0.0021 * t + 0.1 * libm::sin(t / 40.0),
        y: -0.0024 * t,
        yaw: 0.0006 * t,
    }
}

fn fly_out(recording: &mut Recording, noise: &mut Noise) -> f64 {
    let steps = (56.0 / SPEED_M_PER_S * TRACK_HZ) as usize;
    let mut next_snapshot = 0.0;
    for step in 0..=steps {
        let t = step as f64 / TRACK_HZ;
        let metres = t * SPEED_M_PER_S;
        let [x, y] = [
            0.05 * libm::sin(metres),
            0.07 * libm::cos(1.3 * metres) - 0.07,
        ];
        let truth = moved(along(metres), x, y, 0.02 * x);
        let believed = shifted(truth, drift(t));
        let phase = if step < 20 {
            Phase::Ground
        } else {
            Phase::Outbound
        };
        let height = 0.5;
        recording.track.push(TrackPoint {
            t,
            phase,
            truth,
            estimate: believed,
            uncorrected: believed,
            height,
        });
        if metres >= next_snapshot {
            store(recording, noise, (t, truth, believed));
            next_snapshot += SPACING_M;
        }
    }
    steps as f64 / TRACK_HZ
}

fn store(
    recording: &mut Recording,
    noise: &mut Noise,
    (t, truth, believed): (f64, PlanarPose, PlanarPose),
) {
    let index = recording.snapshots.len() as u16;
    let vectors = if index == 0 {
        0
    } else {
        2 + usize::from(index.is_multiple_of(3))
    };
    for _ in 0..vectors {
        let counts = [noise.next(20.0) as i8, noise.next(20.0) as i8];
        let index = recording.odometry.len() as u16;
        recording.odometry.insert(0, OdometryMark { index, counts });
    }
    let coefficient = |k: u32| {
        let phase = TAU * f64::from(k) / 5.3 + 0.6 * truth.x + 0.9 * truth.y;
        (48.0 * libm::sin(phase) + noise.next(30.0)) as i8
    };
    recording.snapshots.push(SnapshotMark {
        t,
        index,
        odometry_count: recording.odometry.len() as u16,
        believed,
        truth,
        coefficients: (0..16).map(coefficient).collect(),
    });
}

/// The state of the way back.
struct WayBack {
    t: f64,
    /// How far beside the route, metres.
    side: f64,
    /// Estimate less truth.
    offset: PlanarPose,
}

impl WayBack {
    fn follow_odometry(&mut self, recording: &mut Recording, noise: &mut Noise, goal: f64) {
        let steps = (SPACING_M / SPEED_M_PER_S * TRACK_HZ) as usize;
        let drift_rate = noise.next(0.006);
        for step in 0..steps {
            self.side += drift_rate;
            let rest = SPACING_M * (1.0 - step as f64 / steps as f64);
            self.push(recording, noise, Phase::Odometry, along(goal + rest), 0.1);
        }
    }

    fn home(&mut self, recording: &mut Recording, noise: &mut Noise, goal: f64) {
        for _ in 0..(HOMING_S * TRACK_HZ) as usize {
            self.side *= 0.88;
            self.push(recording, noise, Phase::Homing, along(goal), 1.2);
        }
    }

    fn push(
        &mut self,
        recording: &mut Recording,
        noise: &mut Noise,
        phase: Phase,
        goal: PlanarPose,
        gain: f64,
    ) {
        self.t += 1.0 / TRACK_HZ;
        self.offset = moved(
            self.offset,
            noise.next(0.006),
            noise.next(0.006),
            noise.next(0.001),
        );
        let (t, offset) = (self.t, self.offset);
        let truth = moved(
            goal,
            self.side + noise.next(0.01),
            self.side + noise.next(0.01),
            0.0,
        );
        let estimate = shifted(truth, offset);
        let uncorrected = shifted(truth, drift(t));
        recording.track.push(TrackPoint {
            t,
            phase,
            truth,
            estimate,
            uncorrected,
            height: 0.5,
        });
        let [x, y] = [
            -gain * self.side + noise.next(0.08),
            -gain * self.side + noise.next(0.08),
        ];
        let target = moved(estimate, x, y, 0.0);
        let visual = phase == Phase::Homing;
        recording.vectors.push(VectorMark {
            t,
            visual,
            start: estimate,
            target,
            truth,
        });
    }

    fn realign(&mut self, recording: &mut Recording, noise: &mut Noise, index: u16) {
        let Some(last) = recording.track.last().copied() else {
            return;
        };
        let left = PlanarPose {
            x: noise.next(0.05),
            y: noise.next(0.05),
            yaw: noise.next(0.01),
        };
        let to = shifted(last.truth, left);
        self.offset = left;
        recording.corrections.push(CorrectionMark {
            t: self.t,
            index,
            from: last.estimate,
            to,
            truth: last.truth,
        });
    }
}
