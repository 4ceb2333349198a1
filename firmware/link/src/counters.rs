//! What the parser has seen, in numbers.

use crate::refusal::Refusal;

/// How often each thing happened since the parser was made. Saturating.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counters {
    /// Frames delivered.
    pub frames_ok: u32,
    /// Bytes that belonged to no delivered frame.
    pub bytes_skipped: u32,
    /// Start bytes refused for [`Refusal::BadLength`].
    pub bad_length: u32,
    /// Start bytes refused for [`Refusal::WrongClass`].
    pub wrong_class: u32,
    /// Start bytes refused for [`Refusal::UnknownMessage`].
    pub unknown_message: u32,
    /// Start bytes refused for [`Refusal::WrongSize`].
    pub wrong_size: u32,
    /// Start bytes refused for [`Refusal::BadChecksum`].
    pub bad_checksum: u32,
    /// Start bytes refused for [`Refusal::CutShort`].
    pub cut_short: u32,
}

impl Counters {
    pub(crate) const NONE: Self = Self {
        frames_ok: 0,
        bytes_skipped: 0,
        bad_length: 0,
        wrong_class: 0,
        unknown_message: 0,
        wrong_size: 0,
        bad_checksum: 0,
        cut_short: 0,
    };

    /// Counts a frame.
    pub(crate) fn deliver(&mut self) {
        self.frames_ok = self.frames_ok.saturating_add(1);
    }

    /// Counts a start byte that belongs to no frame.
    pub(crate) fn refuse(&mut self, why: Refusal) {
        let counter = match why {
            Refusal::BadLength => &mut self.bad_length,
            Refusal::WrongClass => &mut self.wrong_class,
            Refusal::UnknownMessage => &mut self.unknown_message,
            Refusal::WrongSize => &mut self.wrong_size,
            Refusal::BadChecksum => &mut self.bad_checksum,
            Refusal::CutShort => &mut self.cut_short,
        };
        *counter = counter.saturating_add(1);
        self.skip(1);
    }

    /// Counts bytes that belong to no frame.
    pub(crate) fn skip(&mut self, bytes: usize) {
        let bytes = u32::try_from(bytes).unwrap_or(u32::MAX);
        self.bytes_skipped = self.bytes_skipped.saturating_add(bytes);
    }
}
