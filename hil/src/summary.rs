//! The figures of one flight. Field names are a promise to scripts.

use serde::Serialize;

use crate::scenario::Conditions;

/// `summary.json` of a flight. A length, time or factor that is not known is NaN, null in the file.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// The drone followed the route to its first snapshot and landed.
    pub completed: bool,
    /// Why the flight ended, for people.
    pub outcome: String,
    /// `emulator`, `native`, `board`, or `cfclient` where it was imported.
    pub backend: &'static str,
    /// Seed of world, sensors and camera noise.
    pub seed: u64,
    /// Name of the world.
    pub world: String,
    /// Name of the route.
    pub route: String,
    /// How it found back: `both`, `odometry` or `sequence`.
    pub homing: &'static str,
    /// Snapshot spacing, metres; not known where theory finds it, without meaning where `homing` is
    /// `odometry`.
    pub spacing_m: f64,
    /// What the flight was up against.
    pub conditions: Conditions,
    /// True length of the way out, metres.
    pub outbound_m: f64,
    /// True length of the way back, metres.
    pub inbound_m: f64,
    /// Distance from the true start to where the drone stands at the end, metres.
    pub home_error_m: f64,
    /// Inbound truth against the outbound path, root mean square, metres; zero where there was no
    /// way back.
    pub cross_track_rms_m: f64,
    /// Error at the end of the estimate that the camera never corrected, metres: as far from home
    /// would it have led.
    pub odometry_only_error_m: f64,
    /// Snapshots taken.
    pub snapshots: usize,
    /// Route memory with the odometry counts when the way out ended, bytes.
    pub memory_bytes: usize,
    /// `memory_bytes` per metre of the way out; zero where there was none.
    pub bytes_per_m: f64,
    /// Frames the camera sent while it was captured.
    pub frames_sent: u64,
    /// Frames captured whole.
    pub frames_captured: u64,
    /// Frames the camera sent and the firmware did not capture or did not process.
    pub frames_dropped: u64,
    /// VECTOR messages received.
    pub vectors: usize,
    /// Frames of the link.
    pub link: LinkFigures,
    /// How the clock on the wall and the peers were kept up with; none in virtual time.
    pub live: Option<LiveFigures>,
    /// Processor cycles per frame, frame to spectrum; none on the native backend.
    pub cycles_per_frame: Option<CyclesPerFrame>,
    /// Share of cycles in which the processor was awake, 0..=1; none on the native backend.
    pub cpu_load: Option<f64>,
    /// Flight time, seconds.
    pub flight_s: f64,
    /// Wall time, seconds. The only figures that differ from run to run are this and the next.
    pub wall_s: f64,
    /// `flight_s / wall_s`.
    pub realtime_factor: f64,
    /// The image; none on the native backend.
    pub firmware: Option<FirmwareFigures>,
}

/// Frames on the link, both ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LinkFigures {
    /// From the autopilot to the camera board.
    pub to_camera: DirectionFigures,
    /// From the camera board to the autopilot.
    pub to_autopilot: DirectionFigures,
}

/// Frames on the link, one way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct DirectionFigures {
    /// Frames that the sender put on the wire, whole.
    pub frames_sent: u64,
    /// Frames that the receiver named in its log as dropped. One broken frame can make several, one
    /// for each start byte in it.
    pub frames_dropped: u64,
}

/// A flight against the clock on the wall.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LiveFigures {
    /// How well it kept step.
    pub pace: PaceFigures,
    /// Where the other end of the link was met.
    pub link: String,
    /// How often a peer came there.
    pub link_peers: u32,
    /// Where the camera's pose came from, or went to.
    pub pose: String,
    /// How often a peer came there.
    pub pose_peers: u32,
    /// Poses received.
    pub poses: u64,
    /// Lines received that were none.
    pub bad_poses: u64,
}

/// How well steps of a millisecond kept up with the clock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PaceFigures {
    /// Virtual over real time; 1 unless asked for otherwise.
    pub speed: f64,
    /// How late the latest step began, real milliseconds.
    pub largest_lateness_ms: f64,
    /// Share of the steps that began more than 5 ms late, 0..=1.
    pub late_share: f64,
}

/// Quantiles of the cycles of one frame by the firmware's own counter, checked against the rig's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct CyclesPerFrame {
    /// Median.
    pub p50: u32,
    /// 99th percentile.
    pub p99: u32,
    /// Largest.
    pub max: u32,
    /// Median by the emulator's counter, read at the entry and return of the same function; none on a
    /// board that is there.
    pub emulator_p50: Option<u32>,
    /// Largest difference of the two counters over all frames; none on a board that is there.
    pub largest_disagreement: Option<u32>,
}

/// What the image needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct FirmwareFigures {
    /// Bytes of flash.
    pub flash_bytes: u32,
    /// Bytes of static RAM.
    pub ram_bytes: u32,
    /// Deepest stack of this flight, bytes; none where it reached into static RAM, and on a board, whose
    /// stack nobody looks at.
    pub stack_peak_bytes: Option<u32>,
}
