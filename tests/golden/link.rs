//! The link against the published C code: 192 frames and streams with what its generated receiver
//! made of them.
//!
//! The C receiver checks nothing but the checksum and goes on behind the bytes a broken frame
//! claimed; ours is strict and searches those bytes again. So a record is compared in two steps:
//!
//! * the frames that the C receiver delivered and that are well formed (class 5, exact length) must
//!   come out, in that order, with the same fields, bit for bit; frames that are not well formed
//!   must not;
//! * whatever else comes out must be a whole frame that stands verbatim in the stream, between those
//!   frames: one that the C receiver lost. Which records hold such frames, and how many, follows
//!   from how each stream was made and is stated in [`RECOVERED`]; everywhere else the two outputs
//!   are equal.

use std::collections::BTreeMap;

use link::{Camera, Command, Debug, Frame, InsCorrection, Map, Message, Parser, State, Vector};
use serde::Deserialize;
use serde_json::{Value, json};

/// Records in which the C receiver swallows good frames: name, number of frames swallowed.
const RECOVERED: [(&str, usize); 22] = [
    // A stray start byte claims what follows; the vector behind it goes down with it.
    ("adv/garbage_with_stx_before/0", 1),
    ("adv/garbage_with_stx_before/1", 1),
    ("adv/garbage_with_stx_before/2", 1),
    ("adv/garbage_with_stx_before/3", 2),
    ("adv/double_stx", 2),
    ("adv/many_stx", 1),
    // A cut vector, then four good frames: swallowed up to the length the cut one claimed.
    ("adv/truncated_then_frames/1", 4),
    ("adv/truncated_then_frames/2", 2),
    ("adv/truncated_then_frames/5", 2),
    ("adv/truncated_then_frames/6", 2),
    ("adv/truncated_then_frames/20", 1),
    ("adv/truncated_then_frames/27", 1),
    ("adv/truncated_then_frames/28", 1),
    // A good command in the body of a frame whose checksum is wrong.
    ("adv/frame_inside_bad_frame", 1),
    // A length below 8, then three good frames: 0 to 4 wrap to 252 bytes and more, 5 to 7 cost one.
    ("adv/len_0_then_frames", 3),
    ("adv/len_1_then_frames", 3),
    ("adv/len_2_then_frames", 3),
    ("adv/len_3_then_frames", 3),
    ("adv/len_4_then_frames", 3),
    ("adv/len_5_then_frames", 1),
    ("adv/len_6_then_frames", 1),
    ("adv/len_7_then_frames", 1),
];

/// One line of the golden file.
#[derive(Deserialize)]
struct Record {
    name: String,
    hex: String,
    chunks: Option<Vec<String>>,
    sent: Option<Sent>,
    decoded: Vec<BTreeMap<String, Value>>,
}

/// A valid frame as it was handed to the generated C sender.
#[derive(Deserialize)]
struct Sent {
    name: String,
    sender: u8,
    receiver: u8,
    fields: BTreeMap<String, Value>,
}

fn records() -> Vec<Record> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/data/pprzlink.jsonl");
    let lines = std::fs::read_to_string(path).expect("the golden file is part of the project");
    lines
        .lines()
        .map(|line| serde_json::from_str(line).expect("one record a line"))
        .collect()
}

fn bytes(hex: &str) -> Vec<u8> {
    let nibble = |digit: u8| char::from(digit).to_digit(16).expect("hex digits") as u8;
    let pairs = hex.as_bytes().chunks_exact(2);
    pairs
        .map(|pair| nibble(pair[0]) << 4 | nibble(pair[1]))
        .collect()
}

fn parse<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Frame> {
    let mut parser = Parser::new();
    let mut frames = Vec::new();
    for piece in pieces {
        frames.extend(parser.frames(piece));
    }
    frames
}

/// Header and fields under the names and in the notation of the golden file's `decoded`.
fn describe(frame: &Frame) -> BTreeMap<String, Value> {
    let bits = |value: &f32| json!(format!("{:08x}", value.to_bits()));
    let (id, name, fields) = match &frame.message {
        Message::Debug(m) => (5, "IMCU_DEBUG", vec![("msg", json!(m.msg.as_slice()))]),
        Message::Command(m) => (
            6,
            "VISUALHOMING_COMMAND",
            vec![
                ("command", json!(m.command)),
                ("args", json!(m.args.as_slice())),
            ],
        ),
        Message::Vector(m) => (
            9,
            "VISUALHOMING_VECTOR",
            vec![
                ("target_e_bits", bits(&m.target_e)),
                ("target_n_bits", bits(&m.target_n)),
                ("delta_yaw_bits", bits(&m.delta_yaw)),
                ("start_e_bits", bits(&m.start_e)),
                ("start_n_bits", bits(&m.start_n)),
                ("source", json!(m.source)),
            ],
        ),
        Message::State(m) => (
            10,
            "VISUALHOMING_STATE",
            vec![
                ("ins_e_bits", bits(&m.ins_e)),
                ("ins_n_bits", bits(&m.ins_n)),
                ("phi_bits", bits(&m.phi)),
                ("theta_bits", bits(&m.theta)),
                ("psi_bits", bits(&m.psi)),
            ],
        ),
        Message::Map(m) => (
            11,
            "VISUALHOMING_MAP",
            vec![
                ("snapshot_index", json!(m.snapshot_index)),
                ("snapshot_e_bits", bits(&m.snapshot_e)),
                ("snapshot_n_bits", bits(&m.snapshot_n)),
                ("odometry_index", json!(m.odometry_index)),
                ("odometry_e_bits", bits(&m.odometry_e)),
                ("odometry_n_bits", bits(&m.odometry_n)),
                ("snapshot_ak_bk", json!(m.snapshot_ak_bk.as_slice())),
            ],
        ),
        Message::InsCorrection(m) => (
            12,
            "VISUALHOMING_INS_CORRECTION",
            vec![
                ("snapshot_index", json!(m.snapshot_index)),
                ("e_from_bits", bits(&m.e_from)),
                ("n_from_bits", bits(&m.n_from)),
                ("psi_from_bits", bits(&m.psi_from)),
                ("e_to_bits", bits(&m.e_to)),
                ("n_to_bits", bits(&m.n_to)),
                ("psi_to_bits", bits(&m.psi_to)),
            ],
        ),
        Message::Camera(m) => (
            15,
            "VISUALHOMING_CAMERA",
            vec![("snapshot_ak_bk", json!(m.snapshot_ak_bk.as_slice()))],
        ),
    };
    let header = [
        ("sender", json!(frame.sender)),
        ("receiver", json!(frame.receiver)),
        ("class", json!(5)),
        ("component", json!(frame.component)),
        ("id", json!(id)),
        ("name", json!(name)),
    ];
    let all = header.into_iter().chain(fields);
    all.map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What the C receiver delivered, without what only tells how.
fn well_formed(record: &Record) -> Vec<BTreeMap<String, Value>> {
    let good = record
        .decoded
        .iter()
        .filter(|frame| frame["well_formed"] == json!(true));
    good.map(|frame| {
        let told_in_bits = |name: &str| frame.contains_key(&format!("{name}_bits"));
        let kept = frame.iter().filter(|(name, _)| {
            !matches!(name.as_str(), "well_formed" | "payload" | "payload_len")
                && !told_in_bits(name)
        });
        kept.map(|(name, value)| (name.clone(), value.clone()))
            .collect()
    })
    .collect()
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

fn compare(record: &Record, frames: &[Frame]) {
    let name = &record.name;
    let ours: Vec<_> = frames.iter().map(describe).collect();
    let theirs = well_formed(record);
    let recovered = RECOVERED.iter().find(|(recovered, _)| recovered == name);
    match recovered {
        None => assert_eq!(ours, theirs, "{name}"),
        Some((_, lost)) => {
            let mut ours = ours.iter();
            let in_order = theirs.iter().all(|frame| ours.any(|our| our == frame));
            assert!(in_order, "{name}: all that the C receiver delivered");
            assert_eq!(frames.len(), theirs.len() + lost, "{name}");
        }
    }
    assert!(stand_in(&bytes(&record.hex), frames), "{name}");
}

fn float(fields: &BTreeMap<String, Value>, name: &str) -> f32 {
    match &fields[name] {
        Value::String(bits) => f32::from_bits(u32::from_str_radix(bits, 16).expect("hex bits")),
        value => value.as_f64().expect("a number") as f32,
    }
}

fn integer<T: TryFrom<i64>>(value: &Value) -> T {
    let value = value.as_i64().and_then(|value| T::try_from(value).ok());
    value.expect("an integer of the field's type")
}

fn array<T: TryFrom<i64>, Array: FromIterator<T>>(
    fields: &BTreeMap<String, Value>,
    name: &str,
) -> Array {
    let elements = fields[name].as_array().expect("an array");
    elements.iter().map(integer).collect()
}

fn message(name: &str, fields: &BTreeMap<String, Value>) -> Message {
    let float = |name| float(fields, name);
    match name {
        "IMCU_DEBUG" => Message::Debug(Debug {
            msg: array(fields, "msg"),
        }),
        "VISUALHOMING_COMMAND" => Message::Command(Command {
            command: integer(&fields["command"]),
            args: array(fields, "args"),
        }),
        "VISUALHOMING_VECTOR" => Message::Vector(Vector {
            target_e: float("target_e"),
            target_n: float("target_n"),
            delta_yaw: float("delta_yaw"),
            start_e: float("start_e"),
            start_n: float("start_n"),
            source: integer(&fields["source"]),
        }),
        "VISUALHOMING_STATE" => Message::State(State {
            ins_e: float("ins_e"),
            ins_n: float("ins_n"),
            phi: float("phi"),
            theta: float("theta"),
            psi: float("psi"),
        }),
        "VISUALHOMING_MAP" => Message::Map(Map {
            snapshot_index: integer(&fields["snapshot_index"]),
            snapshot_e: float("snapshot_e"),
            snapshot_n: float("snapshot_n"),
            odometry_index: integer(&fields["odometry_index"]),
            odometry_e: float("odometry_e"),
            odometry_n: float("odometry_n"),
            snapshot_ak_bk: array(fields, "snapshot_ak_bk"),
        }),
        "VISUALHOMING_INS_CORRECTION" => Message::InsCorrection(InsCorrection {
            snapshot_index: integer(&fields["snapshot_index"]),
            e_from: float("e_from"),
            n_from: float("n_from"),
            psi_from: float("psi_from"),
            e_to: float("e_to"),
            n_to: float("n_to"),
            psi_to: float("psi_to"),
        }),
        "VISUALHOMING_CAMERA" => Message::Camera(Camera {
            snapshot_ak_bk: array(fields, "snapshot_ak_bk"),
        }),
        other => panic!("the golden file sends no {other}"),
    }
}

#[test]
fn the_parser_delivers_what_the_c_receiver_delivers_and_what_it_lost() {
    let records = records();
    assert_eq!(records.len(), 192);
    for record in &records {
        let stream = bytes(&record.hex);
        compare(record, &parse([&stream[..]]));
        compare(record, &parse(stream.chunks(1)));
        if let Some(chunks) = &record.chunks {
            let chunks: Vec<_> = chunks.iter().map(|chunk| bytes(chunk)).collect();
            assert_eq!(chunks.concat(), stream, "{}", record.name);
            compare(record, &parse(chunks.iter().map(Vec::as_slice)));
        }
    }
}

#[test]
fn every_record_with_lost_frames_is_in_the_golden_file() {
    let records = records();
    for (name, _) in RECOVERED {
        assert!(records.iter().any(|record| record.name == name), "{name}");
    }
}

#[test]
fn a_message_becomes_the_bytes_that_the_c_sender_sends() {
    let records = records();
    let sent = records
        .iter()
        .filter_map(|record| Some((record, record.sent.as_ref()?)));
    let mut count = 0;
    for (record, sent) in sent {
        let frame = Frame {
            sender: sent.sender,
            receiver: sent.receiver,
            component: 0,
            message: message(&sent.name, &sent.fields),
        };
        let encoded = frame.encode();
        assert_eq!(encoded.as_slice(), bytes(&record.hex), "{}", record.name);
        count += 1;
    }
    assert_eq!(count, 77, "the valid records");
}
