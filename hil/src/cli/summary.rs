//! The summary of a flight for people, as `hil fly` ends with it.

use crate::summary::{DirectionFigures, Summary};

/// A row's name and its value.
type Line = (&'static str, String);

/// The verdict and a line a figure, without a newline at the end.
pub(super) fn in_words(summary: &Summary) -> String {
    let verdict = if summary.completed {
        "home"
    } else {
        "NOT HOME"
    };
    let speed = format!(
        "{:.0}x real time ({:.1} s)",
        summary.realtime_factor, summary.wall_s
    );
    let lines = way(summary)
        .into_iter()
        .chain(traffic(summary))
        .chain(board(summary))
        .chain([("speed", speed)])
        .map(|(name, value)| format!("  {name:<22}{value}"));
    let head = format!("{verdict}: {}", summary.outcome);
    std::iter::once(head)
        .chain(lines)
        .collect::<Vec<_>>()
        .join("\n")
}

/// Where the drone flew, and what it remembered of it.
fn way(summary: &Summary) -> [Line; 4] {
    let home_error = format!(
        "{:.2} m (odometry alone: {:.2} m)",
        summary.home_error_m, summary.odometry_only_error_m
    );
    let flown = format!(
        "{:.1} m out, {:.1} m back, {:.0} s",
        summary.outbound_m, summary.inbound_m, summary.flight_s
    );
    let memory = format!(
        "{} snapshots, {} bytes, {:.1} bytes/m",
        summary.snapshots, summary.memory_bytes, summary.bytes_per_m
    );
    [
        ("home error", home_error),
        (
            "cross-track error",
            format!("{:.2} m rms", summary.cross_track_rms_m),
        ),
        ("flown", flown),
        ("route memory", memory),
    ]
}

/// What went over the camera's wires and the link.
fn traffic(summary: &Summary) -> [Line; 2] {
    let frames = format!(
        "{} captured of {} sent, {} dropped",
        summary.frames_captured, summary.frames_sent, summary.frames_dropped
    );
    let one_way = |figures: DirectionFigures| {
        format!(
            "{} sent, {} dropped",
            figures.frames_sent, figures.frames_dropped
        )
    };
    let link = format!(
        "to camera {}; to autopilot {}",
        one_way(summary.link.to_camera),
        one_way(summary.link.to_autopilot)
    );
    [("frames", frames), ("link frames", link)]
}

/// What the image and the processor had to do with it, as far as there are such.
fn board(summary: &Summary) -> impl Iterator<Item = Line> {
    let cycles = summary.cycles_per_frame.as_ref().map(|cycles| {
        let text = format!("p50 {}, p99 {}, max {}", cycles.p50, cycles.p99, cycles.max);
        ("cycles per frame", text)
    });
    let load = summary
        .cpu_load
        .map(|load| ("processor load", format!("{:.1} %", 100.0 * load)));
    let firmware = summary.firmware.as_ref().map(|firmware| {
        let stack = match firmware.stack_peak_bytes {
            Some(bytes) => format!("{bytes} B stack"),
            None if summary.backend == "board" => "stack not measured".to_owned(),
            None => "stack overflown".to_owned(),
        };
        let text = format!(
            "{} B flash, {} B static RAM, {stack}",
            firmware.flash_bytes, firmware.ram_bytes
        );
        ("firmware", text)
    });
    [cycles, load, firmware].into_iter().flatten()
}
