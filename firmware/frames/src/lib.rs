//! Frames over serial: synthetic camera frames for a board whose camera is not there, over a UART in
//! place of the camera's bus, and the board's answers.
//!
//! Pure: bytes in, events out, and back. No clock, no peripheral, no allocation; both ends of the wire
//! use this crate, the rig image of the firmware and the rig.
//!
//! * [`Pieces`] cuts a frame into records, [`Request::encode`] makes the host's other records;
//! * [`Receiver`] is the board's end: it paints pieces straight into the frame buffer that it is
//!   handed, and says what became of each frame;
//! * [`Reply::encode`] makes the board's records, [`Replies`] reads them;
//! * [`Identity`] says what an image is, in its flash and over the wire alike.
//!
//! # Records
//! A record is byte-stuffed (COBS: Cheshire and Baker, "Consistent Overhead Byte Stuffing", IEEE/ACM
//! Transactions on Networking 7, 1999), so that no byte of it is zero, and stands between two zeros:
//! whatever was lost or added on the wire, the next record is found at the next zero. Unstuffed:
//!
//! | offset | size | meaning |
//! |---|---|---|
//! | 0 | 4 | CRC-32 (ISO-HDLC) over all that follows |
//! | 4 | 1 | kind |
//! | 5 | any | body |
//!
//! Numbers are little endian.
//!
//! | kind | record | body |
//! |---|---|---|
//! | 0x01 | [`Request::Identify`] | |
//! | 0x02 | [`Request::Begin`] | u16 `fresh_ms` |
//! | 0x03 | [`Request::End`] | |
//! | 0x04 | [`Request::Count`] | |
//! | 0x10 | piece of a frame, its bytes | u32 frame number, u16 offset of the first byte in the frame, bytes |
//! | 0x11 | piece of a frame, [steps of its luma](coding) | the same, nibbles |
//! | 0x81 | [`Reply::Identity`] | [`Identity::BYTES`] |
//! | 0x82 | [`Reply::Source`] | u8 |
//! | 0x83 | [`Reply::Verdict`] | u32 frame number, u8 verdict, u16 shutter lines, f32 gain |
//! | 0x84 | [`Reply::Counts`] | six u32 |
//!
//! # A session
//! A host asks who is there, and begins a session; from then on the board takes frames from the wire
//! and none from its camera, until the session ends. Each frame has a number above the one before it
//! (a `u32` that wraps), and comes in pieces, in order. The board answers each with a
//! [`Verdict`], and with the shutter and gain that the firmware wants by then, from which the host
//! exposes the frames that follow. Nothing is sent twice: a frame that did not arrive is a frame that
//! the camera would have lost.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod coding;
mod identity;
mod pieces;
mod receiver;
mod record;
mod reply;
mod request;
mod shape;
mod stuffing;
mod verdict;

pub use identity::{BoardName, Identity, ImageKind, VERSION_BYTES};
pub use pieces::{Piece, Pieces};
pub use receiver::{Event, Receiver};
pub use record::{Damage, Encoded, MAX_MESSAGE_BYTES, MAX_RECORD_BYTES, Message};
pub use reply::{Replies, Reply};
pub use request::Request;
pub use shape::Shape;
pub use verdict::{Counts, Source, Verdict};

/// The protocol that this crate speaks. Another number is another language.
pub const PROTOCOL: u16 = 1;

/// The rate of the wire unless the image was built for another, baud: what FT232R, FT230X and CP2102N
/// make at most, and 42 MHz of the chip's bus divided by 14 exactly.
pub const DEFAULT_BAUD: u32 = 3_000_000;
