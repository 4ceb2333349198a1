//! Holds the firmware's homing against solved problems: one JSON object a line.
//!
//! The solutions are in double precision, from the equations of Stürzl & Mallot 2006. Bearings are
//! counter-clockwise from north; a view that is north-aligned has bearing 2πn / 128 at index n.

use nav::homing::{self, FLAT_WEIGHTS, ImageDifference};
use nav::horizon::BEARING_STEP_RAD;
use nav::spectrum::{StoredCoefficients, rotate};
use nav::{Horizon, Snapshot, Spectrum};
use serde::{Deserialize, Serialize};

/// Largest deviation of a coefficient, luma.
const COEFFICIENT_TOLERANCE: f32 = 1e-3;
/// Largest deviation of h: absolute, or relative where h is longer than 1.
const H_TOLERANCE: f32 = 1e-3;
/// Largest deviation of the difference, relative: 17 terms of single precision.
const DIFFERENCE_TOLERANCE: f32 = 1e-3;
/// Bound of the coarse rotation, steps of 2.8 degrees.
const ROTATION_BOUND: u8 = 11;

/// One homing problem with its solution.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    /// The current view: 128 luma values.
    pub horizon: Vec<f32>,
    /// Its coefficients a_1..a_9, luma.
    pub a: Vec<f32>,
    /// Its coefficients b_1..b_9, luma.
    pub b: Vec<f32>,
    /// The snapshot's a_1..a_8 in counts.
    pub snapshot_a: [i8; 8],
    /// The snapshot's b_1..b_8 in counts.
    pub snapshot_b: [i8; 8],
    /// The best of 128 rotations.
    pub align128: u8,
    /// The best rotation within ±11 steps.
    pub align_within_11: i8,
    /// x, y, φ of the 3 x 3 system.
    pub h3: [f32; 3],
    /// The same without the view's ninth term.
    pub h3_without_k9: [f32; 3],
    /// x, y of the 2 x 2 system.
    pub h2: [f32; 2],
    /// Σ |c_k - t_k|² after turning, luma².
    pub difference: f32,
    /// Where the snapshot was taken, seen from here, metres.
    pub true_displacement_m: [f32; 2],
    /// How far its viewer was turned, radians.
    pub true_yaw_rad: f32,
}

/// What became of a file.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Records read.
    pub records: usize,
    /// Lines, from 1, whose record does not hold.
    pub failed: Vec<usize>,
    /// Largest deviation of any component of any h.
    pub worst_h: f32,
    /// Why each failed.
    #[serde(skip)]
    pub failures: Vec<Failure>,
}

/// A record that does not hold.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Its line, from 1.
    pub line: usize,
    /// What deviates.
    pub reason: String,
}

/// A file that is no list of problems.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A line is not a problem.
    #[error("line {line}: {cause}")]
    Malformed {
        /// The line, from 1.
        line: usize,
        /// What JSON found.
        cause: serde_json::Error,
    },
    /// A horizon has another length.
    #[error("line {line}: the horizon has {length} values, not 128")]
    Horizon {
        /// The line, from 1.
        line: usize,
        /// Its length.
        length: usize,
    },
    /// There is nothing in it: nothing was checked, and nothing shall look as if it were.
    #[error("the file holds no record")]
    Empty,
}

/// Checks every record of a file.
pub fn check(text: &str) -> Result<Report, CheckError> {
    let mut report = Report {
        records: 0,
        failed: Vec::new(),
        worst_h: 0.0,
        failures: Vec::new(),
    };
    for (line, text) in (1..)
        .zip(text.lines())
        .filter(|(_, text)| !text.trim().is_empty())
    {
        let problem: Problem =
            serde_json::from_str(text).map_err(|cause| CheckError::Malformed { line, cause })?;
        let view = problem.view().ok_or(CheckError::Horizon {
            line,
            length: problem.horizon.len(),
        })?;
        report.records += 1;
        match problem.deviation(&view) {
            Ok(worst_h) => report.worst_h = report.worst_h.max(worst_h),
            Err(reason) => {
                report.failed.push(line);
                report.failures.push(Failure { line, reason });
            }
        }
    }
    if report.records == 0 {
        Err(CheckError::Empty)
    } else {
        Ok(report)
    }
}

impl Problem {
    /// The spectrum of the current view; none if the horizon has not 128 values.
    pub fn view(&self) -> Option<Spectrum> {
        let luma = self.horizon[..].try_into().ok()?;
        Some(Spectrum::of(&Horizon::new(luma, 0.0)))
    }

    /// The snapshot as stored.
    pub fn snapshot(&self) -> Snapshot {
        let mut counts = [0; 16];
        counts[..8].copy_from_slice(&self.snapshot_a);
        counts[8..].copy_from_slice(&self.snapshot_b);
        Snapshot(counts)
    }

    /// The snapshot turned back by the solution's coarse rotation.
    pub fn turned_snapshot(&self) -> StoredCoefficients {
        let mut stored = self.snapshot().dequantise();
        rotate(
            &mut stored,
            -f32::from(self.align_within_11) * BEARING_STEP_RAD,
        );
        stored
    }

    /// The largest deviation of h if everything holds, else what does not.
    fn deviation(&self, view: &Spectrum) -> Result<f32, String> {
        let a = view.coefficients().iter().map(|c| c.re);
        let b = view.coefficients().iter().map(|c| -c.im);
        within("a", a, &self.a, COEFFICIENT_TOLERANCE)?;
        within("b", b, &self.b, COEFFICIENT_TOLERANCE)?;

        let stored = self.snapshot().dequantise();
        let best = homing::align128(view, &stored, &FLAT_WEIGHTS);
        if best != self.align128 {
            return Err(format!("align128 is {best}, not {}", self.align128));
        }
        let best = homing::align_within(view, &stored, &FLAT_WEIGHTS, ROTATION_BOUND);
        if best != self.align_within_11 {
            return Err(format!(
                "align_within_11 is {best}, not {}",
                self.align_within_11
            ));
        }

        let turned = self.turned_snapshot();
        let whole = ImageDifference::between(view, &turned, &FLAT_WEIGHTS);
        let truncated = ImageDifference::between(&view.truncated(), &turned, &FLAT_WEIGHTS);
        within(
            "difference",
            [whole.constant()],
            &[self.difference],
            DIFFERENCE_TOLERANCE,
        )?;
        let none = |reason| format!("no vector: {reason:?}");
        let h3 = whole.minimum().map_err(none)?;
        let h3_without_k9 = truncated.minimum().map_err(none)?;
        let h2 = whole.minimum_without_turn().map_err(none)?;
        let worst = [
            within("h3", h3.iter().copied(), &self.h3, H_TOLERANCE)?,
            within(
                "h3_without_k9",
                h3_without_k9.iter().copied(),
                &self.h3_without_k9,
                H_TOLERANCE,
            )?,
            within("h2", h2.iter().copied(), &self.h2, H_TOLERANCE)?,
        ];
        Ok(worst.into_iter().fold(0.0, f32::max))
    }
}

/// The largest absolute deviation, if each is within the tolerance: absolute for values up to 1,
/// relative beyond. NaN is never within.
fn within(
    name: &str,
    found: impl IntoIterator<Item = f32>,
    expected: &[f32],
    tolerance: f32,
) -> Result<f32, String> {
    let found: Vec<f32> = found.into_iter().collect();
    if found.len() != expected.len() {
        return Err(format!(
            "{name} has {} values, not {}",
            expected.len(),
            found.len()
        ));
    }
    let mut worst: f32 = 0.0;
    for (found, expected) in found.iter().zip(expected) {
        let deviation = (found - expected).abs();
        // Written so that NaN fails.
        let holds = deviation <= tolerance * expected.abs().max(1.0);
        if !holds {
            return Err(format!("{name} is {found}, not {expected}"));
        }
        worst = worst.max(deviation);
    }
    Ok(worst)
}
