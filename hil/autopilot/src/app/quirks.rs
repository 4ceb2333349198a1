//! The published client's peculiarities on the link, each with a switch.

use super::value_check::ValueCheck;

/// What the receiving half of the app does as the published build does it, bugs included. Each field
/// is one peculiarity: `true` behaves as the real app, `false` as an app without it.
///
/// Source: the client of tomvand/2020-visualhoming-crazyflie with the transport that pprzlink 2.0
/// generates for it, on a Crazyflie's UART2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quirks {
    /// The app takes its own COMMAND for the camera's echo: it sends each command once and never
    /// again, whether the camera has heard it or not, unless the camera reports another mode later.
    ///
    /// The real loop handles a message variable before the first receive call has filled it. Built
    /// for size (gcc, `-Os`, Cortex-M4) that variable shares its place on the stack with the COMMAND
    /// just sent. Builds that lay out the stack in another way repeat the command at 10 Hz.
    pub self_acknowledge: bool,
    /// The variable that is handled before it is filled still holds what the last receive call of an
    /// earlier cycle put into it: that message is handled once more, however old it is.
    ///
    /// In the real app the leftover is whatever the stack happens to hold; a message of the cycle
    /// before is the one content that has an effect and can be foretold. In a cycle that sends a
    /// COMMAND, [`Quirks::self_acknowledge`] takes precedence: the same place then holds the COMMAND.
    pub stack_leftovers: bool,
    /// The result of the receive call is ignored: where nothing came, the last message is handled
    /// again, up to ten times a cycle. Harmless as long as every handler is idempotent; that a
    /// correction is applied once hangs on its index alone.
    pub repeats_last_message: bool,
    /// A message is handled at the beginning of the next receive call, so what the tenth and last
    /// call of a cycle receives is never used.
    pub drops_tenth_message: bool,
    /// UART2 has room for 200 bytes. What comes while it is full is lost, the newest first; a frame
    /// cut like that takes more with it. Without the quirk there is room for everything.
    pub short_buffer: bool,
    /// What came before take-off is read in the first cycle in the air, as if it were new. Without
    /// the quirk it is thrown away then.
    pub keeps_ground_bytes: bool,
    /// Frames are found by the generated C receiver: after a bad checksum it does not search the
    /// bytes again that the broken frame claimed, lengths below 8 wrap round, class and length are
    /// not checked, and a field that the frame is too short for is read from what is left of older
    /// frames. Without the quirk, by [`link::Parser`], which is strict and searches again.
    pub published_receiver: bool,
    /// Targets and corrections are not looked at: NaN, infinities and places beyond the world go to
    /// controller and filter. Without the quirk such a value ends the flight
    /// ([`crate::app::Outcome::BrokenMessage`]) before it gets there.
    pub unchecked_values: bool,
}

impl Quirks {
    /// The published app, in a build that repeats its commands, with one departure: values are
    /// checked. The camera never sends what is no number, so the check can only be met by a corrupted
    /// frame whose checksum holds, and a rig should then say so instead of flying after it.
    pub const PUBLISHED: Self = Self {
        self_acknowledge: false,
        stack_leftovers: false,
        repeats_last_message: true,
        drops_tenth_message: true,
        short_buffer: true,
        keeps_ground_bytes: true,
        published_receiver: true,
        unchecked_values: false,
    };

    /// An app without its bugs.
    pub const NONE: Self = Self {
        self_acknowledge: false,
        stack_leftovers: false,
        repeats_last_message: false,
        drops_tenth_message: false,
        short_buffer: false,
        keeps_ground_bytes: false,
        published_receiver: false,
        unchecked_values: false,
    };

    /// How values are looked at.
    pub(super) fn value_check(&self) -> ValueCheck {
        if self.unchecked_values {
            ValueCheck::Unchecked
        } else {
            ValueCheck::Checked
        }
    }
}

impl Default for Quirks {
    fn default() -> Self {
        Self::PUBLISHED
    }
}
