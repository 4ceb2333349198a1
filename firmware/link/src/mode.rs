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
    /// 0x11: fly back along the route and stay at its start, or home to a single snapshot for ever.
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
    /// A dense sequence of snapshots with odometry (0x07).
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

    /// The mode a command byte asks for; `None` for a byte no operator's button sends.
    ///
    /// Clear shares its low bits with the recording modes, so it is recognised first.
    pub const fn from_byte(byte: u8) -> Option<Self> {
        match byte {
            0x00 => Some(Self::Idle),
            0x0f => Some(Self::Clear),
            0x01..=0x07 => Some(Self::Record(Record {
                snapshots: byte & SNAPSHOTS != 0,
                odometry: byte & ODOMETRY != 0,
                sequence: byte & SEQUENCE != 0,
            })),
            0x11 => Some(Self::FollowAndStay),
            0x12 => Some(Self::Follow),
            _ => None,
        }
    }

    /// Whether the camera steers in this mode.
    pub const fn follows(self) -> bool {
        matches!(self, Self::FollowAndStay | Self::Follow)
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, Record};

    #[test]
    fn every_button_of_the_operator_has_a_mode_that_gives_its_byte_back() {
        for byte in [0x00, 0x0f, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12] {
            assert_eq!(Mode::from_byte(byte).map(Mode::byte), Some(byte));
        }
    }

    #[test]
    fn clear_is_not_a_recording_mode() {
        assert_eq!(Mode::from_byte(0x0f), Some(Mode::Clear));
        assert_eq!(Mode::from_byte(0x03), Some(Mode::Record(Record::ROUTE)));
    }

    #[test]
    fn bytes_without_a_button_have_no_mode() {
        for byte in [0x08, 0x0e, 0x10, 0x13, 0x1f, 0xff] {
            assert_eq!(Mode::from_byte(byte), None);
        }
    }
}
