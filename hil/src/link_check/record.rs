//! One line of a file of link records.

use serde::Deserialize;

use super::notation::Fields;

/// A stream of bytes and what somebody's receiver made of it.
#[derive(Clone, Debug, Deserialize)]
pub struct Record {
    /// What it is called.
    pub name: String,
    /// The whole stream.
    #[serde(rename = "hex")]
    pub stream: Hex,
    /// The pieces it arrived in, where there was more than one.
    #[serde(default)]
    pub chunks: Vec<Hex>,
    /// The message the stream is the frame of, where a sender made it.
    pub sent: Option<Sent>,
    /// What the receiver delivered.
    pub decoded: Vec<Delivered>,
}

/// A message as it was handed to a sender.
#[derive(Clone, Debug, Deserialize)]
pub struct Sent {
    /// Which message.
    pub name: String,
    /// Address of the sender.
    pub sender: u8,
    /// Address of the receiver.
    pub receiver: u8,
    /// Its fields.
    pub fields: Fields,
}

/// A frame as a receiver delivered it.
#[derive(Clone, Debug, Deserialize)]
pub struct Delivered {
    /// Whether it is of the link's class and of exactly its message's length: a strict receiver delivers no others.
    pub well_formed: bool,
    #[serde(flatten)]
    fields: Fields,
}

impl Delivered {
    /// Header and fields in the notation of [`describe`](super::notation::describe): without what only tells how it
    /// was delivered, and without the rounded value of a float whose bits are told.
    pub fn fields(&self) -> Fields {
        let in_bits = |name: &str| self.fields.contains_key(&format!("{name}_bits"));
        let kept = self.fields.iter().filter(|(name, _)| {
            !matches!(name.as_str(), "payload" | "payload_len") && !in_bits(name)
        });
        kept.map(|(name, value)| (name.clone(), value.clone()))
            .collect()
    }
}

/// Bytes that are written as two hexadecimal digits each.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "String")]
pub struct Hex(pub Vec<u8>);

/// Text that is no bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("bytes are written as pairs of hexadecimal digits")]
pub struct NotHex;

impl TryFrom<String> for Hex {
    type Error = NotHex;

    fn try_from(text: String) -> Result<Self, NotHex> {
        let digits: Option<Vec<u8>> = text
            .chars()
            .map(|digit| digit.to_digit(16).map(|value| value as u8))
            .collect();
        let digits = digits
            .filter(|digits| digits.len().is_multiple_of(2))
            .ok_or(NotHex)?;
        let pairs = digits.chunks_exact(2);
        Ok(Self(pairs.map(|pair| pair[0] << 4 | pair[1]).collect()))
    }
}
