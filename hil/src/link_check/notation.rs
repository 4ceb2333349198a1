//! Messages in the records' notation: fields by name; a float as the hexadecimal digits of its bits under its name and
//! `_bits`, or, where a sender was given it, as a number.

use std::collections::BTreeMap;

use link::{Camera, Command, Debug, Frame, InsCorrection, Map, Message, State, Vector};
use serde_json::{Value, json};

/// Fields by name.
pub type Fields = BTreeMap<String, Value>;

/// Fields that are no message.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotAMessage {
    /// The link has no message of this name.
    #[error("there is no message {0:?}")]
    UnknownName(String),
    /// The message has a field that is not there.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// The value is not one of the field's type.
    #[error("{field} cannot be {value}")]
    WrongValue {
        /// The field.
        field: &'static str,
        /// What it holds.
        value: Value,
    },
}

/// Header and fields of a frame.
pub fn describe(frame: &Frame) -> Fields {
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
        Message::Vector(m) => (9, "VISUALHOMING_VECTOR", vector(m)),
        Message::State(m) => (10, "VISUALHOMING_STATE", state(m)),
        Message::Map(m) => (11, "VISUALHOMING_MAP", map(m)),
        Message::InsCorrection(m) => (12, "VISUALHOMING_INS_CORRECTION", ins_correction(m)),
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

fn vector(m: &Vector) -> Vec<(&'static str, Value)> {
    vec![
        ("target_e_bits", bits(m.target_e)),
        ("target_n_bits", bits(m.target_n)),
        ("delta_yaw_bits", bits(m.delta_yaw)),
        ("start_e_bits", bits(m.start_e)),
        ("start_n_bits", bits(m.start_n)),
        ("source", json!(m.source)),
    ]
}

fn state(m: &State) -> Vec<(&'static str, Value)> {
    vec![
        ("ins_e_bits", bits(m.ins_e)),
        ("ins_n_bits", bits(m.ins_n)),
        ("phi_bits", bits(m.phi)),
        ("theta_bits", bits(m.theta)),
        ("psi_bits", bits(m.psi)),
    ]
}

fn map(m: &Map) -> Vec<(&'static str, Value)> {
    vec![
        ("snapshot_index", json!(m.snapshot_index)),
        ("snapshot_e_bits", bits(m.snapshot_e)),
        ("snapshot_n_bits", bits(m.snapshot_n)),
        ("odometry_index", json!(m.odometry_index)),
        ("odometry_e_bits", bits(m.odometry_e)),
        ("odometry_n_bits", bits(m.odometry_n)),
        ("snapshot_ak_bk", json!(m.snapshot_ak_bk.as_slice())),
    ]
}

fn ins_correction(m: &InsCorrection) -> Vec<(&'static str, Value)> {
    vec![
        ("snapshot_index", json!(m.snapshot_index)),
        ("e_from_bits", bits(m.e_from)),
        ("n_from_bits", bits(m.n_from)),
        ("psi_from_bits", bits(m.psi_from)),
        ("e_to_bits", bits(m.e_to)),
        ("n_to_bits", bits(m.n_to)),
        ("psi_to_bits", bits(m.psi_to)),
    ]
}

fn bits(value: f32) -> Value {
    json!(format!("{:08x}", value.to_bits()))
}

/// The message of a name and its fields.
pub fn message(name: &str, fields: &Fields) -> Result<Message, NotAMessage> {
    let float = |field| float(fields, field);
    Ok(match name {
        "IMCU_DEBUG" => Message::Debug(Debug {
            msg: array(fields, "msg")?,
        }),
        "VISUALHOMING_COMMAND" => Message::Command(Command {
            command: integer(fields, "command")?,
            args: array(fields, "args")?,
        }),
        "VISUALHOMING_VECTOR" => Message::Vector(Vector {
            target_e: float("target_e")?,
            target_n: float("target_n")?,
            delta_yaw: float("delta_yaw")?,
            start_e: float("start_e")?,
            start_n: float("start_n")?,
            source: integer(fields, "source")?,
        }),
        "VISUALHOMING_STATE" => Message::State(State {
            ins_e: float("ins_e")?,
            ins_n: float("ins_n")?,
            phi: float("phi")?,
            theta: float("theta")?,
            psi: float("psi")?,
        }),
        "VISUALHOMING_MAP" => Message::Map(Map {
            snapshot_index: integer(fields, "snapshot_index")?,
            snapshot_e: float("snapshot_e")?,
            snapshot_n: float("snapshot_n")?,
            odometry_index: integer(fields, "odometry_index")?,
            odometry_e: float("odometry_e")?,
            odometry_n: float("odometry_n")?,
            snapshot_ak_bk: array(fields, "snapshot_ak_bk")?,
        }),
        "VISUALHOMING_INS_CORRECTION" => Message::InsCorrection(InsCorrection {
            snapshot_index: integer(fields, "snapshot_index")?,
            e_from: float("e_from")?,
            n_from: float("n_from")?,
            psi_from: float("psi_from")?,
            e_to: float("e_to")?,
            n_to: float("n_to")?,
            psi_to: float("psi_to")?,
        }),
        "VISUALHOMING_CAMERA" => Message::Camera(Camera {
            snapshot_ak_bk: array(fields, "snapshot_ak_bk")?,
        }),
        other => return Err(NotAMessage::UnknownName(other.to_owned())),
    })
}

fn get<'a>(fields: &'a Fields, field: &'static str) -> Result<&'a Value, NotAMessage> {
    fields.get(field).ok_or(NotAMessage::Missing(field))
}

fn wrong(field: &'static str, value: &Value) -> NotAMessage {
    NotAMessage::WrongValue {
        field,
        value: value.clone(),
    }
}

/// A number, or the digits of a float that JSON cannot hold.
fn float(fields: &Fields, field: &'static str) -> Result<f32, NotAMessage> {
    let value = get(fields, field)?;
    let float = match value {
        Value::String(bits) => u32::from_str_radix(bits, 16).ok().map(f32::from_bits),
        value => value.as_f64().map(|value| value as f32),
    };
    float.ok_or_else(|| wrong(field, value))
}

fn integer<T: TryFrom<i64>>(fields: &Fields, field: &'static str) -> Result<T, NotAMessage> {
    let value = get(fields, field)?;
    let integer = value.as_i64().and_then(|value| T::try_from(value).ok());
    integer.ok_or_else(|| wrong(field, value))
}

/// An array of no more elements than the message holds.
fn array<T, Array>(fields: &Fields, field: &'static str) -> Result<Array, NotAMessage>
where
    T: TryFrom<i64>,
    Array: for<'a> TryFrom<&'a [T]>,
{
    let value = get(fields, field)?;
    let element = |value: &Value| value.as_i64().and_then(|value| T::try_from(value).ok());
    let elements: Option<Vec<T>> = value
        .as_array()
        .and_then(|elements| elements.iter().map(element).collect());
    elements
        .and_then(|elements| Array::try_from(&elements).ok())
        .ok_or_else(|| wrong(field, value))
}
