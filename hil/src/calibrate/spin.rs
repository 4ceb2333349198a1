//! The check by a spin: a camera that turns about the vertical sees its horizon shift, and nothing
//! else. A centre that is off by d pixels bends the bearings by d / r once round the circle, by another
//! amount in each picture of the spin.

use core::f64::consts::{PI, TAU};

use serde::Serialize;

use super::picture::{Picture, polar};
use super::steepest::vertex;

/// Bearings of a panorama: 1.4 degrees apart, finer than pixels at any radius of the ring.
const BEARINGS: usize = 256;
/// Radii of a panorama.
const RADII: usize = 12;
const STEP_RAD: f64 = TAU / BEARINGS as f64;

/// Parts of the horizon that are compared by themselves.
const OCTANTS: usize = 8;
/// How far an octant may have shifted by itself, bearings: 11 degrees, what a centre does that is off
/// by three pixels.
const REACH: i32 = 8;
/// The least that an octant must resemble the other picture's, as a correlation, to have a shift.
const RESEMBLANCE: f64 = 0.7;
/// The least contrast of an octant that can be compared, as a share of that of the whole panorama.
const CONTRAST: f64 = 0.25;

/// A ring about a centre, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Its centre.
    pub centre: [f64; 2],
    /// Its inner radius.
    pub inner_px: f64,
    /// Its outer radius.
    pub outer_px: f64,
}

impl Band {
    fn mean_radius_px(&self) -> f64 {
        0.5 * (self.inner_px + self.outer_px)
    }
}

/// What the pictures of a spin have in common.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spin {
    /// How far each picture but the first is turned against the first: degrees, clockwise on the screen,
    /// -180..=180.
    pub turns_deg: Vec<f64>,
    /// What is left, octant by octant, where each picture is turned back: degrees RMS.
    pub residual_deg: f64,
    /// The same at the ring's mean radius, pixels.
    pub residual_px: f64,
    /// Octants that could be compared; the others have no pattern, or look too different.
    pub octants: usize,
}

impl Spin {
    /// Compares the pictures with the first; none where there is nothing to compare.
    pub fn of(pictures: &[Picture], band: &Band) -> Option<Self> {
        let (first, others) = pictures.split_first()?;
        let first = Panorama::of(first, band);
        let (mut turns_deg, mut squares, mut octants) = (Vec::new(), 0.0, 0);
        for other in others {
            let other = Panorama::of(other, band);
            let turn = first.turn_to(&other);
            turns_deg.push(turn.to_degrees());
            for shift in first.local_shifts(&other, turn) {
                squares += shift * shift;
                octants += 1;
            }
        }
        let residual_rad = (squares / f64::from(octants.max(1))).sqrt();
        (octants > 0).then(|| Self {
            turns_deg,
            residual_deg: residual_rad.to_degrees(),
            residual_px: residual_rad * band.mean_radius_px(),
            octants: octants as usize,
        })
    }

    /// How far each picture is turned against the one before it: degrees, clockwise on the screen,
    /// -180..180.
    pub fn steps_deg(&self) -> Vec<f64> {
        let before = core::iter::once(&0.0).chain(&self.turns_deg);
        let steps = before.zip(&self.turns_deg).map(|(before, turn)| {
            let step = (turn - before).to_radians();
            libm::remainder(step, TAU).to_degrees()
        });
        steps.collect()
    }
}

/// A ring unrolled: by radius, by angle on the screen (clockwise from the right); of each radius the
/// mean is taken away, and the whole has variance one.
struct Panorama {
    rows: [[f64; BEARINGS]; RADII],
}

impl Panorama {
    fn of(picture: &Picture, band: &Band) -> Self {
        let mut rows = [[0.0; BEARINGS]; RADII];
        for (index, row) in rows.iter_mut().enumerate() {
            let share = (index as f64 + 0.5) / RADII as f64;
            let radius = band.inner_px + share * (band.outer_px - band.inner_px);
            for (bearing, luma) in row.iter_mut().enumerate() {
                let angle = bearing as f64 * STEP_RAD;
                *luma = picture.at(polar(band.centre, radius, angle)).unwrap_or(0.0);
            }
            let mean = row.iter().sum::<f64>() / BEARINGS as f64;
            row.iter_mut().for_each(|luma| *luma -= mean);
        }
        let power: f64 = rows.iter().flatten().map(|luma| luma * luma).sum();
        let scale = ((RADII * BEARINGS) as f64 / power.max(f64::MIN_POSITIVE)).sqrt();
        rows.iter_mut().flatten().for_each(|luma| *luma *= scale);
        Self { rows }
    }

    /// How far the other is turned against this one: radians, clockwise on the screen, -π..=π.
    fn turn_to(&self, other: &Self) -> f64 {
        let scores: Vec<f64> = (0..BEARINGS as i32)
            .map(|shift| self.compare(other, 0..BEARINGS, shift).product)
            .collect();
        let score = |shift: i32| scores[shift.rem_euclid(BEARINGS as i32) as usize];
        let best = (0..BEARINGS as i32).max_by(|a, b| score(*a).total_cmp(&score(*b)));
        let best = best.unwrap_or(0);
        let whole = f64::from(best) + vertex(score(best - 1), score(best), score(best + 1));
        let turn = whole * STEP_RAD;
        if turn > PI { turn - TAU } else { turn }
    }

    /// How far each octant of the other is shifted beyond `turn`, radians.
    fn local_shifts(&self, other: &Self, turn: f64) -> impl Iterator<Item = f64> {
        let whole = (turn / STEP_RAD).round() as i32;
        let rest = turn / STEP_RAD - f64::from(whole);
        let width = BEARINGS / OCTANTS;
        (0..OCTANTS).filter_map(move |octant| {
            let columns = octant * width..(octant + 1) * width;
            let score = |shift: i32| {
                let found = self.compare(other, columns.clone(), whole + shift);
                found.product / (found.here * found.there).sqrt().max(f64::MIN_POSITIVE)
            };
            let best = (-REACH..=REACH).max_by(|a, b| score(*a).total_cmp(&score(*b)))?;
            let contrast =
                self.compare(other, columns.clone(), whole).here / (width * RADII) as f64;
            let clear =
                best.abs() < REACH && score(best) > RESEMBLANCE && contrast > CONTRAST * CONTRAST;
            let shift = f64::from(best) + vertex(score(best - 1), score(best), score(best + 1));
            clear.then_some((shift - rest) * STEP_RAD)
        })
    }

    /// Products of these columns with those of the other that lie `shift` further on.
    fn compare(&self, other: &Self, columns: core::ops::Range<usize>, shift: i32) -> Products {
        let mut products = Products::default();
        let shift = shift.rem_euclid(BEARINGS as i32) as usize;
        for (here, there) in self.rows.iter().zip(&other.rows) {
            for column in columns.clone() {
                let [a, b] = [here[column], there[(column + shift) % BEARINGS]];
                products.product += a * b;
                products.here += a * a;
                products.there += b * b;
            }
        }
        products
    }
}

#[derive(Default)]
struct Products {
    product: f64,
    here: f64,
    there: f64,
}
