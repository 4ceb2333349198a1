//! The frame around a message (pprzlink 2.0).
//!
//! | offset | size | meaning |
//! |---|---|---|
//! | 0 | 1 | start byte 0x99 |
//! | 1 | 1 | length of the whole frame, start byte and checksum included |
//! | 2 | 1 | sender id |
//! | 3 | 1 | receiver id |
//! | 4 | 1 | low nibble: class (5, `intermcu`); high nibble: component |
//! | 5 | 1 | message id |
//! | 6 | length - 8 | body |
//! | length - 2 | 2 | checksum over everything between the start byte and itself |
//!
//! There is no byte stuffing: a start byte can occur anywhere in a frame.

use heapless::Vec;

use crate::checksum::checksum;
use crate::field::{Reader, Writer};
use crate::kind::Kind;
use crate::message::Message;
use crate::refusal::Refusal;

/// Longest frame: its length is one byte.
pub const MAX_FRAME_LEN: usize = 255;
/// Shortest frame: header and checksum around an empty body.
pub const MIN_FRAME_LEN: usize = HEADER_LEN + CHECKSUM_LEN;
/// Longest body.
pub(crate) const MAX_BODY_LEN: usize = MAX_FRAME_LEN - MIN_FRAME_LEN;

/// First byte of every frame.
pub(crate) const START: u8 = 0x99;

const HEADER_LEN: usize = 6;
const CHECKSUM_LEN: usize = 2;
/// Offset of the length byte, where the checksum begins as well.
const LENGTH_AT: usize = 1;
/// Offset of the sender's id; receiver and class follow.
const SENDER_AT: usize = 2;
const CLASS_MASK: u8 = 0x0f;
const COMPONENT_SHIFT: u32 = 4;
/// Offset of the message id.
pub(crate) const ID_AT: usize = 5;
/// Class id of the messages between autopilot and camera.
const INTERMCU: u8 = 5;

/// One encoded frame.
pub type Encoded = Vec<u8, MAX_FRAME_LEN>;

/// A message with the addresses of its header.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// Who sent it. Both ends of this link use 0.
    pub sender: u8,
    /// Whom it is for. Both ends of this link use 0; 255 means everybody.
    pub receiver: u8,
    /// Component id, 0 to 15. Both ends of this link use 0.
    pub component: u8,
    /// What it says.
    pub message: Message,
}

impl From<Message> for Frame {
    /// Addresses the message as both ends of this link do: all zero.
    fn from(message: Message) -> Self {
        Self {
            sender: 0,
            receiver: 0,
            component: 0,
            message,
        }
    }
}

impl Message {
    /// The bytes for the wire, addressed with zeros.
    pub fn encode(&self) -> Encoded {
        encode([0, 0], 0, self)
    }
}

impl Frame {
    /// The bytes for the wire. Of `component`, the low nibble is sent.
    pub fn encode(&self) -> Encoded {
        encode([self.sender, self.receiver], self.component, &self.message)
    }
}

fn encode([sender, receiver]: [u8; 2], component: u8, message: &Message) -> Encoded {
    let mut bytes = Encoded::new();
    let mut out = Writer(&mut bytes);
    let class = (component << COMPONENT_SHIFT) | INTERMCU;
    for byte in [START, 0, sender, receiver, class, message.kind().id()] {
        out.u8(byte);
    }
    message.write(&mut out);
    let len = bytes.len() + CHECKSUM_LEN;
    if let Some(length) = bytes.get_mut(LENGTH_AT) {
        *length = len as u8;
    }
    let sums = checksum(bytes.get(LENGTH_AT..).unwrap_or_default());
    let mut out = Writer(&mut bytes);
    for byte in sums {
        out.u8(byte);
    }
    bytes
}

/// What begins at a start byte.
#[derive(Clone, Copy)]
pub(crate) enum Judged {
    /// Perhaps a frame; more can be said when this many bytes are there.
    Part(u8),
    /// A frame.
    Whole(Claim),
}

/// Judges what `bytes`, of which the first is a start byte, begin with.
///
/// A start byte inside other data claims up to 254 following bytes. To wait for the shortest frame
/// before the header is judged holds nothing up; to judge it then keeps most such claims from holding
/// up the good frames behind them.
#[inline(never)]
pub(crate) fn judge(bytes: &[u8]) -> Result<Judged, Refusal> {
    let Some(header) = bytes.first_chunk() else {
        return Ok(Judged::Part(MIN_FRAME_LEN as u8));
    };
    let claim = Claim::of(header)?;
    let Some(frame) = bytes.get(..usize::from(claim.len)) else {
        return Ok(Judged::Part(claim.len));
    };
    claim.check(frame)?;
    Ok(Judged::Whole(claim))
}

/// What a header promises.
#[derive(Clone, Copy)]
pub(crate) struct Claim {
    kind: Kind,
    /// Bytes of the whole frame.
    len: u8,
}

impl Claim {
    /// Judges a header, and a first glance at the body.
    fn of(bytes: &[u8; MIN_FRAME_LEN]) -> Result<Self, Refusal> {
        let [_, len, _, _, class, id, ..] = *bytes;
        if usize::from(len) < MIN_FRAME_LEN {
            return Err(Refusal::BadLength);
        }
        if class & CLASS_MASK != INTERMCU {
            return Err(Refusal::WrongClass);
        }
        let kind = Kind::of(id).ok_or(Refusal::UnknownMessage)?;
        let claim = Self { kind, len };
        let (len, fixed) = (usize::from(len), MIN_FRAME_LEN + kind.fixed_len());
        if len != fixed && (len < fixed || !kind.has_array()) {
            return Err(Refusal::WrongSize);
        }
        claim.check_count(bytes)?;
        Ok(claim)
    }

    /// Judges what the header did not tell.
    fn check(self, frame: &[u8]) -> Result<(), Refusal> {
        self.check_count(frame)?;
        match frame.split_last_chunk() {
            Some(([_, covered @ ..], sums)) if checksum(covered) == *sums => Ok(()),
            _ => Err(Refusal::BadChecksum),
        }
    }

    /// Whether the length is what the array's length asks for, if there is an array and its length
    /// is among the bytes that are known.
    fn check_count(self, known: &[u8]) -> Result<(), Refusal> {
        if !self.kind.has_array() {
            return Ok(());
        }
        let fixed = self.kind.fixed_len();
        match known.get(HEADER_LEN + fixed - 1) {
            Some(count) if MIN_FRAME_LEN + fixed + usize::from(*count) != usize::from(self.len) => {
                Err(Refusal::WrongSize)
            }
            _ => Ok(()),
        }
    }

    /// Bytes of the whole frame.
    pub(crate) const fn len(self) -> u8 {
        self.len
    }

    /// The frame in `bytes` that were found to begin with it.
    pub(crate) fn frame(self, bytes: &[u8]) -> Frame {
        let mut header = Reader(bytes.get(SENDER_AT..).unwrap_or_default());
        let body = HEADER_LEN..usize::from(self.len) - CHECKSUM_LEN;
        Frame {
            sender: header.u8(),
            receiver: header.u8(),
            component: header.u8() >> COMPONENT_SHIFT,
            message: Message::read(self.kind, bytes.get(body).unwrap_or_default()),
        }
    }
}

#[cfg(test)]
mod tests {
    use heapless::Vec;

    use crate::message::{
        CAMERA_CAPACITY, COMMAND_CAPACITY, Camera, Command, DEBUG_CAPACITY, MAP_CAPACITY, Map,
        Message, Vector,
    };

    #[test]
    fn the_worked_vector_example_has_these_bytes() {
        let vector = Message::Vector(Vector {
            target_e: 1.5,
            target_n: -2.0,
            delta_yaw: 0.25,
            start_e: 0.0,
            start_n: 0.5,
            source: 0,
        });
        let expected = [
            0x99, 0x1d, 0x00, 0x00, 0x05, 0x09, 0x00, 0x00, 0xc0, 0x3f, 0x00, 0x00, 0x00, 0xc0,
            0x00, 0x00, 0x80, 0x3e, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x3f, 0x00, 0xe7,
            0xc3,
        ];
        assert_eq!(vector.encode(), expected);
    }

    #[test]
    fn the_follow_command_has_these_bytes() {
        let follow = Message::Command(Command {
            command: 0x12,
            args: Vec::new(),
        });
        let expected = [0x99, 0x0a, 0x00, 0x00, 0x05, 0x06, 0x12, 0x00, 0x27, 0x90];
        assert_eq!(follow.encode(), expected);
    }

    #[test]
    fn arrays_end_where_a_frame_of_255_bytes_is_full() {
        let capacities = [
            DEBUG_CAPACITY,
            COMMAND_CAPACITY,
            MAP_CAPACITY,
            CAMERA_CAPACITY,
        ];
        assert_eq!(capacities, [246, 245, 226, 246]);
        let map = Map {
            snapshot_ak_bk: [-1; MAP_CAPACITY].into_iter().collect(),
            ..Map::default()
        };
        assert_eq!(Message::Map(map).encode().len(), 255);
        let camera = Camera {
            snapshot_ak_bk: [-1; CAMERA_CAPACITY].into_iter().collect(),
        };
        assert_eq!(Message::Camera(camera).encode().len(), 255);
    }
}
