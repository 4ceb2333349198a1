//! A folder of panoramic pictures on a grid, with a manifest: sets as those of Gaffin & Brayfield or
//! of Bielefeld, for whoever has them.
//!
//! `manifest.toml` says how the pictures are to be read and where each was taken:
//!
//! ```toml
//! licence = "CC BY 4.0, A. Author"
//! spacing_m = 0.127
//! size = [100, 100]             # of each picture, pixels
//! [ring]                        # as a panoramic mirror makes it; or [panorama], see below
//! centre = [49.5, 49.5]
//! radii = [18.0, 45.0]          # between which luma is averaged, pixels
//! north_deg = 90.0              # where north is, counter-clockwise from the right
//! clockwise = false             # whether bearings seen counter-clockwise from above run clockwise
//! # [panorama]
//! # rows = [40, 60]             # first and last row that are averaged
//! # north_column = 50.0
//! # clockwise = false           # whether bearings grow clockwise from left to right
//! [[image]]
//! file = "x0_y0.png"
//! at = [0.0, 0.0]               # x north, y west, metres
//! heading_deg = 0.0             # of the camera, counter-clockwise from north; 0 if left out
//! ```

use core::f32::consts::TAU;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use image::{GrayImage, ImageReader};
use nav::horizon::BEARINGS;
use nav::methods::Luma;
use serde::Deserialize;

use super::grid::Grid;
use super::render::MEAN_LUMA;

/// The manifest's name.
const MANIFEST: &str = "manifest.toml";
/// Positions of a grid at most: a square of 63 m at the paper's spacing.
const MOST_POSITIONS: usize = 250_000;
/// How far from its place on the grid a picture may have been taken, in spacings.
const OFF_GRID: f32 = 0.25;
/// Samples along the radii of a ring.
const RADIAL_SAMPLES: usize = 16;

/// A set that cannot be used at all.
#[derive(Debug, thiserror::Error)]
pub enum PicturesError {
    /// No manifest.
    #[error("{file}: cannot be read: {source}", file = .file.display())]
    Unreadable {
        /// The manifest.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A manifest that says nothing sensible.
    #[error("{file}:{line}: {reason}", file = .file.display())]
    Bad {
        /// The manifest.
        file: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    licence: String,
    spacing_m: f32,
    size: [u32; 2],
    ring: Option<Ring>,
    panorama: Option<Unrolled>,
    image: Vec<Entry>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Ring {
    centre: [f32; 2],
    radii: [f32; 2],
    north_deg: f32,
    #[serde(default)]
    clockwise: bool,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Unrolled {
    rows: [u32; 2],
    north_column: f32,
    #[serde(default)]
    clockwise: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: PathBuf,
    at: [f32; 2],
    #[serde(default)]
    heading_deg: f32,
}

/// Views that were photographed.
#[derive(Debug)]
pub struct Pictures {
    grid: Grid,
    views: BTreeMap<usize, Luma>,
    licence: String,
}

impl Pictures {
    /// Reads a set, and what of it is missing or broken: the rest is used.
    ///
    /// # Errors
    /// [`PicturesError`] where the manifest cannot be used.
    pub fn open(folder: &Path) -> Result<(Self, Vec<String>), PicturesError> {
        let file = folder.join(MANIFEST);
        let text = fs::read_to_string(&file).map_err(|source| PicturesError::Unreadable {
            file: file.clone(),
            source,
        })?;
        let bad = |line, reason: &str| PicturesError::Bad {
            file: file.clone(),
            line,
            reason: reason.to_owned(),
        };
        let manifest: Manifest = toml::from_str(&text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let before = text.bytes().take(start);
            bad(
                1 + before.filter(|byte| *byte == b'\n').count(),
                error.message(),
            )
        })?;
        let shape = manifest.shape().map_err(|reason| bad(1, reason))?;
        let mut grid = manifest.grid().map_err(|reason| bad(1, reason))?;

        let mut complaints = Vec::new();
        let mut views = BTreeMap::new();
        for entry in &manifest.image {
            match manifest.read(folder, entry, &shape, &grid) {
                Err(complaint) => complaints.push(format!("{}: {complaint}", entry.file.display())),
                Ok((index, view)) => {
                    if views.insert(index, view).is_some() {
                        let [x, y] = entry.at;
                        complaints.push(format!(
                            "{}: a second picture at {x}, {y}",
                            entry.file.display()
                        ));
                    }
                }
            }
        }
        for index in 0..grid.free.len() {
            grid.free[index] = views.contains_key(&index);
            if !grid.free[index] {
                let [x, y] = grid.position_m(index);
                complaints.push(format!("no picture at {x:.3}, {y:.3}"));
            }
        }
        let licence = manifest.licence;
        let pictures = Self {
            grid,
            views,
            licence,
        };
        Ok((pictures, complaints))
    }

    /// Where there are pictures.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Under what licence they may be used.
    pub fn licence(&self) -> &str {
        &self.licence
    }

    /// The view from a position, by a viewer who is turned counter-clockwise; none where there is no
    /// picture.
    pub fn view(&self, index: usize, turn_rad: f32) -> Option<Luma> {
        let view = self.views.get(&index)?;
        Some(core::array::from_fn(|n| {
            ring_at(view, n as f32 + turn_rad * (BEARINGS as f32 / TAU))
        }))
    }
}

/// A value between two bearings.
fn ring_at(view: &Luma, place: f32) -> f32 {
    let below = place.floor();
    let index = (below as i32).rem_euclid(BEARINGS as i32) as usize;
    let next = view[(index + 1) % BEARINGS];
    view[index] + (next - view[index]) * (place - below)
}

/// How a picture is read.
enum Shape {
    Ring(Ring),
    Unrolled(Unrolled),
}

impl Manifest {
    fn shape(&self) -> Result<Shape, &'static str> {
        let [width, height] = self.size;
        match (self.ring, self.panorama) {
            (Some(ring), None) if 0.0 < ring.radii[0] && ring.radii[0] < ring.radii[1] => {
                Ok(Shape::Ring(ring))
            }
            (Some(_), None) => Err("the radii of the ring ascend from more than 0"),
            (None, Some(unrolled)) => {
                let [first, last] = unrolled.rows;
                if first <= last && last < height && width > 0 {
                    Ok(Shape::Unrolled(unrolled))
                } else {
                    Err("the rows of the panorama ascend and lie within its size")
                }
            }
            _ => Err("there is either a [ring] or a [panorama]"),
        }
    }

    /// The smallest grid that holds all positions.
    fn grid(&self) -> Result<Grid, &'static str> {
        let spacing_m = self.spacing_m;
        if !(0.001..=10.0).contains(&spacing_m) {
            return Err("spacing_m is from 0.001 to 10");
        }
        let all = self.image.iter().map(|entry| entry.at);
        if self.image.is_empty() || !all.clone().flatten().all(f32::is_finite) {
            return Err("there is at least one [[image]], each `at` two numbers");
        }
        let low = all.clone().fold([f32::INFINITY; 2], |low, at| {
            [low[0].min(at[0]), low[1].min(at[1])]
        });
        let counts = [0, 1].map(|axis: usize| {
            let reach = all.clone().map(|at| at[axis] - low[axis]);
            1 + (reach.fold(0.0, f32::max) / spacing_m).round() as usize
        });
        let [columns, rows] = counts;
        if columns.saturating_mul(rows) > MOST_POSITIONS {
            return Err("the pictures are too far apart for a grid of this spacing");
        }
        Ok(Grid {
            origin_m: low,
            spacing_m,
            columns,
            rows,
            free: vec![true; columns * rows],
        })
    }

    /// A picture's place on the grid and its view, or what is wrong with it.
    fn read(
        &self,
        folder: &Path,
        entry: &Entry,
        shape: &Shape,
        grid: &Grid,
    ) -> Result<(usize, Luma), String> {
        let cell =
            [0, 1].map(|axis: usize| (entry.at[axis] - grid.origin_m[axis]) / grid.spacing_m);
        if cell
            .iter()
            .any(|place| (place - place.round()).abs() > OFF_GRID)
        {
            return Err(format!("taken at {:?}, off the grid", entry.at));
        }
        let index = cell[1].round() as usize * grid.columns + cell[0].round() as usize;
        let reader = ImageReader::open(folder.join(&entry.file)).map_err(|e| e.to_string())?;
        let reader = reader.with_guessed_format().map_err(|e| e.to_string())?;
        let picture = reader.decode().map_err(|e| e.to_string())?.to_luma8();
        if [picture.width(), picture.height()] != self.size {
            return Err(format!(
                "{} x {} pixels, not {} x {}",
                picture.width(),
                picture.height(),
                self.size[0],
                self.size[1]
            ));
        }
        // A camera that is turned to the left sees everything that much further to its right.
        let heading = entry.heading_deg.to_radians();
        let view: Luma = core::array::from_fn(|n| {
            shape.luma(&picture, TAU * n as f32 / BEARINGS as f32 - heading)
        });
        let mean = view.iter().sum::<f32>() / BEARINGS as f32;
        if mean <= 0.0 {
            return Err("black all round".to_owned());
        }
        Ok((index, view.map(|luma| luma * MEAN_LUMA / mean)))
    }
}

impl Shape {
    /// Mean luma at a bearing from the camera's own north.
    fn luma(&self, picture: &GrayImage, bearing: f32) -> f32 {
        let pixel = |x: u32, y: u32| {
            let [x, y] = [x.min(picture.width() - 1), y.min(picture.height() - 1)];
            f32::from(picture.get_pixel(x, y).0[0])
        };
        match self {
            Self::Ring(ring) => {
                let sense = if ring.clockwise { -1.0 } else { 1.0 };
                let angle = ring.north_deg.to_radians() + sense * bearing;
                let [cos, sin] = [libm::cosf(angle), libm::sinf(angle)];
                let [inner, outer] = ring.radii;
                let sample = |n: usize| {
                    let radius = inner + (outer - inner) * (n as f32 + 0.5) / RADIAL_SAMPLES as f32;
                    // Rows run downwards.
                    let [x, y] = [ring.centre[0] + radius * cos, ring.centre[1] - radius * sin];
                    pixel(x.round().max(0.0) as u32, y.round().max(0.0) as u32)
                };
                (0..RADIAL_SAMPLES).map(sample).sum::<f32>() / RADIAL_SAMPLES as f32
            }
            Self::Unrolled(unrolled) => {
                let width = picture.width() as f32;
                let sense = if unrolled.clockwise { -1.0 } else { 1.0 };
                let place = unrolled.north_column + sense * bearing * width / TAU;
                let column = (place.round() as i64).rem_euclid(i64::from(picture.width())) as u32;
                let [first, last] = unrolled.rows;
                let sum: f32 = (first..=last).map(|row| pixel(column, row)).sum();
                sum / (last - first + 1) as f32
            }
        }
    }
}

#[cfg(test)]
mod tests;
