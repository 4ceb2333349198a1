//! The stages of a frame's way from the camera to the wire, and their functions in the image.

use serde::Serialize;

/// A stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// From the last pixel in memory until vision begins with the frame: a time, of which the core
    /// may sleep most.
    CaptureWait,
    /// From the frame to the horizon.
    Unwrap,
    /// From the horizon to its Fourier coefficients.
    Spectrum,
    /// The rest of what a frame takes: the exposure's control above all.
    Expose,
    /// From coefficients to the bytes of a snapshot.
    Quantise,
    /// The rotation that fits best.
    Align,
    /// The rest of the homing: the least squares and what goes with them.
    Solve,
    /// The rest of the answer to a message: the navigator.
    Navigate,
    /// From the answer until its first byte is on the wire: a time.
    Send,
}

impl Stage {
    /// In the order in which they run.
    pub const ALL: [Self; 9] = [
        Self::CaptureWait,
        Self::Unwrap,
        Self::Spectrum,
        Self::Expose,
        Self::Quantise,
        Self::Align,
        Self::Solve,
        Self::Navigate,
        Self::Send,
    ];

    /// The stages whose sum is `vision`.
    pub const VISION: [Self; 6] = [
        Self::Unwrap,
        Self::Spectrum,
        Self::Expose,
        Self::Quantise,
        Self::Align,
        Self::Solve,
    ];

    /// As in tables and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CaptureWait => "capture_wait",
            Self::Unwrap => "unwrap",
            Self::Spectrum => "spectrum",
            Self::Expose => "expose",
            Self::Quantise => "quantise",
            Self::Align => "align",
            Self::Solve => "solve",
            Self::Navigate => "navigate",
            Self::Send => "send",
        }
    }

    /// The functions of the image that are the stage, without those within that are another. None:
    /// the stage is a time between two events.
    pub const fn functions(self) -> &'static [&'static str] {
        match self {
            Self::CaptureWait | Self::Send => &[],
            Self::Unwrap => &["nav::panorama::PanoramaMap::horizon_and_band"],
            Self::Spectrum => &["nav::spectrum::Spectrum::of"],
            Self::Expose => &[VISION],
            Self::Quantise => &["nav::snapshot::Snapshot::quantise"],
            Self::Align => &["nav::homing::alignment::align_within"],
            Self::Solve => &["nav::homing::home"],
            Self::Navigate => &[ANSWER],
        }
    }
}

/// What looks at a frame, from the first to the last of it.
pub const VISION: &str = "vision_frame";

/// What answers a message.
pub const ANSWER: &str = "pilot::Pilot::on_message";
