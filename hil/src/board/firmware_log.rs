//! The firmware's log: defmt records out of RTT, decoded with the image's own table.

use defmt_decoder::{DecodeError, StreamDecoder, Table};

use super::{BoardError, FirmwareLog, FrameLog};

/// Decodes what comes out of the RTT channel.
pub struct LogDecoder<'t> {
    decoder: Box<dyn StreamDecoder + Send + Sync + 't>,
}

/// Reads the log table of an image.
pub fn table(elf: &[u8]) -> Result<Table, BoardError> {
    match Table::parse(elf) {
        Ok(Some(table)) => Ok(table),
        Ok(None) => Err(BoardError::LogTable(
            "the section .defmt is missing".to_owned(),
        )),
        Err(error) => Err(BoardError::LogTable(error.to_string())),
    }
}

impl<'t> LogDecoder<'t> {
    /// A decoder for one image.
    pub fn new(table: &'t Table) -> Self {
        Self {
            decoder: table.new_stream_decoder(),
        }
    }

    /// Takes bytes from the channel and appends the records that are complete.
    pub fn decode(&mut self, bytes: &[u8], into: &mut Vec<FirmwareLog>) -> Result<(), BoardError> {
        self.decoder.received(bytes);
        loop {
            match self.decoder.decode() {
                Ok(record) => {
                    let text = record.display_message().to_string();
                    let level = record.level().map_or("print", |level| level.as_str());
                    into.push(understood(level, text));
                }
                Err(DecodeError::UnexpectedEof) => return Ok(()),
                Err(DecodeError::Malformed) => return Err(BoardError::Log),
            }
        }
    }
}

/// A record that the rig reads by machine, or else a line for people.
fn understood(level: &'static str, text: String) -> FirmwareLog {
    if let Some(frame) = frame(&text) {
        FirmwareLog::Frame(frame)
    } else if let Some((message, why)) = link_drop(&text) {
        FirmwareLog::LinkDrop { message, why }
    } else if let Some(name) = text.strip_prefix("capture fault ") {
        FirmwareLog::CaptureFault {
            name: name.to_owned(),
        }
    } else {
        FirmwareLog::Line { level, text }
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
        };
        assert_eq!(
            understood("warn", "capture fault short line".to_owned()),
            fault
        );
    }

    #[test]
    fn a_dropped_frame_of_the_link_is_told_with_its_message_and_reason() {
        let dropped = FirmwareLog::LinkDrop {
            message: "STATE".to_owned(),
            why: "cut short".to_owned(),
        };
        assert_eq!(
            understood("warn", "link dropped STATE cut short".to_owned()),
            dropped
        );
    }
}
