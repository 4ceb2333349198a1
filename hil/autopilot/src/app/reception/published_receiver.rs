//! The receiver that pprzlink 2.0 generates in C, byte for byte, with all that it does not check.
//!
//! It differs from [`link::Parser`] only on streams with broken frames: behind a checksum that does
//! not match it goes on with the next byte, so that a broken frame takes down whatever lies within
//! the length it claimed; lengths are taken modulo 256; and a field is read wherever it would stand,
//! whether the frame reaches that far or not.

use link::{
    CAMERA_CAPACITY, COMMAND_CAPACITY, Camera, Command, Counters, DEBUG_CAPACITY, Debug,
    InsCorrection, MAP_CAPACITY, Map, Message, State, Vector,
};

/// First byte of every frame.
const START: u8 = 0x99;
/// Bytes of a frame that are no data: start, length and two sums.
const OVERHEAD: u8 = 4;
/// Most data bytes that a length byte can claim. The C buffer has one byte less: a claim of 256
/// writes behind it, with consequences that nobody can foretell. Here there is room.
const MAX_DATA: usize = 256;
/// Data bytes in front of the fields.
const HEADER_BYTES: usize = 4;

/// What the receiver waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wait {
    /// A start byte.
    Start,
    /// The length.
    Length,
    /// The rest of the header and the body.
    Data,
    /// The first sum.
    SumA,
    /// The second sum.
    SumB,
}

/// What a byte has completed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reception<'a> {
    /// A frame whose checksum holds: all that is known of it.
    Frame(RawFrame<'a>),
    /// A frame whose checksum does not hold. Nothing of it is looked at again.
    BadChecksum(RawFrame<'a>),
}

/// The receiver. One byte at a time.
#[derive(Debug, Clone)]
pub struct PublishedReceiver {
    wait: Wait,
    /// Data bytes of this frame, modulo 256.
    claim: u8,
    /// Data bytes received of it, modulo 256.
    received: u8,
    sums: [u8; 2],
    /// The data bytes of this frame over those of older ones.
    data: [u8; MAX_DATA],
    counters: Counters,
}

impl Default for PublishedReceiver {
    /// A receiver that has seen nothing; its buffer is zero.
    fn default() -> Self {
        Self {
            wait: Wait::Start,
            claim: 0,
            received: 0,
            sums: [0, 0],
            data: [0; MAX_DATA],
            counters: Counters::default(),
        }
    }
}

impl PublishedReceiver {
    /// Takes the next byte from the wire; what it completes, if anything.
    pub fn push(&mut self, byte: u8) -> Option<Reception<'_>> {
        match self.wait {
            Wait::Start if byte == START => self.wait = Wait::Length,
            Wait::Start => self.skip(1),
            Wait::Length => {
                self.claim = byte.wrapping_sub(OVERHEAD);
                self.received = 0;
                self.sums = [byte, byte];
                self.wait = Wait::Data;
            }
            Wait::Data => self.store(byte),
            Wait::SumA if byte == self.sums[0] => self.wait = Wait::SumB,
            Wait::SumB if byte == self.sums[1] => {
                self.wait = Wait::Start;
                self.counters.frames_ok = self.counters.frames_ok.saturating_add(1);
                return Some(Reception::Frame(self.frame()));
            }
            Wait::SumA | Wait::SumB => return Some(self.fail()),
        }
        None
    }

    /// What it waits for.
    pub fn wait(&self) -> Wait {
        self.wait
    }

    /// What has been received so far. Only good frames, bad checksums and skipped bytes are counted:
    /// nothing else is ever noticed.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    fn store(&mut self, byte: u8) {
        let [a, b] = self.sums;
        let a = a.wrapping_add(byte);
        self.sums = [a, b.wrapping_add(a)];
        self.data[usize::from(self.received)] = byte;
        self.received = self.received.wrapping_add(1);
        if self.received == self.claim {
            self.wait = Wait::SumA;
        }
    }

    fn fail(&mut self) -> Reception<'_> {
        let sums_read = if self.wait == Wait::SumA { 1 } else { 2 };
        self.skip(2 + self.frame().len + sums_read);
        self.wait = Wait::Start;
        self.counters.bad_checksum = self.counters.bad_checksum.saturating_add(1);
        Reception::BadChecksum(self.frame())
    }

    fn skip(&mut self, bytes: usize) {
        let skipped = &mut self.counters.bytes_skipped;
        *skipped = skipped.saturating_add(bytes as u32);
    }

    fn frame(&self) -> RawFrame<'_> {
        RawFrame {
            data: &self.data,
            len: match self.claim {
                0 => MAX_DATA,
                claim => usize::from(claim),
            },
        }
    }
}

/// The data of a frame, in front of what is left of older ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawFrame<'a> {
    data: &'a [u8; MAX_DATA],
    len: usize,
}

impl<'a> RawFrame<'a> {
    /// Header and body as received.
    pub fn data(&self) -> &'a [u8] {
        &self.data[..self.len]
    }

    /// Sender id.
    pub fn sender(&self) -> u8 {
        self.data[0]
    }

    /// Receiver id.
    pub fn receiver(&self) -> u8 {
        self.data[1]
    }

    /// Class id, 0 to 15.
    pub fn class(&self) -> u8 {
        self.data[2] & 0x0f
    }

    /// Component id, 0 to 15.
    pub fn component(&self) -> u8 {
        self.data[2] >> 4
    }

    /// Message id: all that the client looks at.
    pub fn id(&self) -> u8 {
        self.data[3]
    }

    /// The message with this id, its fields read from wherever they would stand; `None` if the link
    /// has no such message. An array ends where the buffer does.
    pub fn message(&self) -> Option<Message> {
        let mut fields = Fields(&self.data[HEADER_BYTES..]);
        Some(match self.id() {
            5 => Message::Debug(Debug {
                msg: fields.array().take(DEBUG_CAPACITY).collect(),
            }),
            6 => Message::Command(Command {
                command: fields.u8(),
                args: fields.array().take(COMMAND_CAPACITY).collect(),
            }),
            9 => Message::Vector(Vector {
                target_e: fields.f32(),
                target_n: fields.f32(),
                delta_yaw: fields.f32(),
                start_e: fields.f32(),
                start_n: fields.f32(),
                source: fields.u8(),
            }),
            10 => Message::State(State {
                ins_e: fields.f32(),
                ins_n: fields.f32(),
                phi: fields.f32(),
                theta: fields.f32(),
                psi: fields.f32(),
            }),
            11 => Message::Map(Map {
                snapshot_index: fields.u16(),
                snapshot_e: fields.f32(),
                snapshot_n: fields.f32(),
                odometry_index: fields.u16(),
                odometry_e: fields.f32(),
                odometry_n: fields.f32(),
                snapshot_ak_bk: fields.signed_array().take(MAP_CAPACITY).collect(),
            }),
            12 => Message::InsCorrection(InsCorrection {
                snapshot_index: fields.u16(),
                e_from: fields.f32(),
                n_from: fields.f32(),
                psi_from: fields.f32(),
                e_to: fields.f32(),
                n_to: fields.f32(),
                psi_to: fields.f32(),
            }),
            15 => Message::Camera(Camera {
                snapshot_ak_bk: fields.signed_array().take(CAMERA_CAPACITY).collect(),
            }),
            _ => return None,
        })
    }
}

/// Fields back to back, little endian. The buffer is longer than the fields of any message; only an
/// array can reach its end.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let Some((field, rest)) = self.0.split_first_chunk() else {
            return [0; N];
        };
        self.0 = rest;
        *field
    }

    fn u8(&mut self) -> u8 {
        u8::from_le_bytes(self.take())
    }

    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    fn array(&mut self) -> impl Iterator<Item = u8> + use<'a> {
        let len = usize::from(self.u8());
        self.0.iter().copied().take(len)
    }

    fn signed_array(&mut self) -> impl Iterator<Item = i8> + use<'a> {
        self.array().map(|byte| i8::from_le_bytes([byte]))
    }
}

#[cfg(test)]
mod tests {
    use link::{Command, Message, Parser, Vector};
    use proptest::prelude::*;

    use super::{PublishedReceiver, Reception};

    fn delivered(receiver: &mut PublishedReceiver, bytes: &[u8]) -> Vec<Message> {
        let frames = bytes.iter().filter_map(|byte| match receiver.push(*byte)? {
            Reception::Frame(frame) => frame.message(),
            Reception::BadChecksum(_) => None,
        });
        frames.collect()
    }

    fn follow() -> Message {
        Message::Command(Command {
            command: 0x12,
            ..Command::default()
        })
    }

    #[test]
    fn a_broken_frame_takes_down_what_lies_within_its_claim() {
        // A start byte that claims 20 bytes: 16 of data, then the sums, the first of which is the
        // seventh byte of the second command.
        let mut stream = vec![0x99, 20];
        for _ in 0..3 {
            stream.extend(follow().encode());
        }
        let mut receiver = PublishedReceiver::default();
        assert_eq!(delivered(&mut receiver, &stream), [follow()], "the third");
        assert_eq!(receiver.counters().bad_checksum, 1);
    }

    #[test]
    fn a_frame_without_a_body_repeats_the_fields_of_the_one_before() {
        let vector = Message::Vector(Vector {
            target_e: 1.5,
            source: 1,
            ..Vector::default()
        });
        // Sums of 08 00 00 05 09, by hand: A 08 08 08 0d 16, B 08 10 18 25 3b.
        let headless = [0x99, 0x08, 0x00, 0x00, 0x05, 0x09, 0x16, 0x3b];
        let mut receiver = PublishedReceiver::default();
        assert_eq!(
            delivered(&mut receiver, &headless),
            [Message::Vector(Vector::default())]
        );
        delivered(&mut receiver, &vector.encode());
        assert_eq!(delivered(&mut receiver, &headless), [vector]);
    }

    proptest! {
        #[test]
        fn without_broken_frames_it_hears_what_the_strict_parser_hears(
            commands in prop::collection::vec((any::<u8>(), prop::collection::vec(any::<u8>(), 0..40)), 1..20),
            noise in prop::collection::vec(0x9a_u8.., 0..20),
        ) {
            let mut stream = noise;
            for (command, args) in commands {
                let args = args.into_iter().collect();
                stream.extend(Message::Command(Command { command, args }).encode());
            }
            let strict: Vec<_> = Parser::new().frames(&stream).map(|frame| frame.message).collect();
            prop_assert_eq!(delivered(&mut PublishedReceiver::default(), &stream), strict);
        }

        #[test]
        fn no_stream_makes_it_panic(stream in prop::collection::vec(any::<u8>(), 0..2000)) {
            delivered(&mut PublishedReceiver::default(), &stream);
        }
    }
}
