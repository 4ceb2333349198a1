//! What the property tests share: strategies, and (with the fuzz target) what holds for any stream.

pub mod invariants;
pub mod reference;

use std::f32::consts::PI;

use link::{Camera, Command, Debug, Frame, InsCorrection, Map, Message, State, Vector};
use proptest::collection::vec;
use proptest::prelude::*;

/// Any bit pattern of an f32: NaNs with payloads, infinities and subnormals as well.
fn any_bits() -> impl Strategy<Value = f32> {
    any::<u32>().prop_map(f32::from_bits)
}

/// A coordinate or a heading: of a flight, around the limits of what is believed, or any f32.
pub fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -8.0f32..8.0,
        4 => prop_oneof![-30f32..30.0, -1100f32..1100.0],
        1 => prop_oneof![Just(1000.0), Just(-1000.0), Just(8.0 * PI), Just(-8.0 * PI)],
        1 => any_bits(),
    ]
}

fn bytes<const N: usize>() -> impl Strategy<Value = heapless::Vec<u8, N>> {
    vec(any::<u8>(), 0..=N).prop_map(|bytes| bytes.into_iter().collect())
}

fn coefficients<const N: usize>() -> impl Strategy<Value = heapless::Vec<i8, N>> {
    vec(any::<i8>(), 0..=N).prop_map(|values| values.into_iter().collect())
}

fn vector() -> impl Strategy<Value = Vector> {
    (prop::array::uniform5(any_bits()), any::<u8>()).prop_map(|(f, source)| Vector {
        target_e: f[0],
        target_n: f[1],
        delta_yaw: f[2],
        start_e: f[3],
        start_n: f[4],
        source,
    })
}

fn state() -> impl Strategy<Value = State> {
    prop::array::uniform5(any_bits()).prop_map(|f| State {
        ins_e: f[0],
        ins_n: f[1],
        phi: f[2],
        theta: f[3],
        psi: f[4],
    })
}

fn map() -> impl Strategy<Value = Map> {
    (
        any::<[u16; 2]>(),
        prop::array::uniform4(any_bits()),
        coefficients(),
    )
        .prop_map(|(index, f, snapshot_ak_bk)| Map {
            snapshot_index: index[0],
            snapshot_e: f[0],
            snapshot_n: f[1],
            odometry_index: index[1],
            odometry_e: f[2],
            odometry_n: f[3],
            snapshot_ak_bk,
        })
}

fn ins_correction() -> impl Strategy<Value = InsCorrection> {
    (any::<u16>(), prop::array::uniform6(any_bits())).prop_map(|(snapshot_index, f)| {
        InsCorrection {
            snapshot_index,
            e_from: f[0],
            n_from: f[1],
            psi_from: f[2],
            e_to: f[3],
            n_to: f[4],
            psi_to: f[5],
        }
    })
}

/// Any message with any field values.
pub fn message() -> impl Strategy<Value = Message> {
    prop_oneof![
        bytes().prop_map(|msg| Message::Debug(Debug { msg })),
        (any::<u8>(), bytes())
            .prop_map(|(command, args)| Message::Command(Command { command, args })),
        vector().prop_map(Message::Vector),
        state().prop_map(Message::State),
        map().prop_map(Message::Map),
        ins_correction().prop_map(Message::InsCorrection),
        coefficients().prop_map(|snapshot_ak_bk| Message::Camera(Camera { snapshot_ak_bk })),
    ]
}

/// Any message in a frame with any addresses.
pub fn frame() -> impl Strategy<Value = Frame> {
    (any::<[u8; 2]>(), 0u8..16, message()).prop_map(|([sender, receiver], component, message)| {
        Frame {
            sender,
            receiver,
            component,
            message,
        }
    })
}

/// A stream as wires deliver it: noise, start bytes, whole frames, cut frames, flipped bits.
pub fn stream() -> impl Strategy<Value = Vec<u8>> {
    let whole = || frame().prop_map(|frame| frame.encode().to_vec());
    let cut = (whole(), any::<prop::sample::Index>()).prop_map(|(mut bytes, at)| {
        bytes.truncate(at.index(bytes.len()));
        bytes
    });
    let flipped =
        (whole(), any::<prop::sample::Index>(), 0u8..8).prop_map(|(mut bytes, at, bit)| {
            let at = at.index(bytes.len());
            bytes[at] ^= 1 << bit;
            bytes
        });
    let piece = prop_oneof![
        3 => whole(),
        2 => cut,
        2 => flipped,
        1 => vec(any::<u8>(), 0..40),
        1 => vec(Just(0x99), 1..10),
        1 => vec(prop_oneof![Just(0x99), Just(0x05), Just(0x09), Just(0x1d), Just(0xff)], 0..60),
    ];
    vec(piece, 0..8).prop_map(|pieces| pieces.concat())
}
