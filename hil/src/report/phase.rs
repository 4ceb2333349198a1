//! Phases of the flight as they are named and drawn: the colours of van Dijk et al. 2024, Fig. 6,
//! and a dash pattern or width of their own for those who do not tell the colours apart.

use crate::record::{Phase, TrackPoint};

/// A stretch of time in one phase.
pub struct PhaseSpan {
    /// What the drone was doing.
    pub phase: Phase,
    /// First and last flight time, seconds.
    pub time: [f64; 2],
}

/// Name of the phase's colour in the style sheet.
pub fn colour(phase: Phase) -> &'static str {
    match phase {
        Phase::Ground => "muted",
        Phase::Outbound => "outbound",
        Phase::Odometry => "odometry",
        Phase::Homing => "homing",
    }
}

/// Classes of a line flown in this phase.
pub fn line_class(phase: Phase) -> &'static str {
    match phase {
        Phase::Ground => "line ground s-muted",
        Phase::Outbound => "line outbound s-outbound",
        Phase::Odometry => "line odometry s-odometry",
        Phase::Homing => "line homing s-homing",
    }
}

/// The phase in words.
pub fn label(phase: Phase) -> &'static str {
    match phase {
        Phase::Ground => "on the ground",
        Phase::Outbound => "outbound, recording",
        Phase::Odometry => "inbound, by odometry",
        Phase::Homing => "inbound, by camera",
    }
}

/// The flight cut where its phase changes; each piece begins with the last point of the one
/// before, so that the path has no gaps.
pub fn pieces(track: &[TrackPoint]) -> Vec<(Phase, &[TrackPoint])> {
    let mut begin = 0;
    track
        .chunk_by(|a, b| a.phase == b.phase)
        .map(|chunk| {
            let piece = &track[begin.max(1) - 1..begin + chunk.len()];
            begin += chunk.len();
            (chunk[0].phase, piece)
        })
        .collect()
}

/// The phases in the order of time, without gaps.
pub fn spans(track: &[TrackPoint]) -> Vec<PhaseSpan> {
    let span = |(phase, piece): (Phase, &[TrackPoint])| {
        let time = [piece.first()?.t, piece.last()?.t];
        Some(PhaseSpan { phase, time })
    };
    pieces(track).into_iter().filter_map(span).collect()
}
