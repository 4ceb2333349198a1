//! The forms in which a route may remember its views.

use super::packed::{MOST_PACKED_BYTES, PackedSnapshot, Packing};
use super::{SNAPSHOT_BYTES, Snapshot};
use crate::spectrum::Spectrum;

/// The most bytes of a view in any form.
pub const MOST_SNAPSHOT_BYTES: usize = if SNAPSHOT_BYTES > MOST_PACKED_BYTES {
    SNAPSHOT_BYTES
} else {
    MOST_PACKED_BYTES
};

/// How the snapshots of a route are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SnapshotFormat {
    /// Eight frequencies of 8 bits, 16 bytes (paper, Fig. 8).
    #[default]
    Paper,
    /// 4 bits a number.
    Packed(Packing),
}

impl SnapshotFormat {
    /// The format of a number on the link; none where there is no such format.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::Paper),
            2 => Some(Self::Packed(Packing::Fine)),
            3 => Some(Self::Packed(Packing::Lean)),
            _ => None,
        }
    }

    /// The number of the format on the link.
    pub const fn number(self) -> u8 {
        match self {
            Self::Paper => 1,
            Self::Packed(Packing::Fine) => 2,
            Self::Packed(Packing::Lean) => 3,
        }
    }

    /// Bytes of a view.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Paper => SNAPSHOT_BYTES,
            Self::Packed(packing) => packing.bytes(),
        }
    }

    /// Whether views need their [`Detail`](crate::spectrum::Detail).
    pub const fn needs_detail(self) -> bool {
        matches!(self, Self::Packed(Packing::Fine))
    }
}

/// A view in one of the forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoredView {
    /// The paper's.
    Paper(Snapshot),
    /// In 4 bits a number.
    Packed(PackedSnapshot),
}

impl StoredView {
    /// Rounds a view to what the format holds.
    pub fn quantise(view: &Spectrum, format: SnapshotFormat) -> Self {
        match format {
            SnapshotFormat::Paper => Self::Paper(Snapshot::quantise(view)),
            SnapshotFormat::Packed(packing) => {
                Self::Packed(PackedSnapshot::quantise(view, packing))
            }
        }
    }

    /// A view as it was stored; zero where there are too few bytes.
    pub fn from_bytes(format: SnapshotFormat, stored: &[u8]) -> Self {
        match format {
            SnapshotFormat::Paper => {
                let mut counts = [0; SNAPSHOT_BYTES];
                for (count, byte) in counts.iter_mut().zip(stored) {
                    *count = byte.cast_signed();
                }
                Self::Paper(Snapshot(counts))
            }
            SnapshotFormat::Packed(packing) => {
                Self::Packed(PackedSnapshot::from_bytes(packing, stored))
            }
        }
    }

    /// The stored form.
    pub fn bytes(&self) -> heapless::Vec<u8, MOST_SNAPSHOT_BYTES> {
        // As many at most.
        let stored = |bytes: &[u8]| heapless::Vec::from_slice(bytes).unwrap_or_default();
        match self {
            Self::Paper(snapshot) => stored(&snapshot.bytes().map(i8::cast_unsigned)),
            Self::Packed(snapshot) => stored(snapshot.bytes()),
        }
    }

    /// The view in the paper's form, as the link tells of it; frequencies above eight are left out.
    pub fn in_paper_form(&self) -> Snapshot {
        match self {
            Self::Paper(snapshot) => *snapshot,
            Self::Packed(snapshot) => Snapshot::quantise(&snapshot.dequantise().lowest()),
        }
    }
}
