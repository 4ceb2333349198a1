//! The body of a message: its fields back to back, little endian; an array comes last, after a byte
//! with its length.

use crate::field::{Reader, Writer};
use crate::kind::Kind;
use crate::message::{Camera, Command, Debug, InsCorrection, Map, Message, State, Vector};

impl Message {
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

    /// Reads the fields of a message from a body of its size.
    #[inline(never)]
    pub(crate) fn read(kind: Kind, body: &[u8]) -> Self {
        let mut body = Reader(body);
        match kind {
            Kind::Debug => Self::Debug(Debug { msg: body.bytes() }),
            Kind::Command => Self::Command(Command {
                command: body.u8(),
                args: body.bytes(),
            }),
            Kind::Vector => Self::Vector(Vector {
                target_e: body.f32(),
                target_n: body.f32(),
                delta_yaw: body.f32(),
                start_e: body.f32(),
                start_n: body.f32(),
                source: body.u8(),
            }),
            Kind::State => Self::State(State {
                ins_e: body.f32(),
                ins_n: body.f32(),
                phi: body.f32(),
                theta: body.f32(),
                psi: body.f32(),
            }),
            Kind::Map => Self::Map(Map {
                snapshot_index: body.u16(),
                snapshot_e: body.f32(),
                snapshot_n: body.f32(),
                odometry_index: body.u16(),
                odometry_e: body.f32(),
                odometry_n: body.f32(),
                snapshot_ak_bk: body.i8s(),
            }),
            Kind::InsCorrection => Self::InsCorrection(InsCorrection {
                snapshot_index: body.u16(),
                e_from: body.f32(),
                n_from: body.f32(),
                psi_from: body.f32(),
                e_to: body.f32(),
                n_to: body.f32(),
                psi_to: body.f32(),
            }),
            Kind::Camera => Self::Camera(Camera {
                snapshot_ak_bk: body.i8s(),
            }),
        }
    }
}
