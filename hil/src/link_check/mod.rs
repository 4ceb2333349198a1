//! Holds the link's codec against records of another implementation's: one JSON object a line.
//!
//! The generated C receiver of pprzlink checks nothing but the checksum and goes on behind the bytes a broken frame
//! claimed; ours is strict and searches those bytes again. So a record is compared in two steps:
//!
//! * the frames that were delivered and are well formed must come out, in that order, with the same fields, bit for
//!   bit; frames that are not well formed must not;
//! * whatever else comes out must be a whole frame that stands verbatim in the stream, between those frames: one that
//!   the other receiver lost. [`Report::recovered`] counts them.
//!
//! Both hold whether the stream comes whole, byte by byte, or in the pieces it was recorded in. Where the record has
//! the message that was sent, its frame must be the stream.

mod notation;
mod record;

pub use notation::{Fields, NotAMessage, describe};
pub use record::{Delivered, Hex, NotHex, Record, Sent};

use std::collections::BTreeMap;

use link::{Frame, Parser};
use serde::Serialize;

/// What became of a file.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Records read.
    pub records: usize,
    /// Names of those that do not hold.
    pub failed: Vec<String>,
    /// Records whose stream was also encoded from the message that was sent.
    pub encoded: usize,
    /// By record: frames that the recorded receiver lost and ours delivers; only where there are any.
    pub recovered: BTreeMap<String, usize>,
    /// Why each of the failed does not hold.
    #[serde(skip)]
    pub reasons: Vec<String>,
}

/// A file that is no list of records.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A line is not a record.
    #[error("line {line}: {cause}")]
    Malformed {
        /// The line, from 1.
        line: usize,
        /// What JSON found.
        cause: serde_json::Error,
    },
    /// What was sent is no message.
    #[error("line {line}: sent: {cause}")]
    Sent {
        /// The line, from 1.
        line: usize,
        /// What is wrong with it.
        cause: NotAMessage,
    },
    /// There is nothing in it: nothing was checked, and nothing shall look as if it were.
    #[error("the file holds no record")]
    Empty,
}

/// Checks every record of a file.
pub fn check(text: &str) -> Result<Report, CheckError> {
    let mut report = Report::default();
    let lines = (1..).zip(text.lines());
    for (line, text) in lines.filter(|(_, text)| !text.trim().is_empty()) {
        let record: Record =
            serde_json::from_str(text).map_err(|cause| CheckError::Malformed { line, cause })?;
        let encoded = record
            .encoded()
            .map_err(|cause| CheckError::Sent { line, cause })?;
        report.include(&record, encoded);
    }
    if report.records == 0 {
        Err(CheckError::Empty)
    } else {
        Ok(report)
    }
}

impl Report {
    fn include(&mut self, record: &Record, encoded: Option<Vec<u8>>) {
        self.records += 1;
        self.encoded += usize::from(encoded.is_some());
        match record.compare(encoded) {
            Ok(0) => (),
            Ok(recovered) => {
                self.recovered.insert(record.name.clone(), recovered);
            }
            Err(reason) => {
                self.failed.push(record.name.clone());
                self.reasons.push(format!("{}: {reason}", record.name));
            }
        }
    }
}

impl Record {
    /// The frame of what was sent, if that is known.
    fn encoded(&self) -> Result<Option<Vec<u8>>, NotAMessage> {
        let Some(sent) = &self.sent else {
            return Ok(None);
        };
        let frame = Frame {
            sender: sent.sender,
            receiver: sent.receiver,
            component: 0,
            message: notation::message(&sent.name, &sent.fields)?,
        };
        Ok(Some(frame.encode().to_vec()))
    }

    /// How many frames were recovered if everything holds, else what does not.
    fn compare(&self, encoded: Option<Vec<u8>>) -> Result<usize, String> {
        let stream = &self.stream.0;
        if encoded.is_some_and(|encoded| encoded != *stream) {
            return Err("what was sent is encoded to other bytes".to_owned());
        }
        let recovered = self.recovered(&parse([&stream[..]]))?;
        self.recovered(&parse(stream.chunks(1)))
            .map_err(|reason| format!("byte by byte: {reason}"))?;
        if !self.chunks.is_empty() {
            let chunks = self.chunks.iter().map(|chunk| &chunk.0[..]);
            if chunks.clone().flatten().ne(stream) {
                return Err("the chunks are not the stream".to_owned());
            }
            self.recovered(&parse(chunks))
                .map_err(|reason| format!("in its chunks: {reason}"))?;
        }
        Ok(recovered)
    }

    /// How many of the frames the recorded receiver lost, if it delivered all the others.
    fn recovered(&self, frames: &[Frame]) -> Result<usize, String> {
        let good = self.decoded.iter().filter(|frame| frame.well_formed);
        let theirs: Vec<Fields> = good.map(Delivered::fields).collect();
        let mut ours = frames.iter().map(notation::describe);
        for (index, frame) in theirs.iter().enumerate() {
            if !ours.any(|our| our == *frame) {
                return Err(format!(
                    "good frame {} of {} is not delivered as it was",
                    index + 1,
                    theirs.len()
                ));
            }
        }
        if !stand_in(&self.stream.0, frames) {
            return Err("a frame is delivered that is not in the stream".to_owned());
        }
        Ok(frames.len() - theirs.len())
    }
}

fn parse<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Frame> {
    let mut parser = Parser::new();
    let mut frames = Vec::new();
    for piece in pieces {
        frames.extend(parser.frames(piece));
    }
    frames
}

/// Whether the frames stand verbatim in the stream, one behind the other.
fn stand_in(stream: &[u8], frames: &[Frame]) -> bool {
    let mut rest = stream;
    frames.iter().all(|frame| {
        let encoded = frame.encode();
        let mut windows = rest.windows(encoded.len());
        let place = windows.position(|window| window == encoded.as_slice());
        rest = place.map_or(&[], |at| &rest[at + encoded.len()..]);
        place.is_some()
    })
}
