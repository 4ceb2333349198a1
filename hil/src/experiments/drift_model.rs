//! The paper's model of odometry drift, run again.
//!
//! A robot whose first pose is off by N(0.10 m) in x and y and N(5°) in heading goes straight on in steps of 0.25 m;
//! each step turns it by N(2°) and then moves it, off by N(0.025 m) in x and y (van Dijk et al. 2024, simulation setup).

use fake_sensors::random::Normal;

/// Standard deviation of the first position, metres.
const START_SD_M: f64 = 0.10;
/// Standard deviation of the first heading, degrees.
const START_SD_DEG: f64 = 5.0;
/// Standard deviation of the turn in a step, degrees.
const STEP_SD_DEG: f64 = 2.0;
/// Standard deviation of the move in a step, metres.
const STEP_SD_M: f64 = 0.025;
/// Length of a step, metres.
const STEP_M: f64 = 0.25;
/// Stream of the seed.
const STREAM: u64 = u64::from_be_bytes(*b"drifting");

/// Errors after a distance, over many runs, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// The distance.
    pub distance_m: f64,
    /// Standard deviation along the way.
    pub along_sd_m: f64,
    /// Standard deviation across it.
    pub cross_sd_m: f64,
    /// Root mean square error along it.
    pub along_rms_m: f64,
    /// Root mean square error across it.
    pub cross_rms_m: f64,
}

const fn row(
    distance_m: f64,
    [along_sd_m, cross_sd_m, along_rms_m, cross_rms_m]: [f64; 4],
) -> Drift {
    Drift {
        distance_m,
        along_sd_m,
        cross_sd_m,
        along_rms_m,
        cross_rms_m,
    }
}

/// The same model in another implementation, 200,000 runs, to a millimetre.
pub const REFERENCE: [Drift; 6] = [
    row(0.0, [0.100, 0.100, 0.100, 0.100]),
    row(1.0, [0.112, 0.149, 0.112, 0.149]),
    row(2.0, [0.124, 0.245, 0.124, 0.245]),
    row(3.0, [0.135, 0.365, 0.137, 0.365]),
    row(5.0, [0.162, 0.649, 0.170, 0.649]),
    row(10.0, [0.264, 1.545, 0.309, 1.545]),
];

/// Runs the model, and looks at the errors at the distances of [`REFERENCE`].
pub fn run(runs: u32, seed: u64) -> [Drift; REFERENCE.len()] {
    let mut random = Normal::new(seed, STREAM);
    let mut sums = [Sums::default(); REFERENCE.len()];
    for _ in 0..runs {
        let mut x_m = START_SD_M * random.sample();
        let mut y_m = START_SD_M * random.sample();
        let mut heading_rad = START_SD_DEG.to_radians() * random.sample();
        let mut steps = 0_u32;
        for (sums, row) in sums.iter_mut().zip(&REFERENCE) {
            while f64::from(steps) * STEP_M < row.distance_m {
                heading_rad += STEP_SD_DEG.to_radians() * random.sample();
                let (sin, cos) = libm::sincos(heading_rad);
                x_m += STEP_M * cos + STEP_SD_M * random.sample();
                y_m += STEP_M * sin + STEP_SD_M * random.sample();
                steps += 1;
            }
            sums.add(x_m - row.distance_m, y_m);
        }
    }
    let mut found = REFERENCE;
    for (row, sums) in found.iter_mut().zip(&sums) {
        *row = sums.drift(row.distance_m, runs.into());
    }
    found
}

/// Whether all figures are those of the reference: to half its last digit, and to four standard errors of the
/// difference between two standard deviations over so many runs each.
pub fn agrees(found: &[Drift; REFERENCE.len()], runs: u32) -> bool {
    const HALF_A_DIGIT_M: f64 = 0.000_5;
    const REFERENCE_RUNS: f64 = 200_000.0;
    let chance = 4.0 * (0.5 / f64::from(runs) + 0.5 / REFERENCE_RUNS).sqrt();
    let near =
        |found: f64, expected: f64| (found - expected).abs() <= HALF_A_DIGIT_M + chance * expected;
    found.iter().zip(&REFERENCE).all(|(found, expected)| {
        near(found.along_sd_m, expected.along_sd_m)
            && near(found.cross_sd_m, expected.cross_sd_m)
            && near(found.along_rms_m, expected.along_rms_m)
            && near(found.cross_rms_m, expected.cross_rms_m)
    })
}

/// Sums and sums of squares of the errors along and across.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    along: [f64; 2],
    cross: [f64; 2],
}

impl Sums {
    fn add(&mut self, along_m: f64, cross_m: f64) {
        for (sums, error) in [(&mut self.along, along_m), (&mut self.cross, cross_m)] {
            sums[0] += error;
            sums[1] += error * error;
        }
    }

    fn drift(&self, distance_m: f64, runs: f64) -> Drift {
        let rms = |[_, squares]: [f64; 2]| (squares / runs).sqrt();
        let sd = |[sum, squares]: [f64; 2]| {
            let mean = sum / runs;
            (squares / runs - mean * mean).sqrt()
        };
        Drift {
            distance_m,
            along_sd_m: sd(self.along),
            cross_sd_m: sd(self.cross),
            along_rms_m: rms(self.along),
            cross_rms_m: rms(self.cross),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: u32 = 50_000;

    #[test]
    fn the_model_drifts_as_another_implementation_of_it() {
        let found = run(RUNS, 1);
        assert!(agrees(&found, RUNS), "{found:?}");
    }

    #[test]
    fn a_figure_two_per_cent_off_does_not_agree() {
        let mut off = REFERENCE;
        assert!(agrees(&off, RUNS));
        off[4].cross_sd_m *= 1.02;
        assert!(!agrees(&off, RUNS));
    }

    #[test]
    fn at_the_start_the_error_is_that_of_the_first_pose() {
        let [start, ..] = run(RUNS, 2);
        assert!((start.along_sd_m / START_SD_M - 1.0).abs() < 0.02);
        assert!((start.cross_rms_m / START_SD_M - 1.0).abs() < 0.02);
    }
}
