//! The flight app's receiving side against the published client: what its generated C receiver made of 192 frames and
//! streams, broken ones included, and what the client handed to its app.

use std::collections::BTreeSet;

use autopilot::app::published_receiver::{PublishedReceiver, RawFrame, Reception, Wait};
use autopilot::app::{FlightApp, Phase, Quirks, Script, Settings, Step, Until};
use autopilot::ekf::Estimate;
use hil::link_check::{Fields, Hex, describe};
use link::{Frame, Message, Mode};
use nalgebra::{SVector, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde_json::{Value, json};

const RECORDS: &str = include_str!("data/pprzlink.jsonl");

/// The one stream that makes the C receiver write behind its buffer: whatever it did then is no example.
const UNDEFINED: &str = "adv/len_4_wrap_256_valid_ck_UB";

/// One line of the golden file.
#[derive(Deserialize)]
struct Record {
    name: String,
    #[serde(rename = "hex")]
    stream: Hex,
    #[serde(default)]
    chunks: Vec<Hex>,
    /// What the receiver delivered.
    decoded: Vec<Fields>,
    /// What the client handed to its app.
    client: Vec<Fields>,
    /// The receiver's state after the stream.
    end_state: u8,
    #[serde(default)]
    undefined_behaviour: bool,
}

fn records() -> Vec<Record> {
    let lines = RECORDS.lines();
    lines
        .map(|line| serde_json::from_str(line).expect("one record a line"))
        .collect()
}

/// A frame in the golden file's notation.
fn fields(frame: &RawFrame<'_>) -> Fields {
    let message = frame.message();
    let mut fields = match &message {
        Some(message) => describe(&Frame {
            sender: frame.sender(),
            receiver: frame.receiver(),
            component: frame.component(),
            message: message.clone(),
        }),
        None => Fields::from([
            ("sender".to_owned(), json!(frame.sender())),
            ("receiver".to_owned(), json!(frame.receiver())),
            ("component".to_owned(), json!(frame.component())),
            ("id".to_owned(), json!(frame.id())),
            ("name".to_owned(), Value::Null),
        ]),
    };
    // Start, length and two sums are no data.
    let is_its_message_long =
        message.is_some_and(|message| message.encode().len() == frame.data().len() + 4);
    let digits: Vec<_> = frame
        .data()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    fields.extend([
        ("class".to_owned(), json!(frame.class())),
        (
            "well_formed".to_owned(),
            json!(frame.class() == 5 && is_its_message_long),
        ),
        ("payload_len".to_owned(), json!(frame.data().len())),
        ("payload".to_owned(), json!(digits.concat())),
    ]);
    fields
}

/// All frames of a stream, and the state in which it leaves the receiver.
fn receive(stream: &[u8]) -> (Vec<Fields>, u8) {
    let mut receiver = PublishedReceiver::default();
    let mut frames = Vec::new();
    for byte in stream {
        if let Some(Reception::Frame(frame)) = receiver.push(*byte) {
            frames.push(fields(&frame));
        }
    }
    let state = match receiver.wait() {
        Wait::Start => 0,
        Wait::Length => 1,
        Wait::Data => 2,
        Wait::SumA => 3,
        Wait::SumB => 4,
    };
    (frames, state)
}

/// The record's own words for the same frame: without the rounded values of floats that it tells in bits.
fn told_exactly(frame: &Fields) -> Fields {
    let in_bits = |name: &str| frame.contains_key(&format!("{name}_bits"));
    let kept = frame.iter().filter(|(name, _)| !in_bits(name));
    kept.map(|(name, value)| (name.clone(), value.clone()))
        .collect()
}

#[test]
fn the_published_receiver_delivers_what_the_c_receiver_delivers_good_and_bad() {
    let records = records();
    assert_eq!(records.len(), 192);
    let mut undefined = BTreeSet::new();
    for record in &records {
        if record.undefined_behaviour {
            undefined.insert(record.name.as_str());
            continue;
        }
        let (frames, end_state) = receive(&record.stream.0);
        let expected: Vec<_> = record.decoded.iter().map(told_exactly).collect();
        assert_eq!(frames, expected, "{}", record.name);
        assert_eq!(end_state, record.end_state, "{}", record.name);
    }
    assert_eq!(undefined, BTreeSet::from([UNDEFINED]));
    let ill_formed = records.iter().flat_map(|record| &record.decoded);
    let ill_formed = ill_formed.filter(|frame| frame["well_formed"] == json!(false));
    assert!(ill_formed.count() >= 20, "the records hold broken frames");
}

/// A drone that hovers at the origin, whatever it is told.
fn hovering() -> Estimate {
    Estimate {
        position_m: Vector3::new(0.0, 0.0, 0.5),
        velocity_m_s: Vector3::zeros(),
        velocity_body_m_s: Vector3::zeros(),
        attitude: UnitQuaternion::identity(),
        variances: SVector::zeros(),
    }
}

/// An app that follows the camera in the air, and the time.
fn airborne(quirks: Quirks) -> (FlightApp, u64) {
    let steps = vec![Step::Follow {
        mode: Mode::Follow,
        until: Until::Home,
    }];
    let settings = Settings {
        quirks,
        ..Settings::default()
    };
    let mut app = FlightApp::new(Script { steps }, settings);
    let mut now_ms = 0;
    while app.phase() != Phase::Following {
        app.tick(now_ms, &hovering(), &[]);
        now_ms += 1;
    }
    (app, now_ms)
}

/// The messages that the app handles of a stream that arrives in pieces, one piece in each period.
fn handled<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Message> {
    // As much as the receiver finds: neither buffer nor number of messages are in the way.
    let quirks = Quirks {
        published_receiver: true,
        unchecked_values: true,
        ..Quirks::NONE
    };
    const PERIOD_MS: u64 = 100;
    const PERIODS_FOR_THE_REST: u64 = 5;
    let (mut app, mut now_ms) = airborne(quirks);
    let mut run = |piece: &[u8], periods: u64| {
        app.tick(now_ms, &hovering(), piece);
        for at_ms in now_ms + 1..now_ms + periods * PERIOD_MS {
            app.tick(at_ms, &hovering(), &[]);
        }
        now_ms += periods * PERIOD_MS;
    };
    for piece in pieces {
        run(piece, 1);
    }
    run(&[], PERIODS_FOR_THE_REST);
    assert_eq!(app.phase(), Phase::Following);
    let received = app.take_received().into_iter();
    received.map(|received| received.message).collect()
}

/// What the client hands on, in the golden file's notation; `None` for messages that it does not use.
fn handed_on(message: &Message) -> Option<Fields> {
    let fields = match message {
        Message::Command(m) => vec![("type", json!("COMMAND")), ("command", json!(m.command))],
        Message::Vector(m) => vec![
            ("type", json!("VECTOR")),
            ("source", json!(m.source)),
            ("to_n", float(m.target_n)),
            ("to_e", float(m.target_e)),
            ("from_n", float(m.start_n)),
            ("from_e", float(m.start_e)),
            ("delta_psi", float(m.delta_yaw)),
        ],
        // Logged in eight bits.
        Message::Map(m) => vec![
            ("type", json!("MAP")),
            ("snapshot_idx", json!(m.snapshot_index as u8)),
            ("odometry_idx", json!(m.odometry_index as u8)),
            ("snapshot_n", float(m.snapshot_n)),
            ("snapshot_e", float(m.snapshot_e)),
            ("odometry_n", float(m.odometry_n)),
            ("odometry_e", float(m.odometry_e)),
        ],
        Message::InsCorrection(m) => vec![
            ("type", json!("INS_CORRECTION")),
            ("idx", json!(m.snapshot_index)),
            ("from_n", float(m.n_from)),
            ("from_e", float(m.e_from)),
            ("to_n", float(m.n_to)),
            ("to_e", float(m.e_to)),
            ("psi_from", float(m.psi_from)),
            ("psi_to", float(m.psi_to)),
        ],
        Message::Debug(_) | Message::State(_) | Message::Camera(_) => return None,
    };
    let fields = fields.into_iter();
    Some(
        fields
            .map(|(name, value)| (name.to_owned(), value))
            .collect(),
    )
}

/// A float that compares equal to itself, NaN as well; the records do not tell zero's sign.
fn float(value: f32) -> Value {
    json!((value + 0.0).to_string())
}

/// The record's floats in the same notation: they have nine digits, as many as an f32 needs.
fn in_text(message: &Fields) -> Fields {
    let text = |(name, value): (&String, &Value)| {
        let float = match value {
            Value::Number(number) if number.is_f64() || !is_integer(name) => {
                number.as_f64().map(|value| value as f32)
            }
            Value::String(text) if name != "type" => text.parse().ok(),
            _ => None,
        };
        let value = float.map_or_else(|| value.clone(), self::float);
        (name.clone(), value)
    };
    message.iter().map(text).collect()
}

fn is_integer(field: &str) -> bool {
    matches!(
        field,
        "command" | "source" | "idx" | "snapshot_idx" | "odometry_idx"
    )
}

#[test]
fn the_app_handles_what_the_published_client_hands_to_its_app() {
    let mut messages = 0;
    for record in records().iter().filter(|record| record.name != UNDEFINED) {
        let expected: Vec<_> = record.client.iter().map(in_text).collect();
        messages += expected.len();
        let ours =
            |handled: Vec<Message>| -> Vec<_> { handled.iter().filter_map(handed_on).collect() };
        let whole = [&record.stream.0[..]];
        assert_eq!(ours(handled(whole)), expected, "{}", record.name);
        if !record.chunks.is_empty() {
            let chunks = record.chunks.iter().map(|chunk| &chunk.0[..]);
            assert_eq!(ours(handled(chunks)), expected, "{} in chunks", record.name);
        }
    }
    assert!(messages > 200, "{messages} messages");
}

#[test]
fn without_the_quirk_the_app_handles_no_frame_that_is_not_well_formed() {
    let (mut app, start_ms) = airborne(Quirks::NONE);
    // A vector header without a body; its sums, by hand: A 08 08 08 0d 16, B 08 10 18 25 3b.
    let headless = [0x99, 0x08, 0x00, 0x00, 0x05, 0x09, 0x16, 0x3b];
    app.tick(start_ms, &hovering(), &headless);
    for now_ms in start_ms + 1..start_ms + 200 {
        app.tick(now_ms, &hovering(), &[]);
    }
    assert_eq!(app.take_received(), []);
    assert_eq!(app.take_dropped().len(), 1);
}
