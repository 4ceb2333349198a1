//! A log that somebody else has decoded: a line of time stamp, level and message.

use crate::board::FirmwareLog;
use crate::board::firmware_log::understood;
use crate::board::origin::Origin;

/// Levels as defmt names them.
const LEVELS: [&str; 5] = ["error", "warn", "info", "debug", "trace"];

/// Reads a line of `{t} {L} {s}`; none where it is no such line.
pub fn read(line: &str) -> Option<FirmwareLog> {
    let mut words = line.splitn(3, ' ');
    let (stamp, level, text) = (words.next()?, words.next()?, words.next()?);
    let level = LEVELS
        .iter()
        .find(|known| known.eq_ignore_ascii_case(level))?;
    let origin = Origin {
        stamp: stamp.to_owned(),
        place: None,
    };
    Some(understood(level, text.trim_start().to_owned(), origin))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::FrameLog;

    #[test]
    fn a_line_is_read_as_if_the_rig_had_decoded_it() {
        let line = "1.234567 DEBUG frame 17 cycles 93986 luma 79.5 lines 135 gain 1.0";
        let frame = FrameLog {
            cycles: Some(93_986),
            luma: 79.5,
            lines: 135,
            gain: 1.0,
        };
        assert_eq!(read(line), Some(FirmwareLog::Frame(frame)));
        let Some(FirmwareLog::Line { level, text, .. }) = read("0.000001 INFO memory kept false")
        else {
            panic!("a line");
        };
        assert_eq!((level, text.as_str()), ("info", "memory kept false"));
    }

    #[test]
    fn what_the_tool_says_of_itself_is_no_line_of_the_firmware() {
        assert_eq!(read("Firmware exited successfully"), None);
        assert_eq!(read(""), None);
    }
}
