//! The lens record: a calibration as bytes, for a page of flash.
//!
//! Little-endian, without padding:
//!
//! | offset | bytes | field |
//! |---|---|---|
//! | 0 | 4 | magic, `LENS` |
//! | 4 | 2 | version, 1 |
//! | 6 | 2 | length of the record with its checksum, 48 |
//! | 8 | 2 + 2 | width and height of the frame that the lens was calibrated on, pixels |
//! | 12 | 4 + 4 | centre x, y, pixels (`f32`, as all that follow) |
//! | 20 | 4 | inner radius, pixels |
//! | 24 | 4 | outer radius, pixels |
//! | 28 | 4 | horizon radius, pixels |
//! | 32 | 4 | vertical field, radians |
//! | 36 | 4 | zero bearing, radians |
//! | 40 | 1 | direction: 0 clockwise, 1 counter-clockwise |
//! | 41 | 1 | inner edge is up: 0 or 1 |
//! | 42 | 2 | 0 |
//! | 44 | 4 | CRC-32 of all bytes before it (ISO-HDLC: zlib's, Ethernet's) |
//!
//! A reader refuses a version that it does not know. What follows the record on its page is ignored.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

use super::{BearingDirection, CalibrationError, LensCalibration};
use crate::panorama::FrameLayout;

/// Bytes of a record.
pub const RECORD_BYTES: usize = 48;

const MAGIC: [u8; 4] = *b"LENS";
const VERSION: u16 = 1;
/// Where the checksum begins, and with that how many bytes it covers.
const CHECKED_BYTES: usize = RECORD_BYTES - 4;
/// What erased flash reads.
const ERASED: u8 = 0xff;

/// Without a table: 44 bytes, once at boot.
const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Why a page holds no calibration that can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RecordError {
    /// The page is erased: nobody has calibrated this unit.
    Empty,
    /// Fewer bytes than a record has.
    TooShort,
    /// It does not begin as a record does.
    NotARecord,
    /// Written by a later version of this program.
    UnknownVersion(u16),
    /// The length it states is not that of its version.
    WrongLength(u16),
    /// The checksum does not match.
    Damaged,
    /// A field holds a value that has no meaning.
    UnknownValue,
    /// Calibrated on frames of another size.
    OtherFrame {
        /// Their width, pixels.
        width: u16,
        /// Their height, pixels.
        height: u16,
    },
    /// The checksum matches, but there is no such lens.
    Impossible(CalibrationError),
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("empty"),
            Self::TooShort => write!(f, "shorter than the {RECORD_BYTES} bytes of a record"),
            Self::NotARecord => f.write_str("not a lens record"),
            Self::UnknownVersion(version) => write!(f, "version {version} is not known"),
            Self::WrongLength(length) => {
                write!(
                    f,
                    "{length} bytes long by its own account, not {RECORD_BYTES}"
                )
            }
            Self::Damaged => f.write_str("the checksum does not match"),
            Self::UnknownValue => f.write_str("a field holds a value without a meaning"),
            Self::OtherFrame { width, height } => {
                write!(f, "calibrated on frames of {width} x {height} pixels")
            }
            Self::Impossible(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for RecordError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Impossible(error) => Some(error),
            _ => None,
        }
    }
}

/// The record of a lens that was calibrated on frames of this layout.
pub fn encode(lens: &LensCalibration, layout: &FrameLayout) -> [u8; RECORD_BYTES] {
    let mut writer = Writer {
        bytes: [0; RECORD_BYTES],
        at: 0,
    };
    writer.put(&MAGIC);
    for number in [VERSION, RECORD_BYTES as u16, layout.width, layout.height] {
        writer.put(&number.to_le_bytes());
    }
    for number in [
        lens.centre_px.0,
        lens.centre_px.1,
        lens.inner_radius_px,
        lens.outer_radius_px,
        lens.horizon_radius_px,
        lens.vertical_field_rad,
        lens.zero_bearing_rad,
    ] {
        writer.put(&number.to_le_bytes());
    }
    let direction = match lens.direction {
        BearingDirection::Clockwise => 0,
        BearingDirection::CounterClockwise => 1,
    };
    writer.put(&[direction, u8::from(lens.inner_is_up), 0, 0]);
    let checksum = checksum(&writer.bytes);
    writer.put(&checksum.to_le_bytes());
    writer.bytes
}

/// The calibration in the record that `page` begins with, for frames of this layout.
///
/// # Errors
///
/// The first [`RecordError`] that applies; what is returned has passed
/// [`LensCalibration::check`].
pub fn decode(page: &[u8], layout: &FrameLayout) -> Result<LensCalibration, RecordError> {
    let record: &[u8; RECORD_BYTES] = page.first_chunk().ok_or(RecordError::TooShort)?;
    if record.iter().all(|byte| *byte == ERASED) {
        return Err(RecordError::Empty);
    }
    let mut reader = Reader { bytes: record };
    if reader.take() != MAGIC {
        return Err(RecordError::NotARecord);
    }
    match reader.u16() {
        VERSION => {}
        other => return Err(RecordError::UnknownVersion(other)),
    }
    match reader.u16() {
        length if usize::from(length) == RECORD_BYTES => {}
        other => return Err(RecordError::WrongLength(other)),
    }
    let [width, height] = [reader.u16(), reader.u16()];
    let lens = LensCalibration {
        centre_px: (reader.f32(), reader.f32()),
        inner_radius_px: reader.f32(),
        outer_radius_px: reader.f32(),
        horizon_radius_px: reader.f32(),
        vertical_field_rad: reader.f32(),
        zero_bearing_rad: reader.f32(),
        direction: BearingDirection::Clockwise,
        inner_is_up: false,
    };
    let [direction, inner_is_up, zero_a, zero_b] = reader.take();
    if u32::from_le_bytes(reader.take()) != checksum(record) {
        return Err(RecordError::Damaged);
    }
    let lens = LensCalibration {
        direction: match direction {
            0 => BearingDirection::Clockwise,
            1 => BearingDirection::CounterClockwise,
            _ => return Err(RecordError::UnknownValue),
        },
        inner_is_up: match inner_is_up {
            0 => false,
            1 => true,
            _ => return Err(RecordError::UnknownValue),
        },
        ..lens
    };
    if [zero_a, zero_b] != [0, 0] {
        return Err(RecordError::UnknownValue);
    }
    if (width, height) != (layout.width, layout.height) {
        return Err(RecordError::OtherFrame { width, height });
    }
    lens.check(layout).map_err(RecordError::Impossible)?;
    Ok(lens)
}

fn checksum(record: &[u8; RECORD_BYTES]) -> u32 {
    CRC.checksum(&record[..CHECKED_BYTES])
}

/// Puts fields one after the other.
struct Writer {
    bytes: [u8; RECORD_BYTES],
    at: usize,
}

impl Writer {
    fn put(&mut self, field: &[u8]) {
        let end = self.at + field.len();
        if let Some(room) = self.bytes.get_mut(self.at..end) {
            room.copy_from_slice(field);
        }
        self.at = end;
    }
}

/// Takes fields one after the other; zeros beyond the end, which the fields above do not reach.
struct Reader<'r> {
    bytes: &'r [u8],
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        match self.bytes.split_first_chunk() {
            Some((field, rest)) => {
                self.bytes = rest;
                *field
            }
            None => [0; N],
        }
    }

    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }

    fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }
}

#[cfg(test)]
mod tests;
