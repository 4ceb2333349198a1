//! Made-up flights to draw: nothing at all, and a long one on the U route.

use core::f64::consts::TAU;

use crate::record::{
    CorrectionMark, FrameMark, LogLine, OdometryMark, Phase, PlanarPose, Recording, SnapshotMark,
    TrackPoint, VectorMark, WallSegment,
};
use crate::summary::{CyclesPerFrame, FirmwareFigures, Summary};

const SPEED_M_PER_S: f64 = 0.4;
const SPACING_M: f64 = 2.0;
const HOMING_S: f64 = 3.0;
const TRACK_HZ: f64 = 10.0;
const FRAME_HZ: f64 = 30.0;
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

/// A flight of which nothing was recorded.
pub fn nothing() -> (Recording, Summary) {
    (Recording::default(), summary())
}

/// Five minutes: some 3000 track points, 9000 frames, 2500 vectors.
pub fn long_flight() -> (Recording, Summary) {
    let mut recording = Recording {
        plan: arena(),
        route: ROUTE.to_vec(),
        ..Recording::default()
    };
    let mut noise = Noise(1);
    let mut t = fly_out(&mut recording, &mut noise);
    t = fly_back(&mut recording, &mut noise, t);
    take_frames(&mut recording, &mut noise, t);
    write_log(&mut recording, t);
    let mut summary = summary();
    summary.snapshots = recording.snapshots.len();
    summary.vectors = recording.vectors.len();
    summary.memory_bytes = 18 * recording.snapshots.len() + 2 * recording.odometry.len();
    summary.bytes_per_m = summary.memory_bytes as f64 / summary.outbound_m;
    summary.flight_s = t;
    (recording, summary)
}

fn summary() -> Summary {
    Summary {
        completed: true,
        outcome: "landed at the first snapshot".into(),
        backend: "emulator",
        seed: 1,
        world: "arena".into(),
        route: "u".into(),
        homing: "both",
        spacing_m: SPACING_M,
        outbound_m: 56.0,
        inbound_m: 57.3,
        home_error_m: 0.12,
        cross_track_rms_m: 0.09,
        odometry_only_error_m: 1.31,
        snapshots: 0,
        memory_bytes: 0,
        bytes_per_m: 0.0,
        frames_sent: 9012,
        frames_captured: 9010,
        frames_dropped: 2,
        vectors: 0,
        cycles_per_frame: Some(CyclesPerFrame {
            p50: 151_200,
            p99: 204_000,
            max: 291_348,
            emulator_p50: 151_210,
            largest_disagreement: 12,
        }),
        cpu_load: Some(0.083),
        flight_s: 0.0,
        wall_s: 14.2,
        realtime_factor: 22.8,
        firmware: Some(FirmwareFigures {
            flash_bytes: 71_340,
            ram_bytes: 58_112,
            stack_peak_bytes: 6_216,
        }),
    }
}

/// Park and Miller's generator; the sum of two draws stands for a bell curve.
struct Noise(u64);

impl Noise {
    fn draw(&mut self) -> f64 {
        self.0 = self.0 * 48_271 % 2_147_483_647;
        self.0 as f64 / 2_147_483_647.0 - 0.5
    }

    fn next(&mut self, size: f64) -> f64 {
        size * (self.draw() + self.draw())
    }
}

fn arena() -> Vec<WallSegment> {
    let wall = |from, to| WallSegment { from, to };
    vec![
        wall([-2.5, 3.0], [7.5, 3.0]),
        wall([7.5, 3.0], [7.5, -7.0]),
        wall([7.5, -7.0], [-2.5, -7.0]),
        wall([-2.5, -7.0], [-2.5, 3.0]),
        wall([-1.0, -2.0], [3.6, -2.0]),
        wall([1.3, -0.9], [1.3, -3.1]),
    ]
}

/// The place and course after so many metres of the route.
fn along(metres: f64) -> PlanarPose {
    let mut left = metres;
    let mut pose = PlanarPose::default();
    for leg in ROUTE.windows(2) {
        let [dx, dy] = [leg[1][0] - leg[0][0], leg[1][1] - leg[0][1]];
        let length = libm::hypot(dx, dy);
        let part = (left / length).clamp(0.0, 1.0);
        pose = PlanarPose {
            x: leg[0][0] + part * dx,
            y: leg[0][1] + part * dy,
            yaw: 0.02 * libm::sin(metres),
        };
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

/// Drift after so many seconds.
fn drifted(truth: PlanarPose, t: f64) -> PlanarPose {
    moved(
        truth,
        0.0031 * t + 0.1 * libm::sin(t / 40.0),
        -0.0027 * t,
        0.0006 * t,
    )
}

fn fly_out(recording: &mut Recording, noise: &mut Noise) -> f64 {
    let steps = (56.0 / SPEED_M_PER_S * TRACK_HZ) as usize;
    let mut next_snapshot = 0.0;
    for step in 0..=steps {
        let t = step as f64 / TRACK_HZ;
        let metres = t * SPEED_M_PER_S;
        let truth = moved(
            along(metres),
            0.04 * libm::sin(metres),
            0.05 * libm::cos(1.3 * metres),
            0.0,
        );
        let believed = drifted(truth, t);
        recording.track.push(TrackPoint {
            t,
            phase: if step < 20 {
                Phase::Ground
            } else {
                Phase::Outbound
            },
            truth,
            estimate: believed,
            uncorrected: believed,
            height: 0.5,
        });
        if metres >= next_snapshot {
            store(recording, noise, t, truth, believed);
            next_snapshot += SPACING_M;
        }
    }
    steps as f64 / TRACK_HZ
}

fn store(
    recording: &mut Recording,
    noise: &mut Noise,
    t: f64,
    truth: PlanarPose,
    believed: PlanarPose,
) {
    let index = recording.snapshots.len() as u16;
    if index > 0 {
        for _ in 0..2 + usize::from(index % 3 == 0) {
            let counts = [noise.next(20.0) as i8, noise.next(20.0) as i8];
            let index = recording.odometry.len() as u16;
            recording.odometry.insert(0, OdometryMark { index, counts });
        }
    }
    let coefficients = (0..16)
        .map(|k| {
            let phase = TAU * f64::from(k) / 5.3 + 0.6 * truth.x + 0.9 * truth.y;
            (48.0 * libm::sin(phase) + noise.next(30.0)) as i8
        })
        .collect();
    recording.snapshots.push(SnapshotMark {
        t,
        index,
        odometry_count: recording.odometry.len() as u16,
        believed,
        truth,
        coefficients,
    });
}

fn fly_back(recording: &mut Recording, noise: &mut Noise, start: f64) -> f64 {
    let mut t = start;
    let mut offset = drifted(PlanarPose::default(), t);
    for index in (0..recording.snapshots.len()).rev() {
        let goal = SPACING_M * index as f64;
        let leg = (SPACING_M / SPEED_M_PER_S * TRACK_HZ) as usize;
        for step in 0..leg {
            t += 1.0 / TRACK_HZ;
            offset = moved(
                offset,
                noise.next(0.004),
                noise.next(0.006),
                noise.next(0.0005),
            );
            let truth = moved(
                along(goal + SPACING_M * (1.0 - step as f64 / leg as f64)),
                offset.x * 0.02,
                0.1,
                0.0,
            );
            push_back(recording, t, Phase::Odometry, truth, offset);
        }
        for step in 0..(HOMING_S * TRACK_HZ) as usize {
            t += 1.0 / TRACK_HZ;
            let rest = 0.1 * libm::exp(-(step as f64) / 9.0);
            let truth = moved(along(goal), noise.next(0.02), rest + noise.next(0.03), 0.0);
            push_back(recording, t, Phase::Homing, truth, offset);
        }
        let last = recording.track[recording.track.len() - 1];
        let to = moved(
            last.truth,
            noise.next(0.05),
            noise.next(0.05),
            noise.next(0.01),
        );
        recording.corrections.push(CorrectionMark {
            t,
            index: index as u16,
            from: last.estimate,
            to,
            truth: last.truth,
        });
        offset = moved(
            PlanarPose::default(),
            to.x - last.truth.x,
            to.y - last.truth.y,
            to.yaw - last.truth.yaw,
        );
    }
    t
}

fn push_back(
    recording: &mut Recording,
    t: f64,
    phase: Phase,
    truth: PlanarPose,
    offset: PlanarPose,
) {
    let estimate = moved(truth, offset.x, offset.y, offset.yaw);
    recording.track.push(TrackPoint {
        t,
        phase,
        truth,
        estimate,
        uncorrected: drifted(truth, t),
        height: 0.5,
    });
    let target = moved(
        estimate,
        0.2 * libm::sin(2.0 * t),
        0.25 * libm::cos(3.0 * t),
        0.0,
    );
    recording.vectors.push(VectorMark {
        t,
        visual: phase == Phase::Homing,
        start: estimate,
        target,
        truth,
    });
}

fn take_frames(recording: &mut Recording, noise: &mut Noise, end: f64) {
    for frame in 0..(end * FRAME_HZ) as usize {
        let t = frame as f64 / FRAME_HZ;
        let cycles = 151_000.0 + noise.next(9_000.0) + if frame % 97 == 0 { 52_000.0 } else { 0.0 };
        let cycles = if frame == 4321 { 291_348.0 } else { cycles };
        recording.frames.push(FrameMark {
            t,
            cycles: Some(cycles as u32),
            luma: (80.0 - 45.0 * libm::exp(-t / 1.5) + noise.next(6.0) + 9.0 * libm::sin(t / 11.0))
                as f32,
            lines: (210.0 + 60.0 * libm::sin(t / 11.0)) as u16,
            gain: if libm::sin(t / 11.0) > 0.8 { 2.0 } else { 1.0 },
        });
    }
}

fn write_log(recording: &mut Recording, end: f64) {
    let mut say = |t: f64, source, level: &str, text: String| {
        recording.log.push(LogLine {
            t,
            source,
            level: level.into(),
            text,
        });
    };
    say(0.0, "firmware", "info", "boot: reset by power on".into());
    say(0.4, "app", "info", "handshake complete: record".into());
    say(
        31.2,
        "firmware",
        "warn",
        "camera: short frame, capture restarted".into(),
    );
    for second in 1..end as u32 {
        let text = format!("frame {} luma {}", 30 * second, 80 - second % 3);
        say(f64::from(second), "firmware", "debug", text);
    }
    say(end, "rig", "info", "landed <home> & happy".into());
}
