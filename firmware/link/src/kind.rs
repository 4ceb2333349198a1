//! The kinds of messages: ids, names, and how long their bodies are.

/// Which message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Kind {
    Debug = 5,
    Command = 6,
    Vector = 9,
    State = 10,
    Map = 11,
    InsCorrection = 12,
    Camera = 15,
}

/// Bytes of an array's length.
const COUNT: usize = 1;

impl Kind {
    /// The message with this id; `None` if the link has none.
    pub(crate) const fn of(id: u8) -> Option<Self> {
        Some(match id {
            5 => Self::Debug,
            6 => Self::Command,
            9 => Self::Vector,
            10 => Self::State,
            11 => Self::Map,
            12 => Self::InsCorrection,
            15 => Self::Camera,
            _ => return None,
        })
    }

    /// Its id in the class `intermcu`.
    pub(crate) const fn id(self) -> u8 {
        self as u8
    }

    /// Its name in the published list, without the prefix.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Debug => "DEBUG",
            Self::Command => "COMMAND",
            Self::Vector => "VECTOR",
            Self::State => "STATE",
            Self::Map => "MAP",
            Self::InsCorrection => "INS_CORRECTION",
            Self::Camera => "CAMERA",
        }
    }

    /// Bytes of its scalar fields and of its array's length, which is the last of them.
    pub(crate) const fn fixed_len(self) -> usize {
        match self {
            Self::Debug | Self::Camera => COUNT,
            Self::Command => 1 + COUNT,
            Self::Vector => 5 * 4 + 1,
            Self::State => 5 * 4,
            Self::Map => 2 * (2 + 2 * 4) + COUNT,
            Self::InsCorrection => 2 + 6 * 4,
        }
    }

    /// Whether its body ends in an array of bytes.
    pub(crate) const fn has_array(self) -> bool {
        matches!(self, Self::Debug | Self::Command | Self::Map | Self::Camera)
    }
}
