//! Made-up flights to draw: nothing at all, and a long one on the U route.

mod flight;

use crate::record::{FrameMark, LogLine, Recording, WallSegment};
use crate::scenario::Conditions;
use crate::summary::{CyclesPerFrame, FirmwareFigures, LinkFigures, Summary};

const FRAME_HZ: f64 = 30.0;

/// A flight of which nothing was recorded.
pub fn nothing() -> (Recording, Summary) {
    (Recording::default(), summary())
}

/// Five minutes and more: some 3500 track points, 11000 frames, 2200 vectors.
pub fn long_flight() -> (Recording, Summary) {
    let mut recording = Recording {
        plan: arena(),
        ..Recording::default()
    };
    let mut noise = Noise(1);
    let end = flight::fly(&mut recording, &mut noise);
    take_frames(&mut recording, &mut noise, end);
    write_log(&mut recording, end);
    let mut summary = summary();
    summary.snapshots = recording.snapshots.len();
    summary.vectors = recording.vectors.len();
    recording.odometry_stored = recording.odometry.len() as u16;
    summary.memory_bytes = recording.memory().with_counts();
    summary.bytes_per_m = summary.memory_bytes as f64 / summary.outbound_m;
    summary.flight_s = end;
    (recording, summary)
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

fn summary() -> Summary {
    Summary {
        completed: true,
        outcome: "landed at the first snapshot".into(),
        backend: "emulator",
        seed: 1,
        world: "arena".into(),
        route: "u".into(),
        homing: "both",
        spacing_m: 2.0,
        conditions: Conditions::default(),
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
        link: LinkFigures::default(),
        live: None,
        cycles_per_frame: Some(CyclesPerFrame {
            p50: 151_200,
            p99: 204_000,
            max: 291_348,
            emulator_p50: Some(151_210),
            largest_disagreement: Some(12),
        }),
        cpu_load: Some(0.083),
        flight_s: 0.0,
        wall_s: 14.2,
        realtime_factor: 22.8,
        firmware: Some(FirmwareFigures {
            flash_bytes: 71_340,
            ram_bytes: 58_112,
            stack_peak_bytes: Some(6_216),
        }),
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

fn take_frames(recording: &mut Recording, noise: &mut Noise, end: f64) {
    for frame in 0..(end * FRAME_HZ) as usize {
        let t = frame as f64 / FRAME_HZ;
        let late = if frame.is_multiple_of(97) {
            52_000.0
        } else {
            0.0
        };
        let cycles = match frame {
            4321 => 291_348.0,
            _ => 151_000.0 + noise.next(9_000.0) + late,
        };
        let light = libm::sin(t / 11.0);
        let settling = 45.0 * libm::exp(-t / 1.5);
        recording.frames.push(FrameMark {
            t,
            cycles: Some(cycles as u32),
            luma: (80.0 - settling + noise.next(6.0) + 9.0 * light) as f32,
            lines: (210.0 + 60.0 * light) as u16,
            gain: if light > 0.8 { 2.0 } else { 1.0 },
        });
    }
}

fn write_log(recording: &mut Recording, end: f64) {
    let mut say = |t: f64, source, level: &str, text: String| {
        let level = level.to_owned();
        recording.log.push(LogLine {
            t,
            source,
            level,
            text,
            origin: None,
        });
    };
    say(0.0, "firmware", "info", "boot: reset by power on".into());
    say(0.4, "app", "info", "handshake complete: record".into());
    say(
        31.2,
        "firmware",
        "warn",
        "short frame, capture restarted".into(),
    );
    for second in 1..end as u32 {
        let text = format!("frame {} luma {}", 30 * second, 80 - second % 3);
        say(f64::from(second), "firmware", "debug", text);
    }
    say(end, "rig", "info", "landed <home> & happy".into());
}
