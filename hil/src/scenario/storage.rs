//! What the route memory makes of a way.

use clap::ValueEnum;
use nav::SnapshotFormat;
use nav::snapshot::Packing;
use serde::{Deserialize, Serialize};

use super::Spacing;

/// How a snapshot is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SnapshotForm {
    /// Eight frequencies of 8 bits: 16 bytes, as in the paper
    #[default]
    Paper,
    /// Sixteen frequencies of 4 bits: 16 bytes
    Fine,
    /// Eight frequencies of 4 bits: 8 bytes
    Lean,
}

impl SnapshotForm {
    /// The firmware's name for it.
    pub fn format(self) -> SnapshotFormat {
        match self {
            Self::Paper => SnapshotFormat::Paper,
            Self::Fine => SnapshotFormat::Packed(Packing::Fine),
            Self::Lean => SnapshotFormat::Packed(Packing::Lean),
        }
    }

    /// The form of a number on the link.
    pub fn from_number(number: u8) -> Option<Self> {
        let format = SnapshotFormat::from_number(number)?;
        let all = Self::value_variants().iter().copied();
        all.into_iter().find(|form| form.format() == format)
    }
}

/// How far the stored way may deviate from the one flown, in the link's unit of 0.1 m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deviation {
    decimetres: u8,
}

impl Deviation {
    /// 0.1 m, the paper's.
    pub const DEFAULT: Self = Self { decimetres: 1 };

    /// From metres; `None` unless a multiple of 0.1 m within 0.1..=1 m.
    pub fn from_metres(metres: f64) -> Option<Self> {
        let decimetres = 10.0 * metres;
        let whole = (decimetres - decimetres.round()).abs() < 1e-6;
        // Beyond a metre a way round a panel leads through it.
        (whole && (1.0..=10.0).contains(&decimetres.round())).then(|| Self {
            decimetres: decimetres.round() as u8,
        })
    }

    /// In metres.
    pub fn metres(self) -> f64 {
        f64::from(self.decimetres) / 10.0
    }
}

/// What is asked of the route memory besides the spacing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Storage {
    /// The form of the snapshots.
    pub snapshots: SnapshotForm,
    /// What the way between them may lose.
    pub deviation: Deviation,
}

impl Storage {
    /// The paper's, which the firmware has unless it is told otherwise.
    pub const PAPER: Self = Self {
        snapshots: SnapshotForm::Paper,
        deviation: Deviation::DEFAULT,
    };

    /// The arguments of the command to record with snapshots so far apart.
    pub fn arguments(self, spacing: Spacing) -> Vec<u8> {
        let mut arguments = vec![spacing.argument()];
        if self != Self::PAPER {
            arguments.push(self.snapshots.format().number());
            arguments.push(self.deviation.decimetres);
        }
        arguments
    }
}

impl Default for Storage {
    fn default() -> Self {
        Self::PAPER
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_storage_is_not_spoken_of_and_another_is_asked_for_whole() {
        assert_eq!(Storage::PAPER.arguments(Spacing::DEFAULT), [20]);
        let lean = Storage {
            snapshots: SnapshotForm::Lean,
            deviation: Deviation::from_metres(0.3).expect("three tenths"),
        };
        let seven = Spacing::from_metres(7.0).expect("whole metres");
        assert_eq!(lean.arguments(seven), [70, 3, 3]);
        assert_eq!(lean.arguments(Spacing::ByTheory), [255, 3, 3]);
    }

    #[test]
    fn deviations_are_tenths_of_a_metre_up_to_one() {
        let metres = |metres| Deviation::from_metres(metres).map(Deviation::metres);
        assert_eq!((metres(0.1), metres(1.0)), (Some(0.1), Some(1.0)));
        assert_eq!([0.0, 0.05, 0.25, 1.1, f64::NAN].map(metres), [None; 5]);
    }

    #[test]
    fn every_form_has_the_firmwares_number() {
        for form in SnapshotForm::value_variants() {
            let number = form.format().number();
            assert_eq!(SnapshotForm::from_number(number), Some(*form));
        }
        assert_eq!(SnapshotForm::from_number(0), None);
    }
}
