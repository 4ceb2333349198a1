//! The messages. Field names, order and types are those of the published message list (class
//! `intermcu`).

use heapless::Vec;

use crate::frame::MAX_BODY_LEN;
use crate::kind::Kind;

/// Most bytes in a [`struct@Debug`]: what a frame of 255 bytes leaves.
pub const DEBUG_CAPACITY: usize = MAX_BODY_LEN - Kind::Debug.fixed_len();
/// Most arguments of a [`Command`]: what a frame of 255 bytes leaves.
pub const COMMAND_CAPACITY: usize = MAX_BODY_LEN - Kind::Command.fixed_len();
/// Most coefficients in a [`Map`]: what a frame of 255 bytes leaves.
pub const MAP_CAPACITY: usize = MAX_BODY_LEN - Kind::Map.fixed_len();
/// Most coefficients in a [`Camera`]: what a frame of 255 bytes leaves.
pub const CAMERA_CAPACITY: usize = MAX_BODY_LEN - Kind::Camera.fixed_len();

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

impl Message {
    /// What the message is called: its name in the published list without the prefix.
    pub const fn name(&self) -> &'static str {
        self.kind().name()
    }

    /// Which message it is.
    pub(crate) const fn kind(&self) -> Kind {
        match self {
            Self::Debug(_) => Kind::Debug,
            Self::Command(_) => Kind::Command,
            Self::Vector(_) => Kind::Vector,
            Self::State(_) => Kind::State,
            Self::Map(_) => Kind::Map,
            Self::InsCorrection(_) => Kind::InsCorrection,
            Self::Camera(_) => Kind::Camera,
        }
    }
}
