//! What becomes of frames.

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Verdict {
    /// The firmware has looked at it.
    Used,
    /// Whole, but a newer one was there before the firmware could look.
    Missed,
    /// A part of it did not arrive.
    Torn,
    /// Older than one that was there before it, or longer on the way than the session allows.
    Late,
    /// A frame of its number was there already.
    Repeated,
    /// There was no buffer for it: the camera has them, or the firmware was still reading.
    Busy,
}

impl Verdict {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 6] = [
        Self::Used,
        Self::Missed,
        Self::Torn,
        Self::Late,
        Self::Repeated,
        Self::Busy,
    ];

    /// In a word, for logs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Missed => "missed",
            Self::Torn => "torn",
            Self::Late => "late",
            Self::Repeated => "repeated",
            Self::Busy => "busy",
        }
    }

    pub(crate) fn of(byte: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|verdict| *verdict as u8 == byte)
    }
}

/// Where the firmware's frames come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Source {
    /// From the camera.
    Camera,
    /// From the wire.
    Serial,
}

impl Source {
    pub(crate) fn of(byte: u8) -> Option<Self> {
        [Self::Camera, Self::Serial]
            .into_iter()
            .find(|source| *source as u8 == byte)
    }
}

/// How often each thing happened since the receiver was made. Wrapping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Frames that arrived whole and in time.
    pub whole: u32,
    /// Frames of [`Verdict::Torn`].
    pub torn: u32,
    /// Frames of [`Verdict::Late`].
    pub late: u32,
    /// Frames of [`Verdict::Repeated`].
    pub repeated: u32,
    /// Frames of [`Verdict::Busy`].
    pub busy: u32,
    /// Records that were none ([`crate::Damage`]).
    pub corrupt: u32,
}

impl Counts {
    pub(crate) const NONE: Self = Self {
        whole: 0,
        torn: 0,
        late: 0,
        repeated: 0,
        busy: 0,
        corrupt: 0,
    };

    pub(crate) fn drop(&mut self, why: Verdict) {
        let count = match why {
            Verdict::Used | Verdict::Missed => return,
            Verdict::Torn => &mut self.torn,
            Verdict::Late => &mut self.late,
            Verdict::Repeated => &mut self.repeated,
            Verdict::Busy => &mut self.busy,
        };
        *count = count.wrapping_add(1);
    }

    pub(crate) const fn to_array(self) -> [u32; 6] {
        [
            self.whole,
            self.torn,
            self.late,
            self.repeated,
            self.busy,
            self.corrupt,
        ]
    }

    pub(crate) const fn of(array: [u32; 6]) -> Self {
        let [whole, torn, late, repeated, busy, corrupt] = array;
        Self {
            whole,
            torn,
            late,
            repeated,
            busy,
            corrupt,
        }
    }
}
