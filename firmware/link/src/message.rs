//! The messages: fields, sizes and their layout in a frame's body.
//!
//! Field names, order and types are those of the published message list (class `intermcu`). A body
//! is its fields back to back, little endian; an array comes last, after a byte with its length.

use heapless::Vec;

use crate::field::{Reader, Writer};
use crate::frame::MAX_BODY_LEN;

/// Most bytes in a [`struct@Debug`]: what a frame of 255 bytes leaves.
pub const DEBUG_CAPACITY: usize = MAX_BODY_LEN - layout::DEBUG.fixed;
/// Most arguments of a [`Command`]: what a frame of 255 bytes leaves.
pub const COMMAND_CAPACITY: usize = MAX_BODY_LEN - layout::COMMAND.fixed;
/// Most coefficients in a [`Map`]: what a frame of 255 bytes leaves.
pub const MAP_CAPACITY: usize = MAX_BODY_LEN - layout::MAP.fixed;
/// Most coefficients in a [`Camera`]: what a frame of 255 bytes leaves.
pub const CAMERA_CAPACITY: usize = MAX_BODY_LEN - layout::CAMERA.fixed;

/// IMCU_DEBUG: bytes for a person to read. Nobody in the system sends or reads it.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Debug {
    /// The bytes.
    pub msg: Vec<u8, DEBUG_CAPACITY>,
}

/// VISUALHOMING_COMMAND: the autopilot's order, and the camera's echo of it.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command {
    /// The command byte; [`crate::Mode`] gives it a name.
    pub command: u8,
    /// Arguments; empty in every command of the flight app.
    pub args: Vec<u8, COMMAND_CAPACITY>,
}

/// VISUALHOMING_VECTOR: where the camera wants the drone to be. Metres and radians.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Vector {
    /// Target, metres east of the world's origin.
    pub target_e: f32,
    /// Target, metres north.
    pub target_n: f32,
    /// Turn to the right (clockwise), rad.
    pub delta_yaw: f32,
    /// Where the drone was, metres east.
    pub start_e: f32,
    /// Where the drone was, metres north.
    pub start_n: f32,
    /// What gave the vector; [`Source`] gives the byte a name.
    pub source: u8,
}

/// What a vector came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Source {
    /// Homing to a snapshot.
    Visual = 0,
    /// Following stored odometry.
    Odometry = 1,
}

impl Vector {
    /// What the vector came from; `None` for a byte without a meaning.
    pub const fn source(&self) -> Option<Source> {
        match self.source {
            0 => Some(Source::Visual),
            1 => Some(Source::Odometry),
            _ => None,
        }
    }
}

/// VISUALHOMING_STATE: where the autopilot believes to be. Metres and radians.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct State {
    /// Metres east of the world's origin.
    pub ins_e: f32,
    /// Metres north.
    pub ins_n: f32,
    /// Roll, rad. The flight app sends 0.
    pub phi: f32,
    /// Pitch, rad. The flight app sends 0.
    pub theta: f32,
    /// Heading clockwise from north, rad. Not unwrapped.
    pub psi: f32,
}

/// VISUALHOMING_MAP: the active snapshot and odometry vector, for the operator's log. Metres.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Map {
    /// Number of the active snapshot.
    pub snapshot_index: u16,
    /// Its believed place, metres east.
    pub snapshot_e: f32,
    /// Its believed place, metres north.
    pub snapshot_n: f32,
    /// Number of the active odometry vector.
    pub odometry_index: u16,
    /// Its believed end, metres east.
    pub odometry_e: f32,
    /// Its believed end, metres north.
    pub odometry_n: f32,
    /// The snapshot's Fourier coefficients: first all a, then all b.
    pub snapshot_ak_bk: Vec<i8, MAP_CAPACITY>,
}

/// VISUALHOMING_INS_CORRECTION: what the drone calls `from` is `to`. Metres and radians.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InsCorrection {
    /// What tells two corrections apart. The published list names it for the snapshot that was
    /// recognised, but the autopilot applies a number only where it differs from the last one it
    /// applied (at first 0): at the same snapshot a second correction needs another number.
    pub snapshot_index: u16,
    /// Believed place, metres east.
    pub e_from: f32,
    /// Believed place, metres north.
    pub n_from: f32,
    /// Believed heading, rad, clockwise from north.
    pub psi_from: f32,
    /// Actual place, metres east.
    pub e_to: f32,
    /// Actual place, metres north.
    pub n_to: f32,
    /// Actual heading, rad, within half a turn of `psi_from`.
    pub psi_to: f32,
}

/// VISUALHOMING_CAMERA: the coefficients of the current view. The flight app ignores it.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Camera {
    /// Fourier coefficients: first all a, then all b.
    pub snapshot_ak_bk: Vec<i8, CAMERA_CAPACITY>,
}

/// Any message of the link.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(missing_docs, reason = "each variant is documented at its type")]
pub enum Message {
    Debug(Debug),
    Command(Command),
    Vector(Vector),
    State(State),
    Map(Map),
    InsCorrection(InsCorrection),
    Camera(Camera),
}

/// How long the body of each message is.
pub(crate) mod layout {
    /// The body of one kind of message.
    #[derive(Clone, Copy)]
    pub(crate) struct Layout {
        /// Bytes of the scalar fields and of the array's length byte.
        pub(crate) fixed: usize,
        /// Whether the last fixed byte is the length of an array of bytes that follows.
        pub(crate) array: bool,
    }

    pub(crate) const DEBUG: Layout = Layout::with_array(0);
    pub(crate) const COMMAND: Layout = Layout::with_array(1);
    pub(crate) const VECTOR: Layout = Layout::scalars(5 * 4 + 1);
    pub(crate) const STATE: Layout = Layout::scalars(5 * 4);
    pub(crate) const MAP: Layout = Layout::with_array(2 * (2 + 2 * 4));
    pub(crate) const INS_CORRECTION: Layout = Layout::scalars(2 + 6 * 4);
    pub(crate) const CAMERA: Layout = Layout::with_array(0);

    impl Layout {
        const fn scalars(fixed: usize) -> Self {
            let array = false;
            Self { fixed, array }
        }

        const fn with_array(scalars: usize) -> Self {
            Self {
                fixed: scalars + 1,
                array: true,
            }
        }

        /// The layout of message `id`; `None` if the link has no such message.
        pub(crate) const fn of(id: u8) -> Option<Self> {
            match id {
                super::id::DEBUG => Some(DEBUG),
                super::id::COMMAND => Some(COMMAND),
                super::id::VECTOR => Some(VECTOR),
                super::id::STATE => Some(STATE),
                super::id::MAP => Some(MAP),
                super::id::INS_CORRECTION => Some(INS_CORRECTION),
                super::id::CAMERA => Some(CAMERA),
                _ => None,
            }
        }

        /// Whether a body of `len` bytes that starts with `known` can be this message.
        pub(crate) fn fits(self, len: usize, known: &[u8]) -> bool {
            match (self.array, known.get(self.fixed - 1)) {
                (false, _) => len == self.fixed,
                (true, Some(count)) => len == self.fixed + usize::from(*count),
                (true, None) => len >= self.fixed,
            }
        }
    }
}

/// Message ids of the class.
mod id {
    pub(super) const DEBUG: u8 = 5;
    pub(super) const COMMAND: u8 = 6;
    pub(super) const VECTOR: u8 = 9;
    pub(super) const STATE: u8 = 10;
    pub(super) const MAP: u8 = 11;
    pub(super) const INS_CORRECTION: u8 = 12;
    pub(super) const CAMERA: u8 = 15;
}

/// What message `id` is called; `None` if the link has no such message.
pub(crate) const fn name(id: u8) -> Option<&'static str> {
    Some(match id {
        id::DEBUG => "DEBUG",
        id::COMMAND => "COMMAND",
        id::VECTOR => "VECTOR",
        id::STATE => "STATE",
        id::MAP => "MAP",
        id::INS_CORRECTION => "INS_CORRECTION",
        id::CAMERA => "CAMERA",
        _ => return None,
    })
}

impl Message {
    /// What the message is called: its name in the published list without the prefix.
    pub const fn name(&self) -> &'static str {
        match name(self.id()) {
            Some(name) => name,
            None => "?",
        }
    }

    /// The message id in the frame's header.
    pub(crate) const fn id(&self) -> u8 {
        match self {
            Self::Debug(_) => id::DEBUG,
            Self::Command(_) => id::COMMAND,
            Self::Vector(_) => id::VECTOR,
            Self::State(_) => id::STATE,
            Self::Map(_) => id::MAP,
            Self::InsCorrection(_) => id::INS_CORRECTION,
            Self::Camera(_) => id::CAMERA,
        }
    }

    /// Appends the fields to a frame.
    pub(crate) fn write(&self, out: &mut Writer<'_>) {
        match self {
            Self::Debug(m) => out.bytes(&m.msg),
            Self::Command(m) => {
                out.u8(m.command);
                out.bytes(&m.args);
            }
            Self::Vector(m) => {
                out.f32s([m.target_e, m.target_n, m.delta_yaw, m.start_e, m.start_n]);
                out.u8(m.source);
            }
            Self::State(m) => out.f32s([m.ins_e, m.ins_n, m.phi, m.theta, m.psi]),
            Self::Map(m) => {
                out.u16(m.snapshot_index);
                out.f32s([m.snapshot_e, m.snapshot_n]);
                out.u16(m.odometry_index);
                out.f32s([m.odometry_e, m.odometry_n]);
                out.i8s(&m.snapshot_ak_bk);
            }
            Self::InsCorrection(m) => {
                out.u16(m.snapshot_index);
                out.f32s([m.e_from, m.n_from, m.psi_from, m.e_to, m.n_to, m.psi_to]);
            }
            Self::Camera(m) => out.i8s(&m.snapshot_ak_bk),
        }
    }

    /// Reads the fields of message `id`; `None` if the body is not exactly that message.
    pub(crate) fn read(id: u8, body: &[u8]) -> Option<Self> {
        let mut body = Reader(body);
        let message = match id {
            id::DEBUG => Self::Debug(Debug { msg: body.bytes()? }),
            id::COMMAND => Self::Command(Command {
                command: body.u8()?,
                args: body.bytes()?,
            }),
            id::VECTOR => Self::Vector(Vector {
                target_e: body.f32()?,
                target_n: body.f32()?,
                delta_yaw: body.f32()?,
                start_e: body.f32()?,
                start_n: body.f32()?,
                source: body.u8()?,
            }),
            id::STATE => Self::State(State {
                ins_e: body.f32()?,
                ins_n: body.f32()?,
                phi: body.f32()?,
                theta: body.f32()?,
                psi: body.f32()?,
            }),
            id::MAP => Self::Map(Map {
                snapshot_index: body.u16()?,
                snapshot_e: body.f32()?,
                snapshot_n: body.f32()?,
                odometry_index: body.u16()?,
                odometry_e: body.f32()?,
                odometry_n: body.f32()?,
                snapshot_ak_bk: body.i8s()?,
            }),
            id::INS_CORRECTION => Self::InsCorrection(InsCorrection {
                snapshot_index: body.u16()?,
                e_from: body.f32()?,
                n_from: body.f32()?,
                psi_from: body.f32()?,
                e_to: body.f32()?,
                n_to: body.f32()?,
                psi_to: body.f32()?,
            }),
            id::CAMERA => Self::Camera(Camera {
                snapshot_ak_bk: body.i8s()?,
            }),
            _ => return None,
        };
        body.0.is_empty().then_some(message)
    }
}
