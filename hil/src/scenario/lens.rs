//! What the firmware finds on the flash page of the lens record.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use nav::calibration::record::{self, RECORD_BYTES};
use nav::{BearingDirection, LensCalibration, RecordError};
use pilot::FRAME_LAYOUT;
use serde::{Serialize, Serializer};
use serde_json::json;

/// The beginning of the page: a record, or what may have become of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LensPage([u8; RECORD_BYTES]);

/// A file that holds no lens record.
#[derive(Debug, thiserror::Error)]
pub enum LensFileError {
    /// It cannot be read.
    #[error("{}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It is not a record that the flight board would take.
    #[error("{}: not a lens record for this board: {source}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Why.
        source: RecordError,
    },
}

impl LensPage {
    /// A page with these bytes, good or bad.
    pub const fn new(bytes: [u8; RECORD_BYTES]) -> Self {
        Self(bytes)
    }

    /// The record of a lens.
    pub fn of(lens: &LensCalibration) -> Self {
        Self(record::encode(lens, &FRAME_LAYOUT))
    }

    /// A record from a file, which the firmware would take.
    ///
    /// # Errors
    /// [`LensFileError`] with the file and the reason.
    pub fn from_file(path: &Path) -> Result<Self, LensFileError> {
        let bytes = fs::read(path).map_err(|source| LensFileError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        let record = record::decode(&bytes, &FRAME_LAYOUT);
        let page = record.and_then(|_| bytes.first_chunk().ok_or(RecordError::TooShort));
        page.map(|page| Self(*page))
            .map_err(|source| LensFileError::Refused {
                path: path.to_owned(),
                source,
            })
    }

    /// Its bytes.
    pub const fn bytes(&self) -> &[u8; RECORD_BYTES] {
        &self.0
    }

    /// The lens, as the firmware reads it.
    ///
    /// # Errors
    /// [`RecordError`] where the firmware would take the default lens.
    pub fn lens(&self) -> Result<LensCalibration, RecordError> {
        record::decode(&self.0, &FRAME_LAYOUT)
    }
}

/// The lens in figures, or why there is none.
impl Serialize for LensPage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = match self.lens() {
            Ok(lens) => json!({
                "centre_px": [lens.centre_px.0, lens.centre_px.1],
                "inner_radius_px": lens.inner_radius_px,
                "outer_radius_px": lens.outer_radius_px,
                "horizon_radius_px": lens.horizon_radius_px,
                "vertical_field_deg": lens.vertical_field_rad.to_degrees(),
                "zero_bearing_deg": lens.zero_bearing_rad.to_degrees(),
                "direction": match lens.direction {
                    BearingDirection::Clockwise => "clockwise",
                    BearingDirection::CounterClockwise => "counter-clockwise",
                },
                "inner_is_up": lens.inner_is_up,
            }),
            Err(error) => json!({ "refused": error.to_string() }),
        };
        value.serialize(serializer)
    }
}
