//! What can go wrong between the sensor and memory, by name.

/// A fault of the camera's signal or of its way into memory. Each cost at least one frame; none of
/// them ever shows in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// No line has come for [`timing::SILENCE`](super::timing::SILENCE): the clock stands, the
    /// sensor is off, or the cable is.
    NoSignal,
    /// Lines come, but no vertical sync, or a frame went on beyond its last line.
    NoVsync,
    /// A frame passed without a line: the horizontal sync is missing.
    NoLines,
    /// A line ended before its last byte.
    ShortLine,
    /// A line or a frame brought more bytes than it has.
    ExtraBytes,
    /// A frame ended before its last line.
    MissingLines,
    /// The clock stood in the middle of a frame, and goes again.
    StoppedClock,
    /// The DMA came too late, and the interface lost bytes.
    Overrun,
    /// The bus refused the DMA, or the DMA's stream was off while data came.
    DmaError,
}

impl Fault {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::NoSignal,
        Self::NoVsync,
        Self::NoLines,
        Self::ShortLine,
        Self::ExtraBytes,
        Self::MissingLines,
        Self::StoppedClock,
        Self::Overrun,
        Self::DmaError,
    ];

    /// In words, for logs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoSignal => "no signal",
            Self::NoVsync => "no vsync",
            Self::NoLines => "no lines",
            Self::ShortLine => "short line",
            Self::ExtraBytes => "extra bytes",
            Self::MissingLines => "missing lines",
            Self::StoppedClock => "stopped clock",
            Self::Overrun => "overrun",
            Self::DmaError => "dma error",
        }
    }

    /// Its bit in a word of pending faults.
    pub(super) const fn bit(self) -> u32 {
        1 << self as u32
    }
}
