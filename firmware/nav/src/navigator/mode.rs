//! What the autopilot asks for: one byte, kept and echoed as it came.

/// What is being recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Recording {
    /// Bit 0: snapshots.
    pub snapshots: bool,
    /// Bit 1: odometry vectors.
    pub odometry: bool,
    /// Bit 2: a sequence of snapshots instead of a single one.
    pub sequence: bool,
}

impl Recording {
    /// Whether snapshots go on after the first: along odometry always, without it only as a sequence.
    pub const fn repeats_snapshots(&self) -> bool {
        self.snapshots && (self.odometry || self.sequence)
    }
}

/// The camera's mode. Each mode has exactly one byte (VISUALHOMING_COMMAND of the Crazyflie app).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mode {
    /// 0x00: does nothing, and keeps the route.
    Idle,
    /// 0x0F: has forgotten the route, and does nothing.
    Clear,
    /// 0x01: one snapshot. 0x02: odometry. 0x03, 0x07: odometry, and snapshots along it. 0x05: a
    /// sequence of snapshots for purely visual homing from one to the next; it stores no way between
    /// them, so that odometry recorded after it does not lead back to its end.
    Record(Recording),
    /// 0x11: homes at the last snapshot and stays there.
    FollowStay,
    /// 0x12: follows the route home, consuming it, and holds there.
    Follow,
}

impl Mode {
    const CLEAR: u8 = 0x0F;
    const FOLLOW_STAY: u8 = 0x11;
    const FOLLOW: u8 = 0x12;
    const SNAPSHOTS: u8 = 1 << 0;
    const ODOMETRY: u8 = 1 << 1;
    const SEQUENCE: u8 = 1 << 2;

    /// The mode of a command byte; none where it is not a command.
    pub const fn from_byte(byte: u8) -> Option<Self> {
        // Clear has all the recording bits and comes before them.
        match byte {
            0 => Some(Self::Idle),
            Self::CLEAR => Some(Self::Clear),
            Self::FOLLOW_STAY => Some(Self::FollowStay),
            Self::FOLLOW => Some(Self::Follow),
            // A sequence of nothing is not a command.
            Self::SEQUENCE => None,
            bits if bits <= Self::SNAPSHOTS | Self::ODOMETRY | Self::SEQUENCE => {
                Some(Self::Record(Recording {
                    snapshots: bits & Self::SNAPSHOTS != 0,
                    odometry: bits & Self::ODOMETRY != 0,
                    sequence: bits & Self::SEQUENCE != 0,
                }))
            }
            _ => None,
        }
    }

    /// The command byte of the mode: what [`Self::from_byte`] took.
    pub const fn byte(&self) -> u8 {
        match self {
            Self::Idle => 0,
            Self::Clear => Self::CLEAR,
            Self::FollowStay => Self::FOLLOW_STAY,
            Self::Follow => Self::FOLLOW,
            Self::Record(what) => {
                (what.snapshots as u8 * Self::SNAPSHOTS)
                    | (what.odometry as u8 * Self::ODOMETRY)
                    | (what.sequence as u8 * Self::SEQUENCE)
            }
        }
    }
}

/// A byte that is no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct UnknownCommand(pub u8);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_button_of_the_app_is_a_mode_and_is_echoed_as_the_same_byte() {
        for byte in [0x00, 0x0F, 0x01, 0x05, 0x02, 0x03, 0x07, 0x11, 0x12] {
            assert_eq!(Mode::from_byte(byte).map(|mode| mode.byte()), Some(byte));
        }
    }

    #[test]
    fn clear_is_not_taken_for_recording_everything() {
        assert_eq!(Mode::from_byte(0x0F), Some(Mode::Clear));
    }

    #[test]
    fn what_is_no_command_is_refused() {
        let known = (0..=u8::MAX).filter(|&byte| Mode::from_byte(byte).is_some());
        assert!(known.eq([0, 1, 2, 3, 5, 6, 7, 0x0F, 0x11, 0x12]));
    }
}
