//! Which image: what it may do, and on which board.

use std::fmt;

use frames::{BoardName, ImageKind};

/// What the firmware's build reads the rate of the wire from that takes frames.
pub(super) const SERIAL_BAUD: &str = "CATAGLYPHIS_SERIAL_BAUD";

/// An image among those that the firmware can be built into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// What it may do.
    pub kind: ImageKind,
    /// Whose pins it uses.
    pub board: BoardName,
    /// The rate at which a rig image takes frames, baud; none is [`frames::DEFAULT_BAUD`].
    pub baud: Option<u32>,
}

impl Variant {
    /// The image that flies.
    pub const FLIGHT: Self = Self {
        kind: ImageKind::Flight,
        board: BoardName::Flight,
        baud: None,
    };

    /// The image that takes frames over serial, on the board that flies.
    pub const RIG: Self = Self {
        kind: ImageKind::Rig,
        ..Self::FLIGHT
    };

    /// cargo's arguments for it. The image that flies is what cargo builds without any.
    pub(super) fn arguments(&self) -> Vec<String> {
        let mut features = Vec::new();
        if self.board == BoardName::Discovery {
            features.push("board-discovery");
        }
        if self.kind == ImageKind::Rig {
            features.push("rig");
        }
        let mut arguments = Vec::new();
        if self.board != BoardName::Flight {
            arguments.push("--no-default-features".to_owned());
        }
        if !features.is_empty() {
            arguments.push(format!("--features={}", features.join(",")));
        }
        arguments
    }
}

impl fmt::Display for Variant {
    /// The name of its file, without extension: `firmware-rig-discovery`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "firmware-{}-{}", self.kind.name(), self.board.name())?;
        match self.baud {
            Some(baud) => write!(f, "-{baud}"),
            None => Ok(()),
        }
    }
}
