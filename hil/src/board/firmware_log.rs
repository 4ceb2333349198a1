//! The firmware's log: defmt records out of RTT, decoded with the image's own table.

use std::collections::BTreeMap;

use defmt_decoder::{DecodeError, Frame, StreamDecoder, Table};

use super::origin::{Origin, Place};
use super::{BoardError, FirmwareLog, FrameLog};

/// What an image says of its log statements.
#[derive(Debug)]
pub struct LogTable {
    table: Table,
    /// By the index of the statement; empty where the image has no debug information.
    places: BTreeMap<u64, Place>,
}

impl LogTable {
    /// Reads the table of an image.
    pub fn parse(elf: &[u8]) -> Result<Self, BoardError> {
        let unusable = |error: &dyn ToString| BoardError::LogTable(error.to_string());
        let table = Table::parse(elf)
            .map_err(|error| unusable(&error))?
            .ok_or_else(|| unusable(&"the section .defmt is missing"))?;
        // A log without places is a log: a stripped image has none.
        let locations = table.get_locations(elf).unwrap_or_default();
        let places = locations
            .into_iter()
            .map(|(index, location)| (index, location.into()))
            .collect();
        Ok(Self { table, places })
    }

    fn origin(&self, record: &Frame<'_>) -> Origin {
        Origin {
            stamp: record
                .display_timestamp()
                .map(|stamp| stamp.to_string())
                .unwrap_or_default(),
            place: self.places.get(&record.index()).cloned(),
        }
    }
}

/// Decodes what comes out of the RTT channel.
pub struct LogDecoder<'t> {
    table: &'t LogTable,
    decoder: Box<dyn StreamDecoder + Send + Sync + 't>,
}

impl<'t> LogDecoder<'t> {
    /// A decoder for one image.
    pub fn new(table: &'t LogTable) -> Self {
        Self {
            table,
            decoder: table.table.new_stream_decoder(),
        }
    }

    /// The firmware was reset: the rest of what it was about to say will not come.
    pub fn restart(&mut self) {
        *self = Self::new(self.table);
    }

    /// Takes bytes from the channel and appends the records that are complete.
    pub fn decode(&mut self, bytes: &[u8], into: &mut Vec<FirmwareLog>) -> Result<(), BoardError> {
        self.decoder.received(bytes);
        loop {
            match self.decoder.decode() {
                Ok(record) => {
                    let text = record.display_message().to_string();
                    let level = record.level().map_or("print", |level| level.as_str());
                    let origin = self.table.origin(&record);
                    into.push(understood(level, text, origin));
                }
                Err(DecodeError::UnexpectedEof) => return Ok(()),
                Err(DecodeError::Malformed) => return Err(BoardError::Log),
            }
        }
    }
}

/// A record that the rig reads by machine, or else a line for people.
pub(crate) fn understood(level: &'static str, text: String, origin: Origin) -> FirmwareLog {
    let origin = Some(origin);
    if let Some(frame) = frame(&text) {
        FirmwareLog::Frame(frame)
    } else if let Some((message, why)) = link_drop(&text) {
        FirmwareLog::LinkDrop {
            message,
            why,
            origin,
        }
    } else if let Some(name) = text.strip_prefix("capture fault ") {
        FirmwareLog::CaptureFault {
            name: name.to_owned(),
            origin,
        }
    } else {
        FirmwareLog::Line {
            level,
            text,
            origin,
        }
    }
}

/// Reads `link dropped MESSAGE WHY`; the reason may be several words.
fn link_drop(text: &str) -> Option<(String, String)> {
    let (message, why) = text.strip_prefix("link dropped ")?.split_once(' ')?;
    Some((message.to_owned(), why.to_owned()))
}

/// Reads `frame N cycles N luma X lines N gain X`.
fn frame(text: &str) -> Option<FrameLog> {
    let words: Vec<&str> = text.split(' ').collect();
    let [
        "frame",
        _,
        "cycles",
        cycles,
        "luma",
        luma,
        "lines",
        lines,
        "gain",
        gain,
    ] = words.as_slice()
    else {
        return None;
    };
    Some(FrameLog {
        cycles: Some(cycles.parse().ok()?),
        luma: luma.parse().ok()?,
        lines: lines.parse().ok()?,
        gain: gain.parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin() -> Origin {
        Origin {
            stamp: "0.000001".to_owned(),
            place: None,
        }
    }

    #[test]
    fn the_line_of_a_frame_is_read_whole_or_not_at_all() {
        let line = "frame 17 cycles 93986 luma 79.5 lines 135 gain 1.0";
        let read = FrameLog {
            cycles: Some(93_986),
            luma: 79.5,
            lines: 135,
            gain: 1.0,
        };
        assert_eq!(frame(line), Some(read));
        assert_eq!(
            frame("frame 17 cycles many luma 79.5 lines 135 gain 1.0"),
            None
        );
        assert_eq!(frame("state cycles 17"), None);
    }

    #[test]
    fn a_fault_of_the_capture_is_told_with_its_name() {
        let fault = FirmwareLog::CaptureFault {
            name: "short line".to_owned(),
            origin: Some(origin()),
        };
        assert_eq!(
            understood("warn", "capture fault short line".to_owned(), origin()),
            fault
        );
    }

    #[test]
    fn a_dropped_frame_of_the_link_is_told_with_its_message_and_reason() {
        let dropped = FirmwareLog::LinkDrop {
            message: "STATE".to_owned(),
            why: "cut short".to_owned(),
            origin: Some(origin()),
        };
        assert_eq!(
            understood("warn", "link dropped STATE cut short".to_owned(), origin()),
            dropped
        );
    }
}
