//! What the property tests share: strategies for messages, and a receiver written the plain way.

use std::f32::consts::PI;

use link::{
    Camera, Command, Debug, Frame, InsCorrection, MAX_FRAME_LEN, MIN_FRAME_LEN, Map, Message,
    State, Vector,
};
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

/// The whole frames in a stream that is known from end to end, and the offset from which on it
/// could not be decided: the specification of the parser, without regard to time or memory.
pub fn frames_in(stream: &[u8]) -> (Vec<Vec<u8>>, usize) {
    let mut frames = Vec::new();
    let mut at = 0;
    while at < stream.len() {
        match frame_len(&stream[at..]) {
            Some(0) => at += 1,
            Some(len) => {
                frames.push(stream[at..at + len].to_vec());
                at += len;
            }
            None => break,
        }
    }
    (frames, at)
}

/// The whole frames in a stream after which nothing comes.
pub fn frames_in_ended(stream: &[u8]) -> Vec<Vec<u8>> {
    let (mut frames, decided) = frames_in(stream);
    if decided < stream.len() {
        frames.extend(frames_in_ended(&stream[decided + 1..]));
    }
    frames
}

/// Length of the frame that begins here; 0 if none does, `None` if the stream ends too early. A
/// header counts as too early until the shortest frame would be complete, an array's length that
/// comes behind that until the whole frame is.
fn frame_len(bytes: &[u8]) -> Option<usize> {
    if *bytes.first()? != 0x99 {
        return Some(0);
    }
    let header = bytes.get(..MIN_FRAME_LEN)?;
    let len = usize::from(header[1]);
    if len < MIN_FRAME_LEN || header[4] & 0x0f != 5 {
        return Some(0);
    }
    // Bytes of a frame without its array, offset of the array's length.
    let (shortest, array_at) = match header[5] {
        5 | 15 => (9, Some(6)),
        6 => (10, Some(7)),
        9 => (29, None),
        10 => (28, None),
        11 => (29, Some(26)),
        12 => (34, None),
        _ => return Some(0),
    };
    let possible = match array_at {
        None => len == shortest,
        Some(at) if at < MIN_FRAME_LEN => len == shortest + usize::from(header[at]),
        Some(_) => len >= shortest,
    };
    if !possible {
        return Some(0);
    }
    let frame = bytes.get(..len)?;
    if array_at.is_some_and(|at| len != shortest + usize::from(frame[at])) {
        return Some(0);
    }
    let (mut a, mut b) = (0u32, 0u32);
    for byte in &frame[1..len - 2] {
        a = (a + u32::from(*byte)) % 256;
        b = (b + a) % 256;
    }
    let sums = [u32::from(frame[len - 2]), u32::from(frame[len - 1])];
    Some(if sums == [a, b] { len } else { 0 })
}

/// Longest a false start can keep the parser busy.
pub const LONGEST_CLAIM: usize = MAX_FRAME_LEN - 1;
