//! The command byte: what the autopilot asks of the camera, and what the camera reports to be doing.
//!
//! The camera echoes the byte it was sent and keeps reporting it; the autopilot repeats a command
//! every 100 ms until the echo comes. A repeated byte is a retransmission, never a second order.

/// Bit 0 of a recording mode: take snapshots.
const SNAPSHOTS: u8 = 0x01;
/// Bit 1 of a recording mode: store odometry vectors.
const ODOMETRY: u8 = 0x02;
/// Bit 2 of a recording mode: take snapshots in close sequence, to be followed without odometry.
const SEQUENCE: u8 = 0x04;

/// What the camera is to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mode {
    /// 0x00: neither record nor follow; the route is kept.
    Idle,
    /// 0x0F: forget the route.
    Clear,
    /// 0x01 to 0x07: record while the autopilot flies.
    Record(Record),
    /// 0x11: home to the last snapshot and stay there.
    FollowAndStay,
    /// 0x12: fly back along the route.
    Follow,
}

/// Which parts of a route are recorded. At least one is set in a valid command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record {
    /// Take snapshots of the horizon.
    pub snapshots: bool,
    /// Store odometry vectors.
    pub odometry: bool,
    /// Take snapshots in close sequence (together with `snapshots`).
    pub sequence: bool,
}

impl Record {
    /// One snapshot here, nothing else (0x01).
    pub const SINGLE_SNAPSHOT: Self = Self::new(true, false, false);
    /// Odometry vectors only (0x02).
    pub const ODOMETRY: Self = Self::new(false, true, false);
    /// Snapshots and the odometry between them (0x03): the route following of the paper.
    pub const ROUTE: Self = Self::new(true, true, false);
    /// A dense sequence of snapshots without odometry (0x05).
    pub const SEQUENCE: Self = Self::new(true, false, true);
    /// The same with odometry (0x07). The camera records it as it does [`Self::ROUTE`].
    pub const SEQUENCE_WITH_ODOMETRY: Self = Self::new(true, true, true);

    const fn new(snapshots: bool, odometry: bool, sequence: bool) -> Self {
        Self {
            snapshots,
            odometry,
            sequence,
        }
    }

    const fn bits(self) -> u8 {
        (if self.snapshots { SNAPSHOTS } else { 0 })
            | (if self.odometry { ODOMETRY } else { 0 })
            | (if self.sequence { SEQUENCE } else { 0 })
    }
}

impl Mode {
    /// The command byte.
    pub const fn byte(self) -> u8 {
        match self {
            Self::Idle => 0x00,
            Self::Clear => 0x0f,
            Self::Record(record) => record.bits(),
            Self::FollowAndStay => 0x11,
            Self::Follow => 0x12,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, Record};

    #[test]
    fn every_button_of_the_operator_has_a_mode_with_its_byte() {
        for (mode, byte) in [
            (Mode::Idle, 0x00),
            (Mode::Clear, 0x0f),
            (Mode::Record(Record::SINGLE_SNAPSHOT), 0x01),
            (Mode::Record(Record::SEQUENCE), 0x05),
            (Mode::Record(Record::ODOMETRY), 0x02),
            (Mode::Record(Record::ROUTE), 0x03),
            (Mode::Record(Record::SEQUENCE_WITH_ODOMETRY), 0x07),
            (Mode::FollowAndStay, 0x11),
            (Mode::Follow, 0x12),
        ] {
            assert_eq!(mode.byte(), byte);
        }
    }
}
